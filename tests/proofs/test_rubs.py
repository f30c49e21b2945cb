"""What acts along the wall next to a rub, beside arithmetic of many digits."""

from fractions import Fraction

import mpmath
import numpy as np
from compilation import sized

from carom.proofs.balls import at_precision, rational
from carom.proofs.hypotheses import hypotheses_of
from carom.proofs.rotor import ProvenRotor
from carom.proofs.steady import Rub


def random_machine(random):
    gamma, omega, rho = random.uniform(-0.1, 1.0), random.uniform(0.1, 1.2), random.uniform(0.1, 2.0)
    mu, d = random.choice((0.0, 0.02, 0.2, 0.6, 2.0)), random.choice((0.0, 0.3, 0.7, 0.95))
    return {
        "gamma": gamma,
        "omega": omega,
        "rho": rho,
        "phi": 0.0,
        "mu": mu,
        "d": d,
        "radius_ratio": random.uniform(0.5, 20.0),
    }


def test_formulas_beside_quadrature():
    """``Π``, ``T`` and the bound of ``N`` at random places with thirty digits."""
    random = np.random.default_rng(3)
    with mpmath.workdps(30), at_precision(128):
        for _ in range(sized(20, 5, 200)):
            machine = random_machine(random)
            rotor = ProvenRotor(hypotheses_of(machine))
            if not (rub := Rub.of(rotor.numbers)).stiffness > 0:
                continue
            gamma, mu, rho, kappa = (
                mpmath.mpf(machine["gamma"]),
                mpmath.mpf(machine["mu"]),
                mpmath.mpf(machine["rho"]),
                1 - mpmath.mpf(machine["omega"]) ** 2,
            )
            force = mpmath.mpf(float(rub.force.mid()))
            angle = mpmath.findroot(
                lambda x, g=gamma, m=mu, r=rho, k=kappa: g + r * mpmath.sin(x) + m * (r * mpmath.cos(x) + k),
                mpmath.atan2(-gamma - mu * force, force - kappa),
            )

            def torque(off, g=gamma, m=mu, r=rho, k=kappa, a=angle):
                return g + r * mpmath.sin(a + off) + m * (r * mpmath.cos(a + off) + k)

            for place in random.uniform(-1.5, 1.5, 3).tolist():
                ball = rational(Fraction(place))
                whole = mpmath.quad(lambda xi, m=mu, f=torque: f(xi) * mpmath.exp(2 * m * xi), [0, place])
                assert abs(float(rub.torque(ball).mid()) - float(torque(place))) < 1e-12
                assert abs(float(rub.potential(ball).mid()) - float(whole)) < 1e-12
