"""The tree of all pages beside each page: resolved once for a folder, then marked for each page in it.

Furo has Sphinx resolve the tree anew for each page and parses what it gets.  With the 250 pages of the reference this took
nine tenths of the time in which pages are written.  Within a folder the trees differ only in the marks of the page that is read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from bs4 import BeautifulSoup, Tag
from furo.navigation import get_navigation_tree
from sphinx.application import Sphinx

__all__ = ["share_trees"]

ALL = {"collapse": False, "titles_only": True, "maxdepth": -1, "includehidden": True}
"""What Furo shows of the tree."""


class _Tree:
    """The tree of the pages of one folder, without the marks of any of them."""

    def __init__(self, html: str, own: str) -> None:
        self._soup = BeautifulSoup(html, "html.parser")
        for link in self._soup.select("a.current"):
            link["href"] = own
        for marked in self._soup.select(".current, .current-page"):
            marked["class"] = [name for name in marked["class"] if name not in ("current", "current-page")]
            if not marked["class"]:
                del marked["class"]
        for box in self._soup.select("input[checked]"):
            del box["checked"]
        self._links: dict[str, list[Tag]] = {}
        for link in self._soup.find_all("a"):
            self._links.setdefault(link["href"], []).append(link)

    def of(self, own: str) -> str:
        """The tree for the page of this address."""
        before = []
        for link in self._links.get(own, ()):
            for tag in [link, *_around(link)]:
                before.append((tag, dict(tag.attrs)))
                _mark(tag)
        if before:
            entry = link.find_parent("li")
            entry["class"] = [*entry["class"], "current-page"]
        shown = str(self._soup)
        for tag, attributes in reversed(before):
            tag.attrs = attributes
        return shown


def _around(link: Tag) -> Iterator[Tag]:
    """The entries and lists that contain a link, and the boxes that open them."""
    for tag in link.parents:
        if tag.name in ("li", "ul"):
            yield tag
        if tag.name == "li":
            yield from tag.find_all("input", recursive=False)


def _mark(tag: Tag) -> None:
    classes = list(tag.get("class", []))
    if tag.name == "a":
        tag["class"], tag["href"] = ["current", *classes], "#"
    elif tag.name == "input":
        tag["checked"] = ""
    else:
        tag["class"] = [*classes, "current"]


def share_trees(app: Sphinx) -> None:
    """Have Furo show these trees."""
    trees: dict[str, _Tree] = {}
    shown: dict[str, str] = {}

    def instead(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: object) -> None:
        folder, _, name = page.rpartition("/")
        toctree: Callable[..., str] = context["toctree"]
        if folder not in trees:
            trees[folder] = _Tree(get_navigation_tree(toctree(**ALL)), f"{name}.html")
        shown[page] = trees[folder].of(f"{name}.html")
        context["toctree"] = lambda **_: ""  # which Furo resolves

    def after(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: object) -> None:
        context["furo_navigation_tree"] = shown.pop(page)

    app.connect("html-page-context", instead, priority=100)
    app.connect("html-page-context", after, priority=900)
