"""Simulated servos on one half-duplex wire: instruction bytes in, answers out, each byte at its time.

Modelled are the time of every byte, half duplex with collisions, answers in order, every instruction. Not modelled: see the list in
docs/simulator.md (encoder steps inside the loop, radio noise, electrical shock, ...). `answers.py` has the answers of several
servos to one packet.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.packet import BROADCAST_ID, Instruction, Packet
from retarget.robot.robot import RobotModel
from sim.answers import Answers, answers
from sim.audit.audit import Audit
from sim.faults import FaultSchedule
from sim.servos.instructions import Instructions, accesses_of
from sim.servos.servo import SimServo
from sim.wire.wire import Wire, WireSettings
from sim.world import World

_BAUD_TOLERANCE = 0.03
"""Share by which two bauds may differ with a byte's last bit still read right; 57,600 baud is 57,142 on protocol 1.0 (e-manual)."""
_READS = (Instruction.SYNC_READ, Instruction.BULK_READ)
_FAST_READS = (Instruction.FAST_SYNC_READ, Instruction.FAST_BULK_READ)
_GROUP_WRITES = (Instruction.SYNC_WRITE, Instruction.BULK_WRITE)


class SimBus:
    """Servos of a robot that exchange real packets on one wire. Time is passed in.

    Args:
        robot: the robot.
        faults, start_rad: of the world made here when `world` is None; see `World`.
        world: servos that are shared with other wires.
        servo_ids: those on this wire; all when None.
        wire: how wire and adapter behave.
        baud: baud to which the servos are set; unchanged when None.
    """

    def __init__(
        self,
        robot: RobotModel,
        faults: FaultSchedule | None = None,
        start_rad: Sequence[float] | None = None,
        *,
        world: World | None = None,
        servo_ids: Sequence[int] | None = None,
        wire: WireSettings | None = None,
        baud: int | None = None,
    ) -> None:
        self.robot = robot
        self.world = world or World(robot, faults, start_rad)
        mine = None if servo_ids is None else set(servo_ids)
        self.on_wire = [s for s in self.world.all if mine is None or s.spec.servo_id in mine]
        self.servos = {k: s for k, s in self.world.servos.items() if mine is None or k in mine}
        """Servos on this wire, by their id in the robot's file."""
        self.wire = Wire(wire)
        self._answers = Answers(self.wire, self.world)
        self._instructions = Instructions(self.world.audit)
        if baud is not None:
            self.set_baud(baud)
        self._decoder = packet.PacketDecoder()
        speaks_1 = any(s.model.protocol == 1.0 for s in self.on_wire)
        self._decoder_1 = packet1.PacketDecoder(answers=False) if speaks_1 else None

    @property
    def on_goal(self) -> Callable[[float, int, int], None] | None:
        """Called with (time, servo id, tick) for every goal position received; for comparisons."""
        return self._instructions.on_goal

    @on_goal.setter
    def on_goal(self, call: Callable[[float, int, int], None] | None) -> None:
        self._instructions.on_goal = call

    @property
    def faults(self) -> FaultSchedule:
        """The faults that strike servos and wire."""
        return self.world.faults

    @faults.setter
    def faults(self, schedule: FaultSchedule) -> None:
        self.world.faults = schedule

    @property
    def audit(self) -> Audit:
        """The audit of what was received."""
        return self.world.audit

    def set_baud(self, baud: int) -> None:
        """Set every servo's baud directly, as another tool would have done before."""
        for servo in self.on_wire:
            servo.set_baud(baud)

    def receive(self, data: bytes, t_s: float, baud: int, *, patient: bool = False) -> None:
        """Receive `data` that the client sends at `t_s`; answers are put on the wire. `patient`: see `Wire.talk`."""
        with self.world.lock:
            self.world.advance(t_s)
            start_s, byte_s, heard = self.wire.talk(t_s, data, baud, patient=patient)
            if bytes(heard) != data:
                self._note_lost(data, t_s)
            if self.faults.in_force("echo"):
                self.wire.echo(start_s, data, byte_s)
            at = 0
            for end in _packet_ends(heard, with_1=self._decoder_1 is not None):
                end_s = start_s + end * byte_s
                for p in self._decoder.feed(bytes(heard[at:end])):
                    if p.instruction != Instruction.STATUS:
                        self._hear(p, 2.0, end_s, baud)
                self._hear_damaged(self._decoder.damaged_id, 2.0, end_s, baud)
                if self._decoder_1 is not None:
                    for p in self._decoder_1.feed(bytes(heard[at:end])):
                        self._hear(p, 1.0, end_s, baud)
                    self._hear_damaged(self._decoder_1.damaged_id, 1.0, end_s, baud)
                at = end

    def _hear_damaged(self, servo_id: int | None, protocol: float, t_s: float, baud: int) -> None:
        """Handle a packet with a wrong checksum: the servo with its id answers with an error, and does nothing."""
        if servo_id is None or servo_id == BROADCAST_ID:
            return
        self.world.advance(t_s)
        for servo in self._listening(protocol, t_s, baud):
            if servo.servo_id == servo_id and answers(servo, Instruction.WRITE):
                self._answers.send(servo, servo_id, servo.errors.checksum, b"", t_s, baud)

    def _hear(self, p: Packet, protocol: float, t_s: float, baud: int) -> None:
        """Handle one instruction packet, which reaches the servos of its protocol and baud."""
        self.world.advance(t_s)
        listening = self._listening(protocol, t_s, baud)
        by_id: dict[int, list[SimServo]] = {}
        for servo in listening:
            servo.fed(t_s)
            servo_id = servo.servo_id
            if servo_id in by_id:
                by_id[servo_id].append(servo)
            else:
                by_id[servo_id] = [servo]
        if p.instruction in _FAST_READS and protocol == 2.0:
            self._answers.fast(p, by_id, t_s, baud)
        elif p.instruction in _READS:
            self._answers.group(p, protocol, by_id, t_s, baud)
        elif p.instruction in _GROUP_WRITES:
            for access in accesses_of(p, protocol):
                for servo in by_id.get(access.servo_id, ()):
                    self._instructions.write(servo, access.address, access.data, t_s)
                if access.servo_id not in by_id:
                    self._instructions.missed(self.on_wire, access, t_s)
        elif p.servo_id == BROADCAST_ID:
            self._answer_all(p, by_id, t_s, baud)
        else:
            self._answer_one(p, listening, by_id, t_s, baud)

    def _note_lost(self, data: bytes, t_s: float) -> None:
        """Report goals lost in a collision to the audit: the daemon has made these steps, and the audit counts from them."""
        for protocol, decoder in ((2.0, packet.PacketDecoder()), (1.0, packet1.PacketDecoder(answers=False))):
            for p in decoder.feed(data):
                if p.instruction in _GROUP_WRITES:
                    for access in accesses_of(p, protocol):
                        self._instructions.missed(self.on_wire, access, t_s)

    def _listening(self, protocol: float, t_s: float, baud: int) -> list[SimServo]:
        """Servos that receive and understand a packet sent now."""
        low, high = baud * (1 - _BAUD_TOLERANCE), baud * (1 + _BAUD_TOLERANCE)
        listening = [
            s
            for s in self.on_wire
            if low <= s.baud <= high and s.powered and t_s >= s.silent_until_s and s.model.protocol == protocol
        ]
        if self.faults.in_force("deaf"):
            listening = [s for s in listening if not self.faults.active("deaf", t_s, s.spec.servo_id)]
        return listening

    # Answers.

    def _answer_one(
        self, p: Packet, listening: list[SimServo], by_id: dict[int, list[SimServo]], t_s: float, baud: int
    ) -> None:
        """Let the addressed servo answer; a servo with this secondary id obeys without an answer.

        The answer carries the id that was addressed, also when the packet changed the servo's id or baud (manual of RX-28, examples
        7 and 8).
        """
        for servo in listening:
            second_id = servo.memory.get("secondary_id") if "secondary_id" in servo.items else None
            if second_id == p.servo_id != servo.servo_id:
                self._instructions.carry_out(servo, p, t_s, by_second_id=True)
        for servo in by_id.get(p.servo_id, ()):
            error, parameters = self._instructions.carry_out(servo, p, t_s)
            if answers(servo, p.instruction):
                self._answers.send(servo, p.servo_id, error, parameters, t_s, baud)

    def _answer_all(self, p: Packet, by_id: dict[int, list[SimServo]], t_s: float, baud: int) -> None:
        """Handle a broadcast: every servo obeys; only a ping is answered, by one id after another."""
        for servo_id in sorted(by_id):
            ends_s: list[float] = []
            for servo in by_id[servo_id]:
                error, parameters = self._instructions.carry_out(servo, p, t_s)
                if p.instruction == Instruction.PING:
                    ends_s.append(self._answers.send(servo, servo_id, error, parameters, t_s, baud))
            t_s = max(ends_s, default=t_s)


def _packet_ends(data: bytes | bytearray, *, with_1: bool) -> list[int]:
    """Offsets at which packets seem to end, and the end of the data: servos receive the bytes packet by packet."""
    ends: list[int] = []
    at = 0
    while (at := data.find(b"\xff\xff", at)) >= 0:
        end = 0
        if data[at : at + 4] == packet.HEADER and at + 7 <= len(data):
            end = at + 7 + (data[at + 5] | data[at + 6] << 8)
        elif with_1 and at + 4 <= len(data) and data[at + 2] != 0xFF:
            end = at + 4 + data[at + 3]
        if at < end <= len(data):
            ends.append(end)
            at = end
        else:
            at += 1
    if not ends or ends[-1] != len(data):
        ends.append(len(data))
    return ends
