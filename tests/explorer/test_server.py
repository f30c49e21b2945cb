"""Who is let in, and where the page is served: without a browser."""

import asyncio
import gc
import json
import re
import socket
import threading
import weakref
from contextlib import contextmanager, suppress

import pytest
from tornado.httpclient import AsyncHTTPClient, HTTPRequest
from tornado.websocket import WebSocketClosedError, websocket_connect

import carom
from carom.base.outcome import InputError
from carom.explorer import server as servers
from carom.explorer.computing.exports import Origin
from carom.explorer.server import LEFT, Explorer

MACHINE = "examples/keogh-cole.toml"


@contextmanager
def serving(port=0):
    """A server in this thread's loop, and a way to run requests in that loop."""
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)

    async def opened():
        return Explorer(Origin(MACHINE, (), carom.load(MACHINE)), port)

    explorer = loop.run_until_complete(opened())
    try:
        yield explorer, loop.run_until_complete
    finally:
        explorer.stop()
        loop.run_until_complete(asyncio.sleep(0))
        loop.close()
        asyncio.set_event_loop(None)


@pytest.fixture(autouse=True)
def nothing_is_compiled(monkeypatch):
    monkeypatch.setattr(servers, "_compile", lambda origin, ready: ready.set())


def status(run, address, **headers):
    request = HTTPRequest(address, headers=headers)
    return run(AsyncHTTPClient().fetch(request, raise_error=False))


def test_it_serves_this_machine_alone():
    with serving() as (explorer, run):
        assert explorer.address == f"http://127.0.0.1:{explorer.port}/"
        assert status(run, explorer.address).code == 200
        bound = {sock.getsockname()[0] for http in [explorer._server._http] for sock in http._sockets.values()}
        assert bound == {"127.0.0.1"}


@pytest.mark.parametrize("path", ["", "alive", "static/js/bokeh.min.js", "ws"])
def test_other_host_names_are_refused(path):
    with serving() as (explorer, run):
        for host in ("example.com", f"example.com:{explorer.port}", "127.0.0.1", "localhost.example.com", ""):
            assert status(run, explorer.address + path, Host=host).code in (400, 403), host


def test_localhost_is_this_machine_too():
    with serving() as (explorer, run):
        assert status(run, explorer.address, Host=f"localhost:{explorer.port}").code == 200


def test_a_page_of_another_origin_gets_no_connection():
    with serving() as (explorer, run):
        address = explorer.address.replace("http", "ws") + "ws"
        for origin in ("http://example.com", f"http://example.com:{explorer.port}", "null"):
            with pytest.raises(Exception, match="403"):
                run(websocket_connect(HTTPRequest(address, headers={"Origin": origin})))


def test_a_server_says_which_one_it_is():
    with serving() as (first, run):
        one = json.loads(status(run, first.address + "alive").body)
        assert json.loads(status(run, first.address + "alive").body) == one
    with serving() as (second, run):
        assert json.loads(status(run, second.address + "alive").body) != one


def test_a_port_in_use_is_one_line():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(
            InputError, match=rf"^--port = {port}: is in use; give another one, or 0 for any that is free$"
        ):
            Explorer(Origin(MACHINE, (), carom.load(MACHINE)), port)


@pytest.mark.parametrize("port", [-1, 65536])
def test_a_port_that_does_not_exist_is_refused(port):
    with pytest.raises(InputError, match="whole number from 0 to 65535"):
        Explorer(Origin(MACHINE, (), carom.load(MACHINE)), port)


def workers():
    return [thread for thread in threading.enumerate() if thread.name == "carom explore"]


def connect(explorer, run, token=None, protocol="bokeh"):
    """Open a session, as a page does with the key in its text."""
    token = token or re.search(r'"token":"([^"]+)"', status(run, explorer.address).body.decode())[1]
    request = HTTPRequest(
        explorer.address.replace("http", "ws") + "ws", headers={"Origin": explorer.address.rstrip("/")}
    )
    connection = run(websocket_connect(request, subprotocols=[protocol, token]))
    run(connection.read_message())
    return connection


def all_closed(explorer, run):
    """Wait until no session is left."""

    async def wait():
        while explorer._server.get_sessions("/"):
            await asyncio.sleep(0.05)

    run(asyncio.wait_for(wait(), 60.0))


def test_stopping_ends_the_work_of_every_page():
    with serving() as (explorer, run):
        connect(explorer, run)
        working = workers()
        assert len(working) == 3  # for what follows the hand, for the picture, and for what takes long
    for thread in working:
        thread.join(30.0)
        assert not thread.is_alive()


def test_a_page_that_is_closed_ends_its_work_and_gives_its_memory_back():
    with serving() as (explorer, run):
        connection = connect(explorer, run)
        run(asyncio.sleep(3 * LEFT / 1000))
        (session,) = explorer._server.get_sessions("/")
        document, working = weakref.ref(session.document), workers()
        del session
        connection.close()
        all_closed(explorer, run)
        for thread in working:
            thread.join(30.0)
            assert not thread.is_alive()
        run(asyncio.sleep(0.1))
        gc.collect()
        assert document() is None


@pytest.mark.parametrize("path", ["autoload.js?bokeh-autoload-element=1", "metadata", "favicon.ico", "elsewhere"])
def test_what_the_page_does_not_use_is_closed(path):
    with serving() as (explorer, run):
        assert status(run, explorer.address + path).code == 404
        assert explorer._server.get_sessions("/") == []


def test_no_page_shows_it_in_a_frame():
    with serving() as (explorer, run):
        headers = status(run, explorer.address).headers
        assert headers["X-Frame-Options"] == "DENY"
        assert headers["Content-Security-Policy"] == "frame-ancestors 'none'"


def test_as_many_pages_as_there_can_be(monkeypatch):
    monkeypatch.setattr(servers, "MOST", 2)
    with serving() as (explorer, run):
        pages = [connect(explorer, run) for _ in range(2)]
        refused = status(run, explorer.address)
        assert refused.code == 503
        assert refused.body.startswith(b"2 pages of carom explore are open")
        with pytest.raises(Exception, match="503"):
            connect(explorer, run, "any")
        for page in pages:
            page.close()
        all_closed(explorer, run)
        assert status(run, explorer.address).code == 200


def test_malformed_sessions_leave_the_page_answering():
    patch = [json.dumps({"msgid": "1", "msgtype": "PATCH-DOC"}), "{}", "{}"]
    with serving() as (explorer, run):
        for place in range(12):
            token, protocol = [(None, "bokeh"), ("junk", "bokeh"), (None, "other")][place % 3]
            connection = connect(explorer, run, token, protocol)
            for part in (patch, ["nonsense"] * 3)[place % 2]:
                with suppress(WebSocketClosedError):
                    run(connection.write_message(part))
            connection.close()
        all_closed(explorer, run)
        connect(explorer, run).close()
