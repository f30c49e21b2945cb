"""Controllers over both axes of several bearings, with limits of each axis, against real equations of both axes in SciPy."""

import dataclasses

import numpy as np
import pytest
from machines import machine_text
from refusals import assert_refused
from scipy import signal
from scipy.integrate import solve_ivp
from scipy.linalg import block_diag, eigvals, expm

import carom as cm
from carom.rotors import PID, SharedController, StateSpace, load_machine, sensitivity
from carom.rotors.loop_sensitivity import sampling_error

FILE = machine_text("flywheel")
MASS, TILTED, POLAR, SPEED, AT, KI, KS = 293.1, 36.8927, 5.4238, 1000.0 * np.pi, (0.650, -0.825), 819.10, 1.348e7
INVERSE = np.diag([1.0 / MASS, 1.0 / TILTED] * 2)
ANGLES = (0.4, -0.7)
P, D, T, CROSS = 7e4, 140.0, 2e-4, 9e3


def rows(angles):
    """Displacements ``x_1, y_1, x_2, y_2`` along the axes of the bearings by ``x, θ_x, y, θ_y``."""
    turns = [[[np.cos(each), np.sin(each)], [-np.sin(each), np.cos(each)]] for each in angles]
    return np.concatenate([np.kron(turn, [1.0, at]) for turn, at in zip(turns, AT, strict=True)])


def law(seed=1, states=5):
    """Two PD controllers with all axes coupled besides, through states of their own, and sensors a little apart in gain."""
    random = np.random.default_rng(seed)
    A = np.diag([-1.0 / T] * 4 + [-300.0] * states)
    A[4:, 4:] += 100.0 * random.normal(size=(states, states))
    B = np.concatenate([np.eye(4) / T, 30.0 * random.normal(size=(states, 4))])
    C = np.concatenate([-np.eye(4) * D / T, 300.0 * random.normal(size=(4, states))], axis=1)
    return A, B, C, np.diag([P, 1.1 * P, 0.9 * P, P]) + np.eye(4) * D / T + 2e3 * random.normal(size=(4, 4))


def real_matrix(system, angles=ANGLES):
    """Rates of ``(x, θ_x, y, θ_y)``, their rates and the states of the controller."""
    A, B, C, D = system
    at, spin, matrix = rows(angles), np.zeros((4, 4)), np.zeros((8 + len(A),) * 2)
    spin[1, 3], spin[3, 1] = -SPEED * POLAR, SPEED * POLAR
    matrix[:4, 4:8] = np.eye(4)
    matrix[4:8, :4], matrix[4:8, 4:8] = INVERSE @ at.T @ (KS * np.eye(4) - KI * D) @ at, INVERSE @ spin
    matrix[4:8, 8:], matrix[8:, :4], matrix[8:, 8:] = -KI * INVERSE @ at.T @ C, B @ at, A
    return matrix


def machine(shared, tmp_path, **changes):
    path = tmp_path / "flywheel.toml"
    path.write_text(FILE, encoding="utf-8")
    found = load_machine(path)
    bearings = [
        dataclasses.replace(each, axis_angle=angle, **changes)
        for each, angle in zip(found.bearings, ANGLES, strict=True)
    ]
    return dataclasses.replace(found, bearings=bearings, shared_controllers=[shared])


def assert_exponents(found, expected):
    """Each of those expected, and its conjugate, is among those found."""
    both = found.whole.equations.both.exponents(SPEED)[0]
    model = found.model.system.exponents * SPEED + 1j * SPEED
    scale = np.abs(expected).max()
    for each in expected:
        assert np.abs(both - each).min() < 1e-10 * scale
        assert min(np.abs(model - one).min() for one in (each, np.conj(each))) < 1e-10 * scale


@pytest.mark.parametrize("make", [StateSpace, signal.StateSpace], ids=["own", "SciPy"])
def test_matrices_of_both_axes_are_real_equations(make, tmp_path):
    system = law()
    found = machine(SharedController(matrices=make(*system)), tmp_path)
    assert found.whole.equations.is_anisotropic
    assert_exponents(found, eigvals(real_matrix(system)))


def test_cross_coupling_that_turns_with_its_input_keeps_one_direction(tmp_path):
    """``i = (C(s) − i k) z``, in either order of states, against both axes and against the complex equation of half the size."""
    one = block_diag(*[[[-1.0 / T]]] * 2), np.eye(2) / T, -np.eye(2) * D / T, np.eye(2) * (P + D / T)
    turn, both = np.array([[0.0, 1.0], [-1.0, 0.0]]), [np.kron(each, np.eye(2)) for each in one]
    both[3] = both[3] + CROSS * np.kron(np.eye(2), turn)
    ordered = [0, 2, 1, 3]  # states of x, then of y
    listed = [each[ordered][:, ordered] if place == 0 else each for place, each in enumerate(both)]
    listed[1], listed[2] = both[1][ordered], both[2][:, ordered]
    inner = np.concatenate([np.eye(2, 6, 2), np.zeros((4, 6))]).astype(complex)
    at = np.stack([np.ones(2), AT], axis=1)
    half = np.diag([1.0 / MASS, 1.0 / TILTED])
    inner[2:4, :2] = half @ at.T @ (KS * np.eye(2) - KI * (one[3] - 1j * CROSS * np.eye(2))) @ at
    inner[2:4, 2:4], inner[2:4, 4:] = half @ np.diag([0.0, 1j * SPEED * POLAR]), -KI * half @ at.T @ one[2]
    inner[4:, :2], inner[4:, 4:] = one[1] @ at, one[0]
    expected = eigvals(inner)
    assert_spectra = np.sort_complex(np.append(expected, expected.conj()))
    assert np.abs(assert_spectra - np.sort_complex(eigvals(real_matrix(both)))).max() < 1e-7
    for system in (both, listed):
        found = machine(SharedController(matrices=StateSpace(*system)), tmp_path, current_limit=50.0)
        assert not found.whole.equations.is_anisotropic
        own = found.whole.equations.exponents(SPEED)[0]
        assert max(np.abs(own - each).min() for each in expected) < 1e-10 * np.abs(expected).max()
        assert len(found.model.limits) == 2
    apart = sensitivity(machine(SharedController(matrices=StateSpace(*law())), tmp_path), [399.0, 400.0, 401.0])
    matrix, s, sizes = real_matrix(law()), 400j, []
    for place, row in enumerate(rows(ANGLES)):
        added = np.concatenate([np.zeros(4), -KI * INVERSE @ rows(ANGLES).T @ law()[3][:, place], law()[1][:, place]])
        sizes.append(1.0 + row @ np.linalg.solve(s * np.eye(len(matrix)) - matrix, added)[:4])
    for number, value in enumerate(apart.values[1]):
        assert np.abs(np.array(sizes[2 * number : 2 * number + 2]) - value).min() < 1e-9


LIMITS = [
    ({"current_limit": 3.5}, {"current_limit": 4.5}),
    ({"force_limit": "5 kN", "current_limit": 40.0}, {"current_limit": 4.0, "force_limit": None}),
    (
        {"amplifier_bandwidth": 9e3, "current_limit": 8.0, "slew_rate_limit": 2e4},
        {"force_limit": "4 kN", "current_limit": None},
    ),
]


def follow(system, limits, bias, start, until):
    """Places ``(x, θ_x, y, θ_y)`` at the end, of a controller whose axes clip, with unbalance, by DOP853."""
    A, B, C, D = system
    at, spin = rows(ANGLES), np.zeros((4, 4))
    spin[1, 3], spin[3, 1] = -SPEED * POLAR, SPEED * POLAR
    numbers = [{**limits[0], **limits[axis]} for _ in AT for axis in (0, 1)]
    most = [
        [each.get(name) or np.inf for each in numbers] for name in ("current_limit", "slew_rate_limit", "force_limit")
    ]
    most = [np.array([float(str(each).replace(" kN", "e3")) for each in row]) for row in most]
    bandwidth, push = limits[0].get("amplifier_bandwidth"), 7e-4 * SPEED**2

    def clip(values, bounds):
        return np.clip(values + bias, -bounds, bounds) - bias

    def rates(time, state):
        q, w, x, i = np.split(state, [4, 8, 8 + len(A)])
        seen = at @ q
        asked = clip(C @ x + D @ seen, most[0])
        rate = np.zeros(0)
        if bandwidth:
            rate = np.clip(bandwidth * (asked - i), -most[1], most[1])
            asked = i
        force = KS * seen - KI * clip(asked, most[2] / KI)
        outer = np.array([push * np.cos(SPEED * time), 0.0, push * np.sin(SPEED * time), 0.0])
        return np.concatenate([w, INVERSE @ (at.T @ force + spin @ w + outer), A @ x + B @ seen, rate])

    whole = np.concatenate([np.zeros(4), start, np.zeros(len(A) + 4 * bool(bandwidth))])
    found = solve_ivp(rates, (0.0, until), whole, method="DOP853", rtol=1e-11, atol=1e-14, max_step=2e-5)
    return found.y[:4, -1]


@pytest.mark.jit_only
@pytest.mark.parametrize("weight", [False, True])
@pytest.mark.parametrize("limits", LIMITS)
def test_each_axis_has_limits_of_its_own(limits, weight, tmp_path):
    system, until = law(), 0.012
    found = machine(SharedController(matrices=StateSpace(*system)), tmp_path, **limits[0])
    bearings = [dataclasses.replace(each, y=dataclasses.replace(each, **limits[1])) for each in found.bearings]
    gravity = cm.parameters.Gravity() if weight else None
    found = dataclasses.replace(found, bearings=bearings, gravity=gravity)
    model, scales = found.model, found.with_modes(2).scales
    start = np.array([0.02, 0.03, -0.03, 0.01])  # m/s, rad/s
    velocity = np.zeros(len(model.system.rest), complex)
    velocity[:2] = np.array([start[0] + 1j * start[2], start[1] + 1j * start[3]]) * np.sqrt([MASS, TILTED])
    velocity /= scales.velocity * np.sqrt(scales.mass)
    motion = cm.simulate(model, cm.State(np.zeros_like(velocity), velocity), until * scales.speed)
    shares = np.linalg.solve([[1.0, 1.0], AT], [MASS * 9.81, 0.0]) / KI if weight else np.zeros(2)
    bias = np.concatenate(
        [-share * np.array([np.sin(angle), np.cos(angle)]) for share, angle in zip(shares, ANGLES, strict=True)]
    )
    x, tilt, y, other = follow(system, limits, bias, start, until)
    assert {2, 3} & set(motion.segment_limits.ravel().tolist())
    for plane, place in enumerate((0.7, -0.88)):
        end = motion.seen_at(plane).position([motion.time], "fixed")[0] * scales.length
        assert abs(end - (x + place * tilt) - 1j * (y + place * other)) < 1e-8 * scales.length
    assert cm.motions.energy_ledger(motion).imbalance < 1e-9


@pytest.mark.jit_only
def test_controllers_run_on_while_the_rotor_falls(tmp_path):
    """From the whirl of levitation with its sag, falling with the coupled controllers of both axes running, and regained: by matrix exponentials."""
    system, falls, ends = law(), 3e-3, 8e-3
    found = machine(SharedController(matrices=StateSpace(*system), at_regain="running"), tmp_path)
    found = dataclasses.replace(found, gravity=cm.parameters.Gravity(carried_by="stiffness"))
    motion = cm.simulate(found.model, cm.drop(regained_after=f"{falls} s"), f"{ends} s")
    held = np.zeros((20, 20))
    held[:17, :17], held[4, 17], held[6, 18], held[6, 19] = real_matrix(system), 7e-4 / MASS, 7e-4 / MASS, -9.81
    held[4:8, 17:19] *= SPEED**2
    held[17, 18], held[18, 17] = -SPEED, SPEED
    dropped = held.copy()
    dropped[4:8, [*range(4), *range(8, 17)]] = 0.0
    whirl = np.linalg.solve(1j * SPEED * np.eye(17) - held[:17, :17], held[:17, 17] - 1j * held[:17, 18])
    sag = -np.linalg.solve(held[:17, :17], held[:17, 19])
    start = np.concatenate([whirl.real + sag, [1.0, 0.0, 1.0]])
    x, tilt, y, other = (expm((ends - falls) * held) @ expm(falls * dropped) @ start)[:4]
    for plane, place in enumerate((0.7, -0.88)):
        end = motion.seen_at(plane).position([motion.time], "fixed")[0] * 2.5e-4
        assert abs(end - (x + place * tilt) - 1j * (y + place * other)) < 1e-8 * 2.5e-4
    integrating = [dataclasses.replace(each, controller=PID(P, 1.0), at_regain="running") for each in found.bearings]
    assert_refused(
        lambda: dataclasses.replace(found, bearings=integrating, shared_controllers=()),
        r"^at_regain = running: reset or hold",
    )


@pytest.mark.parametrize(("time", "stated"), [(2e-5, 1e-3), (1e-4, 0.1)])
def test_the_error_of_sampling_is_that_of_the_motion_from_sample_to_sample(time, stated, tmp_path):
    """Monodromy of two sampled controllers with exact holds, by SciPy's discretisation of rotor and magnets."""
    gains = [PID(P, 1e4, D, T, time, "tustin"), PID(1.1 * P, 0.0, D, T, time)]
    found = machine(SharedController(matrices=StateSpace(*law())), tmp_path)
    bearings = [dataclasses.replace(each, controller=own) for each, own in zip(found.bearings, gains, strict=True)]
    found = dataclasses.replace(found, bearings=bearings, shared_controllers=())
    at, plant = rows((0.0, 0.0)), real_matrix((np.zeros((0, 0)), np.zeros((0, 4)), np.zeros((4, 0)), np.zeros((4, 4))))
    inner, pushed, seen, *_ = signal.cont2discrete(
        (plant, np.concatenate([np.zeros((4, 4)), -KI * INVERSE @ at.T]), np.eye(4, 8), np.zeros((4, 4))), time
    )
    laws = [signal.tf2ss(*quotient(own, time)) for own in gains for _ in "xy"]
    A, B, C, through = (block_diag(*each) for each in zip(*laws, strict=True))
    step = np.block([[inner + pushed @ through @ at @ seen, pushed @ C], [B @ at @ seen, A]])
    exact = np.log(eigvals(step).astype(complex)) / time
    highest, error = sampling_error(found)
    own = found.whole.equations.exponents(SPEED)[0]
    both = np.append(own, own.conj())
    expected = max(np.abs(both / each - 1.0).min() for each in exact if abs(each) <= highest)
    assert error == pytest.approx(expected, rel=1e-4)
    assert error < stated
    assert f"right to {error:.1g}" in dict(found.rows())["sampled controllers"]


def quotient(gains, time):
    """Numerator and denominator in ``z`` of gains by their rule."""
    share = 0.5 if gains.sampling else 1.0
    late, new, old = gains.filter_time, share * time, (1.0 - share) * time
    slow, fast = np.array([1.0, -1.0]), np.array([late + new, old - late])
    if not gains.integral:
        return gains.proportional * fast + gains.derivative * slow, fast
    above = np.polymul(gains.proportional * fast + gains.derivative * slow, slow)
    return np.polyadd(above, gains.integral * np.polymul([new, old], fast)), np.polymul(slow, fast)
