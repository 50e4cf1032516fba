"""Places of a person's body that hands go to; the corpus performs gestures there, and the signs recognise them there.

Each is (outward, up, forward) in metres in the chest frame from the middle between the shoulders, for the acting arm.
"""

from __future__ import annotations

Vector = tuple[float, float, float]

CHIN: Vector = (0.02, 0.10, 0.13)
MOUTH: Vector = (0.03, 0.16, 0.15)
EYES: Vector = (0.03, 0.25, 0.13)
FOREHEAD: Vector = (0.03, 0.30, 0.12)
BROW: Vector = (0.09, 0.29, 0.12)
EAR: Vector = (0.11, 0.21, 0.03)
CROWN: Vector = (0.03, 0.38, 0.02)
NAPE: Vector = (0.03, 0.17, -0.10)
HEART: Vector = (-0.06, -0.13, 0.13)
BELLY: Vector = (0.0, -0.34, 0.15)
HIP: Vector = (0.17, -0.45, 0.06)
LOWER_BACK: Vector = (0.06, -0.38, -0.15)
OTHER_SHOULDER: Vector = (-0.17, -0.01, 0.08)
STERNUM: Vector = (0.02, -0.16, 0.22)
