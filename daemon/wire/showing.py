"""Untrusted values in words for error messages: short, one line, and without raising any error. No I/O."""

from __future__ import annotations

from typing import cast

LONGEST_SHOWN = 60
"""Characters of an untrusted text that a message repeats."""
LONGEST_REASON = 300
"""Characters of a decoder's own message that are kept; msgspec repeats the names of unknown fields whole."""
_MOST_BITS = 128

_STATES = {"fault": "in fault", "estop": "in e-stop"}


def in_words(state: str) -> str:
    """A state of the robot as words after "the robot is": "limp", "in fault"."""
    return _STATES.get(state, state)


def shown(value: object) -> str:
    """A value as an error message shows it; containers by their kind alone, as repr() of a deep one raises RecursionError."""
    if isinstance(value, str):
        return repr(value[:LONGEST_SHOWN]) + (f"... ({len(value)} characters)" if len(value) > LONGEST_SHOWN else "")
    if isinstance(value, bool) or value is None:
        return repr(value)
    if isinstance(value, int) and value.bit_length() > _MOST_BITS:  # int() to text has a limit of 4,300 digits
        return f"an integer of {value.bit_length()} bits"
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, dict):
        return "an object"
    return f"an array of {len(cast('list[object]', value))}" if isinstance(value, list) else f"a {type(value).__name__}"


def shortened(error: BaseException) -> str:
    """The message of an error, cut to `LONGEST_REASON` characters; its class where the message cannot be had."""
    try:
        text = str(error) or type(error).__name__
    except Exception:
        return type(error).__name__
    text = text.encode("utf-8", "replace").decode("utf-8")  # half of a surrogate pair cannot be sent
    return text if len(text) <= LONGEST_REASON else f"{text[:LONGEST_REASON]}..."
