"""The ROS 2 packages of docs/examples/ros2, as far as Debian goes: manifests, build of the bridge, action, launch file.

ROS itself is not in Debian: the bridge's code runs against a stand-in (`tests/support/ros_stand_in.py`) and a real daemon. The
classes of the action are not built (that takes rosidl_default_generators), and nothing is launched.
"""

from __future__ import annotations

import ast
import importlib.util
import re
import shutil
import subprocess
import sys
import threading
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import pytest

from tests.support import ros_stand_in
from tests.support.harness import MMMD, RunningDaemon, running_daemon

PACKAGES = Path(__file__).parents[2] / "docs" / "examples" / "ros2"
BRIDGE, INTERFACES = PACKAGES / "mmmd_bridge", PACKAGES / "mmmd_interfaces"
SYSTEM_PYTHON = "/usr/bin/python3"
pytestmark = [pytest.mark.realtime, pytest.mark.timeout(120)]


def with_debian(module: str, code: str, *arguments: str) -> str:
    """The output of a program that needs a Python package of Debian; the test is skipped where the package is not installed."""
    found = subprocess.run([SYSTEM_PYTHON, "-c", f"import {module}"], capture_output=True, check=False, timeout=30)
    if found.returncode:
        pytest.skip(f"Debian's Python has no {module} here")
    done = subprocess.run(
        [SYSTEM_PYTHON, "-c", code, *arguments], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("package", [BRIDGE, INTERFACES], ids=lambda package: package.name)
def test_the_manifest_is_valid(package: Path) -> None:
    code = (
        "import sys; from catkin_pkg.package import parse_package; package = parse_package(sys.argv[1]); found = []\n"
        "package.validate(warnings=found); print(package.name, package.get_build_type(), found)"
    )
    build_type = "ament_cmake" if package == INTERFACES else "ament_python"
    assert with_debian("catkin_pkg", code, str(package)) == f"{package.name} {build_type} []\n"


@pytest.mark.long
def test_the_bridge_builds_and_installs_what_ros_looks_for(tmp_path: Path) -> None:
    if shutil.which("colcon") is None:
        pytest.skip("no colcon here")
    shutil.copytree(BRIDGE, tmp_path / "src" / "mmmd_bridge")
    done = subprocess.run(
        ["colcon", "build", "--base-paths", "src/mmmd_bridge"],
        cwd=tmp_path, capture_output=True, text=True, check=False, timeout=100, env={"PATH": "/usr/bin:/bin"},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    installed = tmp_path / "install" / "mmmd_bridge"
    for file in (
        "lib/mmmd_bridge/bridge", "share/mmmd_bridge/package.xml", "share/mmmd_bridge/launch/robot.launch.xml",
        "share/ament_index/resource_index/packages/mmmd_bridge",
    ):  # fmt: skip
        assert (installed / file).is_file(), file
    assert list(installed.glob("lib/python3*/site-packages/mmmd_bridge/bridge.py"))


def test_the_action_is_read_by_the_generators_own_parser(tmp_path: Path) -> None:
    code = """
import sys
import threading
from pathlib import Path
from rosidl_adapter.action import convert_action_to_idl
from rosidl_parser.definition import Action, IdlLocator
from rosidl_parser.parser import parse_idl_file
package, out = Path(sys.argv[1]), Path(sys.argv[2])
convert_action_to_idl(package, package.name, Path("action/Say.action"), out)
action, = parse_idl_file(IdlLocator(out, Path("Say.idl"))).content.get_elements_of_type(Action)
for part in (action.goal, action.result, action.feedback):
    print(*(member.name for member in part.structure.members))
"""
    printed = with_debian("rosidl_parser", code, str(INTERFACES), str(tmp_path)).splitlines()
    ours = ros_stand_in.action_of(INTERFACES / "action" / "Say.action")
    assert [tuple(line.split()) for line in printed[-3:]] == [
        ours.Goal.fields, ours.Result.fields, ours.Feedback.fields
    ]  # fmt: skip


def test_what_the_bridge_imports_is_what_its_manifest_depends_on() -> None:
    tree = ast.parse((BRIDGE / "mmmd_bridge" / "bridge.py").read_text())
    modules = {n.module for n in ast.walk(tree) if isinstance(n, ast.ImportFrom) and n.module}
    modules |= {a.name for n in ast.walk(tree) if isinstance(n, ast.Import) for a in n.names}
    roots = {module.partition(".")[0] for module in modules} - {"daemon"} - set(sys.stdlib_module_names)
    manifest = ElementTree.parse(BRIDGE / "package.xml")
    assert roots == {d.text for d in manifest.iter("exec_depend")} - {"launch_xml", "launch_ros"}


def test_the_launch_file_names_what_there_is() -> None:
    """Every variable is an argument, every parameter is declared by the node, every option is one of `mmmd run`."""
    launch = ElementTree.parse(BRIDGE / "launch" / "robot.launch.xml")
    given = {arg.get("name") for arg in launch.iter("arg")}
    used = re.findall(r"\$\(var (\w+)\)", ElementTree.tostring(launch.getroot(), "unicode"))
    assert set(used) == given
    (node,) = launch.iter("node")
    assert f'"{node.get("exec")} = {node.get("pkg")}.' in (BRIDGE / "setup.py").read_text()
    assert {p.get("name") for p in launch.iter("param")} == {"cmd", "ctl", "pub"}
    (command,) = (executable.get("cmd", "") for executable in launch.iter("executable"))
    told = subprocess.run([*MMMD, "run", "--help"], capture_output=True, text=True, check=True, timeout=30).stdout
    assert command.startswith("mmmd run ") and all(option in told for option in re.findall(r"--\w+", command))


@pytest.fixture(scope="module")
def daemon():
    with running_daemon() as running:
        yield running


@pytest.fixture
def bridge(daemon: RunningDaemon, monkeypatch: pytest.MonkeyPatch):
    """The bridge's module, with ROS stood in for."""
    at = {name: getattr(daemon.endpoints, name) for name in ("cmd", "ctl", "pub")}
    ended = ros_stand_in.installed(monkeypatch, INTERFACES / "action" / "Say.action", at)
    spec = importlib.util.spec_from_file_location("bridge", BRIDGE / "mmmd_bridge" / "bridge.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    yield module
    ended.set()
    for thread in threading.enumerate():
        if thread.name == "joint states":
            thread.join(10)


@pytest.mark.long
def test_the_bridge_says_cancels_stops_and_publishes(bridge: ModuleType, daemon: RunningDaemon) -> None:
    with daemon.armed() as robot:
        node = bridge.Bridge()
        server = ros_stand_in.ActionServer.made

        def goal(text: str) -> ros_stand_in.Goal:
            return ros_stand_in.Goal(server.action.Goal(text=text, tempo=1.0))

        played = goal("wave")
        result = server.execute(played)
        assert result.done and played.outcome == "succeed" and "right" in result.how
        assert [f.stage for f in played.feedback] == ["moving"]

        refused = goal("do a somersault")
        assert not server.execute(refused).done and refused.outcome == "abort"

        cancelled = goal("wave for nine seconds")
        cancelled.is_cancel_requested = True
        result = server.execute(cancelled)
        assert cancelled.outcome == "canceled" and result.how == "cancelled"

        # The cancelled motion says "moving" until it stands.
        robot.wait_for("holding", "idle", timeout_s=10)
        robot.gesture("wave_right", loop=True, wait=False)
        robot.wait_for("moving", timeout_s=10)
        reply = node.services["stop"](None, ros_stand_in.message("Response", "success", "message")())
        assert reply.success and "moving" in reply.message
        assert robot.wait_for("holding", timeout_s=10).command is None

        assert node.has_published.wait(10)
        state = robot.status()
        assert node.published[-1].name == state.joint_names and len(node.published[-1].position) == len(state.goal_rad)
        assert node.published[-1].header.stamp == "now"
