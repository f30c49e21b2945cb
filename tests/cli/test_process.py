"""The program as a process: exit codes, streams and what it loads."""

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from studies import QUICK

CAROM = [sys.executable, "-m", "carom"]


def run(*arguments, **options):
    return subprocess.run(
        [*CAROM, *map(str, arguments)], capture_output=True, text=True, encoding="utf-8", check=False, **options
    )


def test_bad_input_exits_with_2_and_one_line():
    done = run("study", "no-such-file.toml")

    assert (done.returncode, done.stdout) == (2, "")
    assert (
        done.stderr == "carom: machine file = no-such-file.toml: there is no such file; give the path of a TOML file\n"
    )


def test_help_loads_nothing_heavy():
    code = (
        "import sys; from carom.cli import main; main(['--help']); "
        "print([name for name in ('numpy', 'numba', 'matplotlib', 'pint', 'pydantic', 'xarray', 'rich', 'jinja2') "
        "if name in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    assert done.stderr.strip() == "[]"


def test_what_cannot_be_simulated_is_refused_before_anything_is_drawn_or_stored(machine):
    refused = [
        ("--start", "2,0,0,0"),
        ("--start", "a,0,0,0"),
        ("--start", "0,0,0,0", "--until", "soon"),
        ("--kick", "fast"),
        ("--kick", "1,north"),
        (),
        ("--kick", "1 m/s", "--csv", "."),
    ]
    code = (
        "import json, sys; from carom.cli import main; "
        "codes = [main(['simulate', sys.argv[1], *words]) for words in json.loads(sys.argv[2])]; "
        "print(codes, [name for name in ('matplotlib', 'xarray') if name in sys.modules])"
    )
    command = [sys.executable, "-c", code, machine, json.dumps(refused)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)

    assert done.stdout == f"{[2] * len(refused)} []\n", done.stderr


@pytest.mark.jit_only
def test_reader_that_leaves_early_is_no_error(machine):
    command = [*CAROM, "orbits", machine, "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        errors = process.stderr.read()

    assert errors == b""
    assert process.returncode in (0, 1)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full here")  # noqa: PTH110
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_full_disk_is_one_line(unbuffered):
    environment = {**os.environ, "PYTHONUNBUFFERED": unbuffered}
    with open("/dev/full", "w") as full:  # noqa: PTH123
        done = subprocess.run(
            [*CAROM, "--version"], stdout=full, stderr=subprocess.PIPE, text=True, check=False, env=environment
        )

    assert done.returncode == 1
    assert done.stderr == "carom: cannot read or write: No space left on device\n"


@pytest.mark.skipif(os.name != "posix", reason="closes a stream as shells do")
def test_closed_output_is_no_error():
    done = subprocess.run(["sh", "-c", f"{sys.executable} -m carom --version >&-"], capture_output=True, check=False)

    assert (done.returncode, done.stderr) == (0, b"")


@pytest.mark.jit_only
@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_interrupt_leaves_nothing_behind(machine, tmp_path):
    out = tmp_path / "out"
    code = (
        "import os, signal, sys; from carom import plots; from carom.cli import main; save = plots.save\n"
        "def interrupted(figure, path):\n"
        "    paths = save(figure, path)\n"
        "    os.kill(os.getpid(), signal.SIGINT)\n"
        "    return paths\n"
        "plots.save = interrupted; sys.exit(main())"
    )
    process = subprocess.run(
        [sys.executable, "-c", code, "study", machine, *QUICK, "--out", str(out)],
        capture_output=True,
        text=True,
        check=False,
    )

    assert process.returncode == 130
    assert process.stdout == ""
    assert process.stderr == "carom: interrupted\n"
    assert list(tmp_path.iterdir()) == []


LATE = """
import os, signal, sys
class Interrupting:
    def find_spec(self, name, path=None, target=None):
        if name == {name!r}:
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Interrupting())
from carom.__main__ import run
sys.argv = ["carom", "orbits", {machine!r}]
sys.exit(run())
"""


@pytest.mark.parametrize("name", ["carom.cli", "typer", "carom.cli.study", "carom.base.outcome"])
def test_interrupt_while_the_program_is_loaded(machine, name):
    code = LATE.format(name=name, machine=str(machine))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)

    assert (done.returncode, done.stdout, done.stderr) == (130, "", "carom: interrupted\n")


def test_the_command_is_loaded_where_an_interrupt_is_caught():
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]

    assert project["scripts"] == {"carom": "carom.__main__:run"}


def test_a_sigterm_removes_unfinished_files(tmp_path):
    code = """
import os, pathlib, signal, sys
from carom.cli import app
from carom.base.files import unfinished

def wait(**_):
    with unfinished(pathlib.Path("."), folder=True):
        print(*os.listdir())
        os.kill(os.getpid(), signal.SIGTERM)

app.app = wait
sys.exit(app.main(["study"]))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.stdout.strip().endswith(".part")
    assert (done.returncode, list(tmp_path.iterdir())) == (143, [])


def test_without_an_error_stream_the_exit_code_is_told():
    for redirected in ("2>&-", "2>/dev/full"):
        command = f"{sys.executable} -m carom study no-such-file.toml {redirected}"
        assert subprocess.run(["sh", "-c", command], check=False).returncode == 2
