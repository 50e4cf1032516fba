"""Makes the reports of `mmmd eval real` and `mmmd eval paper`: measured tables as plain numbers, with remarks on the sample."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch

from mmm_core.errors import CheckpointError, EvaluationError
from mmm_core.evaluation import paper
from mmm_core.evaluation.extractors import load_evaluator, load_published
from mmm_core.evaluation.metrics import POOL, Interval
from mmm_core.evaluation.pairs import Pair, pairs_for
from mmm_core.evaluation.protocol import Progress
from mmm_core.evaluation.reader import Reader
from mmm_core.evaluation.words import read_vectors
from mmm_core.generate.engine import Engine
from mmm_core.imports.datasets import Split
from mmm_core.inference.checkpoint import EVALUATOR_FILE, file_hash, load_text_encoder

TABLES = {1: "comparison", 3: "speed", 4: "editing in time", 5: "editing the upper body", 6: "ablations"}
"""Subjects of the paper's tables by number; the comparison on KIT-ML is number 2."""
KIT_FEATURES = 251
SPEED_REPEATS, ABLATION_REPEATS = 3, 5
"""Most repeats in tables 3 and 6, which measure many models."""
COLUMNS = ("R1", "R2", "R3", "FID", "MM-Dist", "Diversity", "MModality", "AITS s")
"""Columns in the paper's order; others come after them."""


def default_splits(data: Path) -> tuple[Split, ...]:
    """The held-out splits: "test", and for the small clips.jsonl layout also "val", by which the weights for people were chosen."""
    return ("val", "test") if (data / "clips.jsonl").is_file() else ("test",)


def load_reader(
    evaluator: Path | None = None, glove: Path | None = None, mean: Path | None = None, std: Path | None = None
) -> tuple[Reader, str]:
    """The evaluator to measure with, and its file's hash.

    Args:
        evaluator: file of our evaluator (None: the one that ships), or of the published one if `glove` is given.
        glove: folder of the published word vectors.
        mean: file of the feature means that the published evaluator was trained with.
        std: file of their standard deviations.

    Raises:
        CheckpointError: a file is missing or of another kind.
        EvaluationError: `mean` or `std` is missing, or the word vectors do not fit the evaluator.
    """
    path = evaluator or EVALUATOR_FILE
    if glove is None:
        reader = Reader(load_evaluator(path)[0], load_text_encoder())
    else:
        if mean is None or std is None:
            raise EvaluationError(
                "the published evaluator without its statistics", "its meta/mean.npy and meta/std.npy"
            )
        statistics = [_statistic(p) for p in (mean, std)]
        published = load_published(path, *statistics, n_features=len(statistics[0]))
        reader = Reader(published, read_vectors(glove))
    return reader, file_hash(path)


def real_figures(
    reader: Reader, engine: Engine, pairs: Sequence[Pair], repeats: int, each: int, progress: Progress
) -> dict[str, Any]:
    """Figures on real captions: generated motion against real and reconstructed motion, with ratios as a summary.

    `fid_ratio` is to the FID of the checkpoint's own tokenizer, `fid_ratio_people` to that of the tokenizer for people.
    """
    table = paper.comparison(reader, engine, pairs, repeats, progress, each)
    lines = {name: {key: number(v) for key, v in row.items()} for name, row in table.items()}
    made, real, again = lines["generated"], lines["real motion"], lines["tokenizer"]

    def column(key: str) -> dict[str, Any]:
        return {name: row[key] for name, row in lines.items() if key in row}

    return {
        "r1_ratio": _ratio(made.get("R1"), real.get("R1")),
        "fid_ratio": _ratio(made["FID"], again["FID"]),
        "fid_ratio_people": _ratio(made["FID"], lines.get("tokenizer for people", again)["FID"]),
        "r_precision": {n: [row["R1"], row["R2"], row["R3"]] for n, row in lines.items() if "R1" in row},
        "fid": column("FID"),
        "mm_dist": column("MM-Dist"),
        "diversity": column("Diversity"),
        "mmodality": made["MModality"],
        "half_widths": {n: {k: half_width(v) for k, v in row.items()} for n, row in table.items()},
        **sizes(reader, pairs),
    }


def paper_figures(
    reader: Reader,
    engines: dict[str, Engine],
    pairs: Sequence[Pair],
    repeats: int,
    each: int,
    wanted: Sequence[int],
    progress_of: Callable[[str], Progress],
) -> dict[str, Any]:
    """The paper's tables by title, line and column; an interval is [mean, half its width]."""
    engine = next(iter(engines.values()))
    makers: dict[int, Callable[[Progress], paper.Table]] = {
        1: lambda p: paper.comparison(reader, engine, pairs, repeats, p, each),
        3: lambda p: paper.speed(reader, engine, pairs, min(repeats, SPEED_REPEATS), p),
        4: lambda p: paper.editing_in_time(reader, engine, pairs, repeats, p),
        5: lambda p: paper.editing_the_upper_body(reader, engine, pairs, repeats, p),
        6: lambda p: paper.ablations(reader, engines, pairs, min(repeats, ABLATION_REPEATS), p),
    }
    asked = [1 if t == 2 else t for t in wanted] or list(makers)
    kit = pairs[0].features.shape[1] == KIT_FEATURES
    tables: dict[str, Any] = {}
    for table, make in makers.items():
        if table in asked:
            title = f"{2 if kit and table == 1 else table} ({TABLES[table]})"
            lines = make(progress_of(f"table {title}"))
            tables[title] = {name: {k: _plain(v) for k, v in row.items()} for name, row in lines.items()}
    return {"tables": tables, **sizes(reader, pairs)}


def measured_pairs(reader: Reader, engines: Sequence[Engine], data: Path, splits: Sequence[Split]) -> list[Pair]:
    """The pairs of `data`, after checking that models, folder and evaluator fit each other.

    Raises:
        EvaluationError: they do not fit.
        TrainingDataError: the folder cannot be read.
    """
    for engine in engines:
        reader.fit(engine)
    return pairs_for(engines, data, splits)


def sizes(reader: Reader, pairs: Sequence[Pair]) -> dict[str, Any]:
    """Numbers of motions (`n`) and of different captions (`n_texts`), and remarks on metrics that need more (`caveat`)."""
    n, n_texts = len({p.motion for p in pairs}), len({p.text for p in pairs})
    width = reader.evaluator.config.embedding
    said = [f"{n} motions with {n_texts} different captions; the literature measures 4,400 (HumanML3D)"]
    if n < POOL:
        said.append(f"R-precision is not measured: its pools are of {POOL} motions")
    if n < 10 * width:
        said.append(f"FID in {width} dimensions is biased upwards by so few, see the line of halves")
    if n_texts < n // 2:
        said.append("captions repeat within a pool of 32, which caps R-precision, also that of real motion")
    return {"n": n, "n_texts": n_texts, "caveat": "; ".join(said)}


def number(value: Any) -> float:
    """The mean of an interval, or a number, to four digits."""
    return round(float(value.mean if isinstance(value, Interval) else value), 4)


def half_width(value: Any) -> float:
    """Half of a 95 % interval; 0 for a number."""
    return round(value.half_width, 4) if isinstance(value, Interval) else 0.0


def _plain(value: Any) -> Any:
    """An interval as [mean, half width]; a count stays a whole number."""
    if isinstance(value, Interval):
        return [number(value), half_width(value)]
    return value if isinstance(value, int) else number(value)


def _ratio(made: float | None, reference: float | None) -> float | None:
    return round(made / reference, 4) if made is not None and reference else None


def _statistic(path: Path) -> torch.Tensor:
    try:
        array = np.load(path, allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        raise CheckpointError(path, "", f"not a readable .npy ({error})", "one number for each feature") from None
    if array.ndim != 1 or not np.isfinite(array).all():
        raise CheckpointError(path, "", f"shape {array.shape}", "one finite number for each feature")
    return torch.tensor(array)
