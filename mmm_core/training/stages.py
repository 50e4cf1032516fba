"""Trains a model stage by stage, from data to checkpoint, for `mmmd train`.

corpus -> tokenizer -> ids and caption states -> length predictor, transformer -> checkpoint. Each stage keeps its state in
the run's folder; a finished stage is only loaded, so a caller can request any stage by itself.
"""

from __future__ import annotations

import logging
import os
from dataclasses import replace
from functools import cached_property
from pathlib import Path

import numpy as np
import torch
from torch import nn

from mmm_core import distributed
from mmm_core.corpus.stream import make_corpus
from mmm_core.errors import CheckpointError, TrainingDataError
from mmm_core.evaluation.extractors import OURS, Evaluator, save_evaluator
from mmm_core.evaluation.reconstruction import tokenizer_figures
from mmm_core.imports.clip_weights import read_clip
from mmm_core.imports.datasets import MotionFolder, open_folder
from mmm_core.inference.checkpoint import Model, load_model, load_text_encoder, save_model
from mmm_core.model.clip import ClipText
from mmm_core.model.length import LengthClassifier
from mmm_core.model.text import MiniLm, MiniLmConfig, TextEncoder
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.transformer import MotionTransformer
from mmm_core.model.vqvae import VqVae
from mmm_core.motion.features import RestPose
from mmm_core.motion.motion import FPS, N_FEATURES
from mmm_core.training.batches import CORPUS, CaptionStates, Clip, TokenCorpus, encode_clips, load_clips, save_clips
from mmm_core.training.caption_training import check_changes
from mmm_core.training.cuts import cuts_of
from mmm_core.training.evaluator_training import train_evaluator
from mmm_core.training.fresh import WEIGHTS_FILE, FreshClips, make_round, read_weights
from mmm_core.training.provenance import hours_of, provenance
from mmm_core.training.recipe import Recipe
from mmm_core.training.refining import refined
from mmm_core.training.run import Run
from mmm_core.training.samples import SAMPLE_TEXTS, draw_reconstruction, draw_samples
from mmm_core.training.scope_training import build_scope, own_captions
from mmm_core.training.start import read_start, start_path
from mmm_core.training.tokenizer_training import change_for_people, train_tokenizer, tune_decoder
from mmm_core.training.transformer_training import train_length, train_transformer

log = logging.getLogger(__name__)


class Stages:
    """The stages of one recipe in one run; each property is computed or loaded when it is first read."""

    def __init__(self, recipe: Recipe, run: Run, data: Path | None = None) -> None:
        """Recipe and run; `data` replaces the recipe's data folder."""
        folder = data or (Path(recipe.data.folder) if recipe.data.folder else None)
        self.recipe, self.run, self.data = recipe, run, folder
        self.is_dataset = folder is not None and not (folder / "clips.jsonl").is_file()

    @cached_property
    def folder(self) -> MotionFolder | None:
        """The HumanML3D or KIT-ML folder; None for other data."""
        return open_folder(self.data) if self.is_dataset and self.data else None

    @cached_property
    def clips(self) -> list[Clip]:
        """The training motions, which are made once and then read from the run's folder.

        Raises:
            TrainingDataError: there are no clips with captions.
        """
        path = self.run.folder / CORPUS
        if not path.is_file() and distributed.rank() == 0:
            n, seed, made = self.recipe.data.cuts, self.recipe.seed, enumerate(self._made())
            cuts = (cuts_of(c, n if c.is_real else 1, np.random.default_rng((seed, i))) for i, c in made)
            clips = [c for some in cuts for c in some if len(c.features) and c.captions]
            if not clips:
                raise TrainingDataError(self.data or Path(), "data", "no clip", "data.folder, data.synthesised or both")
            self.run.folder.mkdir(parents=True, exist_ok=True)
            save_clips(path, clips)
        distributed.wait()
        clips = load_clips(path)
        log.info(
            "%d clips, %.1f h, %d from people", len(clips), hours_of(clips, self._fps), sum(c.is_real for c in clips)
        )
        return clips

    def _made(self) -> list[Clip]:
        synthesised, seed = self.recipe.data.synthesised, self.recipe.seed
        if self.folder is not None and synthesised and self.folder.n_features != N_FEATURES:
            found = f"{synthesised} with {self.folder.n_features} features in {self.data}"
            raise TrainingDataError(self.data or Path(), "data.synthesised", found, "0: gestures have 263")
        made = make_corpus(synthesised, self.data if self.folder is None else None, seed, os.cpu_count() or 1)
        clips = [Clip(c.features, list(c.captions), c.is_real) for c in made]
        if self.folder is not None:
            clips += [Clip(e.features, [c.text for c in e.captions], True) for e in self.folder.examples("train")]
        return clips

    @cached_property
    def text(self) -> TextEncoder:
        """The text encoder of the captions.

        Raises:
            TrainingDataError: the recipe trains more of the encoder's layers than it has.
        """
        how = self.recipe.text
        most = MiniLmConfig().n_layers if how.encoder == "minilm" else 0
        if not 0 <= how.tuned_layers <= most:
            raise TrainingDataError(
                self.run.folder, "text.tuned_layers", f"{how.tuned_layers}", f"0 to {most} of {how.encoder}"
            )
        if how.encoder == "minilm":
            return load_text_encoder(n_left_out=how.tuned_layers)
        return read_clip(Path(how.clip), Path(how.vocabulary))

    @cached_property
    def start(self) -> Model | None:
        """The model that the recipe starts from, or None; its codebooks are refined if the recipe has more codes."""
        how = self.recipe.tokenizer
        model = read_start(self.recipe, self.run.folder, self._rest_pose)
        if model is None or model.tokenizer.config.n_codes == how.n_codes:
            return model
        path = self.run.folder / "start_refined.safetensors"
        if not path.is_file():
            fresh, made = self.recipe.data.fresh, list[Clip]()
            if fresh.clips:
                made = make_round(fresh, self.recipe.seed, 0, read_weights(self._fresh_folder / WEIGHTS_FILE))
            grown = refined(model, [*self.clips, *made], how.n_codes, how.schedule, self.run, how.real_share)
            if distributed.rank() == 0:
                save_model(path, grown)
            distributed.wait()
        return load_model(path)

    @cached_property
    def tokenizer(self) -> Tokenizer | VqVae:
        """The trained tokenizer, before any further training of its decoder; with changes if the recipe has a rank for it."""
        start = self.start  # read first, so that a start that does not fit is refused before hours of work
        how, clips = self.recipe.tokenizer, self.clips
        if how.rank:
            check_changes(self.recipe, start, clips, self.run.folder)
        width = clips[0].features.shape[1]
        if start is not None:
            if len(start.tokenizer.mean) != width:
                found = f"a tokenizer of {len(start.tokenizer.mean)} features"
                raise CheckpointError(start_path(self.recipe), "tokenizer", found, f"{width}, as the data have")
            if how.rank and isinstance(start.tokenizer, Tokenizer):
                change_for_people(
                    start.tokenizer, clips, how.rank, how.schedule, self.run, how.batch, how.window_frames
                )
            return start.tokenizer
        shown = torch.from_numpy(max(clips, key=lambda c: len(c.features)).features)

        def sample(module: nn.Module, path: Path) -> None:
            assert isinstance(module, (Tokenizer, VqVae))
            draw_reconstruction(path, module, shown, self.folder is None)

        run = replace(self.run, sampler=sample)
        statistics = None
        if self.folder is not None and not self.recipe.data.synthesised:
            statistics = torch.from_numpy(self.folder.mean), torch.from_numpy(self.folder.std)
        return train_tokenizer(clips, how.config(width), how.schedule, run, statistics=statistics, batch=how.batch,
                               window_frames=how.window_frames, real_share=how.real_share,
                               plain_steps=how.plain_steps)  # fmt: skip

    @cached_property
    def corpus(self) -> TokenCorpus:
        """Ids and caption states of the clips; caption states are kept in the run's folder.

        Raises:
            TrainingDataError: the tokenizer does not pass the recipe's gate.
        """
        self._check_tokenizer()
        captions, rows = self._captions
        is_real = np.array([c.is_real for c in self.clips])
        below = self.recipe.text.tuned_layers
        states = self._caption_states(captions, self.text, f"captions_below_{below}.pt" if below else "captions.pt")
        return TokenCorpus(encode_clips(self.clips, self.tokenizer), rows, states, is_real)

    def _check_tokenizer(self) -> None:
        """Raises TrainingDataError if the recipe has a gate that the tokenizer does not pass."""
        if self.recipe.tokenizer.gate and isinstance(self.tokenizer, Tokenizer) and distributed.rank() == 0:
            if faults := tokenizer_figures(self.tokenizer)["faults"]:
                path = self.run.folder / "tokenizer.pt" if self.start is None else start_path(self.recipe)
                raise TrainingDataError(path, "tokenizer.gate", "; ".join(faults), "more steps, or gate = false")

    @property
    def _captions(self) -> tuple[list[str], list[list[int]]]:
        """Every caption once, and for each clip the rows of its captions."""
        captions = sorted({c for clip in self.clips for c in clip.captions})
        row = {caption: i for i, caption in enumerate(captions)}
        return captions, [[row[c] for c in clip.captions] for clip in self.clips]

    def _caption_states(self, captions: list[str], encoder: TextEncoder, name: str) -> CaptionStates:
        path = self.run.folder / name
        if not path.is_file() and distributed.rank() == 0:
            CaptionStates.encode(captions, encoder).save(path)
        distributed.wait()
        return CaptionStates.load(path)

    @cached_property
    def length(self) -> LengthClassifier:
        """The trained length predictor."""
        start = None
        if self.start is not None and self.start.transformer.config.n_words == self.recipe.text.tuned_layers:
            start = self.start.length  # otherwise it was trained on other word states
        if not isinstance(start, LengthClassifier):
            start = None
        corpus = self.corpus
        if self.fresh is not None:
            corpus = self.fresh.corpus(max(0, self.recipe.transformer.schedule.steps - 1))
        return train_length(corpus, self.recipe.length, self.run, start)

    @cached_property
    def fresh(self) -> FreshClips | None:
        """Gesture clips made while the transformer trains, beside those of `corpus`; None if the recipe makes none.

        Raises:
            TrainingDataError: the recipe trains layers of the text encoder, so that caption states cannot be kept.
        """
        how = self.recipe.data.fresh
        if not how.clips:
            return None
        if self.recipe.text.tuned_layers:
            found = f"{self.recipe.text.tuned_layers}, with data.fresh"
            raise TrainingDataError(self.run.folder, "text.tuned_layers", found, "0 where clips are made anew")
        return FreshClips(how, self._fresh_folder, self.tokenizer, self.text, self.recipe.seed, self.corpus)

    @property
    def _fresh_folder(self) -> Path:
        return self.run.folder / "fresh"

    @cached_property
    def transformer(self) -> MotionTransformer:
        """The trained transformer; with changes if the recipe has a rank.

        Raises:
            TrainingDataError: the recipe has a rank, but no start or no clip of a person.
        """
        how, tokenizer = self.recipe.transformer, self.tokenizer
        if how.rank:
            check_changes(self.recipe, self.start, self.clips, self.run.folder)
        tuned = self.recipe.text.tuned_layers
        config = how.config(tokenizer.config, tokenizer.n_codebooks, self.corpus.captions.words.shape[1], tuned)
        texts = self.text.encode(list(SAMPLE_TEXTS))

        def sample(module: nn.Module, path: Path) -> None:
            assert isinstance(module, MotionTransformer)
            draw_samples(path, module, texts, self.corpus.ids, tokenizer, self.folder is None)

        run = replace(self.run, sampler=sample)
        start = None if self.start is None else self.start.transformer
        return train_transformer(
            self.fresh or self.corpus, tokenizer, config, how.schedule, run, how.corruption, how.tokens_per_batch, start,
            self.text.layers if isinstance(self.text, MiniLm) else None, self.recipe.text.tuned_rate, how.rank, how.motion_loss,
        )  # fmt: skip

    @cached_property
    def evaluator(self) -> Evaluator:
        """The trained evaluator, which is also written to the run's folder.

        The evaluator always reads MiniLM's states, so that models with other text encoders can be compared.
        """
        captions, rows = self._captions
        shared = self.recipe.text.encoder == "minilm" and not self.recipe.text.tuned_layers
        encoder, name = (self.text, "captions.pt") if shared else (load_text_encoder(), "captions_minilm.pt")
        states = self._caption_states(captions, encoder, name)
        width, words = self.clips[0].features.shape[1], states.words.shape[1]
        config = replace(OURS, n_features=width, word=words, rest_pose=self._rest_pose)
        evaluator = train_evaluator(self.clips, states, rows, self.recipe.evaluator, self.run, config)
        if distributed.rank() == 0:
            save_evaluator(self.run.folder / "evaluator.safetensors", evaluator, self.provenance())
        return evaluator

    def model(self) -> Model:
        """The model of all stages, ready to be saved."""
        transformer, length, tokenizer, how = self.transformer, self.length, self.tokenizer, self.recipe.tokenizer
        if isinstance(tokenizer, Tokenizer) and how.decoder.steps and (self.start is None or how.tune_start):
            newest = [] if self.fresh is None else self.fresh.clips(max(0, self.recipe.transformer.schedule.steps - 1))
            tune_decoder(tokenizer, [*self.clips, *newest], how.decoder, self.run)
        text = self.text if isinstance(self.text, ClipText) else None
        has_scope = self.recipe.data.has_gestures and text is None
        scope = build_scope(self.text, self.recipe.scope, own_captions(self.recipe, self.clips)) if has_scope else None
        return Model(tokenizer, transformer, length, scope, self.provenance(), text, self._rest_pose)

    def provenance(self) -> dict[str, object]:
        """Provenance of a checkpoint of this run."""
        start = None if self.start is None else (start_path(self.recipe), self.start)
        return provenance(self.recipe, self.run.folder, self.data, self.clips, self._fps, start)

    @property
    def _rest_pose(self) -> RestPose:
        """Definition of the data's features, as `Model.rest_pose`."""
        return "mmmd" if self.folder is None else "humanml3d"

    @property
    def _fps(self) -> float:
        return FPS if self.folder is None else self.folder.fps
