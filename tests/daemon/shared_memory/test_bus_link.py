import multiprocessing
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.shared_memory.bus_link import N_CYCLES, N_SETPOINTS, BusLink, BusRequest, BusState, Readiness

J = 5


@pytest.fixture
def link():
    made = BusLink.create(J)
    yield made
    made.close()


@pytest.fixture
def bus(link):
    """The same memory, as the bus process maps it."""
    return BusLink.attach(link.path, J)


def frames(n: int, start: float = 0.0) -> np.ndarray:
    return start + np.arange(n * J, dtype=np.float64).reshape(n, J) / 7


def publish(bus: BusLink, cycle: int) -> None:
    record = bus.cycles.next_record()
    record["cycle"], record["state"], record["goal_rad"] = cycle, BusState.PLAYING, cycle / 3
    bus.cycles.publish()


def test_setpoints_arrive_in_order_and_bit_for_bit(link, bus):
    sent = frames(40)
    assert link.setpoints.push(sent, 7, 100, link.epoch, last=True) == 40
    assert link.setpoints.queued_frames == 40
    for i in range(40):
        got = bus.take_setpoint()
        assert got is not None
        assert (got.plan_id, got.frame, got.last) == (7, 100 + i, i == 39)
        assert got.q_rad.tobytes() == sent[i].tobytes()
    assert bus.take_setpoint() is None
    assert link.setpoints.queued_frames == 0


def test_a_taken_setpoint_is_a_copy(link, bus):
    link.setpoints.push(frames(1), 1, 0, link.epoch, last=False)
    got = bus.take_setpoint()
    link.setpoints.push(frames(N_SETPOINTS, 5.0), 2, 0, link.epoch, last=False)
    assert got is not None and got.q_rad.tobytes() == frames(1)[0].tobytes()


def test_a_full_ring_takes_what_fits(link, bus):
    assert link.setpoints.push(frames(N_SETPOINTS + 30), 1, 0, link.epoch, last=True) == N_SETPOINTS
    assert link.setpoints.push(frames(3), 1, N_SETPOINTS, link.epoch, last=True) == 0
    for _ in range(N_SETPOINTS):
        got = bus.take_setpoint()
        assert got is not None and not got.last, "the plan goes on behind what fitted"
    assert link.setpoints.push(frames(3), 1, N_SETPOINTS, link.epoch, last=True) == 3


@given(st.lists(st.tuples(st.sampled_from(["push", "take", "take_back"]), st.integers(1, 60)), max_size=60))
def test_what_is_taken_back_never_arrives_and_the_rest_does_in_order(actions):
    """Against a list: the bus process takes what was pushed last and not taken back, whatever else was before."""
    link = BusLink.create(1)
    try:
        bus, queued, own, number = BusLink.attach(link.path, 1), [], 0, 0
        for action, most in actions:
            if action == "push":
                sent = np.arange(number, number + most, dtype=float)[:, None]
                own = link.setpoints.push(sent, 1, 0, link.epoch, last=False)
                queued, number = queued + sent[:own, 0].tolist(), number + own
            elif action == "take_back":
                n = min(most, own)  # the bus process may have come to some of them already
                assert link.setpoints.take_back(n) == max(0, n - len(queued))
                queued, own = queued[: len(queued) - min(n, len(queued))], 0
            else:
                for _ in range(most):
                    got = bus.take_setpoint()
                    assert (None if got is None else got.q_rad[0]) == (queued.pop(0) if queued else None)
            assert link.setpoints.queued_frames == len(queued)
    finally:
        link.close()


@pytest.mark.parametrize("kind", [BusRequest.STOP, BusRequest.ESTOP, BusRequest.PARK])
def test_a_stop_voids_frames_pushed_before_it_or_without_knowing_of_it(link, bus, kind):
    epoch = link.epoch
    link.setpoints.push(frames(5), 1, 0, epoch, last=False)
    link.request(kind)
    link.setpoints.push(frames(5), 1, 5, epoch, last=True)
    assert bus.take_setpoint() is None
    link.setpoints.push(frames(2), 2, 0, link.epoch, last=True)
    got = bus.take_setpoint()
    assert got is not None and got.plan_id == 2


def all_taken(bus: BusLink) -> list[BusRequest]:
    """Requests as the bus process takes them, one a cycle."""
    taken = []
    while (asked := bus.take_request()) is not None:
        taken.append(asked.kind)
    return taken


A, P, S, E, R, X = (BusRequest[k] for k in ("ARM", "PARK", "STOP", "ESTOP", "RESET", "SHUTDOWN"))


@pytest.mark.parametrize(
    ("given", "taken"),
    [
        ([], []),
        ([A], [A]),
        ([A, P], [A, P]),
        ([P, A, A], [P, A]),  # the newest of a kind
        ([A, P, S], [S]),  # a stop lets nothing move that was asked for before it
        ([S, A], [S, A]),
        ([R, A, E], [E]),  # an e-stop is not undone by what came before it
        ([E, R, A], [E, R, A]),
        ([R, E, R], [E, R]),
        ([E, R, E], [E]),
        ([R, S, A], [R, S, A]),
        ([X, E], [X, E]),
    ],
)
def test_requests_are_taken_once_in_order_without_those_that_are_void(link, bus, given, taken):
    for kind in given:
        link.request(kind)
    assert all_taken(bus) == taken
    assert all_taken(bus) == []


def test_a_request_of_before_the_bus_process_is_not_carried_out(link):
    """A bus process that starts anew must not arm because its predecessor was asked to."""
    link.request(BusRequest.ARM)
    assert all_taken(BusLink.attach(link.path, J)) == []


def test_cycles_are_read_by_several_readers_and_losses_counted(link, bus):
    for cycle in range(10):
        publish(bus, cycle)
    rows, index, lost = link.cycles.since(0)
    assert (list(rows["cycle"]), index, lost) == (list(range(10)), 10, 0)
    for cycle in range(10, N_CYCLES + 200):
        publish(bus, cycle)
    rows, fast, lost = link.cycles.since(index)
    assert lost > 0 and lost + len(rows) == N_CYCLES + 200 - 10
    assert list(rows["cycle"]) == list(range(10 + lost, N_CYCLES + 200))
    assert fast == link.cycles.count
    assert rows["goal_rad"][-1].tobytes() == np.full(J, (N_CYCLES + 199) / 3).tobytes()
    other = BusLink.attach(link.path, J)
    assert len(other.cycles.since(fast - 3)[0]) == 3


def test_rows_read_do_not_change_when_the_ring_goes_round(link, bus):
    publish(bus, 1)
    rows, _, _ = link.cycles.since(0)
    for cycle in range(2, N_CYCLES + 3):
        publish(bus, cycle)
    assert rows["cycle"][0] == 1


def test_readiness_and_reason_reach_the_front(link, bus):
    assert link.readiness is Readiness.STARTING
    bus.set_ready(Readiness.FAILED, "dxl:///dev/ttyUSB9: no such device; prüfe das Kabel")
    assert link.readiness is Readiness.FAILED
    assert link.text.endswith("prüfe das Kabel")
    bus.set_ready(Readiness.READY)
    assert (link.readiness, link.text) == (Readiness.READY, "")
    bus.set_text("x" * 100_000)
    assert 1000 < len(link.text) < 10_000
    bus.set_realtime(True, False)
    assert link.has_realtime == (True, False)


def test_the_heartbeat_ages(link, bus):
    link.heartbeat()
    first = bus.heartbeat_age_s
    assert 0 <= first < 5
    assert bus.heartbeat_age_s >= first


def test_wrong_memory_is_refused(link, tmp_path: Path):
    with pytest.raises(ValueError, match="expected"):
        BusLink.attach(link.path, J + 1)
    foreign = tmp_path / "foreign"
    foreign.write_bytes(bytes(link.path.stat().st_size))
    with pytest.raises(ValueError, match="mmmd"):
        BusLink.attach(foreign, J)


def test_closing_removes_the_file_and_only_the_owner_does(link, bus):
    bus.close()
    assert link.path.exists()
    link.close()
    assert not link.path.exists()
    link.close()


def _abandon(pipe) -> None:
    pipe.send(BusLink.create(J).path)
    pipe.recv()


def test_what_a_killed_daemon_left_is_removed_and_nothing_else(link):
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=_abandon, args=(there,), daemon=True)
    process.start()
    path = here.recv()
    BusLink.create(J).close()
    assert path.exists(), "its owner lives"
    process.kill()
    process.join(30)
    assert path.exists()
    BusLink.create(J).close()
    assert not path.exists()
    assert link.path.exists()


def _play(path: Path, n: int) -> None:
    bus, taken = BusLink.attach(path, J), 0
    while taken < n:
        got = bus.take_setpoint()
        if got is None:
            continue
        record = bus.cycles.next_record()
        record["cycle"], record["frame"], record["goal_rad"] = taken, got.frame, got.q_rad
        bus.cycles.publish()
        taken += 1


def test_across_processes_nothing_is_lost_or_torn(link):
    """A producer here, a consumer in another process, both at full speed: every frame arrives once, whole, in order."""
    n = 3000
    sent = np.repeat(np.arange(n, dtype=np.float64)[:, None], J, 1)
    process = multiprocessing.get_context("spawn").Process(target=_play, args=(link.path, n), daemon=True)
    process.start()
    pushed = 0
    while pushed < n and process.is_alive():
        pushed += link.setpoints.push(sent[pushed : pushed + 50], 1, pushed, link.epoch, last=False)
    process.join(30)
    assert process.exitcode == 0
    rows, _, lost = link.cycles.since(0)
    assert lost == 0
    assert list(rows["frame"]) == list(range(n))
    assert rows["goal_rad"].tobytes() == sent.tobytes()


def test_memory_of_a_killed_front_is_left_while_its_bus_process_lives():
    """It removed it; `ctl` then took the bus process for gone, ended, and nobody took an e-stop any more."""
    first = BusLink.create(2)
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    path = first.path.rename(first.path.with_name(first.path.name.replace(f"-{os.getpid()}-", f"-{gone.pid}-")))
    try:
        bus, ctl = BusLink.attach(path, 2), BusLink.attach(path, 2)
        bus.hold()
        BusLink.create(2).close()
        assert ctl.bus_lives
        os.close(bus._held)  # as when its process ends
        BusLink.create(2).close()
        assert not path.exists()
    finally:
        path.unlink(missing_ok=True)
