"""
35. A proof
===========

The equilibria and all orbits with one impact a period as theorems, in ball arithmetic.  Needs ``pip install "carom[proof]"``.
"""

import carom as cm

proof = cm.prove("../source-paper.toml")
for claim in proof[:6]:
    print(f"{claim.name:32s} {claim.status}")
counts = {status: len(proof.with_status(status)) for status in ("proven", "refuted", "undecided")}
print(counts)

# %%
# The period of the stable orbit, with a guaranteed error.
#
# What to see: the orbits to which the theorems refer.  One theorem is that no other orbit with one impact a period exists.
print({name: str(ball) for name, ball in proof["B1,d solution"].enclosures.items()})
figure = cm.find_orbits(cm.load("../source-paper.toml")).plot()
