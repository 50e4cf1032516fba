"""Pictures of motions and runs: what is drawn is where it belongs, and a file is written whole or not at all."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from daemon.cli import main
from daemon.errors import DaemonError
from daemon.gestures.clips import load_clips
from daemon.pictures.drawing import INSTANTS, contact_sheet, frames, instants
from daemon.pictures.errors import FilmError, NoOpenGLError
from daemon.pictures.film import write_film
from daemon.pictures.joints import joint_plot, spans
from daemon.pictures.performance import Performance, cut, of_motion, of_run
from daemon.pictures.scene import VIEWS, Scene
from daemon.recording.mcap_reading import Log, LoggedCycle
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import JOINT_NAMES
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap
from tests.support.sizes import few_and_long

SIZE = (240, 200)
SHIPPED = Path(__file__).parents[3] / "daemon" / "gestures" / "shipped.npz"


@pytest.fixture(scope="module")
def robot() -> RobotModel:
    return load_robot("op3")


@pytest.fixture(scope="module")
def wave() -> Motion:
    return load_clips(SHIPPED)["wave_right"].posture.motion(text="wave")


@pytest.fixture(scope="module", autouse=True)
def opengl() -> None:
    try:
        Scene(None, SIZE).close()
    except NoOpenGLError as error:
        pytest.skip(str(error))


def angles(robot: RobotModel, **degrees: float) -> np.ndarray:
    q = robot.rest_rad.copy()
    for name, value in degrees.items():
        q[robot.joint_names.index(name)] = np.deg2rad(value)
    return q


def red(image: np.ndarray) -> np.ndarray:
    """Where the left side's colour is seen."""
    return (image[..., 0].astype(int) - image[..., 2] > 60) & (image[..., 0] > 110)


def blue(image: np.ndarray) -> np.ndarray:
    return (image[..., 2].astype(int) - image[..., 0] > 50) & (image[..., 2] > 100)


def run_log(robot: RobotModel, plan_ids: list[int]) -> Log:
    ticks = tuple(int(t) for t in JointServoMap(robot).to_ticks(robot.rest_rad[None])[0].round())
    cycles = [
        LoggedCycle(
            i, i * 10_000_000, "playing" if plan else "holding", plan, True, robot.rest_rad + 0.01 * i, ticks, ticks
        )
        for i, plan in enumerate(plan_ids)
    ]
    return Log({"robot": robot.name}, cycles, plan_texts={1: "wave", 2: "bow"})


def test_the_robots_left_is_on_the_right_of_the_picture(robot: RobotModel) -> None:
    with Scene(robot, SIZE, person=False) as scene:
        image = scene.draw(VIEWS["front"], robot.rest_rad)
    middle = SIZE[0] / 2
    assert np.nonzero(red(image))[1].mean() > middle + 5
    assert np.nonzero(blue(image))[1].mean() < middle - 5


def test_a_raised_left_arm_is_seen_higher(robot: RobotModel) -> None:
    with Scene(robot, SIZE, person=False) as scene:
        down = red(scene.draw(VIEWS["front"], robot.rest_rad))
        up = red(scene.draw(VIEWS["front"], angles(robot, l_sho_roll=-50.0)))
    assert np.nonzero(up)[0].mean() < np.nonzero(down)[0].mean() - 10


@pytest.mark.long
def test_a_ghost_of_the_goal_is_drawn_beside_what_is_measured(robot: RobotModel) -> None:
    with Scene(robot, SIZE, person=False) as scene:
        alone = scene.draw(VIEWS["front"], robot.rest_rad)
        ghost = scene.draw(VIEWS["front"], robot.rest_rad, ghost_rad=angles(robot, l_sho_roll=-50.0))
        same = scene.draw(VIEWS["front"], robot.rest_rad)
    assert np.array_equal(alone, same)
    assert (np.abs(ghost.astype(int) - alone).max(-1) > 20).mean() > 0.003


def test_person_and_robot_stand_beside_each_other(robot: RobotModel, wave: Motion) -> None:
    with Scene(robot, SIZE) as scene:
        robot_alone = scene.draw(VIEWS["half"], robot.rest_rad)
        both = scene.draw(VIEWS["half"], robot.rest_rad, person_m=wave.joints_m[0].astype(float))
    changed = (np.abs(both.astype(int) - robot_alone).max(-1) > 20).any(0)
    assert changed[SIZE[0] // 2 :].sum() > 20 and not changed[: SIZE[0] // 3].any()


@pytest.mark.long
def test_the_nose_shows_where_the_person_looks(wave: Motion) -> None:
    joints_m = wave.joints_m[0].astype(float)
    with Scene(None, SIZE) as scene:
        ahead, left, again = (
            scene.draw(VIEWS["front"], person_m=joints_m, head_faces=np.array(faces))
            for faces in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
        )
    assert np.array_equal(ahead, again) and not np.array_equal(ahead, left)


def test_opengl_that_is_missing_is_named_with_its_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "nowhere")
    with pytest.raises(NoOpenGLError, match="apt install libegl1"):
        Scene(None, SIZE)


@pytest.mark.long
def test_a_sheet_shows_the_side_only_where_depth_matters(robot: RobotModel, wave: Motion) -> None:
    shown = cut(of_motion(wave, robot, "wave"), 0, 20)
    assert shown.person_m is not None
    flat = shown.person_m.copy()
    flat[:, :, 2] = flat[0, :, 2]
    punching = flat.copy()
    punching[:, JOINT_NAMES.index("left_wrist"), 2] += np.linspace(0.0, 2.0, len(flat))
    sheets = [
        contact_sheet([Performance(robot, 20.0, shown.robot_rad, shown.captions, person_m=person)])
        for person in (flat, punching)
    ]
    rows = [sheet.height // 348 for sheet in sheets]
    assert rows == [2, 4]


@pytest.mark.parametrize("n", [1, 2, 8, 99])
def test_a_sheet_goes_from_the_first_frame_to_the_last(n: int) -> None:
    assert len(instants(n)) == INSTANTS and instants(n)[0] == 0 and instants(n)[-1] == n - 1


@pytest.mark.parametrize("suffix", few_and_long([".mp4"], [".gif", ".mp4"]))
def test_a_film_has_every_frame_and_its_length(tmp_path: Path, robot: RobotModel, wave: Motion, suffix: str) -> None:
    shown = cut(of_motion(wave, robot, "wave"), 20, 26)
    file = tmp_path / f"x{suffix}"
    assert write_film(frames(shown, "both", "half", (160, 160)), file, 20.0) == 6
    if suffix == ".gif":
        with Image.open(file) as film:
            assert (film.n_frames, film.info["duration"], film.size) == (6, 50, (160, 160))  # type: ignore[attr-defined]
    else:
        av = pytest.importorskip("av")
        with av.open(str(file)) as film:
            pictures = [f.to_ndarray(format="rgb24") for f in film.decode(video=0)]
        assert len(pictures) == 6 and not np.array_equal(pictures[0], pictures[-1])


def test_a_film_that_fails_leaves_no_file(tmp_path: Path) -> None:
    def broken():
        yield Image.new("RGB", (32, 32))
        raise RuntimeError("the renderer is gone")

    with pytest.raises(RuntimeError):
        write_film(broken(), tmp_path / "x.gif", 20.0)
    with pytest.raises(FilmError, match="no pictures"):
        write_film([], tmp_path / "y.gif", 20.0)
    with pytest.raises(FilmError, match=r"allowed are \.gif and \.mp4"):
        write_film([], tmp_path / "z.avi", 20.0)
    assert list(tmp_path.iterdir()) == []


def test_a_run_is_sampled_at_the_films_rate(robot: RobotModel) -> None:
    shown = of_run(run_log(robot, [0] * 50 + [1] * 51), robot, fps=20.0)
    assert len(shown) == 21 and shown.duration_s == pytest.approx(1.0)
    assert shown.captions[0] == "holding" and shown.captions[-1] == "wave"
    assert shown.goal_rad is not None and shown.goal_rad[1][0] == pytest.approx(robot.rest_rad[0] + 0.05)


def test_plans_of_a_run_and_their_seams(robot: RobotModel) -> None:
    found = spans(run_log(robot, [0, 1, 1, 2, 2, 0, 7, 7]))
    assert [(round(s.start_s, 2), round(s.end_s, 2), s.text) for s in found] == [
        (0.01, 0.03, "wave"),
        (0.03, 0.05, "bow"),
        (0.06, 0.07, "plan 7"),
    ]


def test_the_joint_plot_is_one_panel_a_joint(robot: RobotModel, tmp_path: Path) -> None:
    log = run_log(robot, [0] * 5 + [1] * 30)
    log.plan_texts[1] = "wave 👋🏽"  # a sign that the font lacks is no warning, which a test would fail on
    joint_plot(log, robot, tmp_path / "deep" / "joints.png")
    with Image.open(tmp_path / "deep" / "joints.png") as picture:
        assert picture.width > 1000 and picture.height > 300


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (["--out", "x.bmp"], 2, "allowed: .png"),
        (["--out", "x.gif", "--width", "17"], 2, "even numbers from 160"),
        (["--out", "x.gif", "--from-s", "99"], 1, "no frame from 99"),
        (["--out", "x.gif", "--from-s", "3", "--to-s", "1"], 2, "an end after the beginning"),
    ],
)
def test_what_cannot_be_rendered_is_said(
    arguments: list[str],
    status: int,
    message: str,
    wave: Motion,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    wave.save_npz(tmp_path / "wave.npz")
    assert main(["render", "wave.npz", *arguments]) == status
    assert message in " ".join(capsys.readouterr().err.split())
    assert [file.name for file in tmp_path.iterdir()] == ["wave.npz"]


def test_a_performance_needs_a_frame(robot: RobotModel) -> None:
    assert issubclass(FilmError, DaemonError) and len(cut(of_run(run_log(robot, [0] * 30), robot, 20.0), 2)) == 4
