"""Reads HumanML3D and KIT-ML folders in their published layout.

    FOLDER/new_joint_vecs/ID.npy   (T, 263) or (T, 251) features
    FOLDER/new_joints/ID.npy       (T, 22, 3) or (T, 21, 3) joints, where features are missing
    FOLDER/texts/ID.txt            caption#token/POS token/POS ...#from_s#to_s, one a line; 0#0 is the whole motion
    FOLDER/train.txt val.txt test.txt   ids of a split
    FOLDER/Mean.npy Std.npy        statistics of the features

Guo et al. 2022 (CVPR, "Generating Diverse and Natural 3D Human Motions from Text") sec. 4. A motion is used when it has
40 (KIT-ML: 24) to 199 frames; a caption with a span cuts its own motion out.

A HumanML3D folder made by its own notebooks lists a few motions that the notebooks cannot make (009707 and 011059 have one
frame) or that hold NaN (007975), each also mirrored. So up to one in a hundred motions of a split may be missing or not finite:
they are left out and named in the log. With more of them the folder counts as broken.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mmm_core.errors import TrainingDataError
from mmm_core.imports.kit import KIT, KIT_FPS, kit_facing_yaw_rad
from mmm_core.motion.features import HUMANML3D, FeatureLayout, features_from_rotations
from mmm_core.motion.humanml3d_features import humanml3d_features_from_joints
from mmm_core.motion.motion import FPS

log = logging.getLogger(__name__)
SHORTEST_FRAMES, SHORTEST_KIT_FRAMES, LONGEST_FRAMES = 40, 24, 200
"""Frames of the shortest motion of HumanML3D and of KIT-ML, and length from which on motions are left out, as in the published
protocol."""
UNUSABLE_SHARE = 0.01
"""Share of a split's motions that may be missing or not finite."""
_MISSING, _NOT_FINITE = "no motion", "NaN or infinite values"
Split = Literal["train", "val", "test"]


@dataclass(frozen=True)
class Caption:
    """A sentence, its words with their part of speech where the file has them, and its span."""

    text: str
    tokens: tuple[str, ...]
    start_s: float
    end_s: float | None


@dataclass(frozen=True)
class Example:
    """A motion with sentences that describe all of it."""

    name: str
    features: NDArray[np.float32]  # (T, F)
    captions: tuple[Caption, ...]


@dataclass(frozen=True)
class MotionFolder:
    """An opened folder: its layout, frame rate and statistics; `examples` reads a split."""

    path: Path
    layout: FeatureLayout
    fps: float
    mean: NDArray[np.float32]
    std: NDArray[np.float32]

    @property
    def n_features(self) -> int:
        return self.layout.n_features

    @property
    def shortest_frames(self) -> int:
        """Frames that a motion must have at least."""
        return SHORTEST_FRAMES if self.layout is HUMANML3D else SHORTEST_KIT_FRAMES

    def ids(self, split: Split) -> list[str]:
        """Names in a split.

        Raises:
            TrainingDataError: the list is missing or empty.
        """
        path = self.path / f"{split}.txt"
        try:
            names = path.read_text("utf-8").split()
        except OSError:
            raise TrainingDataError(path, "", "no such file", "one motion's name a line") from None
        if not names:
            raise TrainingDataError(path, "", "no names", "one motion's name a line")
        return names

    def examples(self, split: Split) -> Iterator[Example]:
        """Motions of a split with the captions that describe all of them; a caption with a span gives an example of its own.

        Raises:
            TrainingDataError: a listed file is broken, more than one in a hundred is missing or not finite, or a span lies
                outside its motion.
        """
        names, unusable = self.ids(split), list[str]()
        for name in names:
            try:
                features = self.features(name)
            except TrainingDataError as error:
                unusable.append(name)
                if error.found not in (_MISSING, _NOT_FINITE) or len(unusable) > UNUSABLE_SHARE * len(names):
                    raise
                continue
            if not self.shortest_frames <= len(features) < LONGEST_FRAMES:
                continue
            whole: list[Caption] = []
            for number, caption in enumerate(read_captions(self.path / "texts" / f"{name}.txt")):
                if caption.end_s is None:
                    whole.append(caption)
                    continue
                start, end = int(caption.start_s * self.fps), int(caption.end_s * self.fps)
                if start >= len(features):
                    found = f"{caption.start_s} to {caption.end_s} s"
                    raise TrainingDataError(self.path / "texts" / f"{name}.txt", f"line {number + 1}", found,
                                            f"a span within the motion's {len(features) / self.fps:.2f} s")  # fmt: skip
                part = features[start:end]
                if self.shortest_frames <= len(part) < LONGEST_FRAMES:
                    yield Example(f"{name}_{number}", part, (caption,))
            if whole:
                yield Example(name, features, tuple(whole))
        if unusable:
            log.warning("%s: %d of %d motions of '%s' are missing or not finite and are left out: %s",
                        self.path, len(unusable), len(names), split, " ".join(unusable))  # fmt: skip

    def features(self, name: str) -> NDArray[np.float32]:
        """(T, F) features of a motion: as stored, else made from its joints.

        Raises:
            TrainingDataError: neither file exists, or the file is broken.
        """
        path = self.path / "new_joint_vecs" / f"{name}.npy"
        if path.is_file():
            features = _array(path, (None, self.n_features))
            return features.astype(np.float32)
        path = self.path / "new_joints" / f"{name}.npy"
        if not path.is_file():
            raise TrainingDataError(self.path, name, _MISSING, f"new_joint_vecs/{name}.npy or new_joints/{name}.npy")
        joints = _array(path, (None, self.layout.n_joints, 3)).astype(np.float64)
        if self.layout is HUMANML3D:
            return humanml3d_features_from_joints(joints)
        identity = np.broadcast_to(np.eye(3), (len(joints), self.layout.n_joints - 1, 3, 3))
        return features_from_rotations(joints, kit_facing_yaw_rad(joints), identity, KIT)


def open_folder(path: Path) -> MotionFolder:
    """Open a HumanML3D or KIT-ML folder: find its layout and read its statistics.

    Raises:
        TrainingDataError: the folder, its motions or its statistics are missing, or the statistics have another size than
            the motions.
    """
    if not path.is_dir():
        raise TrainingDataError(path, "", "no such folder", "a HumanML3D or KIT-ML folder")
    first = next((p for kind in ("new_joint_vecs", "new_joints") for p in sorted((path / kind).glob("*.npy"))), None)
    if first is None:
        raise TrainingDataError(path, "new_joint_vecs", "no .npy file", "the folder of a HumanML3D or KIT-ML data set")
    width = _array(first).shape[1]
    layouts = {263: HUMANML3D, 22: HUMANML3D, 251: KIT, 21: KIT}
    if width not in layouts:
        raise TrainingDataError(first, "", f"{width} columns", "263 features or 22 joints (HumanML3D), 251 or 21 (KIT)")
    layout = layouts[width]
    mean, std = (_array(path / name, (layout.n_features,)) for name in ("Mean.npy", "Std.npy"))
    if not (std > 0).all():
        raise TrainingDataError(path / "Std.npy", f"[{int(np.argmin(std))}]", f"{std.min()}", "a spread above 0")
    fps = FPS if layout is HUMANML3D else KIT_FPS
    return MotionFolder(path, layout, fps, mean.astype(np.float32), std.astype(np.float32))


def read_captions(path: Path) -> list[Caption]:
    """Sentences of a text file.

    Raises:
        TrainingDataError: the file is missing, not UTF-8 or without a sentence, or a line lacks one of its four fields or has
            a bad span.
    """
    try:
        lines = path.read_text("utf-8").splitlines()
    except FileNotFoundError:
        raise TrainingDataError(path, "", "no such file", "the captions of a listed motion") from None
    except (OSError, UnicodeDecodeError) as error:
        raise TrainingDataError(path, "", f"not readable ({error})", "UTF-8 text") from None
    captions: list[Caption] = []
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        fields = line.strip().split("#")
        try:
            text, words, start, end = fields
            start_s, end_s = (0.0 if t.strip() == "nan" else float(t) for t in (start, end))
        except ValueError:
            raise TrainingDataError(path, f"line {number}", repr(line[:80]), "caption#words#from_s#to_s") from None
        whole = start_s == 0.0 and end_s == 0.0
        if not text.strip() or not (whole or 0 <= start_s < end_s):
            raise TrainingDataError(path, f"line {number}", repr(line[:80]), "a sentence and 0#0 or from < to")
        captions.append(Caption(text.strip(), tuple(words.split()), start_s, None if whole else end_s))
    if not captions:
        raise TrainingDataError(path, "", "no sentence", "at least one line")
    return captions


def _array(path: Path, shape: tuple[int | None, ...] | None = None) -> NDArray[np.floating]:
    """A finite array of `shape` (None: any length)."""
    try:
        array = np.load(path, allow_pickle=False)
    except FileNotFoundError:
        raise TrainingDataError(path, "", "no such file", "a .npy array") from None
    except (OSError, ValueError, EOFError) as error:
        raise TrainingDataError(
            path, "", f"not a readable .npy ({error})", "an array without pickled objects"
        ) from None
    fits = shape is None or (
        array.ndim == len(shape) and all(want in (None, have) for want, have in zip(shape, array.shape, strict=True))
    )
    if not fits or (shape is None and array.ndim < 2) or not len(array):
        raise TrainingDataError(path, "", f"shape {array.shape}", str(shape or "(T, ...)").replace("None", "T"))
    if not np.isfinite(array).all():
        raise TrainingDataError(path, "", _NOT_FINITE, "finite numbers")
    return array
