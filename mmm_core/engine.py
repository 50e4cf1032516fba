"""Text to motion: wires text encoder, scope, length, transformer, decoding, tokenizer and feature recovery."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mmm_core.checkpoint import MODEL_FILE, Model, file_hash, load_model, load_text_encoder
from mmm_core.errors import GenerationError
from mmm_core.features import recover
from mmm_core.motion import FPS, N_FEATURES, N_JOINTS, Motion
from mmm_core.sampling import SamplingSettings, empty_row, fill
from mmm_core.scope import ScopeVerdict
from mmm_core.text import MiniLm, TextStates
from mmm_core.tokens import FRAMES_PER_TOKEN, MAX_TOKENS, frames_for_seconds, pack_ids, tokens_for_frames

SHORTEST_S = 0.8


@dataclass(frozen=True)
class Generation:
    """A motion and how the text was taken.

    Attributes:
        motion: the motion; of length zero when rejected.
        understood: the nearest known command and its score.
        reason: why the text was degraded or rejected, else empty.
        timings_ms: milliseconds spent in each stage.
    """

    motion: Motion
    understood: str
    reason: str
    timings_ms: dict[str, float]

    @property
    def status(self) -> str:
        """accepted, degraded or rejected."""
        return self.motion.status

    @property
    def scope_score(self) -> float:
        """How near the text lies to what the model can do."""
        return self.motion.scope_score


class Engine:
    """The motion model, ready to be asked. Not for several threads at once."""

    def __init__(self, model: Model, encoder: MiniLm, checkpoint_hash: str, settings: SamplingSettings) -> None:
        self.model = model
        self.encoder = encoder
        self.checkpoint_hash = checkpoint_hash
        self.settings = settings

    @classmethod
    def load(
        cls, path: Path | None = None, *, threads: int | None = 1, settings: SamplingSettings | None = None
    ) -> Engine:
        """The engine with the checkpoint at `path` (the shipped one when None).

        `threads` sets torch's threads for the whole process; None leaves them as they are.

        Raises:
            CheckpointError: a file is missing or does not fit.
        """
        if threads is not None:
            torch.set_num_threads(threads)
        path = path or MODEL_FILE
        return cls(load_model(path), load_text_encoder(), file_hash(path), settings or SamplingSettings())

    def generate(self, text: str, *, seed: int = 0, seconds: float | None = None) -> Generation:
        """The motion for `text`; the same text, seed and seconds give the same motion.

        Args:
            text: a command in English.
            seed: any integer from 0 to 2^31 - 1.
            seconds: length of the motion, at most 9.8; None lets the model choose.

        Raises:
            GenerationError: seed or seconds out of range.
        """
        if not 0 <= seed < 2**31:
            raise GenerationError(f"seed {seed} was asked for", "0 to 2147483647")
        n_frames = None if seconds is None else frames_for_seconds(seconds, FPS)
        clock = _Clock()
        if not text.strip():
            return _rejected(text, seed, ScopeVerdict("rejected", 0.0, "", "the text is empty"), clock)
        with torch.inference_mode():
            states = self.encoder.encode([text])
            verdict = self.model.scope.judge(text, states.sentence[0])
            clock.lap("text")
            if verdict.status == "rejected":
                return _rejected(text, seed, verdict, clock)
            if n_frames is None:
                n_frames = self.predicted_frames(states)
            ids = self.decode_text(states, tokens_for_frames(n_frames), seed)
            clock.lap("decode")
            features = self.model.tokenizer.decode(ids)[0, :n_frames].numpy()
            recovered = recover(features)
            clock.lap("motion")
        motion = Motion(
            joints_m=recovered.joints_m.astype(np.float32),
            fps=FPS,
            head_quat_wxyz=recovered.head_quat_wxyz.astype(np.float32),
            forearm_twist_rad=recovered.forearm_twist_rad.astype(np.float32),
            features=features,
            tokens=pack_ids(ids[0].numpy(), self.model.tokenizer.config.n_codes),
            text=text,
            seed=seed,
            status=verdict.status,
            scope_score=verdict.score,
        )
        return Generation(motion, f"{verdict.nearest} ({verdict.score:.2f})", verdict.reason, clock.laps_ms)

    def predicted_frames(self, states: TextStates) -> int:
        """Number of frames the length predictor gives, whole tokens."""
        longest_s = MAX_TOKENS * FRAMES_PER_TOKEN / FPS
        seconds = min(longest_s, max(SHORTEST_S, self.model.length.seconds(states)[0]))
        return tokens_for_frames(round(seconds * FPS)) * FRAMES_PER_TOKEN

    def decode_text(self, states: TextStates, n_tokens: int, seed: int) -> Tensor:
        """(1, n_tokens, C) ids for a text."""
        transformer = self.model.transformer
        return fill(transformer, states, [empty_row(transformer, n_tokens)], [seed], self.settings)[0][None]


class _Clock:
    """Milliseconds between laps."""

    def __init__(self) -> None:
        self.laps_ms: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        now = time.perf_counter()
        self.laps_ms[name] = 1e3 * (now - self._last)
        self._last = now


def _rejected(text: str, seed: int, verdict: ScopeVerdict, clock: _Clock) -> Generation:
    motion = Motion(
        joints_m=np.zeros((0, N_JOINTS, 3), np.float32),
        fps=FPS,
        head_quat_wxyz=np.zeros((0, 4), np.float32),
        forearm_twist_rad=np.zeros((0, 2), np.float32),
        features=np.zeros((0, N_FEATURES), np.float32),
        tokens=np.zeros(0, np.int32),
        text=text,
        seed=seed,
        status="rejected",
        scope_score=verdict.score,
    )
    understood = f"{verdict.nearest} ({verdict.score:.2f})" if verdict.nearest else ""
    return Generation(motion, understood, verdict.reason, clock.laps_ms)
