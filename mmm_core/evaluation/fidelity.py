"""Measures fidelity, the share of gestures that the model performs as well as its corpus, for `mmmd eval fidelity`.

For every family, gestures and their captions are drawn as the corpus draws them, with seeds that no training uses. The corpus
performs each gesture in its free manner, and the model makes a motion for the caption alone. Both are judged by `likeness`. A
check counts for a family if the corpus's own motions nearly always pass it. Among the gestures whose corpus motion passes all
checks that count, fidelity is the share whose generated motion passes them, too.
"""

from __future__ import annotations

import zlib
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mmm_core.corpus.body import Body
from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.synthesis import ClipSpec, draw_gesture, synthesise_spec
from mmm_core.evaluation.likeness import Checks, judge
from mmm_core.evaluation.reference import reference
from mmm_core.language.count_words import count_asked
from mmm_core.motion.features import recover
from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import PostureFeatures, posture_features

HELD_OUT_SEED = 23_000_001
CORPUS_DRAWS = 10
"""Motions of each family by which checks are chosen, and that the model is measured on unless told otherwise."""
COUNTS_FROM = 0.9
"""Share of the corpus's own motions from which on a check counts."""
N_WORST = 10
"""Families that the figures list as the worst."""
Generate = Callable[[str, int], Motion]


@dataclass(frozen=True)
class Case:
    """A gesture, its sentence, and the outcome of each check for the corpus's own motion."""

    gesture: Gesture
    text: str
    corpus: Checks


def cases_of(family: str, n: int = CORPUS_DRAWS) -> list[Case]:
    """The first `n` cases of a family, which never change."""
    cases: list[Case] = []
    seed = (HELD_OUT_SEED, zlib.crc32(family.encode()))
    draw = 0
    while len(cases) < n:
        rng = np.random.default_rng((*seed, draw))
        draw += 1
        gesture = draw_gesture(rng, (family,))
        clip = synthesise_spec(ClipSpec((gesture,)), rng)
        if clip is not None:
            text = clip.captions[0]
            cases.append(Case(gesture, text, judged(seen(clip.body), gesture, text)))
    return cases


def seen(body: Body) -> PostureFeatures:
    """Posture features of a motion of the corpus."""
    motion = recover(body.features())
    return posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)


def judged(s: PostureFeatures, gesture: Gesture, text: str) -> Checks:
    """The outcome of each check of a motion for a sentence; where the sentence leaves a choice open, the best fit counts."""
    counts = {gesture.count}
    if count_asked(text) is None:
        counts |= set(FAMILIES[gesture.family].counts)
        counts -= {1} if gesture.side == "alternating" else set()
    ways = [
        reference(replace(gesture, count=count), otherwise) for count in sorted(counts) for otherwise in (False, True)
    ]
    verdicts = [judge(s, ref) for ref in ways]
    return min(verdicts, key=lambda v: (sum(not ok for ok in v[0].values()), v[1]))[0]


def fidelity(
    generate: Generate,
    families: Sequence[str] = (),
    n_each: int = CORPUS_DRAWS,
    progress: Callable[[int], None] = lambda _n: None,
) -> dict[str, Any]:
    """The share of the corpus's gestures that the model makes as well, over all and for each family, and the worst families.

    Args:
        generate: (sentence, seed) -> motion.
        families: names of families; all of the corpus when empty.
        n_each: motions of each family.
        progress: called with the number of motions done.
    """
    table: dict[str, dict[str, Any]] = {}
    made = shown = done = 0
    for name in families or tuple(FAMILIES):
        cases = cases_of(name, max(n_each, CORPUS_DRAWS))
        counting = counting_checks(cases)
        missed: Counter[str] = Counter()
        passed = of = 0
        for i, case in enumerate(cases[:n_each]):
            done += 1
            progress(done)
            if not all(case.corpus.get(check, True) for check in counting):
                continue
            motion = generate(case.text, i)
            of += 1
            found = faults_of(motion, case.gesture, case.text, counting)
            passed += not found
            missed.update(found)
        made, shown = made + passed, shown + of
        table[name] = {"share": round(passed / of, 3) if of else None, "n": of, "missed": dict(missed.most_common())}
    ranked = sorted((t["share"], name) for name, t in table.items() if t["share"] is not None)
    return {
        "share": round(made / max(shown, 1), 4),
        "least": ranked[0][0] if ranked else None,
        "worst": [[name, share] for share, name in ranked[:N_WORST]],
        "families": table,
        "n": shown,
    }


def counting_checks(cases: Sequence[Case]) -> list[str]:
    """Names of the checks that count: those that the corpus's own motions pass often enough."""
    names = {check for case in cases for check in case.corpus}
    share = {check: np.mean([case.corpus.get(check, True) for case in cases]) for check in names}
    return sorted(check for check, passed in share.items() if passed >= COUNTS_FROM)


def faults_of(motion: Motion, gesture: Gesture, text: str, counting: Sequence[str]) -> list[str]:
    """The checks that count and that the motion for a text does not pass; "refused" for a motion without frames."""
    if not len(motion.joints_m):
        return ["refused"]
    s = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    checks = judged(s, gesture, text)
    return [check for check in counting if not checks.get(check, True)]
