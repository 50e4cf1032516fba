"""Checks all conditions of a good run: rights, adapter, servos, settings, rate; each finding has the exact remedy."""

from __future__ import annotations

import getpass
import os
import resource
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from daemon.dynamixel.bus_opening import bus_on
from daemon.dynamixel.identity import MUTE_TEXT
from daemon.dynamixel.ports.adapter import GOOD_LATENCY_MS, adapter_at, latency_remedy, latency_timer_ms
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.registers.rules import ADVISED, NEEDED, Finding
from daemon.dynamixel.servo_bus import ServoBus
from daemon.dynamixel.setup.checks import check_servos, check_strangers, fix
from daemon.errors import BusMismatchError, ConfigError, DaemonError, PortError
from daemon.host.clock import Clock
from retarget.robot.robot import RobotModel

GOOD, ADVICE, BAD = "good", "advice", "bad"
_FEW = 2
_LIMITS = "/etc/security/limits.d/99-mmmd.conf"


@dataclass(frozen=True)
class Check:
    """The result of one check.

    Attributes:
        what: subject of the check.
        found: the finding in words.
        verdict: GOOD, ADVICE (works, but less well) or BAD (does not work).
        remedy: correction; empty when good.
    """

    what: str
    found: str
    verdict: str
    remedy: str = ""


@dataclass(frozen=True)
class Diagnosis:
    """All checks, and the budget of a cycle where the bus could be reached."""

    checks: tuple[Check, ...]
    budget: tuple[str, ...] = ()

    @property
    def bad(self) -> bool:
        """Whether some check found that the robot cannot run."""
        return any(c.verdict == BAD for c in self.checks)


def diagnose(
    robot: RobotModel, open_ports: Callable[[], Sequence[Port]], clock: Clock, *, correct: bool = False
) -> Diagnosis:
    """Make all checks, and with `correct` correct the servos' settings where possible."""
    checks = [*_rights()]
    try:
        ports = open_ports()
    except PortError as error:
        return Diagnosis((*checks, Check("port", error.problem, BAD, error.remedy)))
    try:
        for port in ports:
            checks += _adapter(port)
        try:
            bus = bus_on(ports, robot, clock)
            _verify(bus, correct=correct)
        except BusMismatchError as error:
            rows = [
                Check(f"servo {r.servo_id} ({r.joint_name})", r.found, BAD, f"expected {r.expected}")
                for r in error.rows
            ]
            hint = str(error).splitlines()[-1]
            return Diagnosis((*checks, *rows, Check("servos", f"{len(rows)} are not as in the robot file", BAD, hint)))
        checks.append(Check("servos", f"all {len(bus.ids)} answer, as in the robot file", GOOD))
        firmware = ", ".join(sorted({f"{m.name} {f}" for m, f in zip(bus.models, bus.firmware, strict=True)}))
        checks.append(Check("firmware", firmware, GOOD))
        checks += _settings(bus, robot, correct=correct)
        checks += _events(bus)
        return Diagnosis((*checks, *_rate(bus, robot)), tuple(bus.plan().lines(robot.bus.rate_hz)))
    except DaemonError as error:
        return Diagnosis((*checks, Check("bus", str(error), BAD, "check cable and power, then again")))
    finally:
        for port in ports:
            port.close()


def _rights() -> list[Check]:
    """Check whether the bus process may have real-time priority."""
    user = getpass.getuser()
    checks: list[Check] = []
    for what, limit, key in (
        ("real-time priority", resource.RLIMIT_RTPRIO, "rtprio 50"),
        ("locked memory", resource.RLIMIT_MEMLOCK, "memlock unlimited"),
    ):
        soft = resource.getrlimit(limit)[0]
        enough = os.geteuid() == 0 or soft == resource.RLIM_INFINITY or (limit == resource.RLIMIT_RTPRIO and soft >= 40)
        remedy = f"echo '{user} - {key}' | sudo tee -a {_LIMITS}   and log in again"
        checks.append(
            Check(what, "allowed" if enough else "not allowed: late cycles under load", *_good(enough, remedy))
        )
    return checks


def _good(good: bool, remedy: str) -> tuple[str, str]:
    return (GOOD, "") if good else (ADVICE, remedy)


def _adapter(port: Port) -> list[Check]:
    device = getattr(port, "device", None)
    if not isinstance(device, str):
        return [Check("port", f"{port.name}, {port.baud} baud", GOOD)]
    adapter = adapter_at(device)
    kind = f"USB {adapter.vendor}:{adapter.product} {adapter.serial}".strip() if adapter else "no USB adapter"
    checks = [Check("port", f"{device}, {port.baud} baud, {kind}", GOOD)]
    if adapter and not adapter.serial:
        remedy = "after a replug it is found by its path alone: name it by /dev/serial/by-path/"
        checks.append(Check("adapter's serial number", "none", ADVICE, remedy))
    timer_ms = latency_timer_ms(device)
    if timer_ms is not None:
        checks.append(
            Check("latency timer", f"{timer_ms} ms", *_good(timer_ms <= GOOD_LATENCY_MS, latency_remedy(device)))
        )
    return checks


def _verify(bus: ServoBus, *, correct: bool) -> None:
    """Verify the bus; with `correct` servos that answer pings only are first set to answer every request."""
    try:
        bus.verify()
    except BusMismatchError as error:
        if not (correct and any(row.found == MUTE_TEXT for row in error.rows)):
            raise
        bus.let_answer()
        bus.verify()


def _settings(bus: ServoBus, robot: RobotModel, *, correct: bool) -> list[Check]:
    findings = check_servos(bus, robot) + check_strangers(bus)
    fixed: list[Finding] = []
    if correct:
        left = fix(bus, findings)
        fixed = [f for f in findings if f not in left]
        findings = left
    checks: list[Check] = []
    for severity in (NEEDED, ADVISED):
        for item in dict.fromkeys(f.item for f in findings if f.severity == severity):
            checks += _of_item([f for f in findings if (f.item, f.severity) == (item, severity)], correct=correct)
    if fixed:
        checks.append(Check("settings", f"{len(fixed)} corrected", GOOD))
    if not findings:
        checks.append(Check("settings", "as the robot file needs them", GOOD))
    return checks


def _of_item(findings: list[Finding], *, correct: bool) -> list[Check]:
    """The checks of one setting: one for each servo, or one for all where there are many."""
    first = findings[0]
    verdict = BAD if first.severity == NEEDED else ADVICE
    by_fix = "--fix, or " if first.fix is not None and not correct else ""
    if len(findings) <= _FEW:
        return [
            Check(
                f"servo {f.servo_id} ({f.joint_name}) {f.item}", f.found, verdict, f"{f.expected}: {by_fix}{f.remedy}"
            )
            for f in findings
        ]
    what = f"{first.item} of servos {', '.join(str(f.servo_id) for f in findings)}"
    remedy = f"{first.expected} on servo {first.servo_id}: {by_fix}{first.remedy}, and so on"
    return [Check(what, ", ".join(dict.fromkeys(f.found for f in findings)), verdict, remedy)]


def _events(bus: ServoBus) -> list[Check]:
    return [Check(e.kind.value, e.text, ADVICE, "") for e in bus.take_events()]


def _rate(bus: ServoBus, robot: RobotModel) -> list[Check]:
    plan, rate_hz = bus.plan(), robot.bus.rate_hz
    try:
        fits = plan.require(rate_hz)
    except ConfigError:
        remedy = "; ".join(plan.remedies(rate_hz)) or f"bus.rate_hz {int(plan.highest_hz)} or fewer servos on this port"
        return [Check("rate", f"{rate_hz:g} Hz is impossible, {int(plan.highest_hz)} Hz is not", BAD, remedy)]
    found = f"{rate_hz:g} Hz, {plan.cycle_s * rate_hz:.0%} of each period used"
    return [Check("rate", found, *_good(fits, "quicker adapter (latency timer), or a lower bus.rate_hz"))]
