"""Hours of simulated faults in virtual time: `make soak`.

MMMD_SOAK_HOURS (10) and MMMD_SOAK_SEEDS (0,1,2) set how long, MMMD_SOAK_ROBOT (reference) for which robot, MMMD_SOAK_PAUSE_S
(40) how long it is quiet between two faults in the mean.

The real bus side (streamer, gate, servo bus, codec) against the simulated servos. A person stands by: after each fault
the servo that tripped is rebooted, the robot reset and armed again. Nothing else may arm it.
"""

from __future__ import annotations

import logging
import os
import random
import re
import resource
from collections import Counter

import numpy as np
import pytest

from daemon.control.process import SLOW_EVERY
from daemon.control.turns import TURNS_UNKNOWN
from daemon.dynamixel.codec import packet
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel
from sim.faults import INSTANT_KINDS, PACKET_KINDS, Fault
from tests.sim.soak_witness import EXPECTED, Witness
from tests.support.rig import Rig, rig, swing

HOURS = float(os.environ.get("MMMD_SOAK_HOURS", "10"))
ROBOT = os.environ.get("MMMD_SOAK_ROBOT", "reference")
SEEDS = [int(s) for s in os.environ.get("MMMD_SOAK_SEEDS", "0,1,2").split(",")]
MEAN_PAUSE_S = float(os.environ.get("MMMD_SOAK_PAUSE_S", "40"))
REPAIR_S = 3.0
"""A person's time from a fault to the repair; whatever lasted is over by then or keeps it in fault."""
LONGEST_FAULT_S = 60.0
LONGEST_OUT_S = 2 * LONGEST_FAULT_S
"""A fault, its repair, and what may come between while it is armed again."""
LIMP_S = 20.0
"""A servo that hears nothing for a while keeps its torque so long; a person waits until the arm gives way."""
ARMED_WITHIN_S = 60.0
"""From a request to holding in the rest pose, or a named fault: a way is looked for and gone slowly."""
LEAK_BYTES = 24 * 1024 * 1024
_KINDS = (
    *PACKET_KINDS,  # in their order: a seed is a schedule
    "silent",
    "unplug",
    "brown_out",
    "stuck",
    "overload",
    "encoder",
    "hot",
    "reboot",
    "slip",
)


def schedule(robot: RobotModel, hours: float, seed: int) -> tuple[Fault, ...]:
    """Faults one after another, of every kind, with quiet between them."""
    draw, faults, t_s = random.Random(seed), list[Fault](), 20.0
    has_encoder_error = robot.bus.protocol == 2.0
    while True:
        t_s += draw.expovariate(1 / MEAN_PAUSE_S) + 5.0
        if t_s > hours * 3600 - LONGEST_FAULT_S:
            return tuple(faults)
        kind = draw.choice(_KINDS)
        if kind == "encoder" and not has_encoder_error:
            continue
        whom = draw.choice([None, *robot.servo_ids]) if kind in PACKET_KINDS else draw.choice(robot.servo_ids)
        lasts_s = draw.uniform(0.2, 8.0)
        if kind == "deaf" and draw.random() < 0.5:  # long enough for its own watchdog, and it alone
            faults.append(Fault(kind, t_s, t_s + draw.uniform(0.3, 1.0), servo_id=whom))
        elif kind in PACKET_KINDS:
            faults.append(Fault(kind, t_s, t_s + lasts_s, draw.choice([0.001, 0.01, 0.1, 0.5]), whom))
        elif kind in INSTANT_KINDS:
            amount = draw.choice([-1, 1]) * draw.uniform(5, 40) if kind == "slip" else None
            faults.append(Fault(kind, t_s, servo_id=whom, amount=amount))
        elif kind in ("unplug", "brown_out"):
            faults.append(Fault(kind, t_s, t_s + draw.uniform(0.02, 5.0)))
        else:
            faults.append(Fault(kind, t_s, t_s + lasts_s, servo_id=whom))


class Person:
    """Plays motions while all is well; after a fault repairs, resets and arms, and counts what happened.

    Attributes:
        asked, armed: how often the robot was asked to arm, and how often it came to hold then.
        switched_on: how often the daemon switched torque on.
        outages: faults out of holding or playing, whatever came until it held again.
        out_since_s, longest_out_s: when the outage began that is not over yet, and how long one lasted.
    """

    def __init__(self, r: Rig, witness: Witness, seed: int) -> None:
        self.r, self.witness, self.draw = r, witness, np.random.default_rng(seed)
        self.faults, self.asked, self.armed, self.switched_on, self.outages = Counter[str](), 0, 0, 0, 0
        self.out_since_s: float | None = None
        self.longest_out_s = 0.0
        self._motions = [swing(r.robot, seconds) for seconds in (1.0, 2.0, 3.0)]

    def work(self, until_s: float) -> None:
        while self.r.clock.true_s < until_s:
            if self.r.state is BusState.FAULT:
                self._repair()
            elif self.r.state is BusState.LIMP:
                self._arm()
            else:
                self._play()
            del self.r.records[:-1]

    def _play(self) -> None:
        if self.r.state is BusState.HOLDING and self.r.link.setpoints.queued_frames == 0:
            q = self._motions[int(self.draw.integers(3))]
            self.r.link.setpoints.push(q, 1, 0, self.r.link.epoch, last=True)
        if self.draw.random() < 0.01:
            self.r.link.request([BusRequest.STOP, BusRequest.PARK][int(self.draw.integers(2))])
        self._cycles(20)

    def _arm(self) -> None:
        until_s = self.r.clock.true_s + LIMP_S
        while any(self.r.torque) and self.r.clock.true_s < until_s:
            self._cycles(20)
        assert not any(self.r.torque), "limp is limp, as soon as a servo that was deaf hears it"
        self.asked += 1
        self.r.link.request(BusRequest.ARM)
        until_s = self.r.clock.true_s + ARMED_WITHIN_S
        self._cycles(20)
        while self.r.state is BusState.ARMING and self.r.clock.true_s < until_s:
            self._cycles(20)
        if self.r.state is BusState.FAULT:
            return
        assert self.r.state is BusState.HOLDING, f"armed or a named fault, not {self.r.state.name}"
        self.armed += 1
        self.longest_out_s, self.out_since_s = max(self.longest_out_s, self.out_s), None

    @property
    def out_s(self) -> float:
        """How long the outage that is not over yet has lasted."""
        return 0.0 if self.out_since_s is None else self.r.clock.true_s - self.out_since_s

    def _repair(self) -> None:
        """Wait, reboot what is latched, reset; arming is the next step. Nothing may come on by itself meanwhile."""
        since_s = self.r.clock.true_s
        if self.out_since_s is None:
            self.outages, self.out_since_s = self.outages + 1, since_s
        self.faults[re.sub(r"[\d.]+|\(.*?\)", "", self.r.link.text.split(":")[0])[:40]] += 1
        assert self.r.link.text, "a fault has a name"
        had_torque = {s.spec.servo_id for s in self.r.sim.world.all if s.torque}
        while self.r.clock.true_s < since_s + REPAIR_S:
            self._cycles(20)
            assert self.r.state is BusState.FAULT, "a fault stays until a person resets it"
            assert {s.spec.servo_id for s in self.r.sim.world.all if s.torque} <= had_torque, "torque came on by itself"
        turns_unknown = TURNS_UNKNOWN in self.r.link.text
        self.r.link.request(BusRequest.RESET)
        self._cycles(10)
        if turns_unknown:
            self.r.sim.world.lead_by_hand(self.r.robot.park_rad.tolist())
            self._cycles(40)
        for servo in self.r.sim.world.all:
            if servo.alert():
                self.r.sim.world.drives.temperature_c[servo.index] = 30.0  # it had time to cool
                if servo.model.protocol == 2.0:
                    self.r.sim.receive(packet.reboot(servo.servo_id), self.r.clock.true_s + 0.001, self.r.port.baud)
                else:  # its plug is pulled and put back
                    servo.lose_power()
                    servo.restore_power()
                self._cycles(40)

    def _cycles(self, n: int) -> None:
        for _ in range(n):
            had_torque = bool(self.r.records and self.r.records[-1]["torque"])
            self.switched_on += bool(self.r.cycle()["torque"]) > had_torque
            self.witness.look()


def test_the_table_says_of_every_kind_what_is_expected() -> None:
    assert EXPECTED.keys() == set(_KINDS)
    assert all(e.why for e in EXPECTED.values() if e.words is None)


@pytest.mark.long
@pytest.mark.parametrize("listens", [True, False])
def test_the_witness_finds_what_the_daemon_does_not_say(listens: bool) -> None:
    """As if the daemon said nothing: nobody listens to it."""
    fault = Fault("silent", start_s=0.5, end_s=1.5, servo_id=4)
    log = logging.getLogger("daemon")
    with rig("reference", fault) as r:
        witness = Witness(r, [fault])
        try:
            if listens:
                log.addHandler(witness)
            for _ in range(500):
                r.cycle()
                witness.look()
        finally:
            log.removeHandler(witness)
        assert (witness.named["silent"], len(witness.unnamed)) == ((1, 0) if listens else (0, 1))


def test_the_witness_finds_a_servo_that_stands_limp_in_a_robot_that_holds() -> None:
    with rig("reference") as r:
        witness = Witness(r, [])
        r.arm()
        servo = next(iter(r.sim.servos.values()))
        servo.write(servo.items["torque_enable"].address, b"\0")
        r.streamer._judge.fault = lambda _reading: ""  # a daemon that looks at nothing
        for _ in range(600):
            r.cycle()
            witness.look()
        assert [w for w in witness.stopped if "limp" in w] and r.state is BusState.HOLDING


def usage() -> tuple[int, int]:
    """Bytes resident at most so far, and open descriptors."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024, len(os.listdir("/proc/self/fd"))


@pytest.mark.soak
@pytest.mark.parametrize("seed", SEEDS)
def test_hours_of_faults_break_no_limit_and_a_person_arms_each_time(seed: int) -> None:
    robot = load_robot(ROBOT)
    faults = schedule(robot, HOURS, seed)
    link = BusLink.create(robot.n_joints, robot.n_servos)
    r = Rig(robot, link, *faults, slow_every=SLOW_EVERY)
    witness = Witness(r, faults)
    log = logging.getLogger("daemon")
    log.setLevel(logging.WARNING)
    log.propagate = False  # hours of it would be kept
    log.addHandler(witness)
    try:
        person = Person(r, witness, seed)
        person.work(min(900.0, HOURS * 900))
        r.sim.audit.check_poses()  # caches are warm
        before = usage()
        hour = 1.0
        while hour <= HOURS + 1e-9:
            for quarter in (1, 2, 3, 4):
                person.work((hour - 1) * 3600 + quarter * 900)
                r.sim.audit.check_poses()  # as often as before `before`: poses that wait for it are no leak
            so_far = (
                f"{r.sim.audit.goals} goals, {sum(r.sim.audit.violations.values())} violations, {person.armed} armings"
            )
            print(f"seed {seed}: {hour:g} of {HOURS:g} h, {so_far}", flush=True)  # noqa: T201 -- hours without a word are long
            hour += 1.0
        person.work(HOURS * 3600)
        after = usage()
        report = r.sim.audit.report()
        begun = Counter(f.kind for f in faults)
        print(  # noqa: T201 -- what a soak is run for
            f"\nseed {seed}: {HOURS:g} h, {report['goals']} goals, {sum(begun.values())} faults {dict(begun)}, "
            f"named {dict(witness.named)}, unnoticed {dict(witness.unnoticed)}, overlapped {dict(witness.overlapped)}, "
            f"{person.asked} times asked to arm, {person.armed} armed, {person.outages} outages of at most "
            f"{person.longest_out_s:.0f} s, robot faults {dict(person.faults)}, collisions {r.sim.wire.collisions}, "
            f"unnamed {witness.unnamed}, stopped {witness.stopped[:5]}, "
            f"memory {after[0] - before[0]:+d} B, descriptors {after[1] - before[1]:+d}"
        )
        assert report["violations"] == 0, (report["violations_by_kind"], report["details"])
        assert report["self_contacts"] == 0
        assert witness.unnamed == [], "every fault with a consequence is named by the daemon"
        assert witness.stopped == [], "no servo stands still unnoticed"
        assert person.armed <= person.switched_on <= person.asked, "nobody else arms it"
        assert max(person.longest_out_s, person.out_s) < LONGEST_OUT_S, "each recovery was armed"
        assert after[0] - before[0] < LEAK_BYTES and after[1] <= before[1], "memory or descriptors leak"
    finally:
        log.removeHandler(witness)
        log.propagate = True
        link.close()
