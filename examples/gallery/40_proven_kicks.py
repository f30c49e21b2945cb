"""
40. Kicks that are proven to come back
======================================

Which kicks are proven to come back, and after how many impacts.  Needs ``pip install "carom[proof]"``.
"""

from carom.proofs import ProvenKicks, prove_kicks

proof = prove_kicks("../spindle.toml", "200 mm/s", most_impacts=1, time_limit="30 s")
kicks = ProvenKicks.of(proof)
print(kicks.words)

# %%
# What to see: kicks inside the dashed circle never touch; all others touch, and come back through contact.  Grey rings are open: next to them some
# flights only just reach the wall, or reach it twice, which one impact does not allow.  More time, and ``most_impacts=2``, proves the whole disc.
figure = kicks.plot()
