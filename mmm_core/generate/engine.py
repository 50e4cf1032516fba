"""Text to motion: `Engine.load().generate("wave")`."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import torch

from mmm_core.errors import CheckpointError, GenerationError
from mmm_core.generate.motion_generation import MotionGeneration
from mmm_core.generate.motion_model import MotionModel, check_seed
from mmm_core.generate.result import GenerationResult
from mmm_core.generate.sentence_reader import SentenceReader
from mmm_core.inference.checkpoint import MODEL_FILE, Model, file_hash, load_model, load_text_encoder
from mmm_core.inference.int8_linear import convert_to_int8, int8_is_supported
from mmm_core.inference.onednn_linear import can_pack, can_pack_bf16, fastest_precision, has_bf16_matrix_units, pack
from mmm_core.inference.people_weights import PeopleWeights, load_people
from mmm_core.model.sampling import OFFICIAL_SAMPLING, OFFICIAL_UPPER_BODY, SamplingSettings
from mmm_core.model.text import MiniLm, TextEncoder
from mmm_core.model.tokens import frames_for_seconds
from mmm_core.motion.motion import FPS

Precision = Literal["fp32", "bf16", "int8"]
"""Number format of the matrix products. A format other than fp32 now and then changes the choice of a token."""
MOST_CANDIDATES = 64
"""Motions that one generation makes at most, to keep the likeliest."""
_CALIBRATION_TEXTS = (
    ("wave with your right hand", 9.6), ("exactly: raise both arms; clap twice", 3.2),
    ("exactly: bow politely (1.4 times as large)", 2.0), ("turn your head to the left", 1.2),
    ("play the guitar", 3.2), ("point up with your left hand", 1.6),
)  # fmt: skip
"""Texts and seconds whose generation shows eight-bit layers the range of their inputs; no network of the reader reads them."""


class Engine(MotionModel):
    """The motion model with its fast layers in place; one thread at a time may use it."""

    def __init__(
        self,
        model: Model,
        encoder: TextEncoder,
        checkpoint_hash: str,
        settings: SamplingSettings,
        precision: Precision = "fp32",
        reader: SentenceReader | None = None,
        people: PeopleWeights | None = None,
    ) -> None:
        super().__init__(model, encoder, checkpoint_hash, settings, reader, people)
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
            settings: how tokens are sampled; None takes the settings that suit the checkpoint.
            precision: of the transformer; None takes int8 for a model of this repository on a processor that multiplies
                eight-bit integers, else fp32; "auto" times fp32 and bf16. With int8 the text encoder is bf16 on a
                processor with matrix units for it, else fp32.

        Raises:
            CheckpointError: a file is missing or does not fit.
            GenerationError: this machine or this model does not support the precision.
        """
        if threads is not None:
            torch.set_num_threads(threads)
        path = path or MODEL_FILE
        model = load_model(path)
        imported = OFFICIAL_UPPER_BODY if model.tokenizer.part_names == ("upper", "lower") else OFFICIAL_SAMPLING
        plain = SamplingSettings() if model.is_ours else imported
        encoder = model.text or load_text_encoder(n_left_out=model.transformer.config.n_words)
        if getattr(encoder.config, "embedding", encoder.config.width) != model.transformer.config.text_dim:
            expected = "one with CLIP's text tower in it: import it with --clip and --vocabulary"
            raise CheckpointError(path, "text", "no text encoder of its width", expected)
        config = model.transformer.config
        shows_inputs = (
            config.n_out == config.n_codebooks
        )  # a model that only edits cannot generate the calibration texts
        can_int8 = int8_is_supported() and shows_inputs
        if precision is None:
            precision = "int8" if model.is_ours and can_int8 else "fp32"
        chosen = fastest_precision() if precision == "auto" else precision
        if chosen == "int8" and not can_int8:
            needed = "int8 needs a processor and PyTorch with VNNI, and a model of whole motions"
            raise GenerationError("precision int8 was asked for", f"fp32 or bf16: {needed}")
        if chosen == "bf16" and can_pack() and not can_pack_bf16():
            raise GenerationError(
                "precision bf16 was asked for", "fp32: bf16 needs a processor with AVX-512 or the like"
            )
        words = "bf16" if chosen == "bf16" or (chosen == "int8" and has_bf16_matrix_units()) else "fp32"
        pack(encoder, words)
        reader = None
        if model.is_ours and model.scope is not None and isinstance(encoder, MiniLm):
            reader = SentenceReader.load(encoder, words)
        checkpoint_hash = file_hash(path)
        people = load_people(model.transformer, model.tokenizer, path, checkpoint_hash)
        if people is not None:
            pack(people.transformer, words)
        engine = cls(model, encoder, checkpoint_hash, settings or plain, chosen, reader, people)
        if chosen == "int8":
            pack(
                model.transformer.word_layers, words
            )  # not in int8: like the text encoder's, their inputs have outliers
            convert_to_int8(model.transformer, engine.calibrate)
        else:
            pack(model.transformer, chosen)
        return engine

    def calibrate(self) -> None:
        """Generate motions for typical texts and discard them: eight-bit layers measure their inputs meanwhile."""
        for i, (text, seconds) in enumerate(_CALIBRATION_TEXTS):
            self.generate(text, seed=i, seconds=seconds)

    def generate(
        self, text: str, *, seed: int = 0, seconds: float | None = None, candidates: int = 1
    ) -> GenerationResult:
        """The motion for `text`; the same text, seed, seconds and candidates give the same motion.

        Args:
            text: a command in English.
            seed: any integer from 0 to 2^31 - 1.
            seconds: length of the motion, at most 9.8; None lets the model choose.
            candidates: motions generated at once; the likeliest one is kept.

        Raises:
            GenerationError: seed, seconds or candidates out of range, or no seconds for a model without lengths.
        """
        return self.begin(text, seed=seed, seconds=seconds, candidates=candidates).result()

    def begin(self, text: str, *, seed: int = 0, seconds: float | None = None, candidates: int = 1) -> MotionGeneration:
        """The generation that `generate` runs, not yet run; it can also give a preview before the motion.

        Raises:
            GenerationError: as `generate`.
        """
        check_seed(seed)
        if not 1 <= candidates <= MOST_CANDIDATES:
            raise GenerationError(f"{candidates} candidates were asked for", f"1 to {MOST_CANDIDATES}")
        n_frames = None if seconds is None else frames_for_seconds(seconds, FPS)
        return MotionGeneration(self, text, seed, n_frames, candidates)
