"""The examples of docs/examples do what they say, beside a whole daemon with simulated servos."""

from __future__ import annotations

import importlib.util
import json
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader

from mmm_core.model.tokens import pack_ids
from tests.support.harness import RunningDaemon, running_daemon
from tests.support.shipped import shipped_engine

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
TIMEOUT_S = 60.0
pytestmark = pytest.mark.realtime


@pytest.fixture(scope="module")
def daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningDaemon]:
    """A daemon with HTTP that records into `daemon.log`, which is whole once it has ended."""
    log = tmp_path_factory.mktemp("log") / "run.mcap"
    options = ("--http", "127.0.0.1:0", "--log", str(log))
    with running_daemon(
        *options, robot="reference"
    ) as running:  # the notebook takes the rate of the robot of that name
        yield running


@pytest.fixture
def port(daemon: RunningDaemon) -> str:
    end_s = time.monotonic() + TIMEOUT_S
    while not (found := re.search(r"at http://127\.0\.0\.1:(\d+)/", daemon.said)):
        assert time.monotonic() < end_s, daemon.said
        time.sleep(0.05)
    return found[1]


def run(program: str, *arguments: str) -> str:
    """What a program prints, which must end well; skipped where it is not installed."""
    if shutil.which(program) is None:
        pytest.skip(f"no {program} here")
    done = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_hello_by_curl(port: str) -> None:
    accepted, stopped = run("sh", str(EXAMPLES / "hello.sh"), f"http://127.0.0.1:{port}").splitlines()
    assert '"type":"accepted"' in accepted and '"verb":"stop"' in stopped


@pytest.mark.long
def test_hello_in_python(daemon: RunningDaemon) -> None:
    """It stops a robot that moves: it stopped one that had not set out yet."""
    said = run(sys.executable, str(EXAMPLES / "hello.py"), *daemon.at).splitlines()
    assert said[0].startswith("accepted") and said[-3].startswith("done")
    assert said[-1] == "stopped, the robot was moving"


@pytest.mark.long
def test_hello_by_websocket(port: str) -> None:
    """One text interrupts another, and a stop ends the third: each text hears its own end."""
    lines = run(sys.executable, str(EXAMPLES / "hello_websocket.py"), f"ws://127.0.0.1:{port}").splitlines()
    assert "clap cancelled say wave" in lines and "wave done" in [line.strip() for line in lines]
    assert lines[-2:] == ["halt ack ", "again cancelled stop"]


@pytest.mark.long
def test_hello_in_node(port: str) -> None:
    lines = run("node", str(EXAMPLES / "hello.mjs"), f"http://127.0.0.1:{port}").splitlines()
    assert lines[0].startswith("accepted") and lines[-1] == "ack stop"
    assert any(line.startswith("done") for line in lines)


@pytest.mark.long
def test_hello_in_c(port: str, tmp_path: Path) -> None:
    run("cc", "-Wall", "-Wextra", "-Werror", "-o", str(tmp_path / "hello"), str(EXAMPLES / "hello.c"))
    accepted, stopped = run(str(tmp_path / "hello"), port).splitlines()
    assert '"type":"accepted"' in accepted and '"verb":"stop"' in stopped


@pytest.mark.long
def test_hello_in_rust(port: str, tmp_path: Path) -> None:
    run("rustc", "--deny", "warnings", "-o", str(tmp_path / "hello"), str(EXAMPLES / "hello.rs"))
    accepted, stopped = run(str(tmp_path / "hello"), f"127.0.0.1:{port}").splitlines()
    assert '"type":"accepted"' in accepted and '"verb":"stop"' in stopped


@pytest.mark.long
def test_an_assistant_is_interrupted_and_stopped_by_voice(daemon: RunningDaemon) -> None:
    """Four sentences of a recording: the second interrupts the first as soon as somebody speaks, the third is a stop."""
    with daemon.armed():
        heard = [str(EXAMPLES / name) for name in ("heard.wav", "transcript.txt")]
        said = run(sys.executable, str(EXAMPLES / "assistant.py"), *heard, *daemon.at)
    told = dict(re.findall(r"'(.+?)': (.+)", said))
    assert list(told) == (EXAMPLES / "transcript.txt").read_text().splitlines()
    assert [line[:5] for line in said.splitlines()[:3]] == ["(list", "(list", "'wave"] and said.count("(list") == len(
        told
    )
    assert "was cancelled by cancel" in told["wave with your right hand"]
    assert told["please stop"] == "ack"
    assert "cancelled" not in told["nod twice"]


@pytest.mark.long
def test_a_story_says_what_became_of_each_scene(daemon: RunningDaemon) -> None:
    with daemon.armed():
        lines = run(sys.executable, str(EXAMPLES / "story.py"), *daemon.at).splitlines()
    assert [line[:2] for line in lines[:-1]] == ["1.", "2.", "3.", "4.", "5."]
    assert "left out" in lines[2] and not any("left out" in line for line in lines[:2] + lines[3:])
    assert lines[-1].startswith("the end")


@pytest.mark.long
def test_a_language_model_moves_the_robot_and_a_person_stops_it(daemon: RunningDaemon) -> None:
    """By the official SDK's client: tools, a result to repeat, a refusal with its reason, a stop that ends a motion under way."""
    if importlib.util.find_spec("mcp") is None:
        pytest.skip("the official SDK of MCP is not installed")
    with daemon.armed() as robot:
        lines = run(sys.executable, str(EXAMPLES / "language_model.py"), *daemon.at).splitlines()
        assert robot.wait_for("holding", timeout_s=10).command is None
    assert lines[0] == "tools: say, gesture, story, cancel, gestures, look, stop, estop, status"
    told = dict(re.findall(r"^(\w+ (?:answers|refused)): (.+)", "\n".join(lines), re.MULTILINE))
    assert re.fullmatch(r"done after [\d.]+ s; seen on the robot: .+", told["say answers"])
    assert "needs the legs" in told["say refused"]
    assert told["story answers"] == "the command was cancelled by stop" and "moving" in told["stop answers"]
    assert lines.index("person: Stop!") < next(i for i, line in enumerate(lines) if line.startswith("story "))


@pytest.mark.long
def test_poses_that_nobody_taught_are_named(daemon: RunningDaemon) -> None:
    command = [sys.executable, str(EXAMPLES / "inbetween_taught.py"), "arm_out", "arm_up", *daemon.at]
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
    assert done.returncode == 1 and "arm_out" in done.stdout and "your own gestures: none" in done.stdout


@pytest.mark.long
@pytest.mark.parametrize("recording", [False, True])
def test_tokens_of_a_motion(recording: bool, tmp_path: Path) -> None:
    """Tokens of a generated motion are its own; a recording of joints alone is encoded."""
    motion = shipped_engine().generate("clap three times", seed=7).motion
    if recording:
        np.save(tmp_path / "clap.npy", motion.joints_m)
    else:
        motion.save_npz(tmp_path / "clap.npz")
    file = tmp_path / ("clap.npy" if recording else "clap.npz")
    said = run(sys.executable, str(EXAMPLES / "tokens.py"), str(file), str(tmp_path / "tokens.npy"))
    tokens, off_mm = np.load(tmp_path / "tokens.npy"), float(said.partition("are ")[2].split()[0])
    assert tokens.shape == (len(motion.tokens), 3) and tokens.max() < 2048
    if recording:
        assert off_mm < 60
    else:
        assert off_mm < 0.1 and (pack_ids(tokens, 2048) == motion.tokens).all()


@pytest.fixture(scope="module")
def log(daemon: RunningDaemon) -> Path:
    """The log of a run with a gesture in it; the tests that read it come last, as the daemon has ended by then."""
    with daemon.armed() as robot:
        robot.gesture("wave_right")
        path = Path(robot.status().recording)
    assert daemon.terminate() == 0
    return path


@pytest.mark.long
def test_figures_of_a_log(log: Path) -> None:
    table = run(sys.executable, str(EXAMPLES / "log_figures.py"), str(log))
    assert table.startswith("reference, ") and table.count("\n") == 2 + 16
    right, left = (float(re.search(rf"{side}_elbow +([\d.]+)", table)[1]) for side in ("right", "left"))
    assert right > left


@pytest.mark.long
def test_a_log_in_a_notebook(log: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """The test runs the cells in turn, as a reader does; the notebook is kept without outputs."""
    import matplotlib.pyplot  # slow to import, and every worker of xdist collects this file

    notebook = json.loads((EXAMPLES / "log.ipynb").read_text())
    assert notebook["nbformat"] == 4 and all(cell["id"] for cell in notebook["cells"])
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert not any(cell["outputs"] or cell["execution_count"] for cell in cells)
    monkeypatch.setenv("RUN", str(log))
    names: dict[str, Any] = {}
    matplotlib.use("Agg")
    for cell in cells:
        exec(compile("".join(cell["source"]), f"cell {cell['id']}", "exec"), names)
    figure = names["fig"]
    assert [len(axis.lines) for axis in figure.axes] == [2] * 4
    matplotlib.pyplot.close(figure)
    joints, texts = names["joints"], names["texts"]
    assert joints.index[0].startswith("right_") and len(joints) == 16
    assert joints["range_deg"]["right_elbow"] > joints["range_deg"]["left_elbow"]
    assert joints["headroom"].between(0, 1).all() and joints["mean_error_deg"].max() < 20
    assert "wave_right" in set(texts["text"]) and texts["seconds"].max() > 1
    assert 0 < names["lag_ms"] <= 200 and "reference: " in capsys.readouterr().out


@pytest.mark.long
def test_the_layout_for_foxglove_shows_what_a_log_holds(log: Path) -> None:
    """Every panel stands in the layout, every path has values in the log, the log panel lines, and the 3D panel its frame."""
    layout = json.loads((EXAMPLES / "foxglove_layout.json").read_text())
    panels, variables = layout["configById"], layout["globalVariables"]
    assert sorted(leaves(layout["layout"])) == sorted(panels)

    with log.open("rb") as f:
        messages: dict[str, list[Any]] = {}
        schemas: dict[str, str] = {}
        for schema, channel, message in make_reader(f).iter_messages():
            messages.setdefault(channel.topic, []).append(json.loads(message.data))
            schemas[channel.topic] = schema.name if schema else ""

    paths = {path["value"] for panel in panels.values() for path in panel.get("paths", ())}
    assert {p.partition(".")[0] for p in paths} == {"/joint_states", "/joint_goals", "v1/state", "v1/event"}
    for path in paths:
        topic, _, fields = path.partition(".")
        found = [value for message in messages[topic] for value in values_at(message, fields, variables)]
        assert found, path
        numbers = topic.startswith("/")
        assert all(isinstance(value, float if numbers else str) for value in found), path
        assert len(set(found)) > 1, path  # something moved, the state changed, there were events of several types

    assert schemas[panels["RosOut!log"]["topicToRender"]] == "foxglove.Log" and messages["/log"]
    frames = {t[end] for m in messages["/tf"] for t in m["transforms"] for end in ("parent_frame_id", "child_frame_id")}
    assert schemas["/tf"] == "foxglove.FrameTransforms" and panels["3D!robot"]["followTf"] in frames


def leaves(node: str | dict[str, Any]) -> list[str]:
    """Ids of the panels in a layout's tree."""
    return [node] if isinstance(node, str) else [*leaves(node["first"]), *leaves(node["second"])]


def values_at(message: Any, fields: str, variables: dict[str, str]) -> list[Any]:
    """What Foxglove plots of a message: fields, whole slices `[:]`, and filters by a variable (its message path syntax)."""
    found = [message]
    for field in fields.split("."):
        parsed = re.fullmatch(r"(\w+)(\[:\])?(?:\{(\w+)==\$(\w+)\})?", field)
        assert parsed is not None, field
        name, is_slice, key, variable = parsed.groups()
        found = [m[name] for m in found if name in m]
        found = [item for items in found for item in items] if is_slice else found
        found = [item for item in found if key is None or item[key] == variables[variable]]
    return found
