"""Recipes whose training takes a second, and shortcuts for the parts that take longer than the training."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import pytest
import torch

from daemon.cli import main
from mmm_core.corpus.plain_commands import known_commands
from mmm_core.model.text import MiniLm, TextEncoder
from mmm_core.training import caption_training, samples, scope_training
from mmm_core.training.batches import CaptionStates

SCHEDULE = "steps = {steps}\nlearning_rate = 1e-3\nwarmup_steps = 2\nsave_every = 3\n"
SMALL = """
seed = 3
[data]
synthesised = {synthesised}
licence = "made for a test"
[tokenizer]
layout = "{layout}"
n_codes = 16
code_dim = 8
width = 16
batch = 8
window_frames = 40
[tokenizer.schedule]
{schedule}
[tokenizer.decoder]
{schedule}
[transformer]
width = 32
n_heads = 2
n_cross = 1
n_self = 1
dropout = 0.0
tokens_per_batch = 96
[transformer.corruption]
part_share = 0.5
[transformer.schedule]
{schedule}
[length]
{schedule}
[evaluator]
{schedule}
[scope]
sentences = 100
outside = 100
"""


@functools.cache
def index_commands() -> list[str]:
    """The known commands in the index: reading all that ship have takes longer than the training here."""
    return sorted(known_commands(1))[::20]


_VECTORS: dict[str, torch.Tensor] = {}
"""Vectors of the scope's sentences: most are the same in every training here, and reading them takes longer than it."""
_STATES: dict[tuple[int, tuple[str, ...]], CaptionStates] = {}
"""Caption states by the layers that the encoder leaves out: runs of one seed have the same captions."""


@contextmanager
def quick_parts() -> Iterator[None]:
    """Cached vectors and caption states, few known commands, small pictures."""
    vectors_of, states_of = scope_training.sentence_vectors, CaptionStates.encode

    def sentence_vectors(texts: list[str], encoder: TextEncoder) -> torch.Tensor:
        if new := [text for text in dict.fromkeys(texts) if text not in _VECTORS]:
            _VECTORS.update(zip(new, vectors_of(new, encoder), strict=True))
        return torch.stack([_VECTORS[text] for text in texts])

    def encode(captions: Sequence[str], encoder: MiniLm) -> CaptionStates:
        key = encoder.n_left_out, tuple(captions)
        if key not in _STATES:
            _STATES[key] = states_of(captions, encoder)
        return _STATES[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scope_training, "sentence_vectors", sentence_vectors)
        patch.setattr(CaptionStates, "encode", encode)
        patch.setattr(samples, "INSTANTS", 2)  # most of the time of a picture is its axes
        patch.setattr(scope_training, "known_commands", lambda *_: set(index_commands()))
        patch.setattr(scope_training, "OUTSIDE", scope_training.OUTSIDE[::8])
        patch.setattr(caption_training, "N_SENTENCES", 40)
        yield


class Finished(NamedTuple):
    """A recipe's file, and the model that its run gave."""

    recipe: Path
    model: Path


def small(path: Path, layout: str = "parts", steps: int = 8, synthesised: int = 12) -> Path:
    schedule = SCHEDULE.format(steps=steps)
    path.write_text(SMALL.format(layout=layout, schedule=schedule, synthesised=synthesised))
    return path


def finish(folder: Path) -> Finished:
    """Write a small recipe into a folder and train it, with `quick_parts`."""
    recipe = small(folder / "first.toml")
    with quick_parts():
        assert main(["train", "--config", str(recipe), "--run", str(folder / "first"), "--sample-every", "0"]) == 0
    return Finished(recipe, folder / "first" / "model.safetensors")
