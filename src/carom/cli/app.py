"""All commands, and the only place where errors become a line of text, an object of JSON and an exit code."""

from __future__ import annotations

import _thread
import io
import json
import math
import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, TextIO

import typer

from carom.base.outcome import CaromError, CaromWarning, InputError, printable, shown
from carom.cli.options import with_purpose
from carom.cli.terminal import InterruptionError

FAILURE, BAD_INPUT, INTERRUPTED, TERMINATED = 1, 2, 130, 143
AGAIN = 0.01
"""Seconds after which a lost interrupt is raised again."""

# The error of a wrong option or argument; different versions of typer keep click in different places.
UsageError: type[Exception] = typer.BadParameter.__bases__[0]

app = typer.Typer(
    name="carom",
    help="A rotor on magnetic bearings that touches its touchdown bearing: does it come back?",
    epilog="A machine file is TOML with a [machine] table of values with units, a [dimensionless] table, or a [rotor] table.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)
ON_A_MACHINE = (
    "study",
    "simulate",
    "drop",
    "orbits",
    "attractors",
    "prove",
    "response",
    "bifurcations",
    "regions",
    "basins",
    "fit",
)
OTHERS = "sweep", "paper", "explore", "template", "import_rotor"
for name in ON_A_MACHINE + OTHERS:
    command = getattr(import_module(f"carom.cli.{name}"), name)
    # The list of commands shows the first line of each whole, not its beginning.
    short = str(command.__doc__).partition("\n")[0]
    app.command(name.replace("_", "-"), help=command.__doc__, short_help=short)(with_purpose(command))


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"carom {version('carom')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version and exit.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    """Options of the program itself."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; return its exit code.

    0 for success; 1 for a failure not caused by the input; 2 for input that cannot be used; 130 if interrupted; 143 if terminated, in which case the
    process ends here.

    Parameters
    ----------
    arguments : sequence of str, optional
        Command and options; by default those of the process.
    """
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by the caller: discard the output
            setattr(sys, name, Path(os.devnull).open("w"))  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # terminals that cannot show Greek letters get escapes
            stream.reconfigure(errors="backslashreplace")
    words = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    try:
        with _lost_interrupts_repeated(), _warnings_on_one_line(), _ended_in_order():
            code = app(args=words, prog_name="carom", standalone_mode=False)
            sys.stdout.flush()
    except BrokenPipeError:
        _close_quietly(sys.stdout)
        return FAILURE
    except BaseException as problem:  # noqa: BLE001  (last resort: a user sees no traceback)
        failure = _failure_of(problem)
    else:
        if code != INTERRUPTED:  # caught by typer, which prints nothing
            return code if isinstance(code, int) else 0
        failure = CommandFailure(INTERRUPTED, "interrupted")
    return failure.tell(as_json="--json" in words)


@dataclass(frozen=True)
class CommandFailure:
    """Why a command did not succeed, its exit code, and the errors of the input if it was refused."""

    code: int
    message: str
    errors: tuple[InputError, ...] = ()

    def tell(self, as_json: bool) -> int:
        """Print each error on its own line of the error stream, and with ``--json`` one object too; return the exit code."""
        lines = self.message.split("\n") if self.errors else [self.message]
        for line in lines:
            _complain(line)
        if as_json:
            entries = [_entry(error) for error in self.errors] or [{"message": _on_one_line(self.message)}]
            nothing = dict.fromkeys(("field", "value", "allowed", "message"))
            error = nothing | entries[0] | {"code": self.code}
            document = {"error": error} if len(entries) == 1 else {"error": error, "errors": entries}
            try:
                print(json.dumps(document, indent=2), flush=True)  # noqa: T201
            except OSError:
                _close_quietly(sys.stdout)
        return self.code


def _entry(error: InputError) -> dict[str, object]:
    """An error of the input as plain data."""
    value = error.value
    if not isinstance(value, bool | int | None) and not (isinstance(value, float) and math.isfinite(value)):
        value = shown(value)
    return {"field": shown(error.field), "value": value, "allowed": printable(error.allowed), "message": str(error)}


def _failure_of(problem: BaseException) -> CommandFailure:
    """What an exception means for the user; raise it again if ``CAROM_DEBUG=1`` asks for the traceback of an unexpected one."""
    if isinstance(problem, InputError):
        return CommandFailure(BAD_INPUT, str(problem), problem.errors)
    if isinstance(problem, CaromError):
        return CommandFailure(BAD_INPUT, str(problem))
    if isinstance(problem, InterruptionError):
        return CommandFailure(INTERRUPTED, str(problem))
    if isinstance(problem, UsageError):
        message = getattr(problem, "format_message", problem.__str__)()
        return CommandFailure(BAD_INPUT, f"{message} (see carom --help)")
    if isinstance(problem, KeyboardInterrupt | typer.Abort) and not isinstance(problem.__cause__, EOFError):
        return CommandFailure(INTERRUPTED, "interrupted")
    if isinstance(problem, RuntimeError) and isinstance(problem.__context__, KeyboardInterrupt):
        return CommandFailure(INTERRUPTED, "interrupted")  # a thread that was about to start cannot be joined
    if isinstance(problem, OSError):
        _discard_unwritten_output()
        where = f" ({problem.filename})" if problem.filename else ""
        return CommandFailure(FAILURE, f"cannot read or write{where}: {problem.strerror or problem}")
    cause = problem.__cause__ if isinstance(problem, typer.Abort) else problem  # typer takes the end of data for Ctrl-D
    if os.environ.get("CAROM_DEBUG") == "1" or not isinstance(cause, Exception):
        raise cause or problem
    name = type(cause).__name__
    return CommandFailure(FAILURE, f"unexpected {name}, please report it (CAROM_DEBUG=1 shows more): {cause}")


@contextmanager
def _lost_interrupts_repeated() -> Iterator[None]:
    """Repeat an interrupt or a SIGTERM that Python cannot propagate: in finalizers and callbacks of weak references."""
    usual = sys.unraisablehook

    def shown(lost: sys.UnraisableHookArgs) -> None:
        if not issubclass(lost.exc_type, KeyboardInterrupt | SystemExit):
            return usual(lost)
        number = signal.SIGINT if issubclass(lost.exc_type, KeyboardInterrupt) else signal.SIGTERM
        again = threading.Timer(AGAIN, _thread.interrupt_main, (number,))
        again.daemon = True
        return again.start()

    with _replaced(sys, "unraisablehook", shown):
        yield


@contextmanager
def _ended_in_order() -> Iterator[None]:
    """Let a SIGTERM, as of a queue whose time is up, end the process as an error does, so that unfinished files are removed."""

    def end(_number: int, _frame: object) -> None:
        raise SystemExit(TERMINATED)

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    usual = signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, usual)


@contextmanager
def _warnings_on_one_line() -> Iterator[None]:
    """Show a warning of carom itself as one line, without its place in the code."""
    usual = warnings.showwarning

    def shown(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
        if issubclass(category, CaromWarning):
            _complain(str(message))
        else:
            usual(message, category, *place, **more)

    with _replaced(warnings, "showwarning", shown):
        yield


@contextmanager
def _replaced(module: ModuleType, hook: str, by: Callable[..., None]) -> Iterator[None]:
    usual = getattr(module, hook)
    setattr(module, hook, by)
    try:
        yield
    finally:
        setattr(module, hook, usual)


def _complain(message: str) -> None:
    """Print an error or a warning on one line; the exit code is stated even where the line cannot be."""
    try:
        print(f"carom: {_on_one_line(message)}", file=sys.stderr)  # noqa: T201
    except OSError:
        _close_quietly(sys.stderr)


def _on_one_line(message: str) -> str:
    return printable(" ".join(message.split()))


def _discard_unwritten_output() -> None:
    """Discard unwritten output; otherwise the interpreter tries again at exit and prints an error of its own."""
    try:
        sys.stdout.flush()
    except OSError:
        _close_quietly(sys.stdout)


def _close_quietly(stream: TextIO) -> None:
    """Redirect output that cannot be written to the null device, because the interpreter still flushes at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
