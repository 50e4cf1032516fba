"""Films of the families with the lowest fidelity (`mmmd eval fidelity`): the corpus's performance beside the model's."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mmm_core.corpus.beat import BEAT_S
from mmm_core.corpus.synthesis import ClipSpec, synthesise_spec
from mmm_core.errors import TrainingDataError
from mmm_core.evaluation.fidelity import cases_of
from mmm_core.evaluation.films import SEED, PostureFeatures, film
from mmm_core.generate.engine import Engine
from mmm_core.motion.features import recover


@dataclass(frozen=True)
class Ranking:
    """Figures of `mmmd eval fidelity`: (family, share) of the worst families, worst first, and the numbers measured."""

    worst: Sequence[tuple[str, float]]
    n_families: int
    n_motions: int


def read_ranking(path: Path) -> Ranking:
    """The ranking in a file that `mmmd eval fidelity --json` wrote.

    Raises:
        TrainingDataError: the file holds no ranking.
    """
    try:
        found = json.loads(path.read_text("utf-8"))
        worst = [(str(name), float(share)) for name, share in found["worst"]]
        return Ranking(worst, len(found["families"]), int(found["n"]))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise TrainingDataError(path, "worst", str(error), "the output of `mmmd eval fidelity --json`") from error


def make_worst(engine: Engine, ranking: Ranking, out: Path) -> list[Path]:
    """Write to `out` a film of each family's first held-out case that fits into a clip, and their page; returns the files."""
    written: list[Path] = []
    lines: list[str] = []
    for name, share in ranking.worst:
        performed = (
            (case, synthesise_spec(ClipSpec((case.gesture,)), np.random.default_rng(SEED), BEAT_S))
            for case in cases_of(name)
        )  # on the beat, a gesture may be longer than a clip
        fitting = next(((case, clip) for case, clip in performed if clip is not None), None)
        if fitting is None:
            lines.append(f"| {name} | {share:.2f} | no case fits into a clip | |")
            continue
        case, clip = fitting
        shown, made = recover(clip.features), engine.generate(case.text, seed=SEED).motion
        motions = [PostureFeatures.of(m.joints_m, m.head_quat_wxyz) for m in (made, shown) if len(m.joints_m)]
        written.append(out / f"worst_{name}.gif")
        film(written[-1], motions)
        refused = "" if len(motions) > 1 else " (refused: the corpus's motion alone)"
        lines.append(f"| {name} | {share:.2f} | {case.text}{refused} | ![]({written[-1].name}) |")
    page = out / "worst.md"
    page.write_text(
        _PAGE.format(ranking=ranking, seed=SEED, checkpoint=engine.checkpoint_hash[:12], lines="\n".join(lines)),
        "utf-8",
    )
    return [*written, page]


_PAGE = """# The worst

Made by `mmmd eval fidelity --json > fidelity.json` and `python -m mmm_core.evaluation.worst_films fidelity.json`, seed {seed},
checkpoint {checkpoint}: the worst of {ranking.n_families} families of gestures, measured by {ranking.n_motions} motions,
with their shares of what the corpus shows. Left the motion that the model makes for the corpus's own sentence, right the corpus's
motion. Shares alone decide which families stand here, the alphabet among equal ones.

| family | share | sentence | |
|---|---|---|---|
{lines}
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("fidelity", type=Path, help="output of `mmmd eval fidelity --json`")
    parser.add_argument("--out", type=Path, default=Path("docs/films"))
    parser.add_argument("--model", type=Path, help="checkpoint; the shipped one when not given")
    asked = parser.parse_args(arguments)
    written = make_worst(Engine.load(asked.model), read_ranking(asked.fidelity), asked.out)
    sys.stdout.write(f"{len(written)} files in {asked.out}\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
