"""The page as text, and the document of one page: shared objects, figures and session."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterable
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import Any

from bokeh.core.types import ID
from bokeh.document import Document
from bokeh.embed.bundle import bundle_for_objs_and_resources
from bokeh.embed.elements import html_page_for_render_items
from bokeh.embed.util import RenderItem
from bokeh.events import ConnectionLost, DocumentReady
from bokeh.models import CustomJS
from bokeh.resources import Resources

from carom.explorer.background import SupersededError
from carom.explorer.computing.controls import Control
from carom.explorer.computing.exports import Origin
from carom.explorer.page.figures import looks, make_figures
from carom.explorer.page.messages import Message, control_message
from carom.explorer.page.models import Answers, Requests
from carom.explorer.page.questions import Questions
from carom.explorer.page.scripts import PAGE, joined, text_of
from carom.explorer.page.session import Session
from carom.report.html import page_template

TOKEN = "key-of-a-session"


def fill(document: Document, origin: Origin, ready: threading.Event) -> Session:
    """Fill a new document with the page of a machine, and return its session."""
    requests, answers = Requests(name="requests"), Answers(name="answers")

    def hand_over(name: str, value: object) -> None:
        try:
            document.add_next_tick_callback(partial(setattr, answers, name, value))
        except AttributeError:
            # Bokeh has taken the document of a closed page apart; its session is stated of it only after that.
            raise SupersededError from None

    session = Session(origin, hand_over, ready)
    plots, parts = make_figures(session.questions.figures)
    asked: dict[str, Callable[[Any], None]] = {
        "machine": session.show,
        "kick": session.kick,
        "cancel": lambda _: session.cancel(),
        "resume": lambda _: session.resume(),
        "wish": session.wish,
    }
    for name, act in asked.items():
        requests.on_change(name, partial(_act, act))
    for plot in plots.values():
        document.add_root(plot)
    # What no plot refers to is not part of the document.
    next(iter(plots.values())).tags = [requests, answers, *parts.values()]
    document.title = _title(origin)
    begin = CustomJS(args={"requests": requests, "answers": answers, "parts": parts, "plots": plots}, code=_BEGIN)
    document.js_on_event(DocumentReady, begin)
    # Bokeh's client would reconnect with half of the message in which the connection broke still in its buffer, and fail
    # to read anything after it.  So the page is loaded again instead.
    document.config.update(reconnect_session=False, notify_connection_status=False)
    document.js_on_event(ConnectionLost, CustomJS(code=_LOST))
    document.on_session_destroyed(lambda context: session.close())
    return session


def write_page(origin: Origin, resources: Resources) -> str:
    """The page of a machine as text, the same for all who ask: :data:`TOKEN` stands for the key of a session in it."""
    questions = Questions(origin)
    # The figures of every session have these names, so that the page need not know its document.
    places = {plot: ID(f"place-{name}") for name, plot in make_figures(questions.figures)[0].items()}
    return html_page_for_render_items(
        bundle_for_objs_and_resources(None, resources),
        {},
        [RenderItem(token=TOKEN, roots=places, use_for_title=True)],
        _title(origin),
        template=page_template("page.html.jinja", Path(__file__).with_name("files")),
        template_variables={
            "name": origin.case.name,
            "mark": questions.mark,
            "groups": _groups(questions.controls.values()),
            "style": text_of("page.css"),
            "script": joined(PAGE),
            "looks": json.dumps(looks()),
            **questions.variables(),
        },
    )


def _groups(controls: Iterable[Control]) -> list[Message]:
    """Controls by their headings; those of single parts are folded away."""
    found = []
    for heading, members in groupby(controls, key=lambda control: control.group):
        listed = list(members)
        messages = [control_message(each) for each in listed]
        found.append({"heading": heading, "folded": all(each.among for each in listed), "controls": messages})
    return found


def _title(origin: Origin) -> str:
    return f"{origin.case.name} – carom explore"


def _act(act: Callable[[object], None], name: str, old: object, new: object) -> None:
    """Pass a new request on."""
    act(new)


_BEGIN, _LOST = "carom.begin(requests, answers, parts, plots)", "carom.panels.lost()"
