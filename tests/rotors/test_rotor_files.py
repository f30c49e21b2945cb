"""Files of matrices: written and read, in place of sections of a machine file, and what is refused by file and array."""

import os
import zipfile
from pathlib import Path

import numpy as np
import pytest
from flexible_machines import munich_rotor
from refusals import assert_refused
from scipy.io import savemat
from scipy.sparse import csc_matrix

import carom as cm
from carom.base.outcome import InputError
from carom.rotors import MatrixRotor, ProportionalDamping, load_machine, read_rotor, write_rotor

SHAFT = munich_rotor(1.0)
"""Its elements are its sections, so its nodes are those of the matrices."""
DAMPING = ProportionalDamping(10.0, 1e-5)
ARRAYS = {name: 0.5 * (own + own.T) for name, own in zip("MKG", SHAFT.matrices, strict=True)} | {"nodes": SHAFT.places}
EXAMPLE = Path("examples/tum-flexible-rotor.toml").read_text(encoding="utf-8")


def text_with(source, damping='damping_of_mass = "10 1/s"\ndamping_of_stiffness = "10 us"'):
    """The example with a file in place of its shaft and discs."""
    others = EXAMPLE[EXAMPLE.index("[[magnetic_bearing]]") :]
    return f'[rotor]\nspeed = "3000 rpm"\nsource = "{source}"\n{damping}\n{others}'


@pytest.fixture
def folder(tmp_path):
    write_rotor(MatrixRotor(**ARRAYS, damping=DAMPING), tmp_path / "rotor.npz")
    return tmp_path


def test_what_is_written_is_read_again(folder):
    found = read_rotor(folder / "rotor.npz", DAMPING)
    for name in ("M", "K", "G", "nodes"):
        assert np.allclose(getattr(found, name), ARRAYS[name], rtol=1e-15, atol=0)
    named = MatrixRotor(**ARRAYS, damping=10.0 * ARRAYS["M"], names=[f"node {n}" for n in range(len(SHAFT.places))])
    write_rotor(named, folder / "named.npz")
    again = read_rotor(folder / "named.npz")
    assert again.names == named.names
    assert np.allclose(again.damping_matrix, named.damping_matrix, rtol=1e-15, atol=0)


def test_matlab_files_are_the_same(folder):
    arrays = {**ARRAYS, "K": csc_matrix(ARRAYS["K"]), "nodes": SHAFT.places[None], "D": 10.0 * ARRAYS["M"]}
    names = np.array([f"n {n}" for n in range(len(SHAFT.places))], object)
    savemat(folder / "rotor.mat", {**arrays, "names": names, "other": 1.0})
    found = read_rotor(folder / "rotor.mat")
    assert found.names[3] == "n 3"
    assert np.allclose(found.K, ARRAYS["K"], rtol=1e-15, atol=0)


def test_real_coordinates_of_a_file_are_named_or_those_of_ross(folder):
    turned = {"M": np.zeros((4 * len(SHAFT.places),) * 2), "K": None, "G": None}
    count = len(SHAFT.places)
    x, y = (np.add.outer(4 * np.arange(count), pair).ravel() for pair in ((0, 3), (1, 2)))
    signs = np.tile([1.0, -1.0], count)
    for name in turned:
        whole = np.zeros((4 * count, 4 * count))
        if name == "G":
            whole[np.ix_(x, y)], whole[np.ix_(y, x)] = ARRAYS[name] * signs, -(ARRAYS[name].T * signs).T
        else:
            whole[np.ix_(x, x)], whole[np.ix_(y, y)] = ARRAYS[name], ARRAYS[name] * np.outer(signs, signs)
        turned[name] = whole
    np.savez(folder / "real.npz", **turned, nodes=SHAFT.places)
    np.savez(folder / "stated.npz", **turned, nodes=SHAFT.places, coordinates="x y alpha beta")
    for name in ("real", "stated"):
        assert np.allclose(read_rotor(folder / f"{name}.npz", DAMPING).G, ARRAYS["G"], rtol=1e-15, atol=0)


def test_a_machine_file_takes_a_rotor_from_a_file(folder):
    """The example by its sections, and by the matrices of these."""
    (folder / "machine.toml").write_text(text_with("rotor.npz"), encoding="utf-8")
    (folder / "sections.toml").write_text(EXAMPLE.replace("[rotor]", "[rotor]\nlongest_element = 1"), encoding="utf-8")
    found, expected = (cm.load(folder / name).parameters.equations for name in ("machine.toml", "sections.toml"))
    for name in ("mass", "damping", "stiffness", "unlevitated", "forcing", "planes"):
        own = getattr(expected, name)
        assert np.allclose(getattr(found, name), own, rtol=0, atol=1e-8 * np.abs(own).max())


def test_nodes_may_be_called_by_their_names(folder):
    names = [""] * len(SHAFT.places)
    names[4], names[-1] = "bearing A", "end"
    np.savez(folder / "named.npz", **ARRAYS, names=names)
    text = text_with("named.npz").replace("node = 3\n", 'node = "bearing A"\n', 1)
    (folder / "machine.toml").write_text(text.replace("[1, 5]", '["end", 5]'), encoding="utf-8")
    machine = load_machine(folder / "machine.toml")
    assert machine.bearings[0].node == 4
    assert machine.bearings[0].sensor_nodes == (len(names) - 1, 5)
    (folder / "machine.toml").write_text(text.replace("[1, 5]", '["and", 5]'), encoding="utf-8")
    says = r"^\[\[magnetic_bearing\]\] 1: node = and: a number, or the name of a node: bearing A, end$"
    with pytest.raises(InputError, match=says):
        load_machine(folder / "machine.toml")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (text_with("none.npz"), r"^rotor file = .*none.npz: there is no such file$"),
        (text_with("rotor.csv"), r"^rotor file = .*rotor.csv: a file of matrices, .npz or .mat$"),
        (
            text_with("text.npz"),
            r"^rotor file = .*text.npz: a file of numpy.savez, or .*; it cannot be read: it is damaged, cut short, or another kind of file$",
        ),
        (
            text_with("objects.npz"),
            r"^rotor file = .*objects.npz: .* it cannot be read: it is damaged, cut short, or another kind of file$",
        ),
        (
            text_with("part.npz"),
            r"part.npz: G = nothing given: an array of this name \(gyroscopic .*the file holds K, M, nodes$",
        ),
        (text_with("rotor.npz", ""), r"^damping = nothing given: one of: damping_ratio, .* or an array D in the file"),
        (text_with("damped.npz"), r"^damping = both: one of: damping_ratio"),
        (
            text_with("rotor.npz") + '[[section]]\nlength = "1 m"\n',
            r"^source = rotor.npz: not allowed beside \[\[section\]\]",
        ),
        (
            text_with("rotor.npz").replace("node = 7", "node = 70"),
            r"^\[\[unbalance\]\] \d+: node = 70: a node of the shaft: 0 to \d+",
        ),
        (
            text_with("rotor.npz").replace("node = 3\n", 'node = "end"\n'),
            r"1: node = end: a number: nodes of this rotor have",
        ),
    ],
)
def test_what_cannot_be_used_is_refused_by_file_and_array(folder, text, says):
    (folder / "text.npz").write_text("M")
    (folder / "text.mat").write_text("M")
    np.savez(folder / "objects.npz", **{**ARRAYS, "M": np.array([{}], object)})
    np.savez(folder / "part.npz", **{name: ARRAYS[name] for name in ("M", "K", "nodes")})
    np.savez(folder / "nan.npz", **{**ARRAYS, "K": np.full_like(ARRAYS["K"], np.nan)})
    np.savez(folder / "damped.npz", **ARRAYS, D=ARRAYS["M"])
    (folder / "machine.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=says) as problem:
        cm.load(folder / "machine.toml")
    assert all("\n" not in str(each) for each in problem.value.errors)


def test_only_npz_files_are_written(folder):
    with pytest.raises(InputError, match=r"^rotor file = .*rotor.mat: a name that ends in .npz$"):
        write_rotor(read_rotor(folder / "rotor.npz", DAMPING), folder / "rotor.mat")


def _crashing(path):
    savemat(path, {"M": np.eye(2)})
    data = bytearray(path.read_bytes())
    data[176] = 0  # type of the numbers: SciPy reads where there is no memory
    path.write_bytes(data)


def _huge(path):
    """A few bytes that ask for 8 TB."""
    with zipfile.ZipFile(path, "w") as archive, archive.open("M.npy", "w") as stream:
        np.lib.format.write_array_header_1_0(stream, {"descr": "<f8", "fortran_order": False, "shape": (10**6, 10**6)})


@pytest.mark.parametrize(
    ("name", "make", "says"),
    [
        ("crash.mat", _crashing, "it is damaged: reading it ends the program that does$"),
        ("huge.npz", _huge, "it needs more memory than a rotor does$"),
        ("pickle.npz", lambda path: path.write_bytes(b"\x80\x04."), "it is damaged, cut short, or another kind of"),
        ("fifo.npz", os.mkfifo, "this is no file, but a directory or a device$"),
        ("folder.mat", Path.mkdir, "this is no file, but a directory or a device$"),
    ],
)
def test_a_file_that_harms_its_reader_is_refused_in_one_line(tmp_path, name, make, says):
    make(tmp_path / name)
    assert_refused(lambda: read_rotor(tmp_path / name), says)


def test_a_controller_comes_from_a_file(folder):
    """As matrices, as a quotient under MATLAB's names, sampled, and as a filter: the same machine as with its numbers."""
    begins = "A = [[-10000.0]]\nB = [[1.0]]\nC = [[-1.2e9]]\nD = [[132000.0]]"
    savemat(folder / "c.mat", {"A": -1e4, "B": 1.0, "C": -1.2e9, "D": 132000.0, "Ts": 0.0, "sys": "other"})
    savemat(folder / "tf.mat", {"num": [13.2, 12000.0], "den": [1e-4, 1.0], "Ts": 1e-4})
    savemat(folder / "none.mat", {"sys": 1.0})
    number = {
        "numerator = [13.2, 12000]\ndenominator = [1e-4, 1]\nsample_time = 1e-4": 'source = "tf.mat"',
        begins: 'source = "c.mat"',
    }
    template = Path("src/carom/cli/templates/flexible.toml").read_text(encoding="utf-8")
    plain = "numerator = [13.2, 12000]\ndenominator = [1e-4, 1]\n"

    def read(controller):
        (folder / "m.toml").write_text(template.replace(plain, f"{controller}\n"), encoding="utf-8")
        return load_machine(folder / "m.toml")

    below = "\n[[magnetic_bearing.filter]]\n"
    number[f"proportional = 1\n{below}{begins}"] = f'proportional = 1\n{below}source = "c.mat"'
    for stated, source in number.items():
        assert repr(read(source).bearings[1].controller) == repr(read(stated).bearings[1].controller), source
    for source, words in {
        'source = "none.mat"': "ssdata",
        'source = "no.mat"': "no such file",
        "source = 3": "the path of",
        'source = "c.mat"\nA = [[1]]': "not allowed beside A",
    }.items():
        with pytest.raises(InputError, match=words):
            read(source)
