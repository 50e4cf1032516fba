"""Disturbances of a daemon during which an e-stop is given: floods, connections, frozen and killed processes, a torn port."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
import time
from collections.abc import Callable, Generator
from contextlib import AbstractContextManager
from dataclasses import dataclass

import numpy as np

from daemon.bench.estop_rig import BUS, EstopRig
from daemon.bench.floods import flooded

ALIVE_BOUND_S, RESTART_BOUND_S = 1.0, 60.0
"""Seconds after which an e-stop counts as lost: with a live bus process and port; where one of these has to come back, for which
Python takes more than ten on a machine whose cores are all busy.
"""
LONGEST_WAIT_S = 0.6
"""Seconds of the longest wait from the disturbance to the request; each wait is drawn at random."""
SHORTEST_WAIT_S = 0.01
"""Seconds of the shortest wait: by then the last bytes of a process that was just killed have reached the servos."""
LONGEST_TEAR_S = 1.0
"""Seconds for which the port is torn, at most."""
LONGEST_FREEZE_S = 0.8
"""Seconds from the request until the frozen bus process continues, at most; the daemon would kill it about 1 s after the request.
"""

_Act = Callable[[EstopRig, np.random.Generator], AbstractContextManager[None]]


@dataclass(frozen=True)
class Disturbance:
    """One way to disturb the daemon.

    Attributes:
        act: context in which the e-stop is given; at its end frozen processes continue and floods stop.
        state: state of the robot before the disturbance.
        bound_s: seconds after which an e-stop counts as lost.
        bus_away: whether bus process or port are away, so that time is counted from their return as well.
        newcomer: whether the client connects only to give the e-stop; else it was connected before.
    """

    act: _Act
    state: str = "moving"
    bound_s: float = ALIVE_BOUND_S
    bus_away: bool = False
    newcomer: bool = False


def _wait(rng: np.random.Generator, longest_s: float = LONGEST_WAIT_S) -> None:
    """Sleep until a random instant."""
    time.sleep(float(rng.uniform(SHORTEST_WAIT_S, longest_s)))


@contextlib.contextmanager
def _nothing(_rig: EstopRig, rng: np.random.Generator) -> Generator[None]:
    _wait(rng)
    yield


def _flood(name: str) -> _Act:
    @contextlib.contextmanager
    def act(rig: EstopRig, rng: np.random.Generator) -> Generator[None]:
        with flooded(name, getattr(rig.endpoints, name)):
            _wait(rng)
            yield

    return act


@contextlib.contextmanager
def _connections(rig: EstopRig, rng: np.random.Generator) -> Generator[None]:
    name = str(rng.choice(["cmd", "ctl", "pub", "stream"]))
    with flooded("connections", getattr(rig.endpoints, name)):
        _wait(rng)
        yield


@contextlib.contextmanager
def _front_frozen(rig: EstopRig, rng: np.random.Generator) -> Generator[None]:
    os.kill(rig.front, signal.SIGSTOP)
    try:
        _wait(rng)
        yield
    finally:
        os.kill(rig.front, signal.SIGCONT)


@contextlib.contextmanager
def _front_killed(rig: EstopRig, rng: np.random.Generator) -> Generator[None]:
    rig.kill_front()
    _wait(rng)
    yield


@contextlib.contextmanager
def _bus_killed(rig: EstopRig, rng: np.random.Generator) -> Generator[None]:
    os.kill(rig.child(BUS), signal.SIGKILL)
    _wait(rng)
    rig.servos.bus.listen_anew()
    yield


@contextlib.contextmanager
def _bus_frozen(rig: EstopRig, rng: np.random.Generator) -> Generator[None]:
    """Freeze the bus process; in half of the trials it continues soon after the request, else the daemon kills and restarts it."""
    pid = rig.child(BUS)

    def goes_on() -> None:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGCONT)

    timer = threading.Timer(float(rng.uniform(0.0, LONGEST_FREEZE_S)), goes_on)
    os.kill(pid, signal.SIGSTOP)
    try:
        _wait(rng)
        rig.servos.bus.listen_anew()
        if rng.random() < 0.5:
            timer.start()
        yield
    finally:
        timer.cancel()
        goes_on()


@contextlib.contextmanager
def _starting(rig: EstopRig, rng: np.random.Generator) -> Generator[None]:
    """Kill all processes of a daemon during a motion; the servos have torque while the next daemon starts."""
    rig.kill_all()
    rig.start()
    rig.until_listening()
    rig.servos.bus.listen_anew()
    _wait(rng)
    yield


@contextlib.contextmanager
def _port_lost(rig: EstopRig, rng: np.random.Generator) -> Generator[None]:
    rig.servos.unplugged(True)
    try:
        _wait(rng, LONGEST_TEAR_S)
    finally:
        rig.servos.unplugged(False)
    rig.servos.bus.listen_anew()
    _wait(rng)
    yield


DISTURBANCES: dict[str, Disturbance] = {
    "flood_cmd": Disturbance(_flood("cmd")),
    "flood_ctl": Disturbance(_flood("ctl")),
    "flood_pub": Disturbance(_flood("pub")),
    "flood_stream": Disturbance(_flood("stream")),
    "connections_1000": Disturbance(_connections, newcomer=True),
    "front_frozen": Disturbance(_front_frozen),
    "front_killed": Disturbance(_front_killed),
    "bus_killed": Disturbance(_bus_killed, bound_s=RESTART_BOUND_S, bus_away=True),
    "bus_frozen": Disturbance(_bus_frozen, bound_s=RESTART_BOUND_S, bus_away=True),
    "start": Disturbance(_starting, bound_s=RESTART_BOUND_S, bus_away=True, newcomer=True),
    "arming": Disturbance(_nothing, state="arming"),
    "parking": Disturbance(_nothing, state="parking"),
    "port_lost": Disturbance(_port_lost, bound_s=RESTART_BOUND_S, bus_away=True),
}
