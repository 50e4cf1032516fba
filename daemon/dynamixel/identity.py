"""A servo's identity in words, and the likely cause when it does not answer as the robot file says."""

from __future__ import annotations

from collections.abc import Iterable

from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.registers.models import MODELS
from daemon.dynamixel.scan import identify
from daemon.host.clock import Clock

Identity = tuple[int, int]
"""Model number and firmware version."""
PINGS_ONLY: Identity = (0, 0)
"""Identity of a servo that answers a ping but no request for its model (protocol 1.0, status return level 0)."""
MUTE_TEXT = "answers pings only: status return level 0"
_OTHER_PROTOCOL = "speaks protocol"


def identity_text(identity: Identity) -> str:
    """Model and firmware in words."""
    if identity == PINGS_ONLY:
        return MUTE_TEXT
    name = MODELS[identity[0]].name if identity[0] in MODELS else "unknown"
    return f"{name} (model {identity[0]}), firmware {identity[1]}"


def silence_text(port: Port, clock: Clock, servo_id: int, protocol: float) -> str:
    """Description of a silent servo's id: the servo is asked once in the other protocol."""
    other = 1.0 if protocol == 2.0 else 2.0
    identity = identify(port, clock, servo_id, other)
    return "no answer" if identity is None else f"{_OTHER_PROTOCOL} {other}: {identity_text(identity)}"


def mismatch_hint(port: Port, found_texts: Iterable[str], *, any_answers: bool) -> str:
    """Advice on servos with these findings; `any_answers`: whether another servo answers."""
    texts = tuple(found_texts)
    if MUTE_TEXT in texts:
        return "a servo that answers pings only: mmmd doctor --fix lets it answer everything (status_return_level 2)"
    if any(text.startswith(_OTHER_PROTOCOL) for text in texts):
        return (
            "one protocol on a bus: set the servo's protocol with the DYNAMIXEL Wizard, or correct the robot file (MX"
            " servos flashed to 2.0 end in '-2')"
        )
    if any_answers:
        return "check ids and cables: a servo keeps its id, a chain is cut behind the last one that answers"
    return f"nothing answers at {port.baud} baud on {port.name}: check power, and the baud (?baud=...; mmmd scan tries all)"
