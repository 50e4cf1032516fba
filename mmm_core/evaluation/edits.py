"""Measures edits (body parts, segments, new beginnings, new ends, in-betweening) for `mmmd eval edits`.

Each case generates a motion, edits it for a text, and judges the result by the kinematic signs of `mmm_core.recognition`: whether
the edited part shows the gesture that the text names (its arm, direction and number within one), and whether the rest stays. The
expectations are written by hand beside each text (`mmm_core/corpus/prompts/edits_*.jsonl`); the editor never sees them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from typing import Any

import msgspec
import numpy as np

from mmm_core.generate.editing import Edit, edit, extend, in_between
from mmm_core.generate.engine import Engine
from mmm_core.generate.shown_edits import Edited
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.motion import FPS, Motion
from mmm_core.motion.posture_features import PostureFeatures, part, posture_features
from mmm_core.recognition import checks
from mmm_core.recognition.signs import shows

KINDS = ("part", "stretch", "beginning", "end", "between")
SETS = ("development", "test")
SEAM_FRAMES = 2 * FRAMES_PER_TOKEN
"""Frames at a seam that belong to the transition: the decoder's receptive field reaches about two tokens."""
KEPT_M, KEPT_DEG = 0.05, 6.0
"""Mean distance of a wrist, and mean angle of head or trunk, up to which a kept limb has stayed as it was."""
_LIMBS = {"left_arm": ("left",), "right_arm": ("right",), "rest": ("head", "trunk")}
_ALL = ("left", "right", "head", "trunk")


@dataclass(frozen=True)
class EditCase:
    """An edit of a generated motion, and the gesture that its new part must show.

    Attributes:
        kind: one of `KINDS`.
        base, seconds, seed: text, length and seed of the motion that is edited; `seed` is also the edit's.
        text: the edit's text.
        family, limb, side, direction, count: the expected gesture, as in a probe (`mmm_core.corpus.heldout`).
        parts: body parts that are edited; all when empty.
        start_s, end_s: the segment; None is the motion's beginning or end.
        before_s, after_s: seconds of a new beginning, of a new end, or between two motions.
        then: text of the motion that follows (between), generated with the same length and seed.
    """

    kind: str
    base: str
    seconds: float
    seed: int
    text: str
    family: str
    limb: str
    side: str = ""
    direction: str = ""
    count: int | None = None
    parts: tuple[str, ...] = ()
    start_s: float | None = None
    end_s: float | None = None
    before_s: float = 0.0
    after_s: float = 0.0
    then: str = ""


def read_cases(which: str) -> tuple[EditCase, ...]:
    """The cases of one of `SETS`: edits are improved on the development set and reported on the test set.

    Raises:
        msgspec.ValidationError: a field is missing or has the wrong type.
    """
    lines = files("mmm_core.corpus").joinpath("prompts", f"edits_{which}.jsonl").read_bytes()
    return tuple(msgspec.json.decode(line, type=EditCase) for line in lines.splitlines())


def evaluate_edits(
    engine: Engine, progress: Callable[[int], None] = lambda _n: None, stride: int = 1
) -> dict[str, Any]:
    """Shares of edits that show their text (`asked`), keep the rest (`kept`) and do both (`share`), by kind and by set.

    `told` is the share of cases in which the editor's own verdict (reached or not) agrees with the check. `missed` lists
    the texts of cases that fail.

    Args:
        engine: the model.
        progress: called with the number of cases done.
        stride: distance between the cases that are taken; 1 takes all.
    """
    rows: list[tuple[str, EditCase, bool, bool, bool]] = []
    for which in SETS:
        for case in read_cases(which)[::stride]:
            edited, asked, kept = run_case(engine, case)
            rows.append((which, case, asked, kept, edited.reached == asked))
            progress(len(rows))

    def figures(chosen: Sequence[tuple[str, EditCase, bool, bool, bool]]) -> dict[str, Any]:
        def share(values: Sequence[bool]) -> float:
            return round(sum(values) / max(1, len(values)), 4)

        return {
            "share": share([a and k for _, _, a, k, _ in chosen]), "asked": share([r[2] for r in chosen]),
            "kept": share([r[3] for r in chosen]), "told": share([r[4] for r in chosen]), "n": len(chosen),
        }  # fmt: skip

    return {
        **figures(rows),
        "kinds": {kind: figures([r for r in rows if r[1].kind == kind]) for kind in KINDS},
        **{which: figures([r for r in rows if r[0] == which]) for which in SETS},
        "missed": [
            f"{which} {c.kind}: {c.base} / {c.text}" for which, c, asked, kept, _ in rows if not (asked and kept)
        ],
    }


def run_case(engine: Engine, case: EditCase) -> tuple[Edited, bool, bool]:
    """The edited motion, whether it shows the gesture of the text, and whether the rest stayed."""
    base = engine.generate(case.base, seed=case.seed, seconds=case.seconds).motion
    n = len(base.joints_m)
    if case.kind == "between":
        second = engine.generate(case.then, seed=case.seed, seconds=case.seconds).motion
        edited = in_between(engine, base, second, case.after_s, case.text, seed=case.seed)
        new = slice(n, len(edited.motion.joints_m) - len(second.joints_m))
        kept = _stays(base, edited.motion, 0, n, 0) and _stays(second, edited.motion, 0, len(second.joints_m), new.stop)
    elif case.kind in ("beginning", "end"):
        edited = extend(engine, base, case.text, before_s=case.before_s, after_s=case.after_s, seed=case.seed)
        first = round(case.before_s * FPS)
        new = slice(0, first) if first else slice(n, len(edited.motion.joints_m))
        kept = _stays(base, edited.motion, 0, n, first)
    else:
        what = Edit(case.start_s or 0.0, case.end_s, case.parts or None)
        edited = edit(engine, base, what, case.text, seed=case.seed)
        new = slice(round((case.start_s or 0.0) * FPS), n if case.end_s is None else round(case.end_s * FPS))
        others = tuple(limb for name, limbs in _LIMBS.items() if name not in case.parts for limb in limbs)
        kept = not case.parts or _stays(base, edited.motion, 0, n, 0, others, seam=0)
        kept = kept and _stays(base, edited.motion, 0, new.start, 0)
        kept = kept and _stays(base, edited.motion, new.stop, n, new.stop)
    return edited, shows_asked(part(_features(edited.motion), new.start, new.stop), case), kept


def shows_asked(s: PostureFeatures, case: EditCase) -> bool:
    """Whether a motion shows the gesture of a case: its sign, with its arm and direction, and its number within one."""
    body = s if case.limb == "arm" else replace(s, arms="")
    if not shows(body, case.family, case.side, case.direction):
        return False
    aimed = replace(s, arms=case.side) if case.limb == "arm" else body
    if case.direction and checks.direction(aimed, case.family) != case.direction:
        return False
    found = None if case.count is None else checks.count(s, case.family, case.side)
    return case.count is None or (found is not None and abs(found - case.count) <= 1)


def _stays(
    before: Motion, after: Motion, start: int, stop: int, at: int, limbs: Sequence[str] = _ALL, seam: int = SEAM_FRAMES
) -> bool:
    """Whether `limbs` move in frames `start` to `stop` of `before` as they do from frame `at` on in `after`."""
    inner = slice(start + seam if start or at else start, stop - seam)
    if inner.stop - inner.start < 1:
        return True
    shift = at - start
    a = part(_features(before), inner.start, inner.stop)
    b = part(_features(after), inner.start + shift, inner.stop + shift)
    return all(_apart(a, b, limb) for limb in limbs)


def _apart(a: PostureFeatures, b: PostureFeatures, limb: str) -> bool:
    if limb in ("left", "right"):
        return float(np.linalg.norm(a.wrists_m[limb] - b.wrists_m[limb], axis=-1).mean()) <= KEPT_M
    axes = (f"{limb}_yaw_deg", f"{limb}_pitch_deg", f"{limb}_roll_deg")
    return all(float(np.abs(getattr(a, x) - getattr(b, x)).mean()) <= KEPT_DEG for x in axes)


def _features(motion: Motion) -> PostureFeatures:
    return posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
