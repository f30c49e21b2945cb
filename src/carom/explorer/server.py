"""The server: one address on this machine, which refuses requests of foreign pages."""

from __future__ import annotations

import asyncio
import errno
import socket
import threading
import uuid
import weakref
import webbrowser
from collections.abc import Callable
from typing import Any

from bokeh.application import Application
from bokeh.application.handlers.function import FunctionHandler
from bokeh.document import Document
from bokeh.server.server import BaseServer
from bokeh.server.tornado import BokehTornado
from tornado.httpserver import HTTPServer
from tornado.httputil import HTTPServerRequest
from tornado.ioloop import IOLoop, PeriodicCallback
from tornado.web import ErrorHandler, RequestHandler

from carom.explorer.computing.exports import Origin
from carom.explorer.computing.kicked_motion import follow_kick
from carom.explorer.computing.kicks import largest_kick, map_kicks
from carom.explorer.computing.motions import table_of
from carom.explorer.page.document import fill
from carom.explorer.page.session import Session
from carom.models import Jeffcott
from carom.outcome import CaromError, InputError

HERE = "127.0.0.1"
NAMES = (HERE, "localhost")
"""Names under which a browser on this machine asks for the page."""
PORT = 5006
LEFT, WATCH = 10_000, 500
"""Milliseconds after which the session of a closed page ends, and between two checks for closed pages."""


class _Alive(RequestHandler):
    """Says which server this is, so that a page notices when another one has taken its place."""

    def initialize(self, number: str) -> None:
        self.number = number

    def get(self) -> None:
        self.set_header("Cache-Control", "no-store")
        self.write({"server": self.number})


class _Tornado(BokehTornado):
    """Refuses requests under a name other than those of this machine: a foreign page could let its own name resolve to it."""

    def __init__(self, applications: Any, hosts: list[str], **options: Any) -> None:
        self._hosts = frozenset(hosts)
        super().__init__(applications, extra_websocket_origins=hosts, **options)

    def find_handler(self, request: HTTPServerRequest, **options: Any) -> Any:
        if request.host.lower() not in self._hosts:
            return self.get_handler_delegate(request, ErrorHandler, {"status_code": 403})
        return super().find_handler(request, **options)


class Explorer:
    """A server that is bound to its port, and serves when it runs.

    Parameters
    ----------
    origin : Origin
        The machine with which each page begins.
    port : int, optional
        ``0`` for any that is free.

    Raises
    ------
    InputError
        The port is in use or not allowed.
    """

    def __init__(self, origin: Origin, port: int = PORT) -> None:
        bound = _bind(port)
        self.port = bound.getsockname()[1]
        self.loop = IOLoop.current()
        ready, hosts = threading.Event(), [f"{name}:{self.port}" for name in NAMES]
        self._sessions: weakref.WeakKeyDictionary[Document, Session] = weakref.WeakKeyDictionary()

        def open_page(document: Document) -> None:
            self._sessions[document] = fill(document, origin, ready)

        application = Application(FunctionHandler(open_page))
        self._tornado = _Tornado(
            {"/": application},
            hosts,
            extra_patterns=[("/alive", _Alive, {"number": uuid.uuid4().hex})],
            use_index=False,
            unused_session_lifetime_milliseconds=LEFT,
            check_unused_sessions_milliseconds=LEFT // 2,
        )
        http = HTTPServer(self._tornado)
        http.add_socket(bound)
        self._server = BaseServer(self.loop, self._tornado, http)
        self._server.start()
        self._watch = PeriodicCallback(self._drop_work_of_closed_pages, WATCH)
        self._watch.start()
        threading.Thread(target=_compile, args=(origin, ready), name="carom compile", daemon=True).start()

    @property
    def address(self) -> str:
        """Where the page is."""
        return f"http://{HERE}:{self.port}/"

    def run(self) -> None:
        """Serve until interrupted."""
        try:
            self.loop.start()
        finally:
            self.stop()

    def stop(self) -> None:
        """Close the port and end all sessions."""
        self._watch.stop()
        self._server.stop()
        self._server.unlisten()
        for session in self._sessions.values():
            session.close()

    def _drop_work_of_closed_pages(self) -> None:
        for page in self._server.get_sessions("/"):
            if page.connection_count == 0 and page.document in self._sessions:
                self._sessions[page.document].drop_work()


def serve(origin: Origin, port: int = PORT, *, browser: bool = True, tell: Callable[[str], None] = print) -> None:
    """Serve the page until interrupted.

    Parameters
    ----------
    origin : Origin
    port : int
    browser : bool
        Whether to open the page in the browser of the user.
    tell : callable
        Receives the address, once it is served.
    """
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    try:
        explorer = Explorer(origin, port)
        tell(explorer.address)
        if browser:
            webbrowser.open(explorer.address)
        explorer.run()
    finally:
        asyncio.set_event_loop(None)
        loop.close()


def _bind(port: int) -> socket.socket:
    if not 0 <= port <= 65535:
        raise InputError("--port", port, "a whole number from 0 to 65535; 0 for any that is free")
    try:
        bound = socket.create_server((HERE, port))
    except OSError as problem:
        if problem.errno == errno.EADDRINUSE:
            raise InputError("--port", port, "is in use; give another one, or 0 for any that is free") from None
        if problem.errno == errno.EACCES:
            raise InputError("--port", port, "is not allowed for this user; one from 1024 up") from None
        raise
    bound.setblocking(False)
    return bound


def _compile(origin: Origin, ready: threading.Event) -> None:
    """Compile the kernels, or load them, by a first small use."""
    try:
        rotor = Jeffcott(origin.case.parameters)
        largest = largest_kick(origin.case)
        table_of(rotor)
        found = map_kicks(rotor, 17, largest)
        follow_kick(rotor, found.rest, 0.3, 0.1)
    except CaromError:
        pass  # the page says what is wrong with this machine
    finally:
        ready.set()
