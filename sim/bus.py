"""Simulated servos on one half-duplex wire: bytes in, answers out, each byte in its time.

What is modelled: time of every byte, half duplex with collisions, answers in order, every instruction. Not modelled: see
the list in docs/simulator.md (encoder steps inside the loop, radio noise, electrical shock, ...). Where the manual is
silent: in a sync or bulk read the next servo waits for the time of an answer that does not come (on protocol 1.0 for ever,
for it waits for the packet itself); a fast read ends at the first servo that is silent, for the next ones cannot continue
its checksum.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.packet import ALERT_BIT, BROADCAST_ID, Access, Instruction, Packet, Part
from daemon.dynamixel.registers.registers import RETURN_DELAY_UNIT_S
from retarget.robot.robot import RobotModel
from sim.audit.audit import Audit
from sim.faults import FaultSchedule
from sim.servos.instructions import Instructions, accesses_of
from sim.servos.servo import SimServo
from sim.wire.fast_reply import share_as, shares_of
from sim.wire.packet_faults import Piece, apply_packet_faults
from sim.wire.wire import Wire, WireSettings
from sim.world import World

_BAUD_TOLERANCE = 0.03
"""A byte's last bit is still read right; 57,600 baud is 57,142 on a servo of protocol 1.0 (e-manual, "Baud Rate")."""
_READS = (Instruction.SYNC_READ, Instruction.BULK_READ)
_FAST_READS = (Instruction.FAST_SYNC_READ, Instruction.FAST_BULK_READ)
_GROUP_WRITES = (Instruction.SYNC_WRITE, Instruction.BULK_WRITE)


class SimBus:
    """Servos of a robot behind real packets on one wire. Time comes from outside.

    Args:
        robot: whose servos.
        faults, start_rad: of the world made here when `world` is None; see `World`.
        world: servos that are shared with other wires.
        servo_ids: those on this wire; all when None.
        wire: how wire and adapter behave.
        baud: what the servos are set to; as the world made them when None.
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
        """By the id in the robot's file."""
        self.wire = Wire(wire)
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
        """What goes wrong."""
        return self.world.faults

    @faults.setter
    def faults(self, schedule: FaultSchedule) -> None:
        self.world.faults = schedule

    @property
    def audit(self) -> Audit:
        """What was received."""
        return self.world.audit

    def set_baud(self, baud: int) -> None:
        """Set every servo's baud, as a tool would have."""
        for servo in self.on_wire:
            servo.set_baud(baud)

    def receive(self, data: bytes, t_s: float, baud: int, *, patient: bool = False) -> None:
        """The client sends `data` at `t_s`; answers are put on the wire. `patient`: see `Wire.talk`."""
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
        """A packet with a wrong checksum: the servo it seems to be for says so, and does nothing."""
        if servo_id is None or servo_id == BROADCAST_ID:
            return
        self.world.advance(t_s)
        for servo in self._listening(protocol, t_s, baud):
            if servo.servo_id == servo_id and _answers(servo, Instruction.WRITE):
                self._send(servo, servo_id, servo.errors.checksum, b"", t_s, baud)

    def _hear(self, p: Packet, protocol: float, t_s: float, baud: int) -> None:
        """One instruction packet, heard by the servos of its protocol and baud."""
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
            self._answer_fast(p, by_id, t_s, baud)
        elif p.instruction in _READS:
            self._answer_group(p, protocol, by_id, t_s, baud)
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
        """Goals that a collision took are steps that the daemon made all the same: the audit counts from them."""
        for protocol, decoder in ((2.0, packet.PacketDecoder()), (1.0, packet1.PacketDecoder(answers=False))):
            for p in decoder.feed(data):
                if p.instruction in _GROUP_WRITES:
                    for access in accesses_of(p, protocol):
                        self._instructions.missed(self.on_wire, access, t_s)

    def _listening(self, protocol: float, t_s: float, baud: int) -> list[SimServo]:
        """Servos that hear and understand what is said now."""
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
        """The servo that is meant; one with this as its second id obeys in silence.

        It answers as who was asked, also when it has been given another id or baud (manual of RX-28, examples 7 and 8).
        """
        for servo in listening:
            second_id = servo.memory.get("secondary_id") if "secondary_id" in servo.items else None
            if second_id == p.servo_id != servo.servo_id:
                self._instructions.carry_out(servo, p, t_s, by_second_id=True)
        for servo in by_id.get(p.servo_id, ()):
            error, parameters = self._instructions.carry_out(servo, p, t_s)
            if _answers(servo, p.instruction):
                self._send(servo, p.servo_id, error, parameters, t_s, baud)

    def _answer_all(self, p: Packet, by_id: dict[int, list[SimServo]], t_s: float, baud: int) -> None:
        """A broadcast: everybody obeys, and only a ping is answered, by one id after another."""
        for servo_id in sorted(by_id):
            ends_s: list[float] = []
            for servo in by_id[servo_id]:
                error, parameters = self._instructions.carry_out(servo, p, t_s)
                if p.instruction == Instruction.PING:
                    ends_s.append(self._send(servo, servo_id, error, parameters, t_s, baud))
            t_s = max(ends_s, default=t_s)

    def _send(self, servo: SimServo, servo_id: int, error: int, parameters: bytes, t_s: float, baud: int) -> float:
        """Put one status packet of `servo_id` on the wire; the time it ends, or would have ended."""
        byte_s = 0.0 if self.wire.settings.no_wire_delay else 10 / baud
        status = packet.status if servo.model.protocol == 2.0 else packet1.status
        start_s = t_s + self._pause_s(servo)
        alert = servo.alert()
        error |= alert
        end_s = start_s + byte_s * (len(parameters) + (11 if servo.model.protocol == 2.0 else 6))
        pieces = apply_packet_faults(self.faults, servo_id, lambda i: status(i, error, parameters), start_s, byte_s)
        if ((alert and servo.is_faulted) or servo.watchdog_tripped) and pieces == [
            Piece(status(servo_id, error, parameters))
        ]:
            self.audit.heard_in_fault(t_s, servo.spec.servo_id)
        for piece in pieces:
            sent_s = self.wire.answer(start_s + piece.after_s, piece.data, baud, alone=piece.alone)
            end_s = max(end_s, sent_s) if not piece.after_s else end_s
        return end_s

    def _pause_s(self, servo: SimServo) -> float:
        if self.wire.settings.no_wire_delay:
            return 0.0
        return servo.memory.get("return_delay_time") * RETURN_DELAY_UNIT_S + self.wire.settings.turnaround_s

    def _answer_group(
        self, p: Packet, protocol: float, by_id: dict[int, list[SimServo]], t_s: float, baud: int
    ) -> None:
        """One status packet after another, in the order asked; on protocol 1.0 each waits for the packet before its own."""
        for access in accesses_of(p, protocol):
            ends_s = [
                self._send(servo, access.servo_id, *servo.read(access.address, access.length), t_s, baud)
                for servo in by_id.get(access.servo_id, ())
                if _answers(servo, Instruction.READ)
            ]
            if protocol == 1.0 and (not ends_s or self.faults.active("silent", t_s, access.servo_id)):
                return
            byte_s = 0.0 if self.wire.settings.no_wire_delay else 10 / baud
            t_s = max(ends_s, default=t_s + (11 + access.length) * byte_s)

    def _answer_fast(self, p: Packet, by_id: dict[int, list[SimServo]], t_s: float, baud: int) -> None:
        """One packet to which each servo adds its part; those with one id talk at once."""
        turns: list[list[SimServo]] = []
        parts: list[list[Part]] = []
        accesses = accesses_of(p, 2.0)
        for access in accesses:
            able = [servo for servo in by_id.get(access.servo_id, ()) if _answers_fast(servo)]
            if not able:
                break
            turns.append(able)
            parts.append([_part(servo, access) for servo in able])
            if len(turns) == 1 and len({self._pause_s(servo) for servo in able}) > 1:
                break  # two begin at different times: nobody can make out a packet to go on with
        if not turns:
            return
        length = 1 + sum(4 + access.length for access in accesses)
        shares = shares_of(parts, length)
        start_s = t_s + self._pause_s(turns[0][0])
        if not self.faults.strikes_packets and all(len(said) == 1 for said in shares):  # nothing comes between them
            self.faults.packet += len(turns)
            for (servo,), (part,) in zip(turns, parts, strict=True):
                if (part.error & ALERT_BIT and servo.is_faulted) or servo.watchdog_tripped:
                    self.audit.heard_in_fault(t_s, servo.spec.servo_id)
            self.wire.answer(start_s, b"".join(own for (own,) in shares), baud)
            return
        byte_s = 0.0 if self.wire.settings.no_wire_delay else 10 / baud
        for turn, servos in enumerate(turns):
            pieces = [
                (start_s if turn else t_s + self._pause_s(servo), piece)
                for servo, part in zip(servos, parts[turn], strict=True)
                for piece in apply_packet_faults(
                    self.faults, part.servo_id, share_as(parts[:turn], part, length), start_s, byte_s
                )
            ]
            for own_s, piece in pieces:
                self.wire.answer(own_s + piece.after_s, piece.data, baud, alone=piece.alone)
            if not pieces:
                return
            start_s += len(shares[turn][0]) * byte_s


def _answers(servo: SimServo, kind: int) -> bool:
    """Whether the status return level lets it answer."""
    level = servo.memory.get("status_return_level")
    return level == 2 or kind == Instruction.PING or (level == 1 and kind == Instruction.READ)


def _answers_fast(servo: SimServo) -> bool:
    """Whether it takes part in a fast read."""
    return servo.model.has_fast_sync(servo.firmware) and _answers(servo, Instruction.READ)


def _part(servo: SimServo, access: Access) -> Part:
    """What it adds to the answer of a fast read."""
    error, data = servo.read(access.address, access.length)
    return Part(access.servo_id, error | servo.alert(), data.ljust(access.length, b"\0"))


def _packet_ends(data: bytes | bytearray, *, with_1: bool) -> list[int]:
    """Where packets seem to end, and the end of all: what follows an instruction is heard after it."""
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
