"""Rotors by matrices: the same as those of sections, in all forms that other programs write, and what is refused."""

import numpy as np
import pytest
from flexible_machines import munich, munich_rotor
from refusals import assert_refused

from carom.base.outcome import InputError
from carom.rotors import Disc, MatrixRotor, ModalDamping, ProportionalDamping

SHAFT = munich_rotor(1.0)
"""Its elements are its sections, so its nodes are those of the matrices."""
M, K, G = (0.5 * (matrix + matrix.T) for matrix in SHAFT.matrices)
NODES = SHAFT.places
DAMPING = ModalDamping(0.005)
SIZE = len(M)


def in_both_planes(matrix, skew=False, order=("x", "y", "alpha", "beta")):
    """A matrix of a complex displacement and tilt as one of real coordinates: ``β = dx/ds`` and ``α = −dy/ds``."""
    count, each = len(NODES), len(order)
    x, y = (
        np.stack([each * np.arange(count) + order.index(name) for name in pair], axis=1).ravel()
        for pair in (("x", "beta"), ("y", "alpha"))
    )
    signs = np.tile([1.0, -1.0], count)
    whole = np.zeros((each * count, each * count))
    if skew:
        whole[np.ix_(x, y)] = matrix * signs
        whole[np.ix_(y, x)] = -(matrix.T * signs).T
    else:
        whole[np.ix_(x, x)], whole[np.ix_(y, y)] = matrix, matrix * np.outer(signs, signs)
    return whole


def test_it_is_the_rotor_whose_matrices_it_has():
    rotor = MatrixRotor(M, K, G, NODES, SHAFT.damping)
    for name in ("mass", "centre", "diametral_inertia", "polar_inertia"):
        assert getattr(rotor, name) == pytest.approx(getattr(SHAFT, name), rel=1e-12)
    assert rotor.free_modes.frequencies == pytest.approx(SHAFT.free_modes.frequencies, rel=1e-9)
    # The highest of these matrices are 1e6 times the lowest.
    assert rotor.damping_matrix == pytest.approx(SHAFT.damping_matrix, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("order", [None, ("x", "y", "alpha", "beta"), ("x", "beta", "theta", "y", "alpha")])
def test_both_planes_with_real_numbers_are_one_with_complex_ones(order):
    """``M q̈ + (D + ΩG) q̇ + K q`` of both planes has the exponents of the complex equation and their conjugates."""
    stated = order or ("x", "y", "alpha", "beta")
    matrices = [in_both_planes(M, order=stated), in_both_planes(K, order=stated), in_both_planes(G, True, stated)]
    found = MatrixRotor.of_planes(*matrices, NODES, DAMPING, order)
    for own, exact in zip((found.M, found.K, found.G), (M, K, G), strict=True):
        assert np.array_equal(own, exact)
    if "theta" in stated:
        return
    speed, n = 300.0, len(matrices[0])
    accelerations = -np.linalg.solve(matrices[0], np.hstack([matrices[1], speed * matrices[2]]))
    real = np.linalg.eigvals(np.vstack([np.eye(n, 2 * n, n), accelerations]))
    accelerations = -np.linalg.solve(M, np.hstack([K, -1j * speed * G]))
    for each in np.linalg.eigvals(np.vstack([np.eye(SIZE, 2 * SIZE, SIZE), accelerations])):
        # Rounding of the largest exponents, 1e6 1/s; the rigid motions are double roots, of which half the digits remain.
        assert np.abs(real - each).min() < 1e-5 * max(abs(each), 1e3)


def test_a_matrix_of_damping_is_that_of_its_modes():
    given = ProportionalDamping(10.0, 1e-5)
    matrix = MatrixRotor(M, K, G, NODES, 10.0 * M + 1e-5 * K)
    machines = [munich(rotor=rotor) for rotor in (matrix, MatrixRotor(M, K, G, NODES, given))]
    assert matrix.damping_rates is None
    one, other = (machine.reduce(0.05).linear.equations for machine in machines)
    for name in ("mass", "damping", "stiffness"):
        own = getattr(other, name)
        assert np.allclose(getattr(one, name), own, rtol=0, atol=1e-9 * np.abs(own).max())


def test_a_disc_is_put_on_it():
    disc = Disc(2, 0.3, 1e-4, 2e-4)
    rotor = MatrixRotor(M, K, G, NODES, DAMPING, discs=[disc])
    assert rotor.mass == pytest.approx(SHAFT.mass + 0.3, rel=1e-12)
    assert rotor.polar_inertia == pytest.approx(SHAFT.polar_inertia + 2e-4, rel=1e-12)
    assert MatrixRotor(M, K, G, NODES, DAMPING).mass == pytest.approx(SHAFT.mass, rel=1e-12)  # the matrices stay


def test_nodes_have_names():
    names = [""] * (len(NODES) - 1) + ["drive end"]
    rotor = MatrixRotor(M, K, G, NODES, DAMPING, names)
    assert rotor.node_of("drive end") == len(NODES) - 1
    with pytest.raises(InputError, match=r"^node = free end: a number, or the name of a node: drive end$"):
        rotor.node_of("free end")
    with pytest.raises(InputError, match=r"^node = : a number|^node = '': a number"):
        rotor.node_of("")


def changed(matrix, row, column, value):
    other = matrix.copy()
    other[row, column] = value
    return other


def given(**changes):
    return MatrixRotor(**{"M": M, "K": K, "G": G, "nodes": NODES, "damping": DAMPING, **changes})


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (
            lambda: given(M=M[:-1]),
            rf"^M = an array of shape \({SIZE - 1}, {SIZE}\): a square matrix with a displacement",
        ),
        (lambda: given(K=changed(K, 0, 3, np.nan)), r"^K = .*: finite real numbers"),
        (lambda: given(K=changed(K, 0, 1, 3.0)), r"^K = unsymmetric: 3 in row 0, column 1; .* opposite: a symmetric"),
        (lambda: given(M=M + changed(changed(0 * M, 0, 2, 50.0), 2, 0, 50.0)), r"^M = indefinite: eigenvalue -"),
        (
            lambda: given(K=changed(K, 4, 4, K[4, 4] + 1e6)),
            r"^K = holds the rotor when it moves as a whole: .* without its bearings",
        ),
        (lambda: given(K=changed(K, 5, 5, K[5, 5] + 1e4)), r"^K = holds the rotor when it tilts as a whole: "),
        (lambda: given(nodes=1e3 * NODES), r"^K = holds the rotor when it tilts as a whole: .*nodes in m$"),
        (
            lambda: given(K=K * np.outer(*[np.tile([1.0, -1.0], SIZE // 2)] * 2)),
            r"^K = has tilts of the other sign: tilts dx/ds$",
        ),
        (lambda: given(K=-K), r"^K = indefinite: .* on the diagonal in row"),
        (lambda: given(G=M), r"^G = acts on a rotor that does not tilt"),
        (lambda: given(G=-G), r"^G = polar inertia -.* kg m\^2: above zero"),
        (lambda: given(damping=-K), r"^D = indefinite: it feeds a motion"),
        (lambda: given(nodes=NODES[::-1]), r"^nodes = .*: increasing numbers in m"),
        (lambda: given(names=["a", "a"]), r"^names = .*: \d+ texts, one for each node, no name twice$"),
        (
            lambda: MatrixRotor.of_planes(M, K, G, NODES, DAMPING, ("x", "y")),
            r"^coordinates = x, y: .* that name x, y, alpha and beta$",
        ),
        (
            lambda: MatrixRotor.of_planes(in_both_planes(M), in_both_planes(K), in_both_planes(G), NODES, DAMPING),
            r"^G = couples a plane with itself: G is skew",
        ),
        (
            lambda: MatrixRotor.of_planes(
                in_both_planes(M), changed(in_both_planes(K), 4, 4, 9e9), in_both_planes(G, True), NODES, DAMPING
            ),
            r"^K = the planes of x and of y differ: a round shaft",
        ),
        (
            lambda: MatrixRotor.of_planes(
                in_both_planes(M), changed(in_both_planes(K), 4, 5, 9e9), in_both_planes(G, True), NODES, DAMPING
            ),
            r"^K = both planes of bending are coupled: nothing but G couples both planes$",
        ),
        (
            lambda: MatrixRotor.of_planes(in_both_planes(M), K, in_both_planes(G, True), NODES, DAMPING),
            r"^K = an array of shape .*: a square matrix of 4 coordinates at each of \d+ nodes$",
        ),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(make, says):
    assert_refused(make, says)
