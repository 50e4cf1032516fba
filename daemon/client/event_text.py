"""Events of the daemon as lines for people."""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees

from daemon.wire.events import Accepted, Ack, Cancelled, Done, Progress, Refusal
from daemon.wire.showing import in_words


def describe(event: object) -> str:
    """One line about an event, for people."""
    if isinstance(event, Accepted):
        reason = f" ({event.reason})" if event.reason else ""
        length = f"; {event.duration_s:.1f} s" if event.duration_s else ""
        length += ", round and round until another command or `mmmd stop` ends it" if event.goes_on else ""
        lacks = f"; this robot cannot show all of it: {event.lacks}" if event.lacks else ""
        is_told = len(event.commands) > 1 or event.denied or event.refers_to
        read = f"; read as: {'; '.join(event.commands)}" if is_told else ""
        denied = f"; not: {', '.join(event.denied)}" if event.denied else ""
        return f"{event.status}: {event.understood}{reason}{length}{lacks}{read}{denied}"
    if isinstance(event, Progress):
        if event.scene is not None:
            taken = "left out" if event.status == "rejected" else event.status
            return f"scene {event.scene}: {event.text} ({taken}{': ' if event.reason else ''}{event.reason})"
        if event.first_motion_ms is None:
            return f"{event.stage}: {event.reason}" if event.reason else f"{event.stage} ..."
        after = "the text" if event.target_t_mono is None else "the first target"
        return f"{event.stage}: first servo frame {event.first_motion_ms:.0f} ms after {after}"
    if isinstance(event, Done):
        verdict = f"{event.shown}: {_verdict(event)}; " if event.shown else ""
        return (
            f"done: {verdict}{event.duration_s:.2f} s; fastest {event.peak_speed_joint}, {degrees(event.peak_speed_rad_s):.0f} of "
            f"{degrees(event.peak_speed_limit_rad_s):.0f} deg/s; {event.clipped_frames} of {event.frames} frames clipped; "
            f"direction error {event.direction_error_deg:.1f} deg"
        )
    if isinstance(event, Cancelled):
        return f"cancelled by {event.by}"
    if isinstance(event, Ack):
        return f"{event.verb}: the robot was {in_words(event.state)}" + (f"; {event.note}" if event.note else "")
    if isinstance(event, Refusal):
        return event.message
    return str(event)


def repeatable(events: Iterable[object]) -> str:
    """Sentences about a motion that a language model can repeat to a person; they name no figures of joints.

    Args:
        events: events of an accepted command, up to its end or to its acceptance.
    """
    told, began = list[str](), ""
    for event in events:
        if isinstance(event, Accepted):
            length = f", for {event.duration_s:.1f} s" if event.duration_s and not event.goes_on else ""
            length += (
                ", on and on until something else is said, or `stop` or `cancel` is called" if event.goes_on else ""
            )
            began = f"it begins: {event.understood or event.text}{length}"
            told += [f"only in part: {event.reason}"] if event.reason else []
            told += [f"this robot cannot show all of it: {event.lacks}"] if event.lacks else []
            told += [f"left out as asked: {', '.join(event.denied)}"] if event.denied else []
        elif isinstance(event, Progress) and event.scene is not None:
            shown = f"left out, {event.reason}" if event.status == "rejected" else event.understood or event.status
            told.append(f"scene {event.scene}, {event.text!r}: {shown}")
        elif isinstance(event, Done):
            seen = (
                f"; {_verdict(event)}" if event.missing else f"; seen on the robot: {event.seen}" if event.seen else ""
            )
            told.append(f"done after {event.duration_s:.1f} s{seen}")
            began = ""
        elif isinstance(event, Ack):
            told.append("stopped" if event.verb == "stop" else f"{event.verb} was carried out")
            began = ""
    return "\n".join([*told, began] if began else told)


def _verdict(event: Done) -> str:
    """Text of what the motion shows, and of what is missing on the robot, if anything."""
    return f"its motion {event.seen}; on the robot: {event.missing}" if event.missing else event.seen
