"""The server: one address on this machine, which refuses requests of foreign pages and answers all others for little.

A page is the same text for all; a session, which costs threads and memory, begins with the connection of the page.  Foreign pages can
ask for the text, but neither connect nor show it in a frame of theirs.
"""

from __future__ import annotations

import asyncio
import errno
import logging
import os
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
from bokeh.util.token import generate_jwt_token, generate_session_id
from tornado.httpserver import HTTPServer
from tornado.httputil import HTTPServerRequest
from tornado.ioloop import IOLoop
from tornado.web import ErrorHandler, RequestHandler

from carom.base.outcome import CaromError, InputError
from carom.explorer.computing.exports import Origin
from carom.explorer.page.document import TOKEN, fill, write_page
from carom.explorer.page.questions import Questions
from carom.explorer.page.session import Session

HERE = "127.0.0.1"
NAMES = (HERE, "localhost")
"""Names under which a browser on this machine asks for the page."""
PORT = 5006
LEFT = 500
"""Milliseconds after which the session of a closed page ends with all its work, and between two checks for closed pages."""
MOST = 32
"""Pages that can be open at a time."""


class _Alive(RequestHandler):
    """Says which server this is, so that a page notices when another one has taken its place."""

    def initialize(self, number: str) -> None:
        self.number = number

    def get(self) -> None:
        self.set_header("Cache-Control", "no-store")
        self.write({"server": self.number})


class _Page(RequestHandler):
    """Answers with the page: the same text with a fresh key, by which the page opens its session."""

    def initialize(self, text: str) -> None:
        self.text = text

    def set_default_headers(self) -> None:
        self.set_header("Cache-Control", "no-store")
        self.set_header("Content-Security-Policy", "frame-ancestors 'none'")
        self.set_header("X-Frame-Options", "DENY")

    def get(self) -> None:
        self.write(self.text.replace(TOKEN, generate_jwt_token(generate_session_id())))


class _Full(_Page):
    """Says that no further page can be opened."""

    def get(self) -> None:
        self.set_status(503)
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.write(
            f"{MOST} pages of carom explore are open, which is as many as there can be. Close one, and load this one again."
        )


class _Tornado(BokehTornado):
    """Refuses requests under a name other than those of this machine: a foreign page could let its own name resolve to it.

    Of the addresses that Bokeh serves all are closed but the connection and its scripts: some begin a session with each request.
    """

    def __init__(self, applications: Any, hosts: list[str], origin: Origin, **options: Any) -> None:
        self._hosts = frozenset(hosts)
        super().__init__(applications, extra_websocket_origins=hosts, **options)
        self._text = write_page(origin, self.resources())

    def find_handler(self, request: HTTPServerRequest, **options: object) -> Any:
        if request.host.lower() not in self._hosts:
            return self.get_handler_delegate(request, ErrorHandler, {"status_code": 403})
        if request.path in ("/", "/ws") and len(self.get_sessions("/")) >= MOST:
            return self.get_handler_delegate(request, _Full, {"text": ""})
        if request.path == "/":
            return self.get_handler_delegate(request, _Page, {"text": self._text})
        if request.path not in ("/ws", "/alive") and not request.path.startswith("/static/"):
            return self.get_handler_delegate(request, ErrorHandler, {"status_code": 404})
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
        self._sessions: weakref.WeakSet[Session] = weakref.WeakSet()

        def open_page(document: Document) -> None:
            self._sessions.add(fill(document, origin, ready))

        application = Application(FunctionHandler(open_page))
        self._tornado = _Tornado(
            {"/": application},
            hosts,
            origin,
            extra_patterns=[("/alive", _Alive, {"number": uuid.uuid4().hex})],
            use_index=False,
            unused_session_lifetime_milliseconds=LEFT,
            check_unused_sessions_milliseconds=LEFT,
        )
        http = HTTPServer(self._tornado)
        http.add_socket(bound)
        self._server = BaseServer(self.loop, self._tornado, http)
        self._server.start()
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
        self._server.stop()
        self._server.unlisten()
        for session in self._sessions:
            session.close()


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
    if not os.environ.get("CAROM_DEBUG"):
        _keep_quiet()
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


def _keep_quiet() -> None:
    """Keep out of the terminal what the libraries say of requests that are malformed."""
    for library in ("bokeh", "tornado"):
        logging.getLogger(library).setLevel(logging.CRITICAL)


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
        Questions(origin).warm_up()
    except CaromError:
        pass  # the page says what is wrong with this machine
    except RuntimeError as problem:
        if "shutdown" not in str(problem):  # Python says so where the program ends meanwhile, and no thread can begin
            raise
    finally:
        ready.set()
