"""Styles in which a gesture can be made (happily, tiredly, like a machine), with their effects and their words."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Style:
    """A style of gestures.

    Attributes:
        words: words for the style, which follow the gesture's.
        tempo, size: factors on the gesture's tempo and size.
        trunk_pitch_rad, head_pitch_rad: posture, forward and down positive.
        stiffness: 1 for movements without lag, sway or any added movement.
    """

    words: tuple[str, ...]
    tempo: float = 1.0
    size: float = 1.0
    trunk_pitch_rad: float = 0.0
    head_pitch_rad: float = 0.0
    stiffness: float = 0.0


STYLES: dict[str, Style] = {
    "happy": Style(("happily", "cheerfully", "joyfully", "with joy", "in a good mood"), 1.15, 1.12, -0.035, -0.1),
    "sad": Style(
        ("sadly", "tiredly", "wearily", "without energy", "in a sad way", "listlessly"), 0.72, 0.78, 0.11, 0.2
    ),
    "proud": Style(("proudly", "confidently", "with pride", "self-confidently"), 0.95, 1.05, -0.07, -0.08),
    "shy": Style(("shyly", "timidly", "nervously", "hesitantly"), 0.85, 0.72, 0.04, 0.14),
    "stiff": Style(("stiffly", "mechanically", "like a machine", "jerkily"), 1.1, 1.0, 0.0, 0.0, 1.0),
}
