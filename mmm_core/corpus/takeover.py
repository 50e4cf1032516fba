"""Makes gestures that begin in the middle of another one, as when a new text takes over a moving robot.

The first tokens show the gesture that was running; then every channel passes over to the captioned gesture within `LEAD_S`, while
that gesture already runs on its own beat. The captioned gesture is deterministic (`mmm_core.corpus.deterministic`). A model that
is trained to predict the rest, given the first tokens, learns to continue from any pose.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from mmm_core.corpus.beat import BEAT_S
from mmm_core.corpus.body import perform
from mmm_core.corpus.deterministic import synthesise_deterministic
from mmm_core.corpus.score import Score, minimum_jerk
from mmm_core.corpus.synthesis import ClipSpec, SynthClip, draw_gesture, score_of
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.motion.features import features_from_joints
from mmm_core.motion.motion import FPS
from mmm_core.motion.skeleton import Array

SEEN_TOKENS = (2, 8)
"""Least and greatest number of tokens of the running gesture (0.4 to 1.6 s), which are lengths that `prefix_s` may have."""
LEAD_S = 0.6
"""Seconds until every channel has left the running gesture."""


class Takeover(Score):
    """A score that plays `before` until `cut_s`, then passes over to `after`, which begins at `cut_s`."""

    def __init__(self, before: Score, after: Score, cut_s: float) -> None:
        super().__init__(after.rng, after.rest, beat_s=after.beat_s)
        self._before, self._after, self._cut_s = before, after, cut_s

    def sample(self, channel: str, times_s: Array, fore_lag_s: float = 0.0) -> Array:
        """(T, D) values of `channel`, as `Score.sample`."""
        old = self._before.sample(channel, times_s, fore_lag_s)
        new = self._after.sample(channel, np.maximum(times_s - self._cut_s, 0.0), fore_lag_s)
        share = minimum_jerk(np.clip((times_s - self._cut_s) / LEAD_S, 0, 1))[:, None]
        return (1 - share) * old + share * new


def synthesise_takeover(rng: np.random.Generator, weights: Mapping[str, float] | None = None) -> tuple[SynthClip, int]:
    """A clip that begins in the middle of another gesture, with captions of the new one, and the number of tokens of the other.

    Args:
        rng: source of all randomness.
        weights: weights by which families are drawn.
    """
    token_s = FRAMES_PER_TOKEN / FPS
    while True:
        new, running = synthesise_deterministic(rng, weights), replace(draw_gesture(rng), style="", hold_s=0.0)
        if any(gesture.style for gesture in new.spec.gestures):
            continue  # a style holds from a clip's first frame to its last
        after = score_of(new.spec, rng, BEAT_S, deterministic=True)
        before = score_of(ClipSpec((running,)), rng, BEAT_S)
        least = SEEN_TOKENS[0] * token_s
        cut = int(rng.integers(SEEN_TOKENS[0], max(int((before.time_s - least) / token_s), SEEN_TOKENS[0]) + 1))
        n_seen = int(min(rng.integers(SEEN_TOKENS[0], SEEN_TOKENS[1] + 1), cut))
        n_new = int(np.ceil(after.time_s / token_s - 1e-6))
        if n_seen + n_new > MAX_TOKENS:
            continue
        body = perform(Takeover(before, after, cut * token_s), (cut + n_new) * FRAMES_PER_TOKEN)
        first = (cut - n_seen) * FRAMES_PER_TOKEN
        body = replace(body, joints_m=body.joints_m[first:], head_R_world=body.head_R_world[first:],
                       forearm_twist_rad=body.forearm_twist_rad[first:])  # fmt: skip
        features = features_from_joints(body.joints_m, body.head_R_world, body.forearm_twist_rad)
        return SynthClip(features, new.captions, new.spec, body), n_seen
