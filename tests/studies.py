"""Studies of machines that several tests look at: each is made once in a process, for it takes seconds."""

from carom.parameters import Case, Machine, Parameters
from carom.studies import Study, study

QUICK = ("--set", "damping=6000 N s/m", "--set", "friction=0")
"""Of the machine of the examples a study that is soon made: every disturbance comes back at once."""

ORBIT_KEYS = frozenset(
    [
        "name",
        "impacts",
        "period",
        "radial_speed",
        "angle",
        "angular_speed",
        "multipliers",
        "stable",
        "admissible",
        "reason",
    ]
)
"""Of an orbit in a document."""

_MADE: dict[str, Study] = {}


def study_once(subject: Case | Machine | Parameters) -> Study:
    """Study of a machine, which nothing of this process has studied before, or that study."""
    key = repr(subject)
    if key not in _MADE:
        _MADE[key] = study(subject)
    return _MADE[key]
