"""What all tests share."""

from hypothesis import settings

# Kernels compile on their first call, and a busy machine is slow: no test fails for the time it takes.
settings.register_profile("carom", deadline=None)
settings.load_profile("carom")
