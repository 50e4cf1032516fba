import json
from pathlib import Path

import numpy as np
import pytest

from daemon.cli import main
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import LogError
from daemon.recording.mcap_log import LogWriter
from daemon.recording.mcap_reading import Log, read_log
from daemon.recording.replay import ReplayFaultError, replay, stretches
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from retarget.robot.loading import load_robot
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.faults import Fault, FaultSchedule
from sim.port import SimPort
from tests.support.harness import slow_reference
from tests.support.rig import rig, swing
from tests.support.robots import slow
from tests.support.sizes import few_and_long


def write(path: Path, robot, records, drop=()) -> Path:
    with path.open("wb") as f:
        writer = LogWriter(f, robot)
        for i, record in enumerate(records):
            if i not in drop:
                writer.cycle(record)
        writer.finish()
    return path


@pytest.fixture(scope="module")
def session():
    """A whole run: armed, moved, broken off by new targets beyond every limit, stopped, e-stopped, armed again, parked."""
    with rig() as r:
        random = np.random.default_rng(3)
        r.cycle(3)
        r.arm()
        r.push(swing(r.robot, 1.0))
        r.cycle(30)
        r.push(random.uniform(-3, 3, (40, r.robot.n_joints)), plan_id=2)
        r.cycle(65)
        r.link.request(BusRequest.STOP)
        r.cycle(15)
        r.push(swing(r.robot, 1.0), plan_id=3)
        r.cycle(20)
        r.link.request(BusRequest.ESTOP)
        r.cycle(5)
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        r.arm()
        r.push(swing(r.robot, 0.8), plan_id=4)
        r.cycle(43)
        r.link.request(BusRequest.PARK)
        r.cycle()
        r.until(BusState.LIMP)
        r.cycle(3)
        r.assert_limits_kept()
        return r.robot, r.records


@pytest.fixture
def log_file(session, tmp_path) -> Path:
    return write(tmp_path / "run.mcap", *session)


def play(log: Log, *faults: Fault, robot=None):
    """Replay in virtual time; the result, the simulator, and all goals that its servos received."""
    robot = robot or slow()
    clock = VirtualClock()
    sim = SimBus(robot, FaultSchedule(tuple(faults)))
    received: list[tuple[int, int]] = []
    sim.on_goal = lambda _t, servo_id, tick: received.append((servo_id, tick))
    link = BusLink.create(robot.n_joints)
    try:
        result = replay(log, robot, ServoBus.on_port(SimPort(sim, clock), robot.servos, clock), link, clock)
    finally:
        link.close()
    return result, sim, received


def test_the_servos_receive_the_same_goals_bit_for_bit(session, log_file):
    log = read_log(log_file)
    result, sim, received = play(log)
    logged = [c for c in log.cycles if c.torque]
    assert (result.goals, result.same, result.first_difference) == (len(logged), len(logged), "")
    assert result.stretches == 2
    assert sim.audit.report()["violations"] == 0
    assert not any(s.torque for s in sim.servos.values())
    for row, servo_id in enumerate(slow().servo_ids):
        got = [tick for found, tick in received if found == servo_id]
        for stretch in stretches(log):
            wanted = [c.goal_tick[row] for c in stretch]
            assert any(got[i : i + len(wanted)] == wanted for i in range(len(got))), (
                "at the servo itself, in this order"
            )


@pytest.mark.long
def test_twice_replayed_is_the_same_again(log_file):
    assert play(read_log(log_file))[2] == play(read_log(log_file))[2]


@pytest.mark.long
def test_a_changed_goal_is_found_and_named(log_file):
    log = read_log(log_file)
    changed = [c for c in log.cycles if c.torque][50]
    ticks = list(changed.goal_tick)
    ticks[4] += 1
    object.__setattr__(changed, "goal_tick", tuple(ticks))
    result, _, _ = play(log)
    assert not result.identical and result.goals - result.same == 1
    servo = slow().servo_ids[4]
    assert f"cycle {changed.cycle}, servo {servo} " in result.first_difference


def test_a_log_that_breaks_limits_is_held_back_by_the_gate(log_file):
    """Goals that no gate let through (a forged log, another robot file) reach no servo."""
    log = read_log(log_file)
    for cycle in [c for c in log.cycles if c.torque][50:60]:
        cycle.goal_rad[:] += 1.5
    result, sim, _ = play(log)
    assert not result.identical and result.first_difference
    assert sim.audit.report()["violations"] == 0


@pytest.mark.long
def test_behind_cycles_the_log_lost_the_robot_makes_a_new_start(session, tmp_path):
    log = read_log(write(tmp_path / "gap.mcap", *session, drop=range(120, 140)))
    result, sim, _ = play(log)
    assert result.missing_cycles == 20 and result.stretches == 3
    assert sim.audit.report()["violations"] == 0


@pytest.mark.long
def test_a_log_cut_off_is_played_as_far_as_it_goes(log_file):
    data = log_file.read_bytes()
    log_file.write_bytes(data[: len(data) * 3 // 5])
    try:
        log = read_log(log_file)
    except LogError:
        pytest.skip("one chunk only")
    result, sim, _ = play(log)
    assert log.is_cut and result.identical and result.goals > 0
    assert not any(s.torque for s in sim.servos.values())


def test_a_log_in_which_the_robot_was_limp_is_refused(session, tmp_path):
    robot, records = session
    limp = read_log(write(tmp_path / "limp.mcap", robot, records[:3]))
    with pytest.raises(LogError, match="nothing to replay"):
        play(limp)


def test_the_log_of_another_robot_is_refused(log_file):
    with pytest.raises(LogError, match=r"'reference'.*'op3'.*joints.*--robot"):
        play(read_log(log_file), robot=load_robot("op3"))


def test_interrupted_it_leaves_no_torque(log_file):
    robot, clock = slow(), VirtualClock()
    sim, link = SimBus(robot), BusLink.create(robot.n_joints)

    def interrupt(done: int) -> None:
        if done == 75:
            assert any(s.torque for s in sim.servos.values())
            raise KeyboardInterrupt

    try:
        bus = ServoBus.on_port(SimPort(sim, clock), robot.servos, clock)
        with pytest.raises(KeyboardInterrupt):
            replay(read_log(log_file), robot, bus, link, clock, interrupt)
    finally:
        link.close()
    assert not any(s.torque for s in sim.servos.values())


@pytest.mark.parametrize("kind", few_and_long(["trip"], ["trip", "unplug"]))
def test_a_fault_on_the_way_ends_the_replay(log_file, kind):
    with pytest.raises(ReplayFaultError, match="cycle") as caught:
        play(read_log(log_file), Fault(kind, start_s=2.0, servo_id=11 if kind == "trip" else None))
    assert caught.value.exit_status == 3


@pytest.mark.long
def test_the_command_gives_its_figures_as_json(log_file, capsys):
    assert main(["replay", str(log_file), "--robot", slow_reference(), "--json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert figures["identical"] and figures["goals"] == figures["same"] > 0
    assert figures["audit"]["violations"] == 0


def test_the_command_refuses_what_is_no_log(tmp_path, capsys):
    assert main(["replay", str(tmp_path / "none.mcap")]) == 2
    assert "no such file" in capsys.readouterr().err


def test_the_command_plays_a_cut_off_log_warns_and_says_how_it_went(session, tmp_path, capsys):
    robot, records = session
    path = tmp_path / "run.mcap"
    with path.open("wb") as f:
        writer = LogWriter(f, robot)
        for record in records[:100]:
            writer.cycle(record)
        writer.flush()
    assert main(["replay", str(path), "--robot", slow_reference(), "--json"]) == 0
    out, err = capsys.readouterr()
    assert "cut off" in err and json.loads(out)["log_is_cut"]
    for command in ("plot", "render"):
        picture = tmp_path / f"{command}.png"
        assert main([command, str(path), "--robot", slow_reference(), "--out", str(picture)]) == 0
        assert "warning" in (err := capsys.readouterr().err) and "cut off" in err and picture.is_file()
    assert main(["replay", str(path), "--robot", slow_reference()]) == 0
    assert "same goals" in capsys.readouterr().out
