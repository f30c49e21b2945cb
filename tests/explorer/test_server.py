"""Who is let in, and where the page is served: without a browser."""

from __future__ import annotations

import asyncio
import json
import re
import socket
import threading
from contextlib import contextmanager
from pathlib import Path

import pytest

import carom
from carom.explorer.computing.exports import Origin
from carom.outcome import InputError

pytest.importorskip("bokeh", reason="needs the extra carom[explore]")

from tornado.httpclient import AsyncHTTPClient, HTTPRequest
from tornado.websocket import websocket_connect

from carom.explorer import server as servers
from carom.explorer.page.session import Session
from carom.explorer.server import WATCH, Explorer

MACHINE = str(Path(__file__).parents[2] / "examples" / "keogh-cole.toml")


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


def test_stopping_ends_the_work_of_every_page():
    with serving() as (explorer, run):
        assert status(run, explorer.address).code == 200
        working = [thread for thread in threading.enumerate() if thread.name == "carom explore"]
        assert len(working) == 2
    for thread in working:
        thread.join(30.0)
        assert not thread.is_alive()


def test_a_page_that_is_closed_stops_its_work(monkeypatch):
    dropped = threading.Event()
    monkeypatch.setattr(Session, "drop_work", lambda self: dropped.set())
    with serving() as (explorer, run):
        page = status(run, explorer.address).body.decode()
        token = re.search(r'"token":"([^"]+)"', page)[1]
        address = explorer.address.replace("http", "ws") + "ws"
        origin = explorer.address.rstrip("/")
        connection = run(
            websocket_connect(HTTPRequest(address, headers={"Origin": origin}), subprotocols=["bokeh", token])
        )
        run(connection.read_message())
        dropped.clear()
        run(asyncio.sleep(3 * WATCH / 1000))
        assert not dropped.is_set()
        connection.close()
        run(asyncio.to_thread(dropped.wait, 60.0))
        assert dropped.is_set()
