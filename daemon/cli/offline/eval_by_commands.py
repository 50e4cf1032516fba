"""Figures of `mmmd eval` that compare motions with the commands for which they were generated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daemon.errors import CommandError

if TYPE_CHECKING:
    from mmm_core.motion.motion import Motion

MOST_SEEDS = 1000
"""Number of motions for each family, at most."""
MIRRORED_SEEDS = 2
"""Number of seeds with which each probe that names a side is compared with its mirror image."""


MOST_STEPS = 49


def seeds_executed(executed: int, seeds: int) -> int:
    """The number of seeds that simulated robots execute, checked against `--seeds`."""
    if not 0 <= executed <= seeds:
        raise CommandError(f"eval probes: --executed {executed}; allowed: 0 to --seeds ({seeds})")
    return executed


def measure_probes(
    model: Path | None, seeds: int, robots: Sequence[str], executed: int, which: str
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Generate every probe once for each seed; check the motions on each robot, and `executed` seeds as its servos execute them."""
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


def measure_fidelity(
    model: Path | None, seeds: int, families: Sequence[str], steps: int | None
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Generate the corpus's own sentences, each once."""
    from rich.console import Console
    from rich.progress import Progress

    from daemon.bench.report import context
    from mmm_core.corpus.families import FAMILIES
    from mmm_core.evaluation.fidelity import fidelity
    from mmm_core.generate.engine import Engine

    if unknown := [name for name in families if name not in FAMILIES]:
        raise CommandError(f"eval fidelity: no family {unknown[0]!r}; allowed: {', '.join(FAMILIES)}")
    if not 1 <= seeds <= MOST_SEEDS or (steps is not None and not 1 <= steps <= MOST_STEPS):
        found = f"--seeds {seeds}" + ("" if steps is None else f" --steps {steps}")
        raise CommandError(f"eval fidelity: {found}; allowed: 1 to {MOST_SEEDS} motions, 1 to {MOST_STEPS} steps")
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


def measure_words(
    model: Path | None, seeds: int, robots: Sequence[str], which: str
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Generate every sentence once for each seed; check the motions on each robot."""
    from rich.console import Console
    from rich.progress import Progress

    from daemon.bench.report import context
    from mmm_core.corpus.heldout import read_sentences
    from mmm_core.evaluation.sentence_capability import showable_expectations
    from mmm_core.evaluation.sentences import evaluate_sentences
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


def measure_edits(model: Path | None) -> dict[str, Any]:
    """Carry out the edits of both sets, each once."""
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


def measure_scope(model: Path | None) -> dict[str, Any]:
    """Decide on held-out prompts one at a time, as commands arrive."""
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


def measure_tokenizer(model: Path | None) -> dict[str, Any]:
    """Encode and decode the corpus's motions."""
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
