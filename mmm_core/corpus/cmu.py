"""Reads real motion: recordings whose terms allow any use (docs/DATA.md), cut into clips by `clips.jsonl` beside them."""

from __future__ import annotations

import json
import logging
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mmm_core.errors import TrainingDataError
from mmm_core.imports.recordings.common_body import on_common_body
from mmm_core.imports.recordings.files import KINDS, read_motion
from mmm_core.language.mirroring import mirror_words
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.motion.features import features_from_joints, mirror

log = logging.getLogger(__name__)
LONGEST_FRAMES = MAX_TOKENS * FRAMES_PER_TOKEN
"""Frames of the longest clip."""
SHORTEST_FRAMES = 24
"""Frames that a clip must exceed."""
OWN = "own"
"""Terms of a trial that states none: the folder's owner recorded it."""
FREE_TERMS = ("CMU", "MIT", "CC0", OWN)
"""Terms of the trials that are used; trials under other terms are left out."""
MORE = "more"
"""Subfolder with further recordings in the same form."""
SAME_RECORDINGS = {
    "cmu-washwindow_1-test": "14_12",
    "cmu-basketball_signal_1-train": "29_02",
    "cmu-basketball_signal_2-train": "29_07",
    "cmu-directing_traffic_4-train": "14_24",
    "cmu-jumping_4-train": "13_32",
}
"""Trial numbers, in the subfolder, of recordings that the folder itself contains under benchmark names."""


def read_clips(folder: Path, split: str = "train") -> Iterator[tuple[NDArray[np.float32], list[str]]]:
    """Features and sentences of the usable clips of `split`, each followed by its mirror image.

    A clip is usable if its recording is under terms of `FREE_TERMS`, its sentences are not KIT-ML's, and its frames are upright
    and outside `bad_frames`. Recordings come from `motions_common_skeleton.npz` or, without this file, from one file of `KINDS`
    named TRIAL for each trial (an .amc with its .asf beside it). A subfolder `more` is read, too; if both contain a recording, the
    subfolder's copy is used. A line of `clips.jsonl` needs only `trial` and `captions`, and then means the whole recording, for
    training; without `trials.jsonl` all recordings count as the reader's own. The log says how many clips are left out, and why.

    Raises:
        TrainingDataError: a file is missing, or a clip has no captions or lies outside its recording.
        MotionFileError: a recording cannot be read.
    """
    more, replaced = folder / MORE, frozenset[str]()
    if (more / "clips.jsonl").is_file():
        held = {t["trial"]: t for t in _json_lines(more / "trials.jsonl")}
        replaced = frozenset(name for name, t in held.items() if t["replaces_rig"])
        replaced |= {name for name, copy in SAME_RECORDINGS.items() if copy in held}
        yield from _read_folder(more, split, frozenset())
    yield from _read_folder(folder, split, replaced)


def _read_folder(folder: Path, split: str, replaced: frozenset[str]) -> Iterator[tuple[NDArray[np.float32], list[str]]]:
    """The clips of one folder, without those of the trials in `replaced`."""
    listed = folder / "trials.jsonl"
    trials = {t["trial"]: t for t in _json_lines(listed)} if listed.is_file() else None
    left_out = Counter[str]()
    with ExitStack() as stack:
        recording = _recordings(folder, stack)
        for clip in _json_lines(folder / "clips.jsonl"):
            name = str(clip.get("trial", ""))
            label, about = str(clip.get("clip", name)), {} if trials is None else trials.get(name)
            joints = None if about is None else recording(name)
            if about is None or joints is None:
                allowed = (
                    "a trial of trials.jsonl" if trials is not None else f"a recording {name} of {', '.join(KINDS)}"
                )
                raise TrainingDataError(folder, label, f"trial {name!r} is unknown", allowed)
            if clip.get("split", "train") != split or name in replaced:
                continue
            if (terms := about.get("terms", OWN)) not in FREE_TERMS:
                left_out[f"terms {terms!r}, where {', '.join(FREE_TERMS)} are used"] += 1
                continue
            start, end = clip.get("start", 0), clip.get("end", len(joints))
            if not 0 <= start < end <= len(joints) + 1:
                found = f"frames {start} to {end}"
                raise TrainingDataError(folder, label, found, f"within the recording's {len(joints)} frames")
            joints = joints[start:end].astype(np.float64)
            captions = _captions(folder, label, clip)
            if reason := _unusable(joints, captions, (start, end), about.get("bad_frames", [])):
                left_out[reason] += 1
                continue
            for first in range(0, len(joints) - SHORTEST_FRAMES, LONGEST_FRAMES):
                features = features_from_joints(joints[first : first + LONGEST_FRAMES])
                yield features, captions
                yield mirror(features), [mirror_words(c) for c in captions]
    for reason, n in left_out.items():
        log.info("%s: %d clips of %s are left out: %s", folder, n, split, reason)


def _captions(folder: Path, label: str, clip: dict[str, Any]) -> list[str]:
    """The sentences of a clip, without KIT-ML's.

    Raises:
        TrainingDataError: the clip's line has no captions.
    """
    captions = clip.get("captions")
    if not isinstance(captions, list) or not captions:
        raise TrainingDataError(
            folder, label, f"captions {captions!r}", 'a list of sentences, ["waves with the right hand"]'
        )
    sources = clip.get("caption_source", [OWN] * len(captions))
    return [c for c, source in zip(captions, sources, strict=True) if source != "KIT-ML"]


def _unusable(
    joints_m: NDArray[np.float64], captions: list[str], span: tuple[int, int], bad: list[list[int]]
) -> str:  # fmt: skip
    """The reason why a clip is not used; empty for a usable one."""
    if not captions:
        return "their sentences are KIT-ML's"
    if len(joints_m) <= SHORTEST_FRAMES:
        return f"{SHORTEST_FRAMES} frames or fewer"
    if any(span[0] < end and start < span[1] for start, end in bad):
        return "they touch bad frames"
    return "" if _upright(joints_m) else "the person does not stand upright"


def _recordings(folder: Path, stack: ExitStack) -> Callable[[str], NDArray[Any] | None]:
    """A function that maps a trial to (T, 22, 3) joints on the common body at 20 fps, or to None for an unknown trial."""
    path = folder / "motions_common_skeleton.npz"
    if path.is_file():
        motions = stack.enter_context(np.load(path))
        return lambda trial: motions[trial] if trial in motions.files else None

    @lru_cache(maxsize=1)
    def read(trial: str) -> NDArray[Any] | None:
        found = next((p for kind in KINDS if (p := folder / f"{trial}{kind}").is_file()), None)
        return None if found is None else on_common_body(found, read_motion(found))

    return read


def _upright(joints_m: NDArray[np.float64]) -> bool:
    """Whether a person stands or walks: the pelvis is high and the trunk nearly vertical."""
    spine = joints_m[:, 12] - joints_m[:, 0]
    vertical = spine[:, 1] / np.maximum(np.linalg.norm(spine, axis=-1), 1e-6)
    return bool(joints_m[:, 0, 1].min() > 0.6 and vertical.min() > 0.5)


def _json_lines(path: Path) -> list[dict[str, Any]]:
    try:
        return [json.loads(line) for line in path.read_text("utf-8").splitlines() if line.strip()]
    except FileNotFoundError:
        raise TrainingDataError(path, "", "no such file", "one JSON object in each line") from None
    except json.JSONDecodeError as error:
        raise TrainingDataError(path, f"line {error.lineno}", error.msg, "one JSON object in each line") from error
