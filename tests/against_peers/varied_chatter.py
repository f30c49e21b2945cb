"""Run the package's own loop with other heights of completion; a script, for the height is a constant once compiled.

With the compiler off (``NUMBA_DISABLE_JIT=1``) the source of the kernels runs as plain Python and looks its constants up.
Argument: a JSON object with the machine, the start, the time ``until`` and the ``heights``.  Prints for each height the
final position and velocity in the co-rotating frame.
"""

import json
import sys

import numba

from carom.core import advance
from carom.models import jeffcott
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.parameters import Parameters


def main(case: dict) -> list[list[float]]:
    """Final states, one for each height."""
    if not numba.config.DISABLE_JIT:
        raise SystemExit("set NUMBA_DISABLE_JIT=1")
    loop = sys.modules[advance.__module__] if callable(advance) else advance
    rotor, start = (
        jeffcott(Parameters(**case["machine"])),
        State(complex(*case["position"]), complex(*case["velocity"])),
    )
    finals = []
    for height in case["heights"]:
        loop.CHATTER_HEIGHT = height
        final = simulate(rotor, start, case["until"]).final
        finals.append([final.position.real, final.position.imag, final.velocity.real, final.velocity.imag])
    return finals


if __name__ == "__main__":
    print(json.dumps(main(json.loads(sys.argv[1]))))
