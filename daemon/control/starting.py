"""Starts the bus process: opens and verifies the bus, and names every reason why the robot cannot be driven."""

from __future__ import annotations

import logging
from collections.abc import Callable

from daemon.control.control_loop import ControlLoop
from daemon.dynamixel.ports.adapter import latency_advice
from daemon.dynamixel.servo_bus import ServoBus
from daemon.dynamixel.setup.checks import ADVISED, NEEDED, check_servos, require_needed
from daemon.errors import CommandError, ConfigError, DaemonError
from daemon.host.clock import Clock
from daemon.shared_memory.bus_link import BusLink, Readiness
from daemon.shared_memory.request_words import ESTOPS, BusRequest
from retarget.robot.robot import RobotModel

log = logging.getLogger(__name__)

_LEVELS = {NEEDED: logging.ERROR, ADVISED: logging.DEBUG}
Opener = Callable[[], ServoBus]


AFTER_LOSS = "the bus process was lost and is back; servos may still hold: `mmmd reset` makes them limp"
_HELD_BEFORE = "servo {} had torque before it was armed: who drove it may have been cut off; `mmmd reset` makes it limp"


def start(
    robot: RobotModel, open_bus: Opener, link: BusLink, clock: Clock, *, after_loss: bool = False
) -> ControlLoop | None:
    """Open and verify the bus; return a `ControlLoop`, or None with the reason in the link when the robot cannot be driven.

    With `after_loss`, or where a servo has torque already, the loop starts in a latched fault: no joint may move by itself, and no
    servo may count as limp that is not. A pending e-stop or torque-off request cuts torque before anything else.
    """
    try:
        bus = open_bus()
    except DaemonError as error:
        refused = isinstance(
            error, (CommandError, ConfigError)
        )  # raised before any byte was sent: the URL is wrong, not the bus
        link.set_ready(Readiness.REFUSED if refused else Readiness.FAILED, str(error))
        return None
    try:
        _cut_what_is_owed(bus, link)
        bus.verify()
        _cut_what_is_owed(bus, link)
        findings = check_servos(bus, robot)
        _cut_what_is_owed(bus, link)
        for f in findings:
            log.log(
                _LEVELS[f.severity],
                "servo %d (%s): %s %s, should be %s; %s",
                f.servo_id,
                f.joint_name,
                f.item,
                f.found,
                f.expected,
                f.remedy,
            )
        require_needed(findings)
        plan = bus.plan()
        if not plan.require(robot.bus.rate_hz):
            log.warning("the cycle does not fit its period:\n%s", "\n".join(plan.lines(robot.bus.rate_hz)))
        for port in bus.ports:
            advice = latency_advice(getattr(port, "device", ""))
            if advice:
                log.warning("%s", advice)
        bus.exchange(None)
        _cut_what_is_owed(bus, link)
        holding = ", ".join(str(i) for i in bus.ids if bus.read_item(i, "torque_enable"))
    except DaemonError as error:
        bus.close()
        link.set_ready(Readiness.FAILED, str(error))
        return None
    streamer = ControlLoop(robot, bus, link, clock)
    link.setpoints.drop()
    why = AFTER_LOSS if after_loss else _HELD_BEFORE.format(holding) if holding else ""
    if why:
        log.error("fault: %s", why)
        streamer.found_holding()
    link.set_ready(Readiness.READY, why)
    return streamer


def _cut_what_is_owed(bus: ServoBus, link: BusLink) -> None:
    """Cut torque where this is requested while the bus starts; the first cycle serves the request itself, and repeats the cut."""
    if link.owes(*ESTOPS, BusRequest.TORQUE_OFF):
        bus.send_torque_off()
