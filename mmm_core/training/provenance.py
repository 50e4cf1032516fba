"""Provenance of a checkpoint: recipe, data with its licence, seed, revision of the code, last losses."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from pathlib import Path

from mmm_core.inference.checkpoint import Model, file_hash
from mmm_core.training.batches import Clip
from mmm_core.training.recipe import Recipe


def provenance(
    recipe: Recipe,
    run_folder: Path,
    data: Path | None,
    clips: Sequence[Clip],
    fps: float,
    start: tuple[Path, Model] | None,
) -> dict[str, object]:
    """Provenance that a checkpoint of a run carries.

    Args:
        recipe: recipe of the run.
        run_folder: folder with the losses of each stage.
        data: folder of the data; None for synthesised gestures alone.
        clips: training motions.
        fps: frames per second of the clips.
        start: the checkpoint that training went on from; None for new weights.
    """
    sources = [f"those of its start ({start[1].provenance.get('data', 'not stated')})"] if start else []
    sources += ["synthesised gestures (this repository, Apache-2.0)"] if recipe.data.has_gestures else []
    if data is not None:
        sources.append(f"{data.name}: {recipe.data.licence or 'licence not stated by the recipe'}")
    return {
        **({"start": {"sha256": file_hash(start[0]), **start[1].provenance}} if start else {}),
        "recipe": json.loads(json.dumps(recipe.to_dict())),
        "seed": recipe.seed,
        "data": "; ".join(sources),
        "clips": len(clips),
        "clips_from_people": int(sum(c.is_real for c in clips)),
        "hours": round(hours_of(clips, fps), 2),
        "revision": _revision(),
        "metrics": _last_losses(run_folder),
    }


def hours_of(clips: Sequence[Clip], fps: float) -> float:
    """Length of all clips together, in hours."""
    return sum(len(c.features) for c in clips) / fps / 3600


def _last_losses(folder: Path) -> dict[str, dict[str, float]]:
    """The losses in the last line of each stage's log."""
    found: dict[str, dict[str, float]] = {}
    for path in sorted(folder.glob("*.csv")):
        lines = path.read_text().splitlines()
        if len(lines) > 1 and lines[0].startswith("step,"):
            names, values = lines[0].split(","), lines[-1].split(",")
            found[path.stem] = {n: float(v) for n, v in zip(names, values, strict=False) if n != "seconds"}
    return found


def _revision() -> str:
    """Git revision of the code that trains, or "unknown" outside a checkout."""
    try:
        done = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True, check=True, timeout=10)
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return done.stdout.strip()
