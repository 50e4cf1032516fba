"""Contact sheets and short films of generated motions beside people: `python -m mmm_core.evaluation.films ../shared/data`.

A person is drawn by limbs, in half profile: the left side is red and on the right of the picture, the right side is blue. The
generated motion stands on the left; a recording whose caption means the same, if there is one, stands on the right. A long
recording is cut to the part in which the hands move most. Prompts and seed are fixed below, and no result is selected.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw  # matplotlib brings it

from mmm_core.corpus.cmu import read_clips
from mmm_core.errors import TrainingDataError
from mmm_core.generate.engine import Engine
from mmm_core.motion.features import recover
from mmm_core.motion.motion import FPS
from mmm_core.motion.skeleton import JOINT_NAMES, PARENTS, Array, matrix_from_quat, rotation_y

SEED = 1
PANEL = (96, 126)
"""Width and height in pixels of one person."""
METRES = 2.15
"""Metres that the height of a panel shows."""
VIEW_YAW_RAD = np.deg2rad(-32.0)
"""Radians by which the person is turned against the picture."""
FILM_EVERY = 2
"""Frames of the motion from one frame of a film to the next, so that a film has 10 a second."""
INSTANTS = 8
"""Poses in a row of a contact sheet."""
ROWS = 6
"""Prompts of a contact sheet."""
SMOOTH = 3
"""Factor by which a picture is drawn larger and then scaled down, which smooths its lines."""
COLOURS = 6
"""Number of colours of a picture; fewer colours make smaller files."""
_PALETTE = {"": (68, 68, 68), "left": (192, 57, 43), "right": (36, 113, 163)}


@dataclass(frozen=True)
class PostureFeatures:
    """A motion to be drawn: joints (T, 22, 3) in metres and directions that the head faces (T, 3)."""

    joints_m: Array
    face: Array

    @classmethod
    def of(cls, joints_m: Array, head_quat_wxyz: Array) -> PostureFeatures:
        """The motion of joints (T, 22, 3) and head orientations (T, 4)."""
        return cls(joints_m.astype(np.float64), matrix_from_quat(head_quat_wxyz.astype(np.float64))[..., 2])

    def __len__(self) -> int:
        """Number of frames."""
        return len(self.joints_m)

    def cut(self, start: int, end: int) -> PostureFeatures:
        """Frames `start` to `end`."""
        return PostureFeatures(self.joints_m[start:end], self.face[start:end])


@dataclass(frozen=True)
class Film:
    """A prompt, and the caption of the recording to show beside it; empty if no recording shows such a gesture."""

    prompt: str
    real: str = ""

    @property
    def stem(self) -> str:
        """Name of the film's file, without its suffix."""
        return "_".join("".join(c if c.isalnum() else " " for c in self.prompt.lower()).split())


FILMS = (
    Film("swing a sword", "a person swings a sword"),
    Film("throw punches with both fists in turn", "a person throws punches"),
    Film("punch three times with your right fist", "a man punches the air in front of him with his right arm."),
    Film("make circles with both arms", "a person makes circles with both arms"),
    Film("wash the window with your right hand", "a person washes a window"),
    Film("direct the traffic", "a person directs traffic with the arms"),
    Film("twist your upper body from side to side", "a person twists the upper body from side to side"),
    Film("do the arms of jumping jacks", "a person does jumping jacks"),
    Film("stretch your right arm forward", "a person does arm stretch exercises with right arm."),
    Film("block with your left forearm", "someone steps, blocks and punches in a karate form"),
    Film("sway your arms above your head", "a person dances with the arms held high"),
    Film("climb a rope", "a person plays on climbing equipment"),
    Film("wave with your left hand"),
    Film("clap your hands three times"),
    Film("bow"),
    Film("nod twice"),
    Film("look to the left, then look to the right"),
    Film("salute with your right hand"),
    Film("shrug your shoulders"),
    Film("raise your left arm, then raise your right arm"),
    Film("point up and to the left"),
    Film("wave with your right hand while shaking your head"),
    Film("cross your arms and lean back"),
    Film("play the violin"),
)


def recordings(folder: Path, captions: Sequence[str]) -> dict[str, PostureFeatures]:
    """The first recording with each caption, searched in held-out splits first.

    Raises:
        TrainingDataError: no recording has one of the captions.
    """
    found: dict[str, PostureFeatures] = {}
    for split in ("test", "val", "train"):
        for features, texts in list(read_clips(folder, split))[::2]:  # every other clip is a mirror image
            for caption in set(texts) & set(captions) - found.keys():
                motion = recover(features)
                found[caption] = PostureFeatures.of(motion.joints_m, motion.head_quat_wxyz)
    if missing := set(captions) - found.keys():
        raise TrainingDataError(folder, "captions", f"no clip with {sorted(missing)}", "the folder of docs/DATA.md")
    return found


def liveliest(motion: PostureFeatures, n_frames: int) -> PostureFeatures:
    """The `n_frames` of a motion in which the wrists move most relative to the shoulders; a shorter motion is returned whole."""
    if len(motion) <= n_frames:
        return motion
    wrists = motion.joints_m[:, [20, 21]] - motion.joints_m[:, [16, 17]]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(wrists, axis=0), axis=-1).sum(1))])
    start = int(np.argmax(way[n_frames - 1 :] - way[: len(way) - n_frames + 1]))
    return motion.cut(start, start + n_frames)


def person(motion: PostureFeatures, frame: int) -> Image.Image:
    """A picture of one pose with the pelvis in the middle; a line from the head shows the direction that it faces."""
    width, height = (SMOOTH * side for side in PANEL)
    image = Image.new("RGB", (width, height), "white")
    draw = ImageDraw.Draw(image)
    joints_m, R_view = motion.joints_m[frame], rotation_y(np.array([VIEW_YAW_RAD]))[0]
    nose = joints_m[15] + np.array([0.0, 0.05, 0.0]) + 0.2 * motion.face[frame]
    seen = (np.concatenate([joints_m, nose[None]]) - joints_m[0] * np.array([1, 0, 1])) @ R_view.T
    scale = height / METRES
    pixels = np.stack([width / 2 + seen[:, 0] * scale, height - (seen[:, 1] + 0.08) * scale], -1)
    bones = sorted(range(1, len(PARENTS)), key=lambda j: seen[j, 2] + seen[PARENTS[j], 2])  # the nearest drawn last
    for j in bones:
        colour = _PALETTE.get(JOINT_NAMES[j].split("_")[0], _PALETTE[""])
        draw.line([*map(tuple, pixels[[PARENTS[j], j]].tolist())], fill=colour, width=3 * SMOOTH)
    x, y, radius = *pixels[15], 0.09 * scale
    draw.line([(x, y - 0.5 * radius), tuple(pixels[22].tolist())], fill=_PALETTE[""], width=2 * SMOOTH)
    draw.ellipse([x - radius, y - 1.6 * radius, x + radius, y + 0.6 * radius], outline=_PALETTE[""], width=2 * SMOOTH)
    return image.resize(PANEL, Image.Resampling.BOX)


def film(path: Path, motions: Sequence[PostureFeatures]) -> None:
    """Write motions side by side as an animated GIF; a shorter one stands still at its end."""
    n_frames = max(len(m) for m in motions)
    frames = [
        _beside([person(m, min(t, len(m) - 1)) for m in motions]).quantize(COLOURS, dither=Image.Dither.NONE)
        for t in range(0, n_frames, FILM_EVERY)
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    duration_ms = round(1000 * FILM_EVERY / FPS)
    frames[0].save(
        path, save_all=True, append_images=frames[1:], duration=duration_ms, loop=0, optimize=True, disposal=1
    )


def contact_sheet(path: Path, rows: Sequence[tuple[str, PostureFeatures]]) -> None:
    """Write motions at eight instants, each row under its title."""
    title = 14
    sheet = Image.new("RGB", (INSTANTS * PANEL[0], len(rows) * (PANEL[1] + title)), "white")
    draw = ImageDraw.Draw(sheet)
    for i, (text, motion) in enumerate(rows):
        top = i * (PANEL[1] + title)
        draw.text((4, top + 1), f"{text} ({len(motion) / FPS:.1f} s)", fill="black")
        instants = np.linspace(0, len(motion) - 1, INSTANTS).round().astype(int)
        sheet.paste(_beside([person(motion, int(t)) for t in instants]), (0, top + title))
    path.parent.mkdir(parents=True, exist_ok=True)
    sheet.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)


def _beside(images: Sequence[Image.Image]) -> Image.Image:
    row = Image.new("RGB", (PANEL[0] * len(images), PANEL[1]), "white")
    for i, image in enumerate(images):
        row.paste(image, (i * PANEL[0], 0))
    return row


def make(engine: Engine, folder: Path, out: Path, films: Sequence[Film] = FILMS) -> list[Path]:
    """Write a film for each prompt, the contact sheets and a page that shows them; returns the files.

    Raises:
        TrainingDataError: a recording is missing.
    """
    real = recordings(folder, [f.real for f in films if f.real])
    written: list[Path] = []
    lines: list[str] = []
    rows: list[tuple[str, PostureFeatures]] = []
    for one in films:
        generation = engine.generate(one.prompt, seed=SEED)
        made = PostureFeatures.of(generation.motion.joints_m, generation.motion.head_quat_wxyz)
        said = f"{one.prompt!r} ({generation.status}, score {generation.scope_score:.2f})"
        if not len(made):
            lines.append(f"| {one.prompt} | refused: {generation.reason} | |")
            continue
        beside = [liveliest(real[one.real], len(made))] if one.real else []
        written.append(out / f"{one.stem}.gif")
        film(written[-1], [made, *beside])
        lines.append(f"| {one.prompt} | ![]({written[-1].name}) | {one.real or 'no recording of such a thing'} |")
        rows += [(said, made), *((f"recorded: {one.real!r}", other) for other in beside)]
    per_sheet = 2 * ROWS
    for i in range(0, len(rows), per_sheet):
        written.append(out / f"sheet_{i // per_sheet + 1}.png")
        contact_sheet(written[-1], rows[i : i + per_sheet])
    sheets = "\n".join(f"![]({p.name})" for p in written if p.suffix == ".png")
    page = out / "README.md"
    page.write_text(
        _PAGE.format(seed=SEED, checkpoint=engine.checkpoint_hash[:12], lines="\n".join(lines), sheets=sheets)
    )
    return [*written, page]


_PAGE = """# What it looks like

Made by `python -m mmm_core.evaluation.films ../shared/data --out docs/films`, seed {seed}, checkpoint {checkpoint}; nothing
was picked. Left the generated motion; right, where there is one, a CMU recording whose caption says the same (cut to the stretch
in which the hands move most). In half profile: the person's left side is red, the right side blue.

| prompt | | recording beside it |
|---|---|---|
{lines}

The families of gestures that come out worst, beside the corpus: [worst.md](worst.md).

## Contact sheets

{sheets}
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("data", type=Path, help="folder with clips.jsonl (docs/DATA.md)")
    parser.add_argument("--out", type=Path, default=Path("docs/films"))
    parser.add_argument("--model", type=Path, help="checkpoint; the shipped one when not given")
    asked = parser.parse_args(arguments)
    written = make(Engine.load(asked.model), asked.data, asked.out)
    total_kb = sum(p.stat().st_size for p in written) / 1024
    sys.stdout.write(f"{len(written)} files, {total_kb:.0f} kB in {asked.out}\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
