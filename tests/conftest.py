"""Settings for all tests."""

from __future__ import annotations

from hypothesis import settings

# No timed assertions: machines are shared and noisy; speed lives in `mmmd bench`.
settings.register_profile("mmmd", deadline=None)
settings.load_profile("mmmd")
