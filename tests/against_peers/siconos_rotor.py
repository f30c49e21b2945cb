"""Follow a rotor in its clearance with Siconos; run by an interpreter that has it, as a script.

Arguments: directory of the compiled plugin, and a JSON object with the machine, the start in the fixed frame, the time
``until``, the number of ``steps`` and of ``samples``.  Prints a JSON list of ``[x, y, ẋ, ẏ]`` at even times.
"""

import json
import sys

import numpy as np
import siconos.kernel as sk

INERTIA = 1e9
"""Of the shaft's rotation, which the drive keeps even: friction may not slow it."""


def main(directory: str, case: dict) -> list[list[float]]:
    """Moreau–Jean time stepping with ``θ = 1/2``, Newton's restitution and Coulomb's friction."""
    plugin = f"{directory}/WallPlugin"
    stiffness, damping = case["omega"] ** 2, case["gamma"]
    rotor = sk.LagrangianLinearTIDS(
        [*case["position"], 0.0],
        [*case["velocity"], case["radius_ratio"]],
        np.diag([1.0, 1.0, INERTIA]),
        np.diag([stiffness, stiffness, 0.0]),
        np.diag([damping, damping, 0.0]),
    )
    unbalance = np.array([case["rho"], case["phi"]])
    rotor.setzPtr(unbalance)
    rotor.setComputeFExtFunction(f"{plugin}.so", "unbalance")
    contact = sk.Interaction(
        sk.NewtonImpactFrictionNSL(case["d"], 0.0, case["mu"], 2),
        sk.LagrangianScleronomousR(f"{plugin}:gap", f"{plugin}:gap_rates"),
    )
    model = sk.NonSmoothDynamicalSystem(0.0, 2.0 * case["until"])
    model.insertDynamicalSystem(rotor)
    model.link(contact, rotor)
    simulation = sk.TimeStepping(
        model,
        sk.TimeDiscretisation(0.0, case["until"] / case["steps"]),
        sk.MoreauJeanOSI(0.5),
        sk.FrictionContact(2),
    )
    simulation.setNewtonTolerance(1e-12)
    path = []
    for step in range(1, case["steps"] + 1):
        simulation.computeOneStep()
        if step % (case["steps"] // case["samples"]) == 0:
            path.append([*rotor.q()[:2], *rotor.velocity()[:2]])
        simulation.nextStep()
    return path


if __name__ == "__main__":
    print(json.dumps(main(sys.argv[1], json.loads(sys.argv[2]))))
