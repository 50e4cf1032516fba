"""Reads motions of people and their captions, in the features of the measured model.

Rotation channels depend on the rest directions of their source (`checkpoint.Model.rest_pose`). Features of a HumanML3D folder
are converted to ours through joint positions; the opposite conversion would need the body model of that data set.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mmm_core.corpus.cmu import read_clips
from mmm_core.errors import EvaluationError, TrainingDataError
from mmm_core.generate.engine import Engine
from mmm_core.imports.datasets import Caption, Split, open_folder
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.motion.features import features_from_joints, joints_from_positions


@dataclass(frozen=True)
class Pair:
    """A motion of a person, cut to whole tokens, and one of its captions.

    Attributes:
        features: (T, F).
        text: the caption.
        words: "word/POS" tokens of the caption; empty if the data set has none.
        motion: number of the motion, which all pairs of the motion share.
    """

    features: NDArray[np.float32]
    text: str
    words: tuple[str, ...]
    motion: int


def read_pairs(folder: Path, splits: Sequence[Split]) -> list[Pair]:
    """Pairs of a data folder of either kind, one for each caption, in the folder's own features.

    Raises:
        TrainingDataError: there is no pair, or the folder cannot be read.
    """
    pairs: list[Pair] = []
    for number, (features, captions) in enumerate(_motions(folder, splits)):
        whole = features[: min(len(features) // FRAMES_PER_TOKEN, MAX_TOKENS) * FRAMES_PER_TOKEN]
        pairs += [Pair(whole, c.text, c.tokens, number) for c in captions]
    if not pairs:
        held = (
            '"split": "test" in lines of clips.jsonl'
            if folder_rest_pose(folder) == "mmmd"
            else "a folder with this split"
        )
        raise TrainingDataError(
            folder, ", ".join(splits), "no pair of motion and caption", f"{held}, or another --split"
        )
    return pairs


def pairs_for(engines: Sequence[Engine], folder: Path, splits: Sequence[Split]) -> list[Pair]:
    """Pairs of a folder in the features of `engines`.

    Raises:
        TrainingDataError: as `read_pairs`.
        EvaluationError: the models differ in their features, or the folder's features cannot be converted to them.
    """
    forms = {(engine.model.rest_pose, n_features(engine)) for engine in engines}
    if len(forms) > 1:
        found = " and ".join(f"{n} features ({pose})" for pose, n in sorted(forms))
        raise EvaluationError(f"models with {found}", "models of one kind in a run")
    (wanted_pose, wanted), pairs = forms.pop(), read_pairs(folder, splits)
    found, pose = pairs[0].features.shape[1], folder_rest_pose(folder)
    if found != wanted:
        raise EvaluationError(f"{folder} has {found} features, the model {wanted}", "a model trained on such a folder")
    if pose == wanted_pose:
        return pairs
    if pose == "mmmd":
        raise EvaluationError(f"{folder} has this repository's rest directions, the model HumanML3D's",
                              "a HumanML3D folder, or a model of `mmmd train` on this one")  # fmt: skip
    moved = {p.motion: to_our_rest_pose(p.features) for p in {p.motion: p for p in pairs}.values()}
    return [Pair(moved[p.motion], p.text, p.words, p.motion) for p in pairs]


def folder_rest_pose(folder: Path) -> str:
    """Definition of a folder's features, as `checkpoint.Model.rest_pose`."""
    return "mmmd" if (folder / "clips.jsonl").is_file() else "humanml3d"


def n_features(engine: Engine) -> int:
    """Values in a frame of the engine's features."""
    return len(engine.model.tokenizer.mean)


def to_our_rest_pose(features: NDArray[np.float32]) -> NDArray[np.float32]:
    """HumanML3D's (T, 263) features -> ours, through joint positions, so that bones have no twist."""
    return features_from_joints(joints_from_positions(features))


def _motions(folder: Path, splits: Sequence[Split]) -> Iterator[tuple[NDArray[np.float32], tuple[Caption, ...]]]:
    if (folder / "clips.jsonl").is_file():
        for split in splits:
            for features, captions in read_clips(folder, split):
                yield features, tuple(Caption(text, (), 0.0, None) for text in captions)
    else:
        opened = open_folder(folder)
        for split in splits:
            for example in opened.examples(split):
                yield example.features, example.captions
