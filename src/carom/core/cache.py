"""The disk cache of compiled kernels: what is damaged is compiled again, what cannot be kept is done without.

Numba's own cache trusts its files: one that was cut short blocks every later run, and a flipped bit in machine code is
executed.  Here each compiled version of a kernel is a file of its own, which begins with a checksum of all that it was
compiled from and of its content.  A file that does not agree with its checksum is removed before anything in it is looked
at, and the kernel is compiled again.  Files appear whole, under the name of what they hold, so processes that work side by
side need no lock: they write the same.
"""

from __future__ import annotations

import hashlib
import pickle
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite
import numba
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from carom.core.cache_directory import cache_directory, tell_once
from carom.files import write_whole

__all__ = ["KernelCache", "keep"]

CHECKSUM = 32
"""Bytes of the checksum that a file begins with."""


def keep(kernel: Any) -> None:
    """Keep on the disk what a kernel is compiled to."""
    kernel._cache = KernelCache(kernel.py_func, cache_directory())


class KernelCache(_Cache):  # type: ignore[misc]
    """What one kernel has been compiled to.  Numba asks before it compiles, and hands over what it has compiled.

    Parameters
    ----------
    function : function
        The kernel as it is written.
    directory : Path or None
        Where compiled kernels are kept, if anywhere.
    """

    def __init__(self, function: Any, directory: Path | None) -> None:
        self.directory = directory
        self._function = function
        self._enabled = True

    @property
    def cache_path(self) -> str | None:
        """The directory, as Numba's statistics show it."""
        return None if self.directory is None else str(self.directory)

    def load_overload(self, sig: Any, target_context: Any) -> CompileResult | None:
        """Return the version for these types of arguments, or None if it has to be compiled."""
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
        return CompileResult._rebuild(target_context, *pickle.loads(data[CHECKSUM:]))

    def save_overload(self, sig: Any, data: CompileResult) -> None:
        """Keep a version; where that cannot be, it serves this process alone."""
        if not self._enabled or data.library.has_dynamic_globals:  # these are addresses in this process
            return
        if self.directory is None:
            tell_once()
            return
        origin = self._origin(sig, data.codegen)
        content = dumps(data._reduce())
        try:
            write_whole(self.directory / self._name(origin), _checksum(origin, content) + content, self.directory)
        except OSError:
            tell_once()

    def enable(self) -> None:
        """Use the cache."""
        self._enabled = True

    def disable(self) -> None:
        """Do without it."""
        self._enabled = False

    def flush(self) -> None:
        """Forget all versions."""
        for file in self.directory.glob(self._name()) if self.directory else ():
            file.unlink(missing_ok=True)

    def _name(self, origin: bytes | None = None) -> str:
        """Name of the file of a version, or pattern of all of them."""
        kernel = f"{self._function.__module__}.{self._function.__name__.strip('<>')}"
        return f"{kernel}.{hashlib.sha256(origin).hexdigest()[:16] if origin else '*'}"

    def _origin(self, sig: Any, codegen: Any) -> bytes:
        """All that decides the machine code, but for the other sources of the core, by which the directory is named."""
        code, cells = self._function.__code__, self._function.__closure__ or ()
        written = _source(code.co_filename), code.co_firstlineno, dumps(tuple(cell.cell_contents for cell in cells))
        compiler = sys.version, numba.__version__, llvmlite.__version__, codegen.magic_tuple()
        return repr((self._function.__module__, written, compiler, sig)).encode()


def _checksum(origin: bytes, content: bytes) -> bytes:
    return hashlib.sha256(origin + content).digest()


@cache
def _source(path: str) -> str:
    """Hash of a source file."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()
