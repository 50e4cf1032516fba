"""Text to motion: wires text encoder, scope, length, transformer, decoding, tokenizer and feature recovery."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Literal

import numpy as np
import torch
from torch import Tensor

from mmm_core.errors import CheckpointError, GenerationError
from mmm_core.generate.motion_generation import Making
from mmm_core.generate.result import Generation
from mmm_core.inference.checkpoint import MODEL_FILE, Model, file_hash, load_model, load_text_encoder
from mmm_core.inference.int8_linear import can_eight_bit, to_eight_bit
from mmm_core.inference.onednn_linear import fastest_precision, pack
from mmm_core.language.mirroring import canonical, mirror_words
from mmm_core.language.scope import ScopeVerdict, clauses_of, with_clauses
from mmm_core.model.clip import ClipText
from mmm_core.model.sampling import OFFICIAL_SAMPLING, OFFICIAL_UPPER_BODY, SamplingSettings
from mmm_core.model.text import TextEncoder, TextStates, without_pictures
from mmm_core.model.tokens import (
    FRAMES_PER_TOKEN,
    MAX_TOKENS,
    frames_for_seconds,
    pack_ids,
    tokens_for_frames,
    unpack_ids,
)
from mmm_core.motion.features import Root, mirror, recover, recover_from_positions
from mmm_core.motion.motion import FPS, Motion

Precision = Literal["fp32", "bf16", "int8"]
"""Of the matrix products. Any but fp32 is another model's choice of tokens now and then."""
SHORTEST_S = 0.8
MOST_CANDIDATES = 64
_TYPICAL = (
    ("wave with your right hand", 9.6), ("raise both arms, then clap twice", 3.2), ("bow deeply", 2.0),
    ("turn your head to the left", 1.2), ("play the guitar", 3.2), ("point up with your left hand", 1.6),
)  # fmt: skip
"""Texts and seconds that show eight-bit layers the range of their inputs."""


class Engine:
    """The motion model, ready to be asked. Not for several threads at once."""

    def __init__(
        self,
        model: Model,
        encoder: TextEncoder,
        checkpoint_hash: str,
        settings: SamplingSettings,
        precision: Precision = "fp32",
    ) -> None:
        self.model = model
        self.encoder = encoder
        self.checkpoint_hash = checkpoint_hash
        self.settings = settings
        self.precision: Precision = precision

    @classmethod
    def load(
        cls,
        path: Path | None = None,
        *,
        threads: int | None = 1,
        settings: SamplingSettings | None = None,
        precision: Precision | Literal["auto"] | None = None,
    ) -> Engine:
        """The engine with the checkpoint at `path` (the shipped one when None).

        Args:
            path: checkpoint.
            threads: torch's threads for the whole process; None leaves them as they are.
            settings: how the model is asked; None takes what suits the checkpoint.
            precision: of the transformer; None takes int8 for a model of this repository on a processor that multiplies
                eight-bit integers, else fp32; "auto" times fp32 and bf16. The text encoder is fp32 beside int8.

        Raises:
            CheckpointError: a file is missing or does not fit.
            GenerationError: the precision cannot be had here.
        """
        if threads is not None:
            torch.set_num_threads(threads)
        path = path or MODEL_FILE
        model = load_model(path)
        imported = OFFICIAL_UPPER_BODY if model.tokenizer.part_names == ("upper", "lower") else OFFICIAL_SAMPLING
        plain = SamplingSettings() if model.rest_pose == "mmmd" else imported
        encoder = model.text or load_text_encoder(n_left_out=model.transformer.config.n_words)
        if getattr(encoder.config, "embedding", encoder.config.width) != model.transformer.config.text_dim:
            expected = "one with CLIP's text tower in it: import it with --clip and --vocabulary"
            raise CheckpointError(path, "text", "no text encoder of its width", expected)
        config = model.transformer.config
        can_int8 = can_eight_bit() and config.n_out == config.n_codebooks  # one that only edits cannot show its inputs
        if precision is None:
            precision = "int8" if model.rest_pose == "mmmd" and can_int8 else "fp32"
        chosen = fastest_precision() if precision == "auto" else precision
        if chosen == "int8" and not can_int8:
            needed = "int8 needs a processor and PyTorch with VNNI, and a model of whole motions"
            raise GenerationError("precision int8 was asked for", f"fp32 or bf16: {needed}")
        words = "bf16" if chosen == "bf16" else "fp32"
        pack(encoder, words)
        engine = cls(model, encoder, file_hash(path), settings or plain, chosen)
        if chosen == "int8":
            pack(model.transformer.word_layers, words)  # as the text encoder: their inputs have outliers
            to_eight_bit(model.transformer, engine.run_typical)
        else:
            pack(model.transformer, chosen)
        return engine

    def run_typical(self) -> None:
        """Generate what is typical, and forget it."""
        for i, (text, seconds) in enumerate(_TYPICAL):
            self.generate(text, seed=i, seconds=seconds)

    def generate(
        self, text: str, *, seed: int = 0, seconds: float | None = None, candidates: int | None = None
    ) -> Generation:
        """The motion for `text`; the same text, seed, seconds and candidates give the same motion.

        Args:
            text: a command in English.
            seed: any integer from 0 to 2^31 - 1.
            seconds: length of the motion, at most 9.8; None lets the model choose.
            candidates: motions generated at once, of which the model's likeliest is kept; with two or more, a number of
                repetitions that the text names is met more often (`mmm_core.generate.repetition_editing`). None means two
                where the text names a number and no length is given, else one.

        Raises:
            GenerationError: seed, seconds or candidates out of range, or no seconds for a model without lengths.
        """
        return self.begin(text, seed=seed, seconds=seconds, candidates=candidates).finished()

    def begin(self, text: str, *, seed: int = 0, seconds: float | None = None, candidates: int | None = None) -> Making:
        """The same motion, not made yet: first a draft of it can be had, then itself. Arguments as in `generate`.

        Raises:
            GenerationError: as `generate`.
        """
        check_seed(seed)
        if candidates is not None and not 1 <= candidates <= MOST_CANDIDATES:
            raise GenerationError(f"{candidates} candidates were asked for", f"1 to {MOST_CANDIDATES}")
        n_frames = None if seconds is None else frames_for_seconds(seconds, FPS)
        return Making(self, text, seed, n_frames, candidates)

    def understand(self, text: str) -> tuple[TextStates, ScopeVerdict]:
        """States of a text, and how far it lies from what the model can do."""
        return self.understand_all([text])[0]

    def understand_fresh(self, text: str) -> tuple[TextStates, ScopeVerdict, bool]:
        """The same for a motion that is made from nothing, and whether that motion is to be mirrored.

        The model reads only one of a text and its mirror image (`mmm_core.language.mirroring.canonical`), so that the
        mirrored text gives the mirrored motion. Where a motion continues another, the other decides on left and right.
        """
        read, is_mirrored = canonical(text) if self.model.rest_pose == "mmmd" else (text, False)
        states, verdict = self.understand(read)
        if is_mirrored:
            words = {key: mirror_words(getattr(verdict, key)) for key in ("nearest", "reason", "kept")}
            verdict = replace(verdict, **words)
        return states, verdict, is_mirrored

    def understand_all(self, texts: list[str]) -> list[tuple[TextStates, ScopeVerdict]]:
        """The same of several texts, read together; of a text that is kept in part the states are those of that part."""
        states = self.read(texts)
        scope = self.model.scope
        if scope is None:
            return [(states.row(i), _without_scope(text)) for i, text in enumerate(texts)]
        verdicts = [scope.judge(text, sentence) for text, sentence in zip(texts, states.sentence, strict=True)]
        clauses = [clauses_of(text) if scope.classifier is not None else [] for text in texts]
        read = [clause for several in clauses for clause in several]
        if read:
            parts = map(scope.judge, read, self.read(read).sentence)
            verdicts = [
                with_clauses(whole, several, list(islice(parts, len(several))))
                for whole, several in zip(verdicts, clauses, strict=True)
            ]
        return [
            (self.read([verdict.kept]) if verdict.kept else states.row(i), verdict)
            for i, verdict in enumerate(verdicts)
        ]

    def read(self, texts: list[str]) -> TextStates:
        """States of texts as they stand, in scope or not; of one without words, those of a full stop.

        CLIP knows emoji and gets them; the compact encoder does not (`without_pictures`).
        """
        if isinstance(self.encoder, ClipText):
            return self.encoder.encode(texts)
        return self.encoder.encode([without_pictures(text) or "." for text in texts])

    def predicted_frames(self, states: TextStates) -> int:
        """Number of frames the length predictor gives for the first text, whole tokens.

        Raises:
            GenerationError: the model has no length predictor.
        """
        if self.model.length is None:
            raise GenerationError("no length was asked for", "seconds: this model was not trained to choose a length")
        longest_s = MAX_TOKENS * FRAMES_PER_TOKEN / FPS
        seconds = min(longest_s, max(SHORTEST_S, self.model.length.seconds(states)[0]))
        return tokens_for_frames(round(seconds * FPS)) * FRAMES_PER_TOKEN

    def motion(
        self,
        ids: Tensor,
        text: str,
        seed: int,
        verdict: ScopeVerdict,
        n_frames: int | None = None,
        *,
        is_mirrored: bool = False,
    ) -> Motion:
        """The motion of a row of ids (L, C), cut to `n_frames`; mirrored, its ids are those that its features encode to."""
        with torch.inference_mode():
            whole = self.model.tokenizer.decode(ids[None])[0]
            if is_mirrored:
                whole = torch.from_numpy(mirror(whole.numpy()))
                ids = self.model.tokenizer.encode(whole[None])[0]
            features = whole[:n_frames].numpy()
        return self.motion_of_features(features, ids, text, seed, verdict)

    def motion_of_features(
        self, features: np.ndarray, ids: Tensor, text: str, seed: int, verdict: ScopeVerdict, start: Root | None = None
    ) -> Motion:
        """The record of decoded features (T, 263) and their ids; `start` is where the first frame stands."""
        recovered = (recover if self.model.rest_pose == "mmmd" else recover_from_positions)(features, start)
        return Motion(
            joints_m=recovered.joints_m.astype(np.float32),
            fps=FPS,
            head_quat_wxyz=recovered.head_quat_wxyz.astype(np.float32),
            forearm_twist_rad=recovered.forearm_twist_rad.astype(np.float32),
            features=features,
            tokens=pack_ids(ids.numpy(), self.model.tokenizer.config.n_codes),
            text=text,
            seed=seed,
            status=verdict.status,
            scope_score=verdict.score,
        )

    def ids_of(self, motion: Motion) -> Tensor:
        """(L, C) ids of a motion: its own if they fit its frames, else those its features are encoded to.

        Raises:
            GenerationError: the motion has neither, or another frame rate or other features than the model.
        """
        tokenizer = self.model.tokenizer
        if motion.fps != FPS or motion.features.shape[1] != len(tokenizer.mean):
            asked = f"a motion of {motion.fps:g} fps and {motion.features.shape[1]} features was given"
            raise GenerationError(asked, f"{FPS:g} fps and {len(tokenizer.mean)} features, as this model's")
        if len(motion.tokens) and len(motion.tokens) == tokens_for_frames(len(motion.features)):
            return torch.from_numpy(unpack_ids(motion.tokens, tokenizer.config.n_codes, tokenizer.n_codebooks))
        n_frames = len(motion.features) // FRAMES_PER_TOKEN * FRAMES_PER_TOKEN
        if not n_frames or not motion.features.any():
            raise GenerationError("a motion without features or tokens was given", "one written by `mmmd generate`")
        with torch.inference_mode():
            return tokenizer.encode(torch.from_numpy(motion.features[None, :n_frames]))[0]


def check_seed(seed: int) -> None:
    """Raises GenerationError for a seed outside 0 to 2^31 - 1."""
    if not 0 <= seed < 2**31:
        raise GenerationError(f"seed {seed} was asked for", "0 to 2147483647")


def _without_scope(text: str) -> ScopeVerdict:
    """An imported model takes every text but an empty one."""
    return (
        ScopeVerdict("accepted", 1.0, "", "")
        if text.strip()
        else ScopeVerdict("rejected", 0.0, "", "the text is empty")
    )
