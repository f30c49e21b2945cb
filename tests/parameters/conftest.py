"""Machine files with a table more."""

from pathlib import Path

import pytest


@pytest.fixture
def write(tmp_path):
    """Write an example, the machine of Keogh and Cole if none is named, with a table at its end."""

    def written(table: str, base: str = "examples/keogh-cole.toml") -> Path:
        path = tmp_path / "machine.toml"
        path.write_text(f"{Path(base).read_text(encoding='utf-8')}\n{table}\n", encoding="utf-8")
        return path

    return written
