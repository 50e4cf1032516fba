"""The strict checks of `mmmd eval fidelity`: the corpus passes them, and motions broken in one way each do not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mmm_core.corpus.beat import BEAT_S, Calm
from mmm_core.corpus.body import Body, perform
from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.families.gesture import Perform
from mmm_core.corpus.families.strokes import circle, loops, strokes
from mmm_core.corpus.reach import reach
from mmm_core.corpus.score import Score
from mmm_core.corpus.synthesis import ClipSpec, SynthClip, rest_pose, synthesise_spec
from mmm_core.evaluation import fidelity as fidelity_module
from mmm_core.evaluation.fidelity import CORPUS_DRAWS, cases_of, counting_checks, fidelity, judged, seen
from mmm_core.evaluation.reference import reference
from mmm_core.motion.features import mirror, recover
from mmm_core.motion.motion import FPS, Motion
from mmm_core.motion.posture_features import posture_features
from tests.support.sizes import few_and_long

REPEATED = (
    Gesture("row", "both", 4), Gesture("flap", "both", 4), Gesture("knock", "right", 4), Gesture("swim_crawl", "both", 4),
    Gesture("clap", "both", 4), Gesture("march_arms", "both", 4), Gesture("draw_circle", "right", 4), Gesture("nod", "", 4),
    Gesture("wave", "left", 4), Gesture("fist_pump", "left", 4), Gesture("conduct", "right", 4),
)  # fmt: skip
SIDED = (
    Gesture("wave", "left", 3), Gesture("knock", "right", 3), Gesture("salute", "right"), Gesture("point", "left", direction="up"),
    Gesture("look", direction="left"), Gesture("lean", direction="right"), Gesture("throw", "right"), Gesture("raise", "left"),
)  # fmt: skip
RIGHT_ARM = [17, 19, 21]


def performed(g: Gesture, beat_s: float = BEAT_S, seed: int = 5) -> SynthClip:
    clip = None
    rng = np.random.default_rng(seed)
    while clip is None:
        clip = synthesise_spec(ClipSpec((g,)), rng, beat_s)
    return clip


def faults(body: Body, g: Gesture) -> set[str]:
    said = f"do it {g.count} times" if FAMILIES[g.family].counts else "do it"
    return {check for check, ok in judged(seen(body), g, said).items() if not ok}


def name(g: Gesture) -> str:
    return f"{g.side} {g.family} {g.direction}".strip()


@pytest.mark.parametrize("n_people", [5, pytest.param(10, marks=pytest.mark.soak)])
@pytest.mark.parametrize("g", few_and_long([REPEATED[7], REPEATED[9], SIDED[2]], [*REPEATED, *SIDED]), ids=name)
def test_the_clean_performance_and_a_persons_pass(g: Gesture, n_people: int) -> None:
    assert not faults(performed(g).body, g)
    people = [faults(performed(g, 0.0, seed).body, g) for seed in range(n_people)]
    assert sum(not found for found in people) >= 0.8 * n_people, people


@pytest.mark.parametrize("g", few_and_long([REPEATED[7], SIDED[2]], [*REPEATED, *SIDED]), ids=name)
def test_standing_still_fails(g: Gesture) -> None:
    body = performed(g).body
    n = len(body.joints_m)
    still = Body(*(np.repeat(x[:1], n, 0) for x in (body.joints_m, body.head_R_world, body.forearm_twist_rad)))
    assert faults(still, g)


@pytest.mark.parametrize("g", SIDED, ids=name)
def test_the_mirror_image_fails(g: Gesture) -> None:
    motion = recover(mirror(performed(g).features))
    other = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    assert not all(judged(other, g, "do it 3 times" if g.count == 3 else "do it").values())


def made_by(way: Perform, g: Gesture) -> Body:
    """A gesture made in a way of its own."""
    score = Score(np.random.default_rng(0), rest_pose(Calm(np.random.default_rng(0))), beat_s=BEAT_S)
    way(score, g)
    score.relax(0.8)
    return perform(score, int(score.time_s * FPS))


def in_frames(body: Body, frames: np.ndarray) -> Body:
    return Body(body.joints_m[frames], body.head_R_world[frames], body.forearm_twist_rad[frames])


def stroke_frames(g: Gesture) -> list[int]:
    """Where the strokes of the clean performance begin, and where the last one ends."""
    core = reference(g).core
    return np.linspace(core.start, core.stop, g.count + 1).round().astype(int).tolist()


@pytest.mark.parametrize("g", few_and_long([REPEATED[7], REPEATED[9]], REPEATED), ids=name)
def test_every_second_stroke_left_out_fails(g: Gesture) -> None:
    body = performed(g).body
    frames = np.arange(len(body.joints_m))
    at = stroke_frames(g)
    for i in range(1, g.count, 2):
        frames[at[i] : at[i + 1]] = at[i]
    assert faults(in_frames(body, frames), g) & {"count", "pace"}


@pytest.mark.parametrize("g", few_and_long([REPEATED[7], REPEATED[9]], REPEATED), ids=name)
def test_strokes_at_random_times_fail(g: Gesture) -> None:
    body = performed(g).body
    at = stroke_frames(g)
    pauses = np.random.default_rng(3).permutation([0, 4, 14, 24])
    parts = [np.arange(at[0])]
    for i in range(g.count):
        parts += [np.arange(at[i], at[i + 1]), np.full(pauses[i], at[i + 1] - 1)]
    frames = np.concatenate([*parts, np.arange(at[-1], len(body.joints_m))])
    assert faults(in_frames(body, frames), g) & {"pace", "count"}


def test_an_ellipse_of_one_to_three_is_no_circle() -> None:
    g = Gesture("draw_circle", "right", 3)

    def drawn(tall: float) -> set[str]:
        return faults(made_by(loops(circle((0.15, 0.0, 0.42), 0.17, "front", tall), 1.35, (0.9, -0.5, 0)), g), g)

    assert "round" not in drawn(1.0)
    assert "round" in drawn(1 / 3)


@pytest.mark.parametrize(
    "family",
    few_and_long(["flap", "run_arms"], ["row", "swim_breast", "march_arms", "swim_crawl", "conduct"]),
)
def test_arms_out_of_step_fail(family: str) -> None:
    g = Gesture(family, "both", 4)
    body = performed(g).body
    at = stroke_frames(g)
    half = (at[1] - at[0]) // 2
    late = np.maximum(np.arange(len(body.joints_m)) - half, 0)
    joints = body.joints_m.copy()
    joints[:, RIGHT_ARM] = body.joints_m[late][:, RIGHT_ARM]
    assert "phase" in faults(replace(body, joints_m=joints), g)


def test_palms_that_pass_without_meeting_fail() -> None:
    g = Gesture("clap", "both", 4)

    def clapped(nearest_m: float) -> set[str]:
        near, far = (reach((out, -0.18, 0.33), (0.6, -0.8, 0)) for out in (nearest_m / 2, 0.19))
        return faults(made_by(strokes(far, near, 0.56), g), g)

    assert "touch" not in clapped(0.04)
    assert "touch" in clapped(0.2)


@pytest.mark.long
def test_the_figure_is_the_share_of_what_the_corpus_shows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fidelity_module, "CORPUS_DRAWS", 4)
    clips: dict[tuple[str, int], SynthClip] = {}
    for family in ("bow", "salute"):
        for i, case in enumerate(cases_of(family, 4)):
            clips[case.text, i] = performed(case.gesture)

    def generate(text: str, seed: int) -> Motion:
        clip = clips[text, seed]
        if seed == 0:  # one of each family stands still
            clip = replace(clip, features=np.repeat(clip.features[:1], len(clip.features), 0))
        m = recover(clip.features)
        T = len(m.joints_m)
        return Motion(m.joints_m, FPS, m.head_quat_wxyz, m.forearm_twist_rad, clip.features,
                      np.zeros(-(-T // 4), np.int32), text, seed, "accepted", 1.0)  # fmt: skip

    figures = fidelity(generate, ("bow", "salute"), 4)
    assert set(figures) >= {"share", "families", "worst", "n"}
    assert figures["n"] == 8
    assert figures["share"] == 0.75
    assert figures["families"]["bow"]["share"] == 0.75
    assert figures["families"]["bow"]["missed"]


def test_cases_are_the_same_every_time_and_a_broken_check_does_not_count() -> None:
    assert CORPUS_DRAWS == 10
    assert [(c.gesture, c.text) for c in cases_of("bow", 3)] == [(c.gesture, c.text) for c in cases_of("bow", 3)]
    cases = [replace(c, corpus={"sign": True, "pace": i > 2}) for i, c in enumerate(cases_of("bow", 10))]
    assert counting_checks(cases) == ["sign"]
