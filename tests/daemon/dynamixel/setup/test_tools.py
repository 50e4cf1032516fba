"""The tools for servos: scan, settings of single servos with their guards, and the commands."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from daemon.cli import main
from daemon.dynamixel.registers.models import MODEL_NUMBERS, MODELS
from daemon.dynamixel.scan import scan
from daemon.dynamixel.setup.single_servo import find
from daemon.errors import CommandError, LinkTimeoutError
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.port import SimPort
from sim.pty import PtyServer
from tests.support.factory_bus import ROBOT
from tests.support.servo_emulator import FakePort, FakeServo, fake

pytestmark = pytest.mark.realtime


# Scan.


def test_a_scan_finds_every_servo_at_its_baud_and_in_its_protocol() -> None:
    clock = VirtualClock()
    at = {57_600: ("XL330-M288", "XM430-W350"), 1_000_000: ("AX-12A", "MX-28", "2XL430-W250")}
    seen: list[tuple[int, float, float]] = []

    def open_at(baud: int) -> FakePort:
        servos = [FakeServo(MODELS[MODEL_NUMBERS[n]], 3 * i) for i, n in enumerate(at.get(baud, ()), 1)]
        return FakePort(clock, servos, baud)

    result = scan(open_at, clock, bauds=(57_600, 115_200, 1_000_000), on_progress=lambda *a: seen.append(a))
    assert [(f.baud, f.protocol, f.servo_id, f.model_name) for f in result.found] == [
        (57_600, 2.0, 3, "XL330-M288"), (57_600, 2.0, 6, "XM430-W350"), (1_000_000, 2.0, 9, "2XL430-W250"),
        (1_000_000, 1.0, 3, "AX-12A"), (1_000_000, 1.0, 6, "MX-28"),
    ]  # fmt: skip
    assert {f.firmware for f in result.found} == {52} and result.garbled_bauds == ()
    assert seen[0] == (57_600, 2.0, 0.0) and seen[-1] == (1_000_000, 1.0, 1.0)
    assert clock.now_s() < 40


def test_two_servos_with_one_id_are_seen_in_a_scan() -> None:
    far, _, clock = fake("XM430-W350", "XM430-W350")
    far.servos[2].doubled = True
    result = scan(lambda _baud: far, clock, bauds=(1_000_000,), protocols=(2.0,))
    assert [f.servo_id for f in result.found] == [1, 2] and result.garbled_bauds == (1_000_000,)


# Single servos.


def test_settings_are_written_read_back_and_guarded() -> None:
    far, _, clock = fake("XM430-W350", "AX-12A")
    one, old = find(far, clock, 1), find(far, clock, 2)
    assert (one.model.name, old.model.name, old.firmware) == ("XM430-W350", "AX-12A", 52)
    one.set("return_delay_time", 0)
    old.set("punch", 40)
    assert far.servos[1].get("return_delay_time") == 0 and far.servos[2].get("punch") == 40
    for servo, item, value, said in (
        (one, "goal_position", 5, "the daemon's alone"), (one, "torque_enable", 1, "the daemon's alone"),
        (one, "bus_watchdog", 10, "the daemon's alone"),
        (one, "shutdown", 200, r"outside \[0, 63\] of XM430-W350"), (one, "id", 5, "mmmd servo id"),
        (one, "baud_rate", 3, "mmmd servo baud"), (one, "elan", 3, "no item 'elan'"), (old, "moving_speed", 9, "the daemon's"),
        (one, "present_position", 3, "read only"),
    ):  # fmt: skip
        with pytest.raises(CommandError, match=said):
            servo.set(item, value)
    far.servos[1].set("torque_enable", 1)
    with pytest.raises(CommandError, match=r"only with torque off.*mmmd park"):
        one.set("return_delay_time", 5)
    with pytest.raises(CommandError, match="lets its joint fall"):
        one.reboot(drop=False)
    one.reboot(drop=True)
    with pytest.raises(CommandError, match="knows no reboot"):
        old.reboot(drop=True)
    with pytest.raises(LinkTimeoutError, match="mmmd scan"):
        find(far, clock, 77)


@pytest.mark.parametrize(
    ("servo_id", "item", "value"), [(1, "torque_enable", 0), (2, "torque_enable", 0), (2, "torque_limit", 99)]
)
def test_a_joint_that_is_held_is_let_go_only_when_it_is_said(servo_id: int, item: str, value: int) -> None:
    """`mmmd servo set 3 torque_enable 0` dropped an arm, which `reboot` refuses to do unasked."""
    far, _, clock = fake("XM430-W350", "AX-12A")
    one, there = find(far, clock, servo_id), far.servos[servo_id]
    if servo_id == 2:
        there.set("torque_limit", 500)
    there.set("torque_enable", 1)
    before = there.get(item)
    with pytest.raises(CommandError, match=rf"holds torque: '{item}' = {value} lets its joint fall; --drop"):
        one.set(item, value)
    assert there.get(item) == before
    one.set(item, value, drop=True)
    assert there.get(item) == value
    there.set("torque_enable", 0)
    one.set(item, 0)


def test_an_id_is_changed_only_when_it_is_free_and_the_new_one_answers() -> None:
    far, _, clock = fake("XM430-W350", "XM430-W350")
    with pytest.raises(CommandError, match="id 2 is taken"):
        find(far, clock, 1).set_id(2)
    with pytest.raises(CommandError, match="allowed are 0 to 252"):
        find(far, clock, 1).set_id(253)
    find(far, clock, 1).set_id(7)
    assert find(far, clock, 7).get("id") == 7
    with pytest.raises(LinkTimeoutError):
        find(far, clock, 1)


@pytest.mark.parametrize("servo_id", [1, 3])
def test_an_id_is_changed_and_a_reboot_waited_for_on_simulated_servos(servo_id: int) -> None:
    clock = VirtualClock()
    port = SimPort(SimBus(ROBOT), clock)
    find(port, clock, servo_id).set_id(40)
    one = find(port, clock, 40)
    one.set("led", 1)
    one.reboot(drop=False)
    assert one.get("led") == 0 and clock.now_s() < 1.0, "it is back, and its RAM is as after power on"


@pytest.mark.parametrize("kind", ["id", "baud"])
def test_a_servo_that_confirms_as_its_new_self_is_looked_for_there(kind: str) -> None:
    """Some answer a new id or baud at once under it: no answer comes from the servo that was asked."""
    far, _, clock = fake("XM430-W350")
    one = find(far, clock, 1)
    far.spoil = lambda raw, _servo_id: b"" if far.writes[-1][7] == 3 else raw
    if kind == "id":
        one.set_id(7)
        assert find(far, clock, 7).get("id") == 7
    else:
        one.set_baud(2_000_000)
        assert far.servos[1].get("baud_rate") == 4


def test_a_baud_that_the_model_has_not_is_refused() -> None:
    far, _, clock = fake("XL330-M288", "AX-12A")
    with pytest.raises(CommandError, match="no 4500000 baud"):
        find(far, clock, 1).set_baud(4_500_000)
    find(far, clock, 1).set_baud(2_000_000)
    find(far, clock, 2).set_baud(500_000)
    assert far.servos[1].get("baud_rate") == 4 and far.servos[2].get("baud_rate") == 3


# Commands.


def test_a_servo_is_given_another_baud_and_heard_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    server = PtyServer(SimBus(ROBOT), tmp_path / "servos")
    thread = threading.Thread(target=server.serve)
    thread.start()
    url = f"dxl://{tmp_path}/servos?baud="
    try:
        assert main(["servo", "baud", "3", "57600", "--bus", url + "1000000"]) == 0
        assert "its baud is now 57600; it answers there" in capsys.readouterr().out
        assert main(["servo", "get", "3", "id", "--bus", url + "1000000"]) == 1
        assert f"at 1000000 baud on {url}1000000" in capsys.readouterr().err, "the URL as it was given"
    finally:
        server.stop()
        thread.join(5)
        server.close()


@pytest.mark.parametrize("name", ["scan", "doctor", "servo", "calibrate"])
def test_every_tool_says_how_to_use_it(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([name, "--help"]) == 0
    assert "Example" in capsys.readouterr().out


def test_the_tools_on_simulated_servos(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["servo", "get", "3", "present_temperature", "--bus", "sim://", "--json"]) == 0
    assert '"present_temperature": ' in capsys.readouterr().out
    assert main(["servo", "set", "3", "led", "1", "--bus", "sim://"]) == 0
    assert main(["servo", "set", "3", "led", "--bus", "sim://"]) == 2
    assert main(["servo", "id", "3", "x", "--bus", "sim://"]) == 2
    assert main(["calibrate", "--bus", "sim://"]) == 2
    assert "--limp" in capsys.readouterr().err
    assert main(["doctor", "--bus", "sim://", "--json"]) == 0
    assert '"rate"' in capsys.readouterr().out
    assert main(["doctor", "--bus", "dxl:///dev/ttyNONE"]) == 1
    assert main(["scan", "/dev/ttyNONE"]) == 1
    assert main(["scan", "/dev/ttyNONE", "--protocol", "3.0"]) == 2
