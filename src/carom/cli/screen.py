"""Output to the terminal that is safe for any names and file contents."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment

from carom.base.outcome import printable


class Screen(Console):
    """A console that shows control characters in texts as escapes; its own colours and cursor control still work.

    A plain text is printed as one line.  Line breaks inside tables and other renderables are kept.
    """

    def print(self, *objects: Any, **options: Any) -> None:
        """Print as :meth:`rich.console.Console.print` does."""
        super().print(*(printable(thing) if isinstance(thing, str) else thing for thing in objects), **options)

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """Render as :meth:`rich.console.Console.render` does."""
        for segment in super().render(renderable, options):
            if segment.control or segment.text.isprintable():
                yield segment
            else:
                yield Segment("\n".join(map(printable, segment.text.split("\n"))), segment.style)
