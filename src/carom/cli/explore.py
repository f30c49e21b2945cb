"""``carom explore``: the interactive page."""

from __future__ import annotations

import sys
from importlib.util import find_spec

import typer

from carom.base.outcome import CaromError
from carom.cli.options import SETTINGS, option
from carom.cli.terminal import console, read_machine

MACHINE = typer.Argument(None, metavar="[MACHINE.toml]", help="The machine file; by default the example machine.")
PORT = option("P", "Port on this computer; 0 for any free port.", default=5006)
BROWSER = option(None, "Open the page in the browser.", "--browser/--no-browser", default=True)


def explore(
    machine: str | None = MACHINE,
    settings: list[str] | None = SETTINGS,
    port: int = PORT,
    browser: bool = BROWSER,
) -> None:
    """Explore a machine on an interactive page: move a gain, see which kicks come back, and watch any of them.

    The page is served on this computer only, at the address printed first, until Ctrl-C. Needs the extra carom[explore].
    """
    if find_spec("bokeh") is None:
        raise CaromError("carom explore needs Bokeh: pip install 'carom[explore]'")
    from carom.explorer.computing.exports import Origin
    from carom.explorer.example import example_file
    from carom.explorer.page.questions import Questions
    from carom.explorer.server import serve

    path = str(example_file()) if machine is None else machine
    origin = Origin(path, tuple(settings or ()), read_machine(path, settings))
    words = Questions(origin).words()

    def tell(address: str) -> None:
        typer.echo(address)
        console().print(f"{words}.")
        sys.stdout.flush()

    serve(origin, port, browser=browser, tell=tell)
