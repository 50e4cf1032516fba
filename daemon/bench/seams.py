"""Smoothness where motions meet: jerk of the human motion against real motion, velocity steps of the joints, closure of loops."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daemon.bench.daemon_rig import percentile
from daemon.bench.motions import recordings_folder
from daemon.bench.report import context
from daemon.bench.texts import draw_texts
from daemon.errors import CommandError
from daemon.playback.chunk_maker import FADE_FRAMES, blended_from
from daemon.playback.sources.preview_source import without_stillness
from daemon.playback.sources.source_factory import PREFIX_FRAMES
from daemon.poses.cycles import closed, find_loop
from daemon.poses.idle import IdleSource
from daemon.poses.pose_sequence import PoseSequence, distance_deg, joined, posture_of, standing
from mmm_core.corpus.cmu import read_clips
from mmm_core.motion.features import recover
from mmm_core.motion.motion import FPS, Motion
from retarget.path.paths import JointState
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot

if TYPE_CHECKING:
    from mmm_core.generate.engine import Engine

Array = NDArray[np.float64]

WINDOW = 20
"""Frames (one second) around a seam, and of a window of real motion."""
PREFIX_S = 0.4
LATEST_GO_OVER = 10
"""Frames of the draft, half a second, within which the motion itself takes the draft's place."""
UPPER = (12, 15, 16, 17, 18, 19, 20, 21)
_METHOD = (
    "peak jerk: largest third difference of position times 20^3, m/s3, over neck, head, shoulders, elbows, wrists against the"
    " pelvis on the common body, in one second around the seam at 20 fps; mean over seams divided by the mean over one-second"
    " windows of held-out CMU motion (the livelier half); prompts cut in at a random moment (also with a prefix of 0.4 s), out"
    " of idle movements, loops, and motions that take their draft's place in its first half second; velocity step: change of the"
    " goal's velocity at the seam from one bus period to the next"
    " beyond what the path itself changes in a period, as a share of the joint's limit; closure: angle between the frame a"
    " loop ends in and the one before its beginning"
)


def bench_seams(n: int = 60, seed: int = 0, robot: str = "reference") -> dict[str, Any]:
    """`peak_jerk_ratio` (the worst kind of seam), `velocity_step_share`, `loop_closure_deg`, and figures of each kind of seam."""
    from mmm_core.generate.engine import Engine

    folder = recordings_folder()
    if folder is None:
        raise CommandError(
            "bench seams: it needs the recordings of docs/DATA.md, in $MMMD_SHARED/data or in ../shared/data"
        )
    rng = np.random.default_rng(seed)
    engine = Engine.load(threads=1)
    motions = [engine.generate(t, seed=seed + i).motion for i, t in enumerate(draw_texts(2 * n, seed))]
    motions = [m for m in motions if len(m.joints_m) > 2 * WINDOW]
    clips = [posture_of(m) for m in motions]
    real = real_jerk(folder, rng)
    prompt, steps = _prompt_seams(clips, rng, Retargeter(load_robot(robot)))
    prefixed = _prefix_seams(engine, motions, np.random.default_rng(seed))
    idle = [_idle_seam(p, rng) for p in clips[:n]]
    loops = [(p, loop) for p in clips if (loop := find_loop(p)) is not None]
    rounds = [peak_jerk(joined([closed(p, loop)] * 3), loop[1] - loop[0]) for p, loop in loops]
    closure = [_closure_deg(p, loop) for p, loop in loops]
    kinds = {
        "prompt_to_prompt": prompt, "prompt_with_prefix": prefixed, "idle_to_prompt": idle, "loop": rounds,
        "draft_to_motion": _draft_seams(engine, motions[:n], np.random.default_rng(seed)),
    }  # fmt: skip
    ratios = {kind: round(float(np.mean(values)) / real, 3) for kind, values in kinds.items()}
    return {
        "peak_jerk_ratio": max(ratios.values()),
        "ratio_of": ratios,
        "real_peak_jerk_m_s3": round(real, 1),
        "velocity_step_share": percentile(steps, 100),
        "loop_closure_deg": percentile(closure, 100),
        "n": {kind: len(values) for kind, values in kinds.items()},
        "robot": robot,
        **context(seed, _METHOD),
    }


def _prompt_seams(
    clips: list[PoseSequence], rng: np.random.Generator, retargeter: Retargeter
) -> tuple[list[float], list[float]]:
    """Peak jerk where one text takes over from another, and the velocity steps of the joints there."""
    jerk: list[float] = []
    steps: list[float] = []
    rate_hz = retargeter.robot.bus.rate_hz
    limit = retargeter.robot.velocity_limit_rad_s
    for a, b in zip(clips[::2], clips[1::2], strict=False):
        k = int(rng.integers(WINDOW // 2, len(a) - WINDOW // 2))
        after = blended_from(a.at(k + np.arange(FADE_FRAMES)), without_stillness(b))
        jerk.append(peak_jerk(joined([a[:k], after]), k))
        first = retargeter.retarget(a)
        q = first.at_rate(rate_hz)
        f = min(len(q) - 2, round(k / FPS * rate_hz))
        t_s = np.array([(f + 1) / rate_hz])
        second = retargeter.retarget(after, JointState(q[f], first.velocity_at(t_s)[0])).at_rate(rate_hz)
        v = np.diff(np.concatenate([q[f - 2 : f + 1], second[:3]]), axis=0) * rate_hz  # two steps before, three after
        bend = np.abs(np.diff(v, axis=0))
        steps.append(float((np.maximum(0, bend[1] - np.maximum(bend[0], bend[2])) / limit).max()))
    return jerk, steps


def _prefix_seams(engine: Engine, motions: list[Motion], rng: np.random.Generator) -> list[float]:
    """Peak jerk where the second text of each pair continues the first one's motion, as `say` with a prefix does."""
    from mmm_core.generate.continuation import continue_motion
    from mmm_core.generate.keyframes import features_of

    jerk: list[float] = []
    for a, b in zip(motions[::2], motions[1::2], strict=False):
        whole = posture_of(a)
        k = int(rng.integers(WINDOW // 2, len(whole) - WINDOW // 2))
        shown = whole.at(np.arange(k - PREFIX_FRAMES, k)).motion()
        before = replace(shown, features=features_of(shown).numpy())
        after = posture_of(continue_motion(engine, before, PREFIX_S, b.text, seed=b.seed).motion)
        after = blended_from(whole.at(k + np.arange(FADE_FRAMES)), after)
        jerk.append(peak_jerk(joined([whole[:k], after]), k))
    return jerk


def _draft_seams(engine: Engine, motions: list[Motion], rng: np.random.Generator) -> list[float]:
    """Peak jerk where a motion takes the place of its draft."""
    jerk: list[float] = []
    for motion in motions:
        made = engine.begin(motion.text, seed=motion.seed).preview()
        if made is None:
            continue
        draft, whole = posture_of(made.motion), posture_of(motion)
        k = int(rng.integers(1, LATEST_GO_OVER))
        after = blended_from(draft.at(k + np.arange(FADE_FRAMES)), whole[k:])
        jerk.append(peak_jerk(joined([draft[:k], after]), k))
    return jerk


def _idle_seam(p: PoseSequence, rng: np.random.Generator) -> float:
    """Peak jerk where a text takes over from idle movements."""
    score = IdleSource("lively", int(rng.integers(1000)))
    idle = joined([score.next()[0] for _ in range(4)])
    k = int(rng.integers(WINDOW, len(idle) - FADE_FRAMES))
    after = blended_from(idle.at(k + np.arange(FADE_FRAMES)), without_stillness(p))
    return peak_jerk(joined([idle[:k], after]), k)


def _closure_deg(p: PoseSequence, loop: tuple[int, int]) -> float:
    """Degrees between the loop's last frame and the frame before its first."""
    return float(distance_deg(closed(p, loop)[-1:], p.at(np.array([loop[0] - 1])))[0])


def peak_jerk(p: PoseSequence, at: int) -> float:
    """Largest jerk within half a second of frame `at`, in m/s3."""
    joints = _on_common_body(p).joints_m[:, UPPER]
    around = joints[max(0, at - WINDOW // 2) : at + WINDOW // 2]
    return float(np.linalg.norm(np.diff(around, n=3, axis=0), axis=-1).max()) * FPS**3


def _on_common_body(p: PoseSequence) -> PoseSequence:
    return replace(p, lengths_m=standing().lengths_m)


def real_jerk(folder: Any, rng: np.random.Generator) -> float:
    """Mean peak jerk of one-second windows of held-out real motion, over the half of the windows with more jerk."""
    peaks: list[float] = []
    for features, _ in read_clips(folder, "test"):
        recovered = recover(features)
        p = _posture_of_joints(recovered)
        if len(p) > WINDOW + 4:
            at = int(rng.integers(WINDOW // 2, len(p) - WINDOW // 2))
            peaks.append(peak_jerk(p, at))
        if len(peaks) >= 600:
            break
    return float(np.mean(np.sort(peaks)[len(peaks) // 2 :]))


def _posture_of_joints(recovered: Any) -> PoseSequence:
    from mmm_core.motion.motion import N_FEATURES, Motion

    T = len(recovered.joints_m)
    motion = Motion(
        recovered.joints_m.astype(np.float32), FPS, recovered.head_quat_wxyz.astype(np.float32),
        np.zeros((T, 2), np.float32), np.zeros((T, N_FEATURES), np.float32), np.zeros(0, np.int64), "", 0, "accepted", 1.0,
    )  # fmt: skip
    return posture_of(motion)
