"""The evaluator: maps motions and texts to vectors that are close when they belong together.

Guo et al. 2022 (CVPR, "Generating Diverse and Natural 3D Human Motions from Text") sec. 6.1: convolutions make movement
snippets of four frames, which a bidirectional GRU reads; another one reads words. Attributes carry the published names, so
that a user's copy of the published checkpoint (`finest.tar`) can be loaded. Our evaluator has this architecture at a smaller
size, and reads MiniLM's word states instead of GloVe and parts of speech.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal

import torch
from torch import Tensor, nn
from torch.nn.utils.rnn import pack_padded_sequence

from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import fill_module, load_tensors, save_tensors
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS

N_CONTACTS = 4
"""Number of foot contacts, the last features of a row, which the evaluator does not read."""
KIND = "mmmd-evaluator"
"""Kind of file that holds an evaluator of ours."""


@dataclass(frozen=True)
class EvaluatorConfig:
    """Sizes; the defaults are the published ones for HumanML3D.

    `rest_pose` is the definition of the features in the training data (see `checkpoint.Model`).
    """

    n_features: int = 263
    movement: int = 512
    text_hidden: int = 512
    motion_hidden: int = 1024
    embedding: int = 512
    word: int = 300
    part_of_speech: int = 15
    rest_pose: Literal["mmmd", "humanml3d"] = "humanml3d"


OURS = EvaluatorConfig(
    movement=128, text_hidden=128, motion_hidden=128, embedding=64, word=384, part_of_speech=0, rest_pose="mmmd"
)
"""Sizes of the evaluator that this repository trains: small, since it learns from a few hundred clips of people."""


class MovementEncoder(nn.Module):
    """(B, T, F - 4) frames -> (B, T / 4, movement) snippets."""

    def __init__(self, config: EvaluatorConfig) -> None:
        super().__init__()
        W = config.movement
        self.main = nn.Sequential(
            nn.Conv1d(config.n_features - N_CONTACTS, W, 4, 2, 1), nn.Dropout(0.2), nn.LeakyReLU(0.2),
            nn.Conv1d(W, W, 4, 2, 1), nn.Dropout(0.2), nn.LeakyReLU(0.2),
        )  # fmt: skip
        self.out_net = nn.Linear(W, W)

    def forward(self, x: Tensor) -> Tensor:
        return self.out_net(self.main(x.transpose(1, 2)).transpose(1, 2))


class _BiGru(nn.Module):
    """A bidirectional GRU whose last states in both directions pass two layers."""

    def __init__(self, n_in: int, hidden: int, middle: int, n_out: int) -> None:
        super().__init__()
        self.input_emb = nn.Linear(n_in, hidden)
        self.gru = nn.GRU(hidden, hidden, batch_first=True, bidirectional=True)
        self.output_net = nn.Sequential(
            nn.Linear(2 * hidden, middle), nn.LayerNorm(middle), nn.LeakyReLU(0.2), nn.Linear(middle, n_out)
        )
        self.hidden = nn.Parameter(torch.randn(2, 1, hidden))

    def read(self, x: Tensor, lengths: Tensor) -> Tensor:
        """(B, N, n_in) with (B,) lengths -> (B, n_out)."""
        packed = pack_padded_sequence(self.input_emb(x), lengths.cpu(), batch_first=True, enforce_sorted=False)
        _, last = self.gru(packed, self.hidden.repeat(1, len(x), 1))
        return self.output_net(torch.cat([last[0], last[1]], -1))


class TextReader(_BiGru):
    """(B, N, word) word vectors and (B, N, 15) parts of speech -> (B, embedding)."""

    def __init__(self, config: EvaluatorConfig) -> None:
        super().__init__(config.word, config.text_hidden, config.text_hidden, config.embedding)
        self.pos_emb = nn.Linear(config.part_of_speech, config.word) if config.part_of_speech else None

    def forward(self, words: Tensor, parts_of_speech: Tensor | None, lengths: Tensor) -> Tensor:
        if self.pos_emb is not None and parts_of_speech is not None:
            words = words + self.pos_emb(parts_of_speech)
        return self.read(words, lengths)


class MotionReader(_BiGru):
    """(B, N, movement) snippets -> (B, embedding)."""

    def __init__(self, config: EvaluatorConfig) -> None:
        super().__init__(config.movement, config.motion_hidden, config.motion_hidden, config.embedding)

    def forward(self, snippets: Tensor, lengths: Tensor) -> Tensor:
        return self.read(snippets, lengths)


class Evaluator(nn.Module):
    """The three networks, with the mean and standard deviation of their training features."""

    mean: Tensor
    std: Tensor

    def __init__(self, config: EvaluatorConfig) -> None:
        super().__init__()
        self.config = config
        self.movement_encoder = MovementEncoder(config)
        self.text_encoder = TextReader(config)
        self.motion_encoder = MotionReader(config)
        self.register_buffer("mean", torch.zeros(config.n_features))
        self.register_buffer("std", torch.ones(config.n_features))

    def motions(self, features: Sequence[Tensor]) -> Tensor:
        """(B, embedding) vectors of B motions (T_i, F), not normalised; a motion's vector does not depend on its neighbours.

        After normalising, zeros fill the batch to `MAX_TOKENS`, or to the longest motion if that is longer. The convolution at a
        motion's end is sensitive to padding (through its bias), and the published extractor was trained with this width.
        """
        lengths = torch.tensor([len(f) // FRAMES_PER_TOKEN for f in features])
        width = max(MAX_TOKENS, int(lengths.max())) * FRAMES_PER_TOKEN
        batch = self.mean.new_zeros(len(features), width, self.config.n_features)
        for row, one in zip(batch, features, strict=True):
            n = len(one) // FRAMES_PER_TOKEN * FRAMES_PER_TOKEN
            row[:n] = (one[:n].to(self.mean) - self.mean) / self.std
        snippets = self.movement_encoder(batch[..., :-N_CONTACTS])
        return self.motion_encoder(snippets, lengths)

    def texts(self, words: Tensor, parts_of_speech: Tensor | None, lengths: Tensor) -> Tensor:
        """(B, embedding) vectors of B texts."""
        return self.text_encoder(words, parts_of_speech, lengths)


def save_evaluator(path: Path, evaluator: Evaluator, provenance: dict[str, object]) -> None:
    """Write an evaluator of ours to a file."""
    tensors = {k: t.half() if k not in ("mean", "std") else t for k, t in evaluator.state_dict().items()}
    save_tensors(path, tensors, KIND, {"config": asdict(evaluator.config), "provenance": provenance})


def load_evaluator(path: Path) -> tuple[Evaluator, dict[str, object]]:
    """An evaluator of ours, and its provenance.

    Raises:
        CheckpointError: the file is missing or of another kind, or a tensor does not fit.
    """
    tensors, metadata = load_tensors(path, KIND)
    evaluator = Evaluator(EvaluatorConfig(**metadata["config"]))
    fill_module(evaluator, tensors, path)
    return evaluator, metadata["provenance"]


def load_published(path: Path, mean: Tensor, std: Tensor, n_features: int = 263) -> Evaluator:
    """The published evaluator (`text_mot_match/model/finest.tar`) with its statistics (`meta/mean.npy`, `std.npy`).

    Raises:
        CheckpointError: the file is not the published one, or the statistics have another size.
    """
    parts = ("movement_encoder", "text_encoder", "motion_encoder")
    try:
        content = torch.load(path, map_location="cpu", weights_only=True)
    except Exception as error:
        first = str(error).split("\n", 1)[0]
        raise CheckpointError(path, "", f"not readable as tensors ({first})", "the published finest.tar") from error
    for part in parts:
        if not isinstance(content, dict) or not isinstance(content.get(part), Mapping):
            raise CheckpointError(path, part, "missing, or no dict of tensors", ", ".join(parts))
    for name, statistic in (("mean", mean), ("std", std)):
        if statistic.shape != (n_features,):
            raise CheckpointError(path, name, f"shape {tuple(statistic.shape)}", f"({n_features},)")
    evaluator = Evaluator(EvaluatorConfig(n_features=n_features))
    tensors = {f"{p}.{k}": t for p in parts for k, t in content[p].items()}
    fill_module(evaluator, {**tensors, "mean": mean.float(), "std": std.float()}, path)
    return evaluator
