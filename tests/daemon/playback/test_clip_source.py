"""What a command plays: rounds without a seam, repeats that are counted, holds, and idle movements without end."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.playback.sources.clip_source import ClipSource, in_full
from daemon.poses.cycles import Marks, after_loop, closed, find_hold, find_loop, marks_of
from daemon.poses.idle import STYLES, IdleSource, looking
from daemon.poses.pose_sequence import PoseSequence, distance_deg, joined, posture_of, standing
from daemon.wire.requests import Say
from mmm_core.motion.motion import FPS
from mmm_core.motion.posture_features import posture_features
from mmm_core.recognition.seen import seen
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from tests.support.kinematic import DOWN, motion_of, raised_arm
from tests.support.kinematic import FPS as KINEMATIC_FPS

ARM = posture_of(raised_arm("right", 1.5, 1.3, "right"))


def waving(strokes: int = 4, stroke_s: float = 0.8) -> PoseSequence:
    """The right arm goes up, its forearm swings `strokes` times, and it comes down."""
    from mmm_core.motion.skeleton import BONE_LENGTHS_M, JOINT_NAMES, PARENTS

    assert KINEMATIC_FPS == FPS
    n_up, n = round(0.8 * FPS), round(strokes * stroke_s * FPS)
    ease = np.linspace(0, 1, n_up)
    ease = ease**3 * (10 - 15 * ease + 6 * ease**2)
    up = np.concatenate([ease, np.ones(n), ease[::-1]])
    swing = np.concatenate([np.zeros(n_up), 0.5 * np.sin(2 * np.pi * np.arange(n) / (stroke_s * FPS)), np.zeros(n_up)])
    T = len(up)
    joints = np.zeros((T, 22, 3))
    joints[:, 0, 1] = 0.95
    for j, p in enumerate(PARENTS[1:], 1):
        side, _, part = JOINT_NAMES[j].partition("_")
        d = np.tile(np.array(DOWN[part] if part else (0, 1, 0.05), float), (T, 1))
        if side == "right" and part == "elbow":
            d = np.stack([np.sin(0.1 + 1.2 * up), -np.cos(0.1 + 1.2 * up), 0.1 * np.ones(T)], -1)
        if side == "right" and part == "wrist":
            a = 0.1 + 2.6 * up
            d = np.stack([np.sin(a + swing), -np.cos(a + swing), 0.1 * np.ones(T)], -1)
        if side == "right":
            d[:, 0] *= -1
        d /= np.linalg.norm(d, axis=1, keepdims=True)
        joints[:, j] = joints[:, p] + BONE_LENGTHS_M[j] * d
    return posture_of(motion_of(joints, "wave"))


WAVE = waving()


def played(score, most: int = 50) -> tuple[list[PoseSequence], bool]:
    """Stretches up to the last, or `most` of them."""
    stretches = []
    for _ in range(most):
        stretch, last = score.next()
        stretches.append(stretch)
        if last:
            return stretches, True
    return stretches, False


def steps_deg(p: PoseSequence) -> np.ndarray:
    return distance_deg(p[1:], p[:-1])


def test_a_wave_goes_round_above_the_shoulder():
    a, b = find_loop(WAVE)
    assert 14 <= a < b <= 14 + 66  # the arm is up between
    assert distance_deg(standing(), WAVE[a:b]).min() > 60


def test_a_motion_that_never_comes_back_does_not_go_round():
    half = WAVE[:16]
    assert find_loop(half) is None and find_loop(WAVE[:5]) is None


def test_a_closed_loop_has_no_seam():
    """The step from the last frame to the first is no larger than those within, to a degree."""
    loop = find_loop(WAVE)
    p = closed(WAVE, loop)
    seam = distance_deg(p[-1:], p[:1])[0]
    assert seam <= steps_deg(p).max() + 1.0
    last = distance_deg(p[-1:], WAVE.at(np.array([loop[0] - 1])))[0]
    assert last < 1.0  # it ends where the frame before its first stands


def test_what_follows_the_last_round_grows_out_of_it():
    loop = find_loop(WAVE)
    whole = joined([closed(WAVE, loop), after_loop(WAVE, loop)])
    assert steps_deg(whole).max() <= steps_deg(WAVE).max() * 1.3 + 1.0


@pytest.mark.parametrize("repeat", [1, 2, 3, 7])
def test_the_whole_motion_is_repeated(repeat):
    """`say bow --repeat 3` looped the part in the bent pose, so that the robot showed four bows and never stood up."""
    stretches, ended = played(ClipSource(WAVE, Say(text="wave", repeat=repeat)))
    assert ended and [len(stretch) for stretch in stretches] == [len(WAVE)] * repeat
    assert all(distance_deg(WAVE[-1:], stretch[-1:])[0] < 0.01 for stretch in stretches)
    assert steps_deg(joined(stretches)).max() <= steps_deg(WAVE).max() * 1.3 + 1.0


@pytest.mark.parametrize("repeat", [2, 3])
def test_what_is_told_counts_the_strokes_of_all_rounds(repeat):
    """`say wave --repeat 3` told the strokes of the first round alone."""
    play = Say(text="wave", repeat=repeat)
    whole = in_full(WAVE, play, marks_of(WAVE), 60.0)
    stretches, _ = played(ClipSource(WAVE, play))
    assert whole is not None and len(whole) == sum(map(len, stretches))
    once, all_rounds = (seen(posture_features_of(p), "wave")[0].count for p in (WAVE, whole))
    assert once and all_rounds == repeat * once


def test_a_repeated_motion_that_is_held_stops_in_its_last_round():
    stretches, ended = played(ClipSource(ARM, Say(text="raise", repeat=3, hold=True)))
    assert ended and [len(stretch) for stretch in stretches] == [len(ARM), len(ARM), find_hold(ARM) + 1]


def test_a_repeated_motion_that_is_finished_ends_with_its_round():
    score = ClipSource(WAVE, Say(text="wave", repeat=5))
    assert not score.next()[1]
    score.finish()
    assert score.next()[1]


def test_what_is_longer_than_one_looks_at_is_not_counted():
    marks = marks_of(WAVE)
    assert in_full(WAVE, Say(text="wave", repeat=1000), marks, 15.0) is None
    assert in_full(WAVE, Say(text="wave", loop=True), marks, 15.0) is None


def posture_features_of(p: PoseSequence):
    motion = p.motion()
    return posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)


def test_a_motion_without_loop_is_done_again_as_a_whole():
    p = WAVE[:40]
    stretches, ended = played(ClipSource(p, Say(text="x", loop=True), Marks(None, 20)), 5)
    assert not ended and [len(s) for s in stretches] == [40] * 5


def test_a_loop_has_no_end_until_it_is_finished():
    score = ClipSource(WAVE, Say(text="wave", loop=True))
    stretches, ended = played(score, 30)
    assert not ended and all(len(s) >= 16 for s in stretches)
    score.finish()
    last, is_last = score.next()
    assert is_last
    assert distance_deg(last[-1:], WAVE[-1:])[0] < 0.01
    assert steps_deg(joined([*stretches, last])).max() <= steps_deg(WAVE).max() * 1.3 + 1.0


def test_hold_ends_in_the_pose_that_says_most():
    hold = find_hold(ARM)
    assert 10 <= hold <= 20  # the arm is highest in the middle
    stretches, ended = played(ClipSource(ARM, Say(text="raise", hold=True)))
    assert ended and len(stretches[0]) == hold + 1
    assert distance_deg(standing(), stretches[0][-1:])[0] > 0.9 * distance_deg(standing(), ARM).max()


def test_options_change_every_stretch():
    plain, _ = played(ClipSource(WAVE, Say(text="w", repeat=2)))
    fast, _ = played(ClipSource(WAVE, Say(text="w", repeat=2, tempo=2.0, mirror=True, amplitude=0.5)))
    for a, b in zip(plain, fast, strict=True):
        assert len(b) == pytest.approx(len(a) / 2, abs=1)
    assert distance_deg(standing(), joined(fast)).max() == pytest.approx(
        0.5 * distance_deg(standing(), joined(plain)).max(), rel=0.05
    )


def test_marks_can_be_given():
    assert marks_of(WAVE) == Marks(find_loop(WAVE), find_hold(WAVE))


@pytest.mark.parametrize("style", STYLES)
def test_idle_movements_are_small_slow_continuous_and_never_end(style):
    score = IdleSource(style, seed=4)
    p = joined([score.next()[0] for _ in range(60)])
    away = distance_deg(standing(), p)
    assert away[0] < 0.5 and 1.0 < away.max() < 40.0
    assert steps_deg(p).max() * FPS < 25.0  # degrees a second
    score.finish()
    last, ended = score.next()
    assert ended and distance_deg(standing(), last[-1:])[0] < 0.01


@pytest.mark.parametrize("name", ["reference", "op3"])
def test_idle_movements_need_no_help_to_stay_within_the_robot(name):
    retargeter = Retargeter(load_robot(name))
    score = IdleSource("lively")
    state = None
    for _ in range(6):
        p, _ = score.next()
        path = retargeter.retarget(p.motion(), state, settle=False)
        assert path.report.interventions == 0


def test_looking_turns_the_head_and_nothing_else():
    p = looking(WAVE, 0.5, 0.2, np.ones(len(WAVE)))
    assert np.array_equal(p.bones, WAVE.bones)
    assert np.allclose(p.head_quat_wxyz, p.head_quat_wxyz[0])
