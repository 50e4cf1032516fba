"""The table of docs/daemon.md, "Where motions meet": what a prefix of `say` changes, by its length.

    python -m docs.tools.prefix_table --seeds 2

Each probe of the development set takes over from an unrelated motion at a random frame, without a prefix and with prefixes of
0.2 to 1.6 s of that motion. The first 0.4 s grow out of it in every case, as they do in the daemon. Printed for each length are the
probes' shares of the motion after the takeover, the distance of its first frame from the frame before, and the mean peak jerk as
`mmmd bench seams` measures it.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

from daemon.bench.motions import recordings_folder
from daemon.bench.seams import WINDOW, peak_jerk, real_jerk
from daemon.playback.chunk_maker import FADE_FRAMES, blended_from
from daemon.playback.sources.source_factory import PREFIX_FRAMES
from daemon.poses.pose_sequence import PoseSequence, distance_deg, joined, posture_of
from mmm_core.corpus.heldout import PROBES
from mmm_core.evaluation.probes import evaluate
from mmm_core.generate.continuation import continue_motion
from mmm_core.generate.engine import Engine
from mmm_core.generate.keyframes import features_of
from mmm_core.motion.motion import Motion

LENGTHS_S = (0.0, 0.2, 0.4, 0.8, 1.6)
COLUMNS = ("side", "direction", "count", "count_exact", "pose")


Running = Callable[[str, int], tuple[PoseSequence, int]]
"""(sentence, seed) -> the motion that runs before it, and the frame at which that is cut off."""


class Takeovers:
    """Motions that take over from another one, at prefixes of one length.

    Attributes:
        jerks_m_s3: peak jerk of each takeover.
        apart_deg: mean angle of the bones between the last frame before each takeover and the first frame of its motion.
    """

    def __init__(self, engine: Engine, running: Running, prefix_s: float) -> None:
        self._engine, self._running, self._prefix_s = engine, running, prefix_s
        self.jerks_m_s3: list[float] = []
        self.apart_deg: list[float] = []

    def motion(self, text: str, seed: int) -> Motion:
        """The motion for `text`, as it is played after the running one; empty where the text is refused."""
        running, k = self._running(text, seed)
        if self._prefix_s:
            shown = running.at(np.arange(k - PREFIX_FRAMES, k)).motion()
            before = replace(shown, features=features_of(shown).numpy())
            made = continue_motion(self._engine, before, self._prefix_s, text, seed=seed).motion
        else:
            made = self._engine.generate(text, seed=seed).motion
        if not len(made.joints_m):
            return made
        clip = posture_of(made)
        self.apart_deg.append(float(distance_deg(clip[:1], running.at(np.array([k - 1])))[0]))
        after = blended_from(running.at(k + np.arange(FADE_FRAMES)), clip)
        self.jerks_m_s3.append(peak_jerk(joined([running[:k], after]), k))
        return after.motion()


def unrelated(engine: Engine) -> Running:
    """The motion of another probe for each probe and seed, the same whenever it is asked for."""
    places = {probe.text: i for i, probe in enumerate(PROBES)}

    @cache
    def running(text: str, seed: int) -> tuple[PoseSequence, int]:
        rng = np.random.default_rng((places[text], seed))
        while True:
            other = PROBES[int(rng.integers(len(PROBES)))]
            motion = engine.generate(other.text, seed=seed).motion
            if other.text != text and len(motion.joints_m) > 2 * WINDOW:
                clip = posture_of(motion)
                return clip, int(rng.integers(WINDOW // 2, len(clip) - WINDOW // 2))

    return running


def main() -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=1, help="takeovers of each probe")
    n_seeds = parser.parse_args().seeds
    folder = recordings_folder()
    engine = Engine.load(threads=1)
    real_m_s3 = real_jerk(folder, np.random.default_rng(0)) if folder is not None else np.nan
    out, running = sys.stdout.write, unrelated(engine)
    out(f"checkpoint {engine.checkpoint_hash[:12]}, {n_seeds} takeovers of each probe\n")
    out(f"| prefix | peak jerk against real motion | first frame apart, degrees | {' | '.join(COLUMNS)} |\n")
    for length_s in LENGTHS_S:
        takeovers = Takeovers(engine, running, length_s)
        found = evaluate(takeovers.motion, range(n_seeds), probes=PROBES)
        shares = " | ".join(f"{100 * found[c]:.0f} % of {found['n_each'][c]}" for c in COLUMNS)
        jerk = np.mean(takeovers.jerks_m_s3) / real_m_s3
        out(f"| {length_s:g} s | {jerk:.2f} | {np.mean(takeovers.apart_deg):.0f} | {shares} |\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
