"""The table of the parts of a flexible machine: every part, where it is, and its entries as the file has them."""

from pathlib import Path

import carom as cm

FILE = "examples/tum-flexible-rotor.toml"


def test_parts_are_told_as_the_file_has_them():
    rows = dict(cm.load(FILE).rows())
    assert rows["rotor"] == "3.273 kg, 702 mm long"
    assert rows["speed"] == "3,000 rpm"
    assert rows["magnetic bearing 2"].startswith("at 623 mm, sensors at 581 and 665 mm: ki 50 N/A, ks -100,000 N/m; ")
    assert "integral 1,500 A/m/s" in rows["magnetic bearing 1"]
    assert rows["touchdown bearing 1"].startswith(
        "at 94 mm: clearance 0.2 mm, rotor radius 4.8 mm, friction 0.15; hunt-crossley"
    )
    assert rows["unbalance 1"] == "at 363 mm: 20 g mm, at 0°"
    assert rows["gravity"].startswith("9.81 m/s²")
    assert "friction" not in rows


def test_a_support_is_told_with_what_it_has(tmp_path):
    text = Path(FILE).read_text(encoding="utf-8")
    path = tmp_path / "supported.toml"
    path.write_text(
        text + '\n[[support]]\nnode = 7\nkxx = "2e4 N/m"\nkyy = "1e4 N/m"\ncxx = "5 N s/m"\n', encoding="utf-8"
    )
    rows = dict(cm.load(path).rows())
    assert rows["support 1"] == "at 363 mm: kxx 20,000 N/m, kyy 10,000 N/m, cxx 5 N s/m"
