"""Rotors on springs by the numbers of ROSS: what its eigenvalues and responses must be of the matrices."""

import numpy as np
import pytest


class OnSprings:
    """A rotor of finite elements on springs and dampers at nodes."""

    def __init__(self, rotor, springs, damping):
        self.rotor, self.mass, self.gyroscopic = rotor, rotor.matrices.mass, rotor.matrices.gyroscopic
        self.stiffness, self.damping = rotor.matrices.stiffness.copy(), damping.copy()
        for node, spring, damper in springs:
            place = 2 * rotor.place_of(node)
            self.stiffness[place, place] += spring
            self.damping[place, place] += damper

    def assert_eigenvalues(self, speeds):
        """Forward whirls have a positive imaginary part here; backward ones a negative one, and ROSS lists their conjugates."""
        n = len(self.mass)
        for at in speeds:
            spin = self.damping - 1j * at["speed"] * self.gyroscopic
            accelerations = -np.linalg.solve(self.mass, np.concatenate([self.stiffness, spin], axis=1))
            values = np.linalg.eigvals(np.concatenate([np.eye(n, 2 * n, n), accelerations]))
            values = np.where(values.imag < 0.0, values.conj(), values)
            for expected in (complex(*pair) for pair in at["values"]):
                # Eigenvalues of pencils whose largest are 1e4 times as large.
                assert np.abs(values - expected).min() < 1e-8 * abs(expected)

    def assert_response(self, asked):
        """Of an unbalance of one."""
        for number, speed in enumerate(asked["speeds"]):
            push = np.zeros(len(self.mass))
            push[2 * self.rotor.place_of(asked["node"])] = speed**2
            spin = self.damping - 1j * speed * self.gyroscopic
            found = np.linalg.solve(self.stiffness - speed**2 * self.mass + 1j * speed * spin, push)
            for node, x in zip(asked["at_nodes"], asked["x"], strict=True):
                assert found[2 * self.rotor.place_of(node)] == pytest.approx(complex(*x[number]), rel=1e-8)
