"""Pictures and errors of ten gestures on OP3 and OP2, retargeted before and after arms were weighed by frame.

    python -m docs.tools.retarget_before_after docs/pictures

writes `before_after_op3.png` and `before_after_op2.png` and prints the table of docs/retargeting.md. It needs a git clone with
its history: "before" is the code of the parent of the commit that introduced `retarget/human/weighing.py`, run in a process of
its own on the same motions and robot files.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from daemon.pictures.scene import VIEWS, Scene
from mmm_core.generate.engine import Engine
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import matrix_from_quat
from retarget.human.human import SIDES, read_human
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot

Array = NDArray[np.float64]
BEFORE = "2454cea73cd04a1be32e6a09fb342c4e690d5556^"
"""Commit whose retargeting is "before"."""
ROBOTS = ("op3", "op2")
GESTURES = (
    "wave with your right hand", "clap three times", "raise both arms", "salute with your right hand", "cross your arms",
    "point forward with your left hand", "put your hands on your hips", "punch twice with your right fist",
    "beckon with your left hand", "drum with both hands",
)  # fmt: skip
SEED = 0
_MOVES_DEG = 20.0
"""Degrees by which an arm's bones turn from the first frame in a gesture that the arm takes part in."""
_MIDDLE = (0.2, 0.8)
"""Share of the motion that the two instants of the pictures are taken from."""
_PANEL_PX, _TITLE_PX, _LABEL_PX, _MARGIN_PX = (200, 190), 30, 20, 88
_COLUMNS = 5
"""Gestures side by side."""
_INK, _PALE_INK = (40, 44, 52), (100, 106, 116)
_COLOURS = 96

_OLD_RETARGETING = """
import sys
sys.path.insert(0, sys.argv[1])
import numpy as np
from mmm_core.motion.motion import load_npz
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
retargeter = Retargeter(load_robot(sys.argv[2]))
for path in sys.argv[3:]:
    np.save(path + "." + sys.argv[2] + ".npy", retargeter.retarget(load_npz(path)).q_rad)
"""


@dataclass(frozen=True)
class Errors:
    """Mean errors of one gesture over all frames of the arms that take part in it, degrees.

    Attributes:
        upper: angle between the person's and the robot's upper arm.
        fore: angle between the forearms.
        hand: angle between the lines from shoulder to wrist, with the robot's lengths.
    """

    upper: float
    fore: float
    hand: float


@dataclass(frozen=True)
class Shown:
    """One gesture on one robot: the motion, the paths before and after (T, J), and their errors."""

    motion: Motion
    paths: tuple[Array, Array]
    errors: tuple[Errors, Errors]


def made_before(motions: list[Motion], robot: str, folder: Path) -> list[Array]:
    """Paths (T, J) of the motions as the code of `BEFORE` makes them."""
    tree = folder / "before"
    if not tree.is_dir():
        root = Path(__file__).parent.parent.parent
        paths = ["retarget", "mmm_core/*.py", "mmm_core/motion"]
        packed = subprocess.run(["git", "archive", BEFORE, *paths], cwd=root, capture_output=True, check=True).stdout
        tree.mkdir()
        subprocess.run(["tar", "-x", "-C", str(tree)], input=packed, check=True)
    files = [folder / f"{k}.npz" for k in range(len(motions))]
    for motion, file in zip(motions, files, strict=True):
        motion.save_npz(file)
    command = [sys.executable, "-c", _OLD_RETARGETING, str(tree), robot, *map(str, files)]
    subprocess.run(command, cwd=folder, check=True)
    return [np.load(f"{file}.{robot}.npy") for file in files]


def errors(retargeter: Retargeter, motion: Motion, q_rad: Array) -> Errors:
    """The errors of a path of a motion."""
    human = read_human(motion)
    T = len(motion.joints_m)
    poses = retargeter.poses(human)
    moved = np.rad2deg(np.arccos(np.clip(np.einsum("sti,si->st", human.fore, human.fore[:, 0]), -1, 1))).max(1)
    takes_part = moved > _MOVES_DEG
    assert takes_part.any(), f"{motion.text}: no arm moves"
    bones = retargeter.direction_errors_deg(poses, q_rad[:T]).reshape(2, 2, -1)[:, takes_part]
    names = [point.name for point in retargeter.kinematics.key_points]
    places = retargeter.kinematics.places(q_rad[:T])
    hands: list[float] = []
    for s, side in enumerate(SIDES):
        if takes_part[s]:
            reach = places[:, names.index(f"{side}_wrist")] - places[:, names.index(f"{side}_shoulder")]
            chain = retargeter.arms[s]
            wanted = np.linalg.norm(chain.upper_m) * human.upper[s] + np.linalg.norm(chain.fore_m) * human.fore[s]
            cosine = (reach * wanted).sum(-1) / (np.linalg.norm(reach, axis=-1) * np.linalg.norm(wanted, axis=-1))
            hands.append(float(np.rad2deg(np.arccos(np.clip(cosine, -1, 1))).mean()))
    return Errors(float(bones[0].mean()), float(bones[1].mean()), float(np.mean(hands)))


def instants(motion: Motion) -> tuple[int, int]:
    """The two frames in the middle of a motion between which the person's arms differ most."""
    human = read_human(motion)
    T = len(motion.joints_m)
    frames = np.arange(round(_MIDDLE[0] * (T - 1)), round(_MIDDLE[1] * (T - 1)) + 1)
    directions = np.concatenate([human.upper, human.fore])[:, frames].transpose(1, 0, 2).reshape(len(frames), -1)
    apart = np.linalg.norm(directions[:, None] - directions[None], axis=-1)
    first, second = np.unravel_index(int(apart.argmax()), apart.shape)
    return int(frames[min(first, second)]), int(frames[max(first, second)])


def sheet(robot_name: str, every: list[Shown]) -> Image.Image:
    """The picture of one robot: for each gesture two instants of the person, the robot before and the robot after."""
    width, height = _PANEL_PX
    column = 2 * width + 12
    band = _TITLE_PX + 3 * height + 2 * _LABEL_PX
    rows = -(-len(every) // _COLUMNS)
    picture = Image.new("RGB", (_MARGIN_PX + _COLUMNS * column, rows * band + _TITLE_PX), "white")
    pen = ImageDraw.Draw(picture)
    robot = load_robot(robot_name)
    with Scene(None, _PANEL_PX) as people, Scene(robot, _PANEL_PX, person=False) as robots:
        for k, shown in enumerate(every):
            left, top = _MARGIN_PX + k % _COLUMNS * column, k // _COLUMNS * band
            pen.text((left + 6, top + 6), shown.motion.text, _INK, _font(19))
            faces = matrix_from_quat(shown.motion.head_quat_wxyz.astype(np.float64))[:, :, 2]
            for c, frame in enumerate(instants(shown.motion)):
                drawn = [people.draw(VIEWS["half"], person_m=shown.motion.joints_m[frame], head_faces=faces[frame])]
                drawn += [robots.draw(VIEWS["half"], path[min(frame, len(path) - 1)]) for path in shown.paths]
                for r, image in enumerate(drawn):
                    at = top + _TITLE_PX + r * height + max(r - 1, 0) * _LABEL_PX
                    picture.paste(Image.fromarray(image), (left + c * width, at))
                pen.text(
                    (left + c * width + 6, top + _TITLE_PX + 4),
                    f"{frame / shown.motion.fps:.1f} s",
                    _PALE_INK,
                    _font(14),
                )
            for r, of in enumerate(shown.errors):
                at = top + _TITLE_PX + (r + 2) * height + r * _LABEL_PX
                said = f"upper arm {of.upper:.0f}, forearm {of.fore:.0f}, hand {of.hand:.0f} degrees"
                pen.text((left + 6, at + 2), said, _INK, _font(15))
    for row in range(rows):
        for r, title in enumerate(("person", "before", "after")):
            pen.text(
                (8, row * band + _TITLE_PX + (r + 0.45) * height + max(r - 1, 0) * _LABEL_PX), title, _INK, _font(19)
            )
    said = f"{robot_name}: mean errors of upper arm, forearm, and line from shoulder to wrist; red: its left, blue: its right"
    pen.text((_MARGIN_PX, rows * band + 6), said, _PALE_INK, _font(16))
    return picture.quantize(_COLOURS, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)


def table(of: dict[str, list[Shown]]) -> str:
    """The errors as Markdown."""
    lines = [
        "| gesture |" + "".join(f" `{r}` upper arm | forearm | hand |" for r in of),
        "|---|" + "---|---|---|" * len(of),
    ]
    for k, text in enumerate(GESTURES):
        lines.append(f"| {text} |" + "".join(_cells([every[k]]) for every in of.values()))
    lines.append("| mean |" + "".join(_cells(every) for every in of.values()))
    return "\n".join(lines)


def _cells(every: list[Shown]) -> str:
    kinds = ("upper", "fore", "hand")
    means = [[np.mean([getattr(s.errors[when], kind) for s in every]) for when in (0, 1)] for kind in kinds]
    return "".join(f" {before:.1f}, {after:.1f} |" for before, after in means)


def _font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(size)


def draw(out: Path) -> None:
    """Write both pictures into a folder and print the table."""
    engine = Engine.load()
    motions = [engine.generate(text, seed=SEED).motion for text in GESTURES]
    shown: dict[str, list[Shown]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for robot in ROBOTS:
            retargeter = Retargeter(load_robot(robot))
            shown[robot] = []
            for motion, old in zip(motions, made_before(motions, robot, Path(folder)), strict=True):
                new = retargeter.retarget(motion).q_rad
                found = errors(retargeter, motion, old), errors(retargeter, motion, new)
                shown[robot].append(Shown(motion, (old, new), found))
    for robot, every in shown.items():
        path = out / f"before_after_{robot}.png"
        sheet(robot, every).save(path, optimize=True)
        sys.stdout.write(f"{path}\n")
    sys.stdout.write(f"{table(shown)}\n")


if __name__ == "__main__":
    draw(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures"))
