"""Measures sentences as people say them: each is generated with several seeds and judged by its motion, not by its reading."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, pairwise, permutations
from typing import Any

import numpy as np

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.heldout import Command, Probe, Sentence
from mmm_core.evaluation.manner import judge_manner, plain_sentence
from mmm_core.evaluation.probes import MIN_PART, judge
from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import PostureFeatures, part, posture_features
from mmm_core.motion.skeleton import standing_joints
from mmm_core.recognition import checks
from mmm_core.recognition.expected import goes, is_seen
from mmm_core.recognition.signs import shows

Generate = Callable[[str, int], Motion]
_REST = 0.35
"""Share of the greatest distance from the first frame below which the body is at rest."""
_PART_STEP = 4
"""Frames between two moments at which a motion is divided."""


def judge_sentence(sentence: Sentence, shown: PostureFeatures) -> dict[str, bool]:
    """Whether a motion meets each expectation of a sentence, except tempo and size, which `manner.judge_manner` judges."""
    verdict: dict[str, bool] = {}
    if sentence.nothing:
        return {"denial": checks.limb(shown) == ""}
    if len(sentence.commands) > 1:
        verdict["order"] = is_in_turn(sentence.commands, shown)
    for step in sentence.commands if len(sentence.commands) == 1 else ():
        if len(step) > 1:
            verdict["at_once"] = seen_at_once(step, shown)
        for command in step if len(step) == 1 else ():
            verdict = judge(as_probe(command), shown, with_pose=True)
    if sentence.denied or sentence.kind == "denial":
        kept = not any(shows_as_usual(shown, family) for family in sentence.denied)
        verdict["denial"] = kept and all(ok for key, ok in verdict.items() if key != "count_exact")
    return verdict


def shows_as_usual(shown: PostureFeatures, family: str, side: str = "", direction: str = "") -> bool:
    """Whether a motion shows a gesture with as many strokes as the corpus makes where no number is said: two, or one.

    A fist that is held out goes up and down once, as a hand does that is shaken once. But nobody shakes a hand once unasked.
    """
    return shows(shown, family, side, direction, min(2, *FAMILIES[family].counts or (1,)))


def seen_at_once(commands: Sequence[Command], shown: PostureFeatures) -> bool:
    """Whether a motion shows several commands, each on its own limb; arms without a side must act on different sides.

    Signs of head and trunk require other limbs to be still, so each command is judged as if the limbs of the others were still.
    """
    arms = [c for c in commands if c.limb == "arm"]
    others = [c for c in commands if c.limb != "arm"]
    limbs = {c.limb for c in commands}
    if not all(_shows(c, _still(shown, limbs - {c.limb})) for c in others):
        return False
    if len(arms) == 1 or all(c.side for c in arms):
        return all(_shows(c, shown) for c in arms)
    return any(
        all(_shows(replace(c, side=side), shown) for c, side in zip(arms, sides, strict=True))
        for sides in permutations(("left", "right"))
        if all(c.side in ("", side) for c, side in zip(arms, sides, strict=True))
    )


def evaluate_sentences(
    generate: Generate,
    plain: Generate,
    sentences: Sequence[Sentence],
    seeds: Sequence[int],
    progress: Callable[[int], None] = lambda _n: None,
    showable: Mapping[str, frozenset[str]] | None = None,
) -> dict[str, Any]:
    """Shares of expectations met over all sentences and seeds, of whole sentences by kind, and the sentences missed most.

    Args:
        generate: (sentence, seed) -> motion; a motion without frames meets no expectation of movement.
        plain: generates the plain sentence that tempo and size are compared with, and a sentence without slips.
        sentences: the sentences to judge.
        seeds: seeds of each sentence.
        progress: called with the number of motions done.
        showable: expectations that are met when the corpus itself performs a sentence, by text, from `sentence_capability`;
            the shares of these alone are given as "of_showable".
    """
    met: dict[str, list[bool]] = defaultdict(list)
    whole: dict[str, list[bool]] = defaultdict(list)
    could: dict[str, list[bool]] = defaultdict(list)
    clean: list[bool] = []
    misses: dict[str, int] = defaultdict(int)
    for i, sentence in enumerate(sentences):
        for seed in seeds:
            motion = generate(sentence.text, seed)
            verdict = _verdict(sentence, motion)
            command = sentence.commands[0][0] if sentence.kind == "manner" and len(sentence.commands) == 1 else None
            if command is not None and (command.tempo or command.size):
                verdict.pop("tempo", None)
                shown = plain(plain_sentence(command), seed)
                unseen = {key: False for key in ("tempo", "size") if getattr(command, key)}
                verdict |= judge_manner(command, motion, shown) if len(motion.joints_m) else unseen
            if sentence.clean:
                clean.append(_all(_verdict(sentence, plain(sentence.clean, seed))))
            for key, ok in verdict.items():
                met[key].append(ok)
                if showable is not None and key in showable.get(sentence.text, (key,)):
                    could[key].append(ok)
            whole[sentence.kind].append(_all(verdict))
            misses[sentence.text] += not _all(verdict)
        progress((i + 1) * len(seeds))
    of_showable = {"of_showable": {**_shares(could), "n_each": _sizes(could)}} if showable is not None else {}
    slips = {"slips": round(sum(whole["slips"]) / max(1, sum(clean)), 4)} if clean else {}
    return {
        **_shares(met),
        **slips,
        "kinds": _shares(whole),
        **of_showable,
        "n": len(sentences) * len(seeds),
        "n_each": _sizes(met),
        "most_missed": sorted(((n, text) for text, n in misses.items() if n), reverse=True),
    }


def _shares(met: Mapping[str, Sequence[bool]]) -> dict[str, float]:
    return {key: round(float(np.mean(values)), 4) for key, values in sorted(met.items())}


def _sizes(met: Mapping[str, Sequence[bool]]) -> dict[str, int]:
    return {key: len(values) for key, values in sorted(met.items())}


def _verdict(sentence: Sentence, motion: Motion) -> dict[str, bool]:
    if len(motion.joints_m):
        return judge_sentence(
            sentence, posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
        )
    if sentence.nothing:
        return {"denial": True}
    expected = judge_sentence(sentence, _nobody())
    return dict.fromkeys(expected, False)


def _nobody() -> PostureFeatures:
    """Posture features of a person who stands still."""
    joints = np.repeat(standing_joints().reshape(1, 22, 3), 30, 0)
    return posture_features(joints, np.tile([1.0, 0, 0, 0], (30, 1)), np.zeros((30, 2)))


def _all(verdict: Mapping[str, bool]) -> bool:
    return all(ok for key, ok in verdict.items() if key != "count_exact")


def as_probe(c: Command) -> Probe:
    """A command as a probe without a text."""
    return Probe("", c.family, c.limb, c.side, c.count, c.direction, c.hold_s)


def _still(shown: PostureFeatures, limbs: Collection[str]) -> PostureFeatures:
    """The posture features of a motion with the arms at rest, and with the angles of the given limbs ("head", "trunk") set to 0."""
    nothing = np.zeros_like(shown.trunk_yaw_deg)
    still = replace(shown, arms="")
    if "head" in limbs:
        still = replace(still, head_yaw_deg=nothing, head_pitch_deg=nothing, head_roll_deg=nothing)
    if "trunk" in limbs:
        still = replace(still, trunk_yaw_deg=nothing, trunk_pitch_deg=nothing, trunk_roll_deg=nothing)
    return still


def _shows(c: Command, shown: PostureFeatures) -> bool:
    if not shows(shown, c.family, c.side, c.direction):
        return False
    arms = c.side if c.family == "point" and c.side else shown.arms
    return not c.direction or goes(replace(shown, arms=arms), c.family, c.side, c.direction)


def is_in_turn(steps: Sequence[Sequence[Command]], shown: PostureFeatures) -> bool:
    """Whether the motion can be divided into the steps in order and, for two steps, at no frame at rest in reverse order.

    Two steps that differ by number, tempo or size alone ("clap slowly, later on fast") are not sought in reverse order.
    """
    T = len(shown.head_yaw_deg)
    moments = range(MIN_PART, T - MIN_PART, _PART_STEP if len(steps) > 2 else 2)
    parts: dict[tuple[int, int], PostureFeatures] = {}
    seen: dict[tuple[int, int, int], bool] = {}

    def step_seen(i: int, start: int, end: int) -> bool:
        if (i, start, end) not in seen:
            if (start, end) not in parts:
                parts[start, end] = part(shown, start, end)
            seen[i, start, end] = _step_seen(steps, i, parts[start, end])
        return seen[i, start, end]

    def parted(order: Sequence[int], cuts: Sequence[int]) -> bool:
        edges = [0, *cuts, T]
        if any(b - a < MIN_PART for a, b in pairwise(edges)):
            return False
        return all(step_seen(i, edges[k], edges[k + 1]) for k, i in enumerate(order))

    forward = list(range(len(steps)))
    found = any(parted(forward, cuts) for cuts in combinations(moments, len(steps) - 1))
    if len(steps) == 2 and found and _signs(steps[0]) != _signs(steps[1]):
        rests = _at_rest(shown)
        return not any(rests[t] and parted([1, 0], (t,)) and _as_usual(steps, shown, t) for t in moments)
    return found


def _as_usual(steps: Sequence[Sequence[Command]], shown: PostureFeatures, t: int) -> bool:
    """Whether each of two steps in reverse order, the second one up to frame t, has its usual strokes where no number is said."""
    parts = ((steps[1], part(shown, 0, t)), (steps[0], part(shown, t, len(shown.head_yaw_deg))))
    return all(
        shows_as_usual(seen, c.family, c.side, c.direction)
        for step, seen in parts
        if len(step) == 1
        for c in step
        if not c.count
    )


def _signs(step: Sequence[Command]) -> list[Command]:
    """The commands of a step without number, tempo, size and hold, by which they are not told apart."""
    return [replace(c, count=None, tempo="", size="", hold_s=0.0) for c in step]


def _at_rest(shown: PostureFeatures) -> np.ndarray:
    """(T,) whether the body is near its first pose in each frame, by `_REST`."""
    angles = [
        shown.head_yaw_deg,
        shown.head_pitch_deg,
        shown.head_roll_deg,
        shown.trunk_yaw_deg,
        shown.trunk_pitch_deg,
        shown.trunk_roll_deg,
    ]
    path = np.concatenate([shown.wrists_m["left"], shown.wrists_m["right"], np.stack(angles, -1) / 80], -1)
    away = np.linalg.norm(path - path[0], axis=-1)
    return away < _REST * away.max()


def _step_seen(steps: Sequence[Sequence[Command]], i: int, shown: PostureFeatures) -> bool:
    """Whether a part of a motion shows a step."""
    step = steps[i]
    if len(step) > 1:
        return seen_at_once(step, shown)
    return is_seen(shown, step[0], [steps[k][0] for k in (i - 1, i + 1) if 0 <= k < len(steps)])
