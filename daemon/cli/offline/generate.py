"""`mmmd generate`: text to human motion, without a robot."""

from __future__ import annotations

import json as json_module
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, TypeVar

import msgspec
import tyro

from daemon.errors import CommandError
from daemon.wire.requests import LONGEST_S, MAX_SEED, MAX_TEXT_CHARS, SHORTEST_S

if TYPE_CHECKING:
    from mmm_core.generate.engine import Engine
from mmm_core.generate.result import GenerationResult

_FILE_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,119}")


class Prompt(msgspec.Struct, forbid_unknown_fields=True):
    """One line of a batch file."""

    id: str
    text: str
    seed: int = 0
    seconds: float | None = None


class SceneLine(msgspec.Struct, forbid_unknown_fields=True):
    """One line of a story."""

    text: str
    seconds: float | None = None


BvhNames = Literal["mmmd", "cmu", "mixamo"]
Precision = Literal["fp32", "bf16", "int8", "auto"]
Line = TypeVar("Line", bound=msgspec.Struct)


def generate(
    text: Annotated[str | None, tyro.conf.Positional] = None,
    out: Path | None = None,
    seed: int = 0,
    seconds: float | None = None,
    bvh: Path | None = None,
    bvh_names: BvhNames = "mmmd",
    batch: Path | None = None,
    story: Path | None = None,
    candidates: int = 1,
    model: Path | None = None,
    threads: int = 1,
    precision: Precision | None = None,
    json: bool = False,
) -> int:
    """Turn a text into the motion of 22 joints at 20 fps, in an .npz file, and a .bvh for Blender on request.

    BVH lengths are centimetres, y up. Exit status 1 when the text is out of the model's scope.

    Example: mmmd generate "wave with your right hand" --seed 7 --out wave.npz --bvh wave.bvh

    Example for a retargeting program: mmmd generate "bow" --out bow.npz --bvh bow.bvh --bvh-names mixamo

    Example for many: mmmd generate --batch prompts.jsonl --out motions

    Example for one long motion: mmmd generate --story scenes.jsonl --out story.npz

    Args:
        text: what to do, in English.
        out: .npz file to write; with --batch a folder.
        seed: the same text, seed and seconds give the same motion.
        seconds: length of the motion; the model chooses when it is not given.
        bvh: BVH file to write as well.
        bvh_names: its bones: mixamo or cmu as retargeting programs know them, in a T pose at rest; mmmd has our joints.
        batch: JSON lines of {"id", "text", "seed", "seconds"}: one .npz named by its id for each.
        story: JSON lines of {"text", "seconds"}: one motion with generated transitions, of any length.
        candidates: motions made at once; the one that the model finds likeliest is kept. A story has one motion of each scene.
        model: checkpoint; the shipped one when it is not given.
        threads: CPU threads.
        precision: of matrix products; int8 for the shipped model where the processor multiplies such integers (VNNI), else
            fp32; auto times fp32 and bf16. Another precision may choose another token now and then.
        json: print one JSON object for each motion.
    """
    if sum(source is not None for source in (text, batch, story)) != 1:
        example = 'mmmd generate "nod twice" --out nod.npz'
        raise CommandError(f"generate: give one of a text, --batch and --story; example: {example}")
    if out is None:
        raise CommandError("generate: --out is missing; name the .npz file (with --batch the folder) to write")
    if batch is not None and bvh is not None:
        raise CommandError("generate: --bvh goes with one text; with --batch leave it out")
    if batch is not None:
        return _generate_batch(_prompts(batch), out, _load(model, threads, precision), candidates, json)
    if story is not None:
        if candidates != 1:
            raise CommandError("generate: --candidates does not go with --story; leave it out")
        return _tell(story, out, bvh, bvh_names, seed, _load(model, threads, precision))
    prompt = Prompt("", text or "", seed, seconds)
    problem = _problem(prompt)
    if problem:
        raise CommandError(f"generate: {problem}")
    for path, suffix in ((out, ".npz"), (bvh, ".bvh")):
        if path is not None and path.suffix != suffix:
            raise CommandError(
                f"generate: {path}: written is a {suffix} file; name it so, for example {path.stem}{suffix}"
            )
        if path is not None and not path.parent.is_dir():
            raise CommandError(f"generate: {path}: no folder '{path.parent}'; make it, or choose another")
    made = _load(model, threads, precision).generate(prompt.text, seed=seed, seconds=seconds, candidates=candidates)
    _save(made, out)
    if made.status == "rejected":
        _say(_summary(prompt, made, out), json)
        nearest = f"; the nearest it knows: {made.understood}" if made.understood else ""
        sys.stderr.write(f"mmmd: {prompt.text!r} is out of scope: {made.reason}{nearest}\n")
        return 1
    if bvh is not None:
        from mmm_core.motion.bvh import save_bvh

        save_bvh(made.motion, bvh, bvh_names)
    _say(_summary(prompt, made, out), json)
    return 0


def _generate_batch(prompts: list[Prompt], folder: Path, engine: Engine, candidates: int, json: bool) -> int:
    from rich.console import Console
    from rich.progress import track

    folder.mkdir(parents=True, exist_ok=True)
    rejected = refused = 0
    console = Console(stderr=True)
    for prompt in track(prompts, "generating", console=console, disable=not console.is_terminal):
        if problem := _problem(prompt):
            refused += 1
            sys.stderr.write(f"mmmd: {prompt.id}: refused: {problem}\n")
            if json:
                refusal: dict[str, object] = {
                    "id": prompt.id,
                    "text": prompt.text,
                    "seed": prompt.seed,
                    "status": "rejected",
                    "reason": problem,
                }
                _say(refusal, json)
            continue
        made = engine.generate(prompt.text, seed=prompt.seed, seconds=prompt.seconds, candidates=candidates)
        path = folder / f"{prompt.id}.npz"
        _save(made, path)
        rejected += made.status == "rejected"
        if json:
            _say(_summary(prompt, made, path), json)
    if not json:
        told = f", {refused} lines refused" if refused else ""
        sys.stdout.write(
            f"{len(prompts) - refused} motions in {folder}, {rejected} of them rejected as out of scope{told}\n"
        )
    return int(refused == len(prompts))


def _tell(path: Path, out: Path, bvh: Path | None, bvh_names: BvhNames, seed: int, engine: Engine) -> int:
    """Generate a story as one motion; print the scenes that were rejected."""
    from mmm_core.generate.story import Scene, check_scenes, generate_story
    from mmm_core.motion.bvh import save_bvh
    from mmm_core.motion.motion import joined

    scenes = [Scene(line.text, line.seconds) for _, line in _lines(path, "--story", SceneLine)]
    check_scenes(scenes)
    pieces = list(generate_story(engine, scenes, seed=seed))
    for piece in pieces:
        if piece.status == "rejected":
            sys.stderr.write(f"mmmd: left out: {piece.text!r} is out of scope ({piece.scope_score:.2f})\n")
    whole = joined(pieces)
    if not len(whole.joints_m):
        sys.stderr.write(
            f"mmmd: generate: --story {path}: no scene is a motion that the model knows; {out} is not written\n"
        )
        return 1
    whole.save_npz(out)
    if bvh is not None:
        save_bvh(whole, bvh, bvh_names)
    n_told = len(scenes) - sum(piece.status == "rejected" for piece in pieces)
    sys.stdout.write(f"{out}: {len(whole.joints_m)} frames at {whole.fps:g} fps from {n_told} texts\n")
    return 0


def _save(made: GenerationResult, path: Path) -> None:
    """Write a motion; that of a refused text, which has no frames, takes no other file's place."""
    if made.status != "rejected" or not path.exists():
        made.motion.save_npz(path)


def _load(model: Path | None, threads: int, precision: Precision | None) -> Engine:
    if threads < 1:
        raise CommandError(f"generate: --threads {threads}; allowed: 1 or more")
    from mmm_core.generate.engine import Engine

    return Engine.load(model, threads=threads, precision=precision)


def _prompts(path: Path) -> list[Prompt]:
    """The lines of a batch file; ids, which name files, are checked before the first motion is generated."""
    seen: set[str] = set()
    lines = _lines(path, "--batch", Prompt)
    for number, prompt in lines:
        problem = ""
        if not _FILE_ID.fullmatch(prompt.id):
            problem = f"id {prompt.id!r} is no file name; allowed: letters, digits, '.', '_', '-', at most 120"
        if not problem and prompt.id in seen:
            problem = f"id {prompt.id!r} stands twice in the file"
        if problem:
            raise CommandError(f"--batch {path}: line {number}: {problem}")
        seen.add(prompt.id)
    return [prompt for _, prompt in lines]


def _lines(path: Path, option: str, kind: type[Line]) -> list[tuple[int, Line]]:
    """The JSON lines of a file with their numbers, without blank lines."""
    try:
        lines = path.read_text("utf-8").splitlines()
    except UnicodeDecodeError as error:
        raise CommandError(f"{option} {path}: not UTF-8 ({error})") from None
    except OSError as error:
        raise CommandError(f"{option} {path}: {error.strerror}") from None
    found: list[tuple[int, Line]] = []
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        try:
            found.append((number, msgspec.json.decode(line, type=kind)))
        except msgspec.DecodeError as error:
            allowed = ", ".join(f'"{field}"' for field in kind.__struct_fields__)
            raise CommandError(f"{option} {path}: line {number}: {error}; allowed: {{{allowed}}}") from None
    if not found:
        raise CommandError(f"{option} {path}: no lines; one JSON object a line is expected")
    return found


def _problem(prompt: Prompt) -> str:
    """The error of a prompt; empty when there is none."""
    if not prompt.text.strip():
        return f"the text is empty; allowed: 1 to {MAX_TEXT_CHARS} characters"
    if len(prompt.text) > MAX_TEXT_CHARS:
        return f"the text has {len(prompt.text)} characters; allowed: 1 to {MAX_TEXT_CHARS}"
    if not 0 <= prompt.seed <= MAX_SEED:
        return f"seed {prompt.seed}; allowed: 0 to {MAX_SEED}"
    if prompt.seconds is not None and not SHORTEST_S <= prompt.seconds <= LONGEST_S:
        return f"seconds {prompt.seconds:g}; allowed: {SHORTEST_S} to {LONGEST_S}"
    return ""


def _summary(prompt: Prompt, made: GenerationResult, path: Path) -> dict[str, object]:
    return {
        "id": prompt.id, "text": prompt.text, "seed": prompt.seed, "out": str(path), "status": made.status,
        "scope_score": round(made.scope_score, 4), "understood": _understood(made), "nearest": made.understood,
        "reason": made.reason,
        "frames": len(made.motion.joints_m), "fps": made.motion.fps, "ms": round(sum(made.timings_ms.values()), 1),
    }  # fmt: skip


def _say(summary: dict[str, object], json: bool) -> None:
    if json:
        sys.stdout.write(json_module.dumps(summary) + "\n")
        sys.stdout.flush()
    elif summary["status"] != "rejected":
        frames, fps = summary["frames"], summary["fps"]
        sys.stdout.write(f"{summary['out']}: {frames} frames at {fps:g} fps: {summary['understood']}\n")


def _understood(made: GenerationResult) -> str:
    """One sentence on the content of a motion; "" for none."""
    from mmm_core.recognition.seen import Scene, scenes_seen, sentence

    motion = made.motion
    if not len(motion.joints_m):
        return ""
    scenes = made.scenes or (Scene(motion.duration_s, f"{motion.text}\n{made.understood}"),)
    return sentence(scenes_seen(motion, scenes))
