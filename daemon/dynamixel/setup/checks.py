"""Compares the servos' settings with those that the robot file needs: read at the start, corrected only on request."""

from __future__ import annotations

from collections.abc import Sequence

from daemon.dynamixel.identity import identity_text
from daemon.dynamixel.registers.rules import ADVISED, NEEDED, Finding, findings_of, items_of
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import BusMismatchError, CommandError, MismatchRow
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap


def check_servos(bus: ServoBus, robot: RobotModel) -> list[Finding]:
    """Settings that differ from the required ones, servo by servo; reads only."""
    findings: list[Finding] = []
    ticks = JointServoMap(robot)
    ends = {
        s.servo_id: (int(low), int(high))
        for s, low, high in zip(robot.servos, ticks.position_min_tick, ticks.position_max_tick, strict=True)
    }
    for servo, model, firmware in zip(bus.servos, bus.models, bus.firmware, strict=True):
        values = bus.read_items(servo.servo_id, items_of(model))
        findings += findings_of(servo, ends[servo.servo_id], model, firmware, values)
    return findings


def check_strangers(bus: ServoBus) -> list[Finding]:
    """Servos that answer and are not in the robot file: no process controls them, and they may hold torque. Takes about 0.2 s."""
    expected, remedy = "no servo of an id that the robot file does not name", "take it off the bus, or name it there"
    return [
        Finding(f.servo_id, "no joint", "id", identity_text((f.model_number, f.firmware)), expected, ADVISED, remedy)
        for f in bus.strangers()
    ]


def require_needed(findings: Sequence[Finding]) -> None:
    """Refuse servos with settings that would make the robot move other than commanded.

    Raises:
        BusMismatchError: a servo has such a setting; the error has a table.
    """
    needed = [f for f in findings if f.severity == NEEDED]
    if needed:
        rows = [MismatchRow(f.servo_id, f.joint_name, f"{f.item} {f.expected}", f.found) for f in needed]
        by_hand = [f.remedy for f in needed if f.fix is None]
        fixed = ["mmmd doctor --fix"] if len(by_hand) < len(needed) else []
        raise BusMismatchError(rows, f"correct them with torque off: {'; '.join(fixed + by_hand)}")


def fix(bus: ServoBus, findings: Sequence[Finding]) -> list[Finding]:
    """Correct the findings that can be corrected, each confirmed by reading it back; return the others.

    Status return levels come first: below 2 a servo confirms no other write.

    Raises:
        CommandError: a servo has torque: its settings cannot be written, and its torque is not cut without a request.
    """
    to_fix = [f for f in findings if f.fix is not None]
    holding = sorted({f.servo_id for f in to_fix if bus.read_item(f.servo_id, "torque_enable")})
    if holding:
        ids = ", ".join(map(str, holding))
        raise CommandError(f"servo {ids}: torque is on; park the robot first (mmmd park), then fix")
    left = [f for f in findings if f.fix is None]
    for f in sorted(to_fix, key=lambda f: f.item != "status_return_level"):
        assert f.fix is not None
        bus.write_item(f.servo_id, f.item, f.fix)
        if bus.read_item(f.servo_id, f.item) != f.fix:
            left.append(f)
    return left
