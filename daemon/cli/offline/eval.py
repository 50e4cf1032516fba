"""`mmmd eval`: measures how well the model carries out commands, and how near its motions are to real ones."""

from __future__ import annotations

import json as json_module
import sys
from pathlib import Path
from typing import Annotated, Literal

import tyro

from daemon.cli.offline.eval_by_commands import (
    measure_edits,
    measure_fidelity,
    measure_probes,
    measure_scope,
    measure_tokenizer,
    measure_words,
    seeds_executed,
)
from daemon.cli.offline.eval_by_data import checked, data_folder, measured, print_tables

EvalName = Literal["probes", "fidelity", "edits", "words", "scope", "tokenizer", "real", "paper"]
TABLE_WIDTH = 150
"""Characters of a line where the output is no terminal: a table in a file is not cut."""


def eval(
    name: Annotated[EvalName, tyro.conf.Positional],
    json: bool = False,
    seeds: int = 5,
    robots: tuple[str, ...] = ("reference", "op3"),
    probes: Literal["development", "test"] = "development",
    words: Literal[
        "dev",
        "dev_2",
        "dev_3",
        "dev_4",
        "dev_5",
        "seen",
        "test",
        "test_singles",
        "test_denials",
        "test_denials_2",
        "test_1",
        "test_2",
        "test_3",
        "test_4",
        "test_5",
        "phrases_dev",
        "phrases_test",
    ] = "dev",
    executed: int = 1,
    families: tuple[str, ...] = (),
    steps: int | None = None,
    repeats: int = 20,
    data: Annotated[Path | None, tyro.conf.arg(metavar="DIR")] = None,
    split: tuple[Literal["train", "val", "test"], ...] = (),
    model: tuple[Path, ...] = (),
    tables: tuple[int, ...] = (),
    temperature: float | None = None,
    motions_per_text: int = 30,
    evaluator: Path | None = None,
    glove: Path | None = None,
    evaluator_mean: Path | None = None,
    evaluator_std: Path | None = None,
) -> int:
    """Measure the model.

    probes: side, limb, count (within one) and direction of motions for commands in words it was not trained on, as
    generated and as the paths of robots show them, of all and of what can be shown (of_showable: what the checks see on a
    person, or on the robot, when the corpus itself performs the probe), and as simulated servos execute those paths under
    load (executed: judged on the positions that they measure; kept: the share of what the path shows). How far the mirrored
    text's motion is from the mirrored motion.

    fidelity: whether each gesture of the corpus is made as well as the corpus makes it, from the corpus's own sentences and
    held-out seeds: sign, arms, way, pose, number, pace and size of strokes, round paths, arms in step, hands that meet. A check
    counts for a family when the corpus itself passes it in 9 of 10; share is the model's part of what the corpus passes.

    words: sentences as people type, speak and transcribe them (docs/language.md), judged by the motion that comes of them: the
    verb said once, two limbs at once, slips, denial, manner, parts in turn, everyday words, long requests; as generated and on
    --robots.

    edits: whether 100 edits show what their text asks and keep the rest: body parts, stretches, new beginnings, new ends,
    in-betweening; half of them are a development set (docs/evaluation.md).

    scope: refusals on 487 prompts kept apart, half of which the model can do: AUROC of the score, false refusals, false
    acceptances by kind, milliseconds a decision (docs/scope.md).

    tokenizer: what is left of the corpus's own motions once they are encoded and decoded: the amplitude of head and trunk, and
    what the probes expect; the gate that `mmmd train` keeps before anything is trained on a tokenizer.

    real: against held-out motion of people with the evaluator of this repository: R-precision of generated against real,
    FID of generated against that of the tokenizer, the checkpoint's and the one for people. --data is the folder of docs/DATA.md.

    paper: the tables of the paper's section 5 for the data and checkpoints given: 1 or 2 comparison, 3 speed, 4 editing in
    time, 5 upper body, 6 ablations (over steps, and over several --model). docs/evaluation.md says how all is measured.

    Example: mmmd eval probes --json

    Example: mmmd eval probes --seeds 1 --robots poppy_torso my_robot.toml

    Example: mmmd eval probes --probes test --seeds 5 --robots reference --json

    Example: mmmd eval fidelity --seeds 10 --json

    Example: mmmd eval fidelity --families row flap march_arms --steps 8

    Example: mmmd eval words --words dev --seeds 2 --robots reference --json

    Example: mmmd eval edits --json

    Example: mmmd eval scope --json

    Example: mmmd eval real --data ../shared/data --json

    Example: mmmd eval paper --data HumanML3D --model official.safetensors --evaluator finest.tar --glove glove
    --evaluator-mean meta/mean.npy --evaluator-std meta/std.npy --tables 1 4

    Args:
        name: what to evaluate.
        json: print one JSON object instead of lines.
        seeds: motions for each probe, or each family (fidelity).
        robots: names or robot files, each of which shows the probes' motions as well.
        probes: which set of probes: models are chosen by one, and reported on the other.
        words: which set of sentences; `seen` are those that the rules were written by, `test_1` to `test_5` are older tests,
            `phrases_` ask for one gesture each, in other words than the corpus (docs/language.md).
        executed: seeds of each probe that the simulated robots execute too; 0: none.
        families: families of the corpus (fidelity); all when none is given.
        steps: decoding steps of every motion (fidelity); the model's own when it is not given.
        repeats: of the whole measurement, for 95 % intervals.
        data: data folder (real, paper).
        split: splits to take; val and test of a clips.jsonl folder, else test.
        model: checkpoint; the shipped one when it is not given; several for table 6.
        tables: of the paper; all when none is given.
        temperature: of sampling; 1 for imported models, else the model's own when it is not given.
        motions_per_text: motions for each of at most 100 texts, for MModality.
        evaluator: an evaluator of `mmmd train evaluator`, or the published finest.tar; ours when it is not given.
        glove: folder of the published word vectors, with finest.tar.
        evaluator_mean: statistics finest.tar was trained with.
        evaluator_std: the same.
    """
    from rich.console import Console

    if name == "probes":
        figures, shown = measure_probes(
            model[0] if model else None, seeds, robots, seeds_executed(executed, seeds), probes
        )
    elif name == "fidelity":
        figures, shown = measure_fidelity(model[0] if model else None, seeds, families, steps)
    elif name == "words":
        figures, shown = measure_words(model[0] if model else None, seeds, robots, words)
    elif name == "edits":
        figures = shown = measure_edits(model[0] if model else None)
    elif name == "tokenizer":
        figures = shown = measure_tokenizer(model[0] if model else None)
    elif name == "scope":
        figures = shown = measure_scope(model[0] if model else None)
    else:
        figures = shown = measured(
            name, data_folder(name, data), split, model, (evaluator, glove, evaluator_mean, evaluator_std),
            checked(name, repeats, motions_per_text, tables, temperature),
        )  # fmt: skip
    console = Console() if sys.stdout.isatty() else Console(width=TABLE_WIDTH)
    if json:
        console.out(json_module.dumps(figures))
    elif name == "paper":
        print_tables(console, figures["tables"])
        console.print(f"n {figures['n']} motions; {figures['caveat']}", highlight=False)
    else:
        for key, value in shown.items():
            console.print(f"{key}: {value}", highlight=False)
    return 0
