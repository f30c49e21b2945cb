"""
40. Kicks that are proven to come back
======================================

Kicks that are proven to come back, and the largest number of impacts before.  Needs ``pip install "carom[proof]"``.
"""

from carom.proofs import ProvenKicks, prove_kicks

proof = prove_kicks("../spindle.toml", "200 mm/s", most_impacts=1, time_limit="30 s")
kicks = ProvenKicks.of(proof)
print(kicks.words)

# %%
# What to see: after kicks inside the dashed circle the rotor never touches; after the others it may touch, and comes back.  Grey rings are open: there some
# flights just reach the wall, or reach it twice, while only one impact is allowed.  More time, and ``most_impacts=2``, proves the whole disc.
figure = kicks.plot()
