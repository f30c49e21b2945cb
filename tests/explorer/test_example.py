"""The machine of the page is one file, in a checkout and in an installed package."""

import subprocess
import sys
import zipfile
from pathlib import Path

import carom
from carom.explorer import example

ROOT = Path(__file__).parents[2]
FILE = ROOT / "examples" / "balanced-rotor.toml"


def test_a_checkout_shows_its_example():
    assert example.example_file() == FILE


def test_an_installed_package_shows_the_same(tmp_path, monkeypatch):
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "installed")
        names = archive.namelist()
    assert {f"carom/explorer/page/files/{name}" for name in ("page.html.jinja", "page.css", "main.js")} <= set(names)
    monkeypatch.setattr(example, "__file__", str(tmp_path / "installed" / "carom" / "explorer" / "example.py"))
    shipped = example.example_file()
    assert tmp_path in shipped.parents
    assert shipped.read_bytes() == FILE.read_bytes()
    assert carom.load(shipped).machine == carom.load(FILE).machine
