"""Front half and bus half of the daemon on one virtual clock: what is played, without processes, sockets or a model."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

from daemon.playback.bus_follower import BusFollower
from daemon.playback.playback import Playback
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.poses.layers import Layers
from daemon.state.bus_view import BusView
from daemon.state.ledger import Entry, Ledger, Route
from daemon.state.machine import RobotState, StateMachine
from daemon.wire.event_base import Event
from daemon.wire.requests import Command, Say
from sim.clock import VirtualClock
from sim.faults import Fault
from tests.support.rig import Rig, rig

ROUTE = Route((b"test",), once=False)


class _LoopClock:
    """A virtual clock for an event loop: waiting lets others move it."""

    def __init__(self, clock: VirtualClock) -> None:
        self._clock = clock

    def now_s(self) -> float:
        return self._clock.now_s()

    def sleep_until(self, t_s: float) -> None:
        self._clock.sleep_until(t_s)

    async def sleep(self, seconds: float) -> None:
        due_s = self.now_s() + seconds
        while self.now_s() < due_s:
            await asyncio.sleep(0)


class _Worker(ThreadPoolExecutor):
    """Carries work out at once, in the event loop's thread, while `meanwhile` lets virtual time pass."""

    def __init__(self, meanwhile: Callable[[], None]) -> None:
        super().__init__(1)
        self._meanwhile = meanwhile

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            result = fn(*args, **kwargs)
            self._meanwhile()
            future.set_result(result)
        except BaseException as error:
            future.set_exception(error)
        return future


class FrontRig:
    """Playback over a rig. `tick` is one bus period and one tick of the front.

    Attributes:
        late_cycles: bus periods that each piece of work in a worker thread takes.
        events: all events so far.
    """

    def __init__(self, bus: Rig, idle: str = "off") -> None:
        self.bus, self.late_cycles = bus, 1
        clock = _LoopClock(bus.clock)
        view = BusView(bus.link, bus.robot, clock)
        self.buffer = SetpointBuffer(bus.robot, bus.link, view, 0.1, clock=clock)
        self.follower = BusFollower(bus.link, view, self.buffer, StateMachine())
        self.events: list[Event] = []
        self.ledger = Ledger(lambda _route, event: self.events.append(event), lambda _event: None)
        self.layers = Layers(idle)
        self.playback = Playback(self.buffer, self.follower, self.ledger, self.layers, clock=clock)
        self._now_s = clock.now_s

    def run(self, work: Callable[[], Any]) -> None:
        """Run a coroutine function of a test on an armed robot."""

        async def armed() -> None:
            asyncio.get_running_loop().set_default_executor(_Worker(self._cycle_late))
            self.bus.arm()
            self._cycle(1)
            self.playback.idle(free=False)  # stillness counts from here
            await work()

        asyncio.run(armed())

    def _cycle(self, n: int) -> None:
        for _ in range(n):
            self.bus.cycle()
            self.follower.update()

    def _cycle_late(self) -> None:
        self._cycle(self.late_cycles)

    async def tick(self, n: int = 1) -> None:
        for _ in range(n):
            self._cycle(1)
            self.playback.watch(finish_loop=False, is_to_last=True)
            self.playback.idle(free=True)
            for _ in range(5):  # tasks that the tick began come to where they wait for the clock
                await asyncio.sleep(0)

    async def until(self, what: Callable[[], bool], within: int = 3000) -> None:
        """Tick until a condition holds."""
        for _ in range(within):
            if what():
                return
            await self.tick()
        raise AssertionError(f"not within {within} cycles; events: {self.kinds}")

    @property
    def kinds(self) -> list[str]:
        """Events so far, as type and id."""
        return [f"{event.__struct_config__.tag} {event.id}" for event in self.events]

    @property
    def moves(self) -> bool:
        return self.follower.machine.state is RobotState.MOVING

    def entry(self, command_id: str, request: Command | None = None) -> Entry:
        """A command that has just come."""
        request = request or Say(text=command_id, id=command_id)
        entry = self.ledger.open(request, ROUTE, round(self._now_s() * 1e9))
        assert entry is not None
        return entry


@contextmanager
def front_rig(*faults: Fault, idle: str = "off", name: str = "reference") -> Iterator[FrontRig]:
    with rig(name, *faults) as bus:
        yield FrontRig(bus, idle)
