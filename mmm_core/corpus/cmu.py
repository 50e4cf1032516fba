"""Real motion: `clips.jsonl` beside the recordings that it cuts, of sources whose terms allow any use (docs/DATA.md)."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mmm_core.errors import TrainingDataError
from mmm_core.imports.recordings.common_body import on_common_body
from mmm_core.imports.recordings.files import read_motion
from mmm_core.language.mirroring import mirror_words
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.motion.features import features_from_joints, mirror

LONGEST_FRAMES = MAX_TOKENS * FRAMES_PER_TOKEN
SHORTEST_FRAMES = 24
FREE_TERMS = ("CMU", "MIT", "CC0")
"""Terms of trials that are used; every other is left out."""
MORE = "more"
"""Subfolder with further recordings in the same form."""
SAME_RECORDINGS = {
    "cmu-washwindow_1-test": "14_12",
    "cmu-basketball_signal_1-train": "29_02",
    "cmu-basketball_signal_2-train": "29_07",
    "cmu-directing_traffic_4-train": "14_24",
    "cmu-jumping_4-train": "13_32",
}
"""Benchmark names under which a folder holds recordings that its subfolder holds under their trial's number."""


def read_clips(folder: Path, split: str = "train") -> Iterator[tuple[NDArray[np.float32], list[str]]]:
    """Features and sentences of the usable clips of `split`, each followed by its mirror image.

    Used: recordings under terms of `FREE_TERMS`, sentences that are not KIT-ML's, upright frames outside `bad_frames`. The
    recordings are those of `motions_common_skeleton.npz`, or where there is none, TRIAL.bvh or TRIAL.amc (with its .asf).
    A subfolder `more` is read too; of a recording that both hold, the subfolder's copy is used.

    Raises:
        TrainingDataError: a file is missing or a clip lies outside its recording.
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
    trials = {t["trial"]: t for t in _json_lines(folder / "trials.jsonl")}
    with ExitStack() as stack:
        recording = _recordings(folder, stack)
        for clip in _json_lines(folder / "clips.jsonl"):
            trial = trials.get(clip["trial"])
            joints = None if trial is None else recording(clip["trial"])
            if trial is None or joints is None:
                raise TrainingDataError(
                    folder, clip["clip"], f"trial {clip['trial']!r} is unknown", "a trial of trials.jsonl"
                )
            if clip["split"] != split or trial["terms"] not in FREE_TERMS or clip["trial"] in replaced:
                continue
            captions = [c for c, s in zip(clip["captions"], clip["caption_source"], strict=True) if s != "KIT-ML"]
            if not 0 <= clip["start"] < clip["end"] <= len(joints) + 1:
                found = f"frames {clip['start']} to {clip['end']}"
                raise TrainingDataError(folder, clip["clip"], found, f"within the recording's {len(joints)} frames")
            joints = joints[clip["start"] : clip["end"]].astype(np.float64)
            if not captions or _touches(clip, trial["bad_frames"]) or not _upright(joints):
                continue
            for start in range(0, len(joints) - SHORTEST_FRAMES, LONGEST_FRAMES):
                features = features_from_joints(joints[start : start + LONGEST_FRAMES])
                yield features, captions
                yield mirror(features), [mirror_words(c) for c in captions]


def _recordings(folder: Path, stack: ExitStack) -> Callable[[str], NDArray[Any] | None]:
    """Gives (T, 22, 3) metres at 20 fps of a trial on the common body, None where there is none; the last is kept."""
    path = folder / "motions_common_skeleton.npz"
    if path.is_file():
        motions = stack.enter_context(np.load(path))
        return lambda trial: motions[trial] if trial in motions.files else None

    @lru_cache(maxsize=1)
    def read(trial: str) -> NDArray[Any] | None:
        found = next((p for kind in (".bvh", ".amc") if (p := folder / f"{trial}{kind}").is_file()), None)
        return None if found is None else on_common_body(found, read_motion(found))

    return read


def _upright(joints_m: NDArray[np.float64]) -> bool:
    """Standing or walking: pelvis high, trunk not far from vertical."""
    spine = joints_m[:, 12] - joints_m[:, 0]
    vertical = spine[:, 1] / np.maximum(np.linalg.norm(spine, axis=-1), 1e-6)
    return bool(joints_m[:, 0, 1].min() > 0.6 and vertical.min() > 0.5)


def _touches(clip: dict[str, Any], spans: list[list[int]]) -> bool:
    return any(clip["start"] < end and start < clip["end"] for start, end in spans)


def _json_lines(path: Path) -> list[dict[str, Any]]:
    try:
        return [json.loads(line) for line in path.read_text("utf-8").splitlines() if line.strip()]
    except FileNotFoundError:
        raise TrainingDataError(path, "", "no such file", "one JSON object in each line") from None
    except json.JSONDecodeError as error:
        raise TrainingDataError(path, f"line {error.lineno}", error.msg, "one JSON object in each line") from error
