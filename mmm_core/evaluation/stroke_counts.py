"""Counts the strokes of a gesture, or how often a gesture without strokes is done: turning points along the axis of its reference.

How many turning points the reference performance has with one, two, ... twelve strokes tells what a number of them means, so no
table of families is needed; each further stroke has as many as the twelfth. `recognition.checks.count` counts some families
without the corpus.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.evaluation.reference import Reference, channels, reference
from mmm_core.language.count_words import MOST
from mmm_core.motion.posture_features import PostureFeatures
from mmm_core.motion.repetitions import peaks_beyond
from mmm_core.recognition import checks

Array = NDArray[np.floating]
_NUMBERS = range(1, 13)
"""Numbers of strokes of reference performances."""
_SHOWS_AXIS = 3
"""Strokes of the reference performance that gives the axes."""
TURN_SHARE = 0.4
"""Share of the gesture's range by which a stroke rises and falls at least."""
_IN_CYCLES = frozenset({"shake_head", "sway"})
"""Families of which `checks.count` counts each swing to either side, and a sentence both as one."""


def count_strokes(shown: PostureFeatures, family: str, side: str = "", direction: str = "") -> int | None:
    """The strokes of a motion of a family, or how often a gesture without strokes is done; None where that cannot be told.

    Args:
        shown: the motion.
        family: its family.
        side: side that the gesture was asked with; that of the moving arms when empty.
        direction: its direction.
    """
    if family not in _IN_CYCLES and (found := checks.count(shown, family, side)) is not None:
        return found
    sides = FAMILIES[family].sides
    sides_in_turn = (side, shown.arms, "right", *sides)
    own_side = next((one for one in sides_in_turn if one in sides), "")
    if not FAMILIES[family].counts:
        return _times_done(shown, reference(Gesture(family, own_side, direction=direction)))
    counted = _counted_channels(family, own_side, direction)
    if counted is None:
        return None
    names, turns_by_number = counted
    ref = reference(Gesture(family, own_side, _SHOWS_AXIS, direction))
    if not any(_moves(shown, ref, name) for name in names):
        return 0
    n = _turns(shown, ref, names)
    further = np.arange(1, MOST - len(_NUMBERS) + 1) * (turns_by_number[-1] - turns_by_number[-2])
    of_numbers = np.concatenate([turns_by_number, turns_by_number[-1] + further])
    return 1 + int(np.argmin(np.abs(of_numbers - n)))


@lru_cache(maxsize=512)
def _counted_channels(family: str, side: str, direction: str) -> tuple[tuple[str, ...], tuple[int, ...]] | None:
    """Channels whose turning points tell the number of strokes, and how many there are with each number."""
    performed = [reference(Gesture(family, side, n, direction)) for n in _NUMBERS]
    axes = reference(Gesture(family, side, _SHOWS_AXIS, direction))
    paths = channels(axes.shown)
    by_reach = sorted(paths, key=lambda name: -float(np.linalg.norm(np.ptp(paths[name][axes.core], axis=0))))
    for names in (axes.acting, *((name,) for name in by_reach)):
        found = tuple(_turns(one.shown, axes, names) for one in performed)
        if names and all(few < more for few, more in pairwise(found)):
            return names, found
    return None


def _times_done(shown: PostureFeatures, ref: Reference) -> int | None:
    """Count the departures from the rest pose in a motion of a gesture without strokes; None for standing, which has none."""
    done = expected = 0
    for name in ref.acting:
        signal, meant = ref.along(shown, name), ref.along(ref.shown, name)
        turn = TURN_SHARE * float(np.ptp(meant))
        sense = first_sense(meant, turn)
        done += len(peaks_beyond(sense * signal, turn))
        expected += len(peaks_beyond(sense * meant, turn))
    return round(done / expected) if expected else None


def _turns(shown: PostureFeatures, ref: Reference, names: tuple[str, ...]) -> int:
    """Turning points of a motion in the sense of the reference's first stroke, of all channels together."""
    n = 0
    of_shown, of_reference = channels(shown), channels(ref.shown)
    for name in names:
        clean = of_reference[name][ref.core]
        axis = _axis(clean)
        signal, meant = of_shown[name] @ axis, clean @ axis
        turn = TURN_SHARE * float(np.ptp(meant))
        n += len(turning_points(first_sense(meant, turn) * signal, turn)) if turn > 0 else 0
    return n


def _moves(shown: PostureFeatures, ref: Reference, name: str) -> bool:
    """Whether a channel moves as far along its axis as a stroke needs to."""
    clean = channels(ref.shown)[name][ref.core]
    axis = _axis(clean)
    return bool(np.ptp(channels(shown)[name] @ axis) > TURN_SHARE * np.ptp(clean @ axis))


def _axis(path: Array) -> Array:
    """The direction (D,) in which a path (T, D) extends most."""
    return np.asarray(np.linalg.svd(path - path.mean(0), full_matrices=False)[2][0])


def first_sense(signal: Array, turn: float) -> float:
    """The sense, 1 or -1, of the first stroke of a signal (T,) whose strokes rise and fall by `turn`."""
    far = np.flatnonzero(np.abs(signal - signal[0]) > 0.5 * turn)
    return 1.0 if not len(far) or signal[far[0]] > signal[0] else -1.0


def turning_points(signal: Array, turn: float) -> list[int]:
    """Frames of the peaks, without a last peak after which the signal does not fall: its frame is arbitrary if nothing moves."""
    found = peaks_beyond(signal, turn)
    return found[:-1] if found and signal[found[-1]] - signal[found[-1] :].min() < turn else found
