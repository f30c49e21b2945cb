"""What each kind of machine brings to the page: its controls, its work, and the parts of the page that show what is found.

The session, the server and the document take it as it is, and never ask which kind it is; :mod:`carom.explorer.page.kinds` chooses it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from carom.explorer.computing.controls import Control
from carom.explorer.computing.exports import Origin
from carom.explorer.page.view import View
from carom.progress import Progress

Message = dict[str, Any]
Pairs = tuple[tuple[float, float], ...]


class Tell(Protocol):
    """What work in the background tells the page on its way; both raise where it is no longer wanted."""

    def __call__(self, progress: Progress) -> None:
        """Tell how far it is."""

    def show(self, message: Message) -> None:
        """Show an answer before it is complete."""


@dataclass(frozen=True)
class Shown:
    """What a page shows at present.

    Attributes
    ----------
    number : int
        That of the request for it.
    subject : Any
        The machine, as its kind has made it of the settings.
    settings : mapping
        Texts of the controls that were changed.
    along : str
        The control moved last.
    view : View
    held : bool
        Whether a slider is being dragged.
    """

    number: int
    subject: Any
    settings: Mapping[str, str]
    along: str
    view: View
    held: bool = False


Work = Callable[[Shown, Tell], Message]
"""Work for the machine shown."""


@dataclass(frozen=True)
class Task:
    """Work that takes long: what is done in words, and the answer that it gives."""

    words: str
    work: Work
    answer: str


class Kind(Protocol):
    """A kind of machine on the page; each session has one of its own, which may keep what it has found.

    Attributes
    ----------
    origin : Origin
    mark : str
        Text that differs from machine to machine.
    controls : mapping
        By name.
    slots : tuple of str
        Answers with the motions after the kicks that are drawn, each of which is among the quick work too.
    quick : mapping
        Work by its answer, the most urgent first; a dragged slider waits for the first alone.
    apart : tuple of str
        Quick work that may take a second: it does not hold up the rest.
    early : tuple of str
        Work that needs no kernels.
    long : mapping
        Work that is begun when nothing moves, in its order.
    wished : mapping
        Work that takes long and is begun only when the page asks for it.
    along : str
        The control that counts as moved last at first.
    template, scripts, figures : str, tuple of str, tuple of str
        Parts of the page.
    planes_shown : int
        Touchdown bearings at which a motion is drawn.
    frame : {"rotating", "fixed"}
        In which it is drawn first.
    reading : str
        How the picture of kicks is read, in a figure without the page.
    """

    origin: Origin
    mark: str
    controls: Mapping[str, Control]
    slots: tuple[str, ...]
    quick: Mapping[str, Work]
    apart: tuple[str, ...]
    early: tuple[str, ...]
    long: Mapping[str, Task]
    wished: Mapping[str, Task]
    along: str
    template: str
    scripts: tuple[str, ...]
    figures: tuple[str, ...]
    planes_shown: int
    frame: str
    reading: str

    def subject(self, settings: Mapping[str, str]) -> Any:
        """The machine with other values of its controls; refuse all that cannot be used at once."""

    def values(self, subject: Any) -> Mapping[str, float | None]:
        """Values of the controls of a machine."""

    def kicks(self, shown: Shown) -> Pairs:
        """Parts of the kicks that are drawn, one for each slot, in the unit that people are told."""

    def exports(self, shown: Shown) -> Message:
        """What can be copied, by the name of its button."""

    def variables(self) -> Message:
        """What the template needs beside the controls."""

    def words(self) -> str:
        """What the page begins with, in a line."""

    def warm_up(self) -> None:
        """Compile the kernels, or load them, by a first small use."""
