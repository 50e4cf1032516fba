"""`mmmd eval`: how well the model does what it is told, and how near it comes to real motion."""

from __future__ import annotations

import json as json_module
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

from daemon.errors import CommandError

if TYPE_CHECKING:
    from mmm_core.motion.motion import Motion

EvalName = Literal["probes", "fidelity", "edits", "words", "scope", "tokenizer", "real", "paper"]
MIRRORED_SEEDS = 2
"""Seeds with which each probe that names a side is compared with its mirror image."""
MOST_REPEATS = 1000
MOST_STEPS = 49
TABLE_WIDTH = 150
"""Characters a line, where no terminal says otherwise: a table in a file is not cut."""


def eval(
    name: Annotated[EvalName, tyro.conf.Positional],
    json: bool = False,
    seeds: int = 5,
    robots: tuple[str, ...] = ("reference", "op3"),
    probes: Literal["development", "test"] = "development",
    words: Literal["dev", "dev2", "test"] = "dev2",
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
    FID of generated against the tokenizer's own. --data is the folder of docs/DATA.md.

    paper: the tables of the paper's section 5 for the data and checkpoints given: 1 or 2 comparison, 3 speed, 4 editing in
    time, 5 upper body, 6 ablations (over steps, and over several --model). docs/evaluation.md says how all is measured.

    Example: mmmd eval probes --json

    Example: mmmd eval probes --seeds 1 --robots poppy_torso my_robot.toml

    Example: mmmd eval probes --probes test --seeds 5 --robots reference --json

    Example: mmmd eval fidelity --seeds 10 --json

    Example: mmmd eval fidelity --families row flap march_arms --steps 8

    Example: mmmd eval words --words dev2 --seeds 2 --robots reference --json

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
        words: which set of sentences; the rules have been written by all three (docs/language.md).
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
        figures, shown = _probes(model[0] if model else None, seeds, robots, _seeds_executed(executed, seeds), probes)
    elif name == "fidelity":
        figures, shown = _fidelity(model[0] if model else None, seeds, families, steps)
    elif name == "words":
        figures, shown = _words(model[0] if model else None, seeds, robots, words)
    elif name == "edits":
        figures = shown = _edits(model[0] if model else None)
    elif name == "tokenizer":
        figures = shown = _tokenizer(model[0] if model else None)
    elif name == "scope":
        figures = shown = _scope(model[0] if model else None)
    else:
        figures = shown = _measured(
            name, _data_folder(name, data), split, model, (evaluator, glove, evaluator_mean, evaluator_std),
            _checked(name, repeats, motions_per_text, tables, temperature),
        )  # fmt: skip
    console = Console() if sys.stdout.isatty() else Console(width=TABLE_WIDTH)
    if json:
        console.out(json_module.dumps(figures))
    elif name == "paper":
        _print_tables(console, figures["tables"])
        console.print(f"n {figures['n']} motions; {figures['caveat']}", highlight=False)
    else:
        for key, value in shown.items():
            console.print(f"{key}: {value}", highlight=False)
    return 0


def _seeds_executed(executed: int, seeds: int) -> int:
    if not 0 <= executed <= seeds:
        raise CommandError(f"eval probes: --executed {executed}; allowed: 0 to --seeds ({seeds})")
    return executed


def _probes(
    model: Path | None, seeds: int, robots: Sequence[str], executed: int, which: str
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Every probe generated once for each seed; the same motions checked on each robot, `executed` seeds as its servos do them."""
    from rich.console import Console
    from rich.progress import Progress

    from daemon.bench.executed import Executed
    from daemon.bench.report import context
    from mmm_core.corpus.heldout import PROBE_SETS
    from mmm_core.evaluation.mirrored import mirrored_figures
    from mmm_core.evaluation.probes import evaluate
    from mmm_core.evaluation.robot_capability import showable
    from mmm_core.generate.engine import Engine
    from retarget.pipeline import Retargeter
    from retarget.robot.loading import load_robot
    from retarget.robot_to_human import shown_on_a_person

    probes = PROBE_SETS[which]
    retargeters = {name: Retargeter(load_robot(name)) for name in robots}
    engine = Engine.load(model)
    motions: dict[tuple[str, int], Motion] = {}

    def generated(text: str, seed: int) -> Motion:
        motions[text, seed] = engine.generate(text, seed=seed).motion
        return motions[text, seed]

    figures: dict[str, Any] = {}
    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("what the checks see", total=len(probes))
        seen = showable(lambda motion: motion, lambda n: bar.update(task, completed=n), probes)
        bar.reset(task, description="generated", total=len(probes) * seeds)
        figures["generated"] = evaluate(generated, range(seeds), lambda n: bar.update(task, completed=n), seen, probes)
        for name, retargeter in retargeters.items():

            def on_robot(text: str, seed: int, retargeter: Retargeter = retargeter) -> Motion:
                return shown_on_a_person(retargeter, motions[text, seed])

            bar.reset(task, description=f"what {name} can show", total=len(probes))
            can = showable(partial(shown_on_a_person, retargeter), lambda n: bar.update(task, completed=n), probes)
            bar.reset(task, description=name, total=len(probes) * seeds)
            found = evaluate(on_robot, range(seeds), lambda n: bar.update(task, completed=n), can, probes)
            figures.setdefault("retargeted", {})[name] = found
            if executed:
                bar.reset(task, description=f"{name} executes", total=len(probes) * executed)
                robot = Executed(retargeter)
                done = evaluate(
                    lambda text, seed, robot=robot: robot.shown(motions[text, seed]),
                    range(executed), lambda n: bar.update(task, completed=n), can, probes,
                )  # fmt: skip
                figures.setdefault("executed", {})[name] = {**done, **robot.figures()}

    def again(text: str, seed: int) -> Motion:
        return motions[text, seed] if (text, seed) in motions else engine.generate(text, seed=seed).motion

    figures["mirrored"] = mirrored_figures(again, [p.text for p in probes], range(min(seeds, MIRRORED_SEEDS)))
    method = (
        f"held-out probes, {which} set (mmm_core/corpus/heldout.py), kinematic checks on generated joints, and on the joints "
        "that a robot's path shows (retarget/robot_to_human.py); refused counts as wrong; executed: on positions measured by "
        "simulated servos with the robot's body in MuJoCo behind them (daemon/bench/executed.py)"
    )
    figures |= {
        "n": figures["generated"]["n"],
        "set": which,
        "checkpoint": engine.checkpoint_hash,
        **context(0, method),
    }
    return figures, {
        "generated": figures["generated"],
        **figures.get("retargeted", {}),
        **{f"{name}, executed": found for name, found in figures.get("executed", {}).items()},
        "mirrored": figures["mirrored"],
    }


def _fidelity(
    model: Path | None, seeds: int, families: Sequence[str], steps: int | None
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The corpus's own sentences, each generated once."""
    from rich.console import Console
    from rich.progress import Progress

    from daemon.bench.report import context
    from mmm_core.corpus.families import FAMILIES
    from mmm_core.evaluation.fidelity import fidelity
    from mmm_core.generate.engine import Engine

    if unknown := [name for name in families if name not in FAMILIES]:
        raise CommandError(f"eval fidelity: no family {unknown[0]!r}; allowed: {', '.join(FAMILIES)}")
    if not 1 <= seeds <= MOST_REPEATS or (steps is not None and not 1 <= steps <= MOST_STEPS):
        found = f"--seeds {seeds}" + ("" if steps is None else f" --steps {steps}")
        raise CommandError(f"eval fidelity: {found}; allowed: 1 to {MOST_REPEATS} motions, 1 to {MOST_STEPS} steps")
    engine = Engine.load(model)
    if steps is not None:
        engine.settings = replace(engine.settings, steps=steps)
    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("fidelity", total=len(families or FAMILIES) * seeds)
        figures = fidelity(
            lambda text, seed: engine.generate(text, seed=seed).motion,
            families, seeds, lambda n: bar.update(task, completed=n),
        )  # fmt: skip
    method = (
        "the corpus's own sentences, held-out seeds, strict checks against the corpus's clean performance "
        "(mmm_core/evaluation/likeness.py) in so far as the corpus passes them itself"
    )
    figures |= {"steps": steps, "checkpoint": engine.checkpoint_hash, **context(0, method)}
    return figures, {key: figures[key] for key in ("share", "least", "worst", "n")}


def _words(model: Path | None, seeds: int, robots: Sequence[str], which: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Every sentence generated once for each seed; the same motions checked on each robot."""
    from rich.console import Console
    from rich.progress import Progress

    from daemon.bench.report import context
    from mmm_core.corpus.heldout import read_sentences
    from mmm_core.evaluation.sentences import evaluate_sentences, showable_expectations
    from mmm_core.generate.engine import Engine
    from retarget.pipeline import Retargeter
    from retarget.robot.loading import load_robot
    from retarget.robot_to_human import shown_on_a_person

    sentences = read_sentences(f"words_{which}")
    retargeters = {name: Retargeter(load_robot(name)) for name in robots}
    engine = Engine.load(model)

    @cache
    def generated(text: str, seed: int) -> Motion:
        return engine.generate(text, seed=seed).motion

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("generated", total=len(sentences) * seeds)
        seen = showable_expectations(sentences)
        found = evaluate_sentences(
            generated, generated, sentences, range(seeds), lambda n: bar.update(task, completed=n), seen
        )
        for name, retargeter in retargeters.items():

            @cache
            def on_robot(text: str, seed: int, retargeter: Retargeter = retargeter) -> Motion:
                motion = generated(text, seed)
                return shown_on_a_person(retargeter, motion) if len(motion.joints_m) else motion

            bar.reset(task, description=name, total=len(sentences) * seeds)
            can = showable_expectations(sentences, partial(shown_on_a_person, retargeter))
            found.setdefault("retargeted", {})[name] = evaluate_sentences(
                on_robot, on_robot, sentences, range(seeds), lambda n: bar.update(task, completed=n), can
            )
    method = (
        f"sentences of mmm_core/corpus/prompts/words_{which}.jsonl, judged by kinematic checks of the motion "
        "(mmm_core/evaluation/sentences.py), generated and as a robot's path shows it; tempo and size against the corpus's plain "
        "sentence"
    )
    figures = {
        "test" if which == "test" else "development": found,
        "n": found["n"],
        "checkpoint": engine.checkpoint_hash,
        **context(0, method),
    }
    return figures, {"generated": found, **found.get("retargeted", {})}


def _edits(model: Path | None) -> dict[str, Any]:
    """The cases of both sets, each edited once."""
    from rich.console import Console
    from rich.progress import Progress

    from daemon.bench.report import context
    from mmm_core.evaluation.edits import SETS, evaluate_edits, read_cases
    from mmm_core.generate.engine import Engine

    engine = Engine.load(model)
    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("edits", total=sum(len(read_cases(which)) for which in SETS))
        figures = evaluate_edits(engine, lambda n: bar.update(task, completed=n))
    method = "edits of generated motions, judged by kinematic signs; mmm_core/evaluation/edits.py"
    return {**figures, "checkpoint": engine.checkpoint_hash, **context(0, method)}


def _scope(model: Path | None) -> dict[str, Any]:
    """Held-out prompts, one at a time, as a command comes in."""
    from daemon.bench.report import context
    from mmm_core.corpus.scope_prompts import SCOPE_TEST
    from mmm_core.evaluation.scope import scope_figures
    from mmm_core.generate.engine import Engine

    engine = Engine.load(model)
    if engine.model.scope is None:
        raise CommandError("eval scope: the model has no scope (imported ones have none); take one of mmmd train")
    method = "held-out prompts (mmm_core/corpus/scope_prompts.py), read one at a time; docs/scope.md"
    figures = scope_figures(engine, SCOPE_TEST.in_scope, SCOPE_TEST.out_of_scope, list(SCOPE_TEST.mixed))
    return {**figures, "checkpoint": engine.checkpoint_hash, **context(0, method)}


def _tokenizer(model: Path | None) -> dict[str, Any]:
    """The corpus's motions, encoded and decoded."""
    from daemon.bench.report import context
    from mmm_core.evaluation.reconstruction import tokenizer_figures
    from mmm_core.inference.checkpoint import MODEL_FILE, file_hash, load_model
    from mmm_core.model.tokenizer import Tokenizer

    path = model or MODEL_FILE
    tokenizer = load_model(path).tokenizer
    if not isinstance(tokenizer, Tokenizer):
        raise CommandError("eval tokenizer: the model's tokenizer is one of the paper's; take one by body parts")
    method = "motions of the gesture corpus, encoded and decoded (mmm_core/evaluation/reconstruction.py)"
    return {**tokenizer_figures(tokenizer), "checkpoint": file_hash(path), **context(0, method)}


@dataclass(frozen=True)
class _Asked:
    """How much is measured."""

    repeats: int
    each: int
    tables: tuple[int, ...]
    temperature: float | None


def _checked(name: str, repeats: int, each: int, tables: tuple[int, ...], temperature: float | None) -> _Asked:
    if not 1 <= repeats <= MOST_REPEATS:
        raise CommandError(f"eval {name}: --repeats {repeats}; allowed: 1 to {MOST_REPEATS}")
    if not 2 <= each <= MOST_REPEATS:
        raise CommandError(f"eval {name}: --motions-per-text {each}; allowed: 2 to {MOST_REPEATS}")
    if not set(tables) <= {1, 2, 3, 4, 5, 6}:
        raise CommandError(f"eval {name}: --tables {' '.join(map(str, tables))}; allowed: 1 to 6")
    if temperature is not None and not 0 <= temperature <= 10:
        raise CommandError(f"eval {name}: --temperature {temperature}; allowed: 0 to 10")
    return _Asked(repeats, each, tables, temperature)


def _data_folder(name: str, data: Path | None) -> Path:
    if data is None:
        raise CommandError(f"eval {name}: --data is missing; example: mmmd eval {name} --data ../shared/data")
    return data


def _measured(
    name: str,
    data: Path,
    split: Sequence[Any],
    models: Sequence[Path],
    evaluator: tuple[Path | None, Path | None, Path | None, Path | None],
    asked: _Asked,
) -> dict[str, Any]:
    from daemon.bench.report import context
    from mmm_core.evaluation import paper, report
    from mmm_core.generate.engine import Engine

    if evaluator[1] is not None and None in evaluator:
        raise CommandError("eval: --glove goes with --evaluator finest.tar, --evaluator-mean and --evaluator-std")
    splits = split or report.default_splits(data)
    reader, evaluator_hash = report.load_reader(*evaluator)
    loaded: dict[str, Engine] = {str(path): Engine.load(path) for path in models} or {"shipped": Engine.load()}
    engines = {key: paper.for_evaluation(engine, asked.temperature) for key, engine in loaded.items()}
    engine = next(iter(engines.values()))
    pairs = report.measured_pairs(reader, list(engines.values()), data, splits)
    with _Bar() as bar:
        if name == "real":
            figures = report.real_figures(reader, engine, pairs, asked.repeats, asked.each, bar.titled("real"))
        else:
            figures = report.paper_figures(
                reader, engines, pairs, asked.repeats, asked.each, asked.tables, bar.titled
            )  # fmt: skip
    method = (
        f"{asked.repeats} repeats, splits {', '.join(splits)}, one caption of each motion a repeat, lengths of the real "
        f"motions, temperature {engine.settings.temperature}, {asked.each} motions a text for MModality; docs/evaluation.md"
    )
    return {
        **figures, "splits": list(splits), "checkpoint": engine.checkpoint_hash, "evaluator": evaluator_hash,
        **context(0, method),
    }  # fmt: skip


class _Bar:
    """A line on stderr that says how far a table is."""

    def __init__(self) -> None:
        from rich.console import Console

        self._status = Console(stderr=True).status("reading")

    def __enter__(self) -> _Bar:
        self._status.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._status.stop()

    def titled(self, title: str) -> Callable[[str], None]:
        """A function that takes how far it is."""
        return lambda text: self._status.update(f"{title}, repeat {text}")


def _print_tables(console: Any, tables: dict[str, Any]) -> None:
    from rich.table import Table

    from mmm_core.evaluation.report import COLUMNS

    for title, lines in tables.items():
        found = {key for row in lines.values() for key in row}
        columns = [c for c in COLUMNS if c in found] + sorted(found - set(COLUMNS))
        shown = Table("", *columns, title=f"Table {title}", title_justify="left")
        for name, row in lines.items():
            cells = [row.get(c, "") for c in columns]
            shown.add_row(name, *(f"{c[0]:.3f}±{c[1]:.3f}" if isinstance(c, list) else str(c) for c in cells))
        console.print(shown if lines else f"Table {title}: nothing to show, the model has no body parts")
