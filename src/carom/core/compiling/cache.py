"""The disk cache of compiled kernels.  A damaged file is compiled again; an unwritable disk only costs time.

Numba's own cache trusts its files: a truncated file makes every later run fail, and a flipped bit in machine code is
executed.  Here each compiled version of a kernel has its own file.  The file begins with a checksum of its content and
of everything it was compiled from.  If the checksum does not match, the file is removed before its content is read, and
the kernel is compiled again.  Files are written atomically, and their names are derived from what they were compiled
from.  So processes that run at the same time need no lock: they write the same content.
"""

from __future__ import annotations

import hashlib
import pickle
import sys
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import llvmlite
import numba
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from carom.base.files import write_whole
from carom.core.compiling.cache_directory import cache_directory, warn_once
from carom.core.compiling.choice import compiles_plainly
from carom.core.compiling.names import source_of

if TYPE_CHECKING:
    from types import FunctionType

    from numba.core.codegen import JITCPUCodegen
    from numba.core.cpu import CPUContext
    from numba.core.registry import CPUDispatcher
    from numba.core.types import Type
    from numba.core.typing.templates import Signature

CHECKSUM = 32
"""Length of the checksum at the start of a file, in bytes."""


def keep(kernel: CPUDispatcher) -> None:
    """Cache the compiled versions of a kernel on disk."""
    kernel._cache = KernelCache(kernel.py_func, cache_directory())


class KernelCache(_Cache):  # type: ignore[misc]
    """The compiled versions of one kernel.  Numba queries it before it compiles, and stores here what it has compiled.

    Parameters
    ----------
    function : function
        The Python function of the kernel.
    directory : Path or None
        The cache directory; None to cache nothing.
    """

    def __init__(self, function: FunctionType, directory: Path | None) -> None:
        self.directory = directory
        self._function = function
        self._enabled = True

    @property
    def cache_path(self) -> str | None:
        """The directory as text, for Numba's statistics."""
        return None if self.directory is None else str(self.directory)

    def load_overload(self, sig: Signature | tuple[Type, ...], target_context: CPUContext) -> CompileResult | None:
        """Return the version for these argument types, or None if it has to be compiled."""
        target_context.refresh()
        if not self._enabled or self.directory is None:
            return None
        origin = self._origin(sig, target_context.codegen())
        file = self.directory / self._name(origin)
        try:
            data = file.read_bytes()
        except OSError:
            return None
        if data[:CHECKSUM] != _checksum(origin, data[CHECKSUM:]):
            with suppress(OSError):
                file.unlink()
            return None
        needs, reduced = pickle.loads(data[CHECKSUM:])
        for module, name, args in needs:  # machine code that this one calls
            getattr(import_module(module), name).compile(args)
        return CompileResult._rebuild(target_context, *reduced)

    def save_overload(self, sig: Signature | tuple[Type, ...], data: CompileResult) -> None:
        """Write a version to the cache; if that fails, only this process uses it."""
        if not self._enabled or data.library.has_dynamic_globals:  # addresses that are valid in this process only
            return
        if self.directory is None:
            warn_once()
            return
        origin = self._origin(sig, data.codegen)
        content = dumps((list(getattr(data.library, "needs", ())), data._reduce()))
        try:
            write_whole(self.directory / self._name(origin), _checksum(origin, content) + content, self.directory)
        except OSError:
            warn_once()

    def enable(self) -> None:
        """Use the cache."""
        self._enabled = True

    def disable(self) -> None:
        """Stop using the cache."""
        self._enabled = False

    def flush(self) -> None:
        """Delete all cached versions of this kernel."""
        for file in self.directory.glob(self._name()) if self.directory else ():
            file.unlink(missing_ok=True)

    def _name(self, origin: bytes | None = None) -> str:
        """File name of one version, or the pattern that matches all versions."""
        kernel = f"{self._function.__module__}.{self._function.__name__.strip('<>')}"
        return f"{kernel}.{hashlib.sha256(origin).hexdigest()[:16] if origin else '*'}"

    def _origin(self, sig: Signature | tuple[Type, ...], codegen: JITCPUCodegen) -> bytes:
        """Everything that determines the machine code, except the other sources: these name the directory."""
        compiler = sys.version, numba.__version__, llvmlite.__version__, codegen.magic_tuple(), compiles_plainly()
        return repr((source_of(self._function), compiler, sig)).encode()


def _checksum(origin: bytes, content: bytes) -> bytes:
    return hashlib.sha256(origin + content).digest()
