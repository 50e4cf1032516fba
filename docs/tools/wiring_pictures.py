"""The pictures of docs/bus.md and docs/safety.md: how a robot is wired, and what stands between a goal and a servo.

    python -m docs.tools.wiring_pictures docs/pictures

writes them as SVG, which a reader can enlarge and a change of which can be read.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path

INK, PAPER, GREY = "#1f2933", "#ffffff", "#6b7280"
POWER, DATA, STOP, SOFT = "#b45309", "#1d4ed8", "#b91c1c", "#e8eef7"
_FONT = "font-family='system-ui, sans-serif'"


@dataclass
class Drawing:
    """An SVG picture of boxes, lines and words; lengths are pixels."""

    width: int
    height: int
    title: str
    parts: list[str] = field(default_factory=list[str])

    def box(self, x: int, y: int, w: int, h: int, words: str, colour: str = INK, fill: str = SOFT) -> None:
        """A box with words in its middle, line by line."""
        self.parts.append(
            f"<rect x='{x}' y='{y}' width='{w}' height='{h}' rx='6' fill='{fill}' stroke='{colour}' stroke-width='2'/>"
        )
        lines = words.split("\n")
        for k, line in enumerate(lines):
            bold = " font-weight='bold'" if k == 0 else ""
            at = y + h / 2 + 5 + 18 * (k - (len(lines) - 1) / 2)
            self.parts.append(
                f"<text x='{x + w / 2}' y='{at:g}' text-anchor='middle' font-size='14' fill='{INK}'{bold}>{line}</text>"
            )

    def line(self, points: str, colour: str, width: int = 3, *, dashed: bool = False, arrow: bool = False) -> None:
        """A line through points "x,y x,y"."""
        more = (" stroke-dasharray='7 5'" if dashed else "") + (" marker-end='url(#arrow)'" if arrow else "")
        self.parts.append(f"<polyline points='{points}' fill='none' stroke='{colour}' stroke-width='{width}'{more}/>")

    def words(self, x: int, y: int, words: str, colour: str = GREY, size: int = 13, anchor: str = "start") -> None:
        """One line of words."""
        self.parts.append(
            f"<text x='{x}' y='{y}' font-size='{size}' fill='{colour}' text-anchor='{anchor}'>{words}</text>"
        )

    def svg(self) -> str:
        """The picture."""
        head = (
            f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {self.width} {self.height}' width='{self.width}' "
            f"height='{self.height}' role='img' {_FONT}>"
        )
        arrow = (
            f"<defs><marker id='arrow' viewBox='0 0 8 8' refX='7' refY='4' markerWidth='7' markerHeight='7' orient='auto'>"
            f"<path d='M0 0 L8 4 L0 8 z' fill='{INK}'/></marker></defs>"
        )
        paper = f"<rect width='{self.width}' height='{self.height}' fill='{PAPER}'/>"
        return "\n".join([head, f"<title>{self.title}</title>", arrow, paper, *self.parts, "</svg>", ""])


def wiring() -> Drawing:
    """Computer, adapter, chain of servos; the power supply with its switch in the supply line."""
    d = Drawing(900, 400, "Wiring: computer, U2D2, servo chain, power supply with a switch")
    d.box(20, 40, 150, 70, "computer\nmmmd run")
    d.box(260, 40, 140, 70, "U2D2\nUSB adapter", DATA)
    d.line("170,75 260,75", DATA)
    d.words(188, 66, "USB", DATA)
    d.box(490, 30, 150, 90, "power hub\nor SMPS2Dynamixel", POWER)
    d.line("400,75 490,75", DATA)
    d.words(404, 66, "data, ground", DATA)
    for k, name in enumerate(("servo 1", "servo 2", "servo 3", "servo n")):
        x = 330 + 145 * k
        d.box(x, 290, 105, 60, name + ("\nlast" if k == 3 else f"\nid {k + 1}"))
        if k:
            d.line(f"{x - 40},312 {x},312", POWER)
            d.line(f"{x - 40},328 {x},328", DATA)
    d.line("540,120 540,205 300,205 300,312 330,312", POWER)
    d.line("580,120 580,235 315,235 315,328 330,328", DATA)
    d.words(310, 198, "V+ and ground", POWER)
    d.words(330, 254, "data: one line for all (TTL), or a pair (RS-485)", DATA)
    d.box(700, 40, 180, 70, "power supply\nof the servos' voltage", POWER)
    d.line("700,75 672,75", POWER)
    d.line("658,75 640,75", POWER)
    d.parts.append(f"<circle cx='665' cy='75' r='17' fill='{PAPER}' stroke='{STOP}' stroke-width='4'/>")
    d.line("655,85 675,65", STOP, 4)
    d.line("665,92 665,140", STOP, 2)
    d.words(590, 158, "switch within reach: cuts the servos' power,", STOP)
    d.words(590, 176, "whatever runs on the computer", STOP)
    d.words(20, 150, "mmmd estop: torque off", INK, 14)
    d.words(20, 170, "by a packet on the data line.", INK, 14)
    d.words(20, 190, "It needs computer, adapter and", INK, 14)
    d.words(20, 210, "cable to work; the switch does not.", INK, 14)
    d.words(20, 300, "Grounds of adapter and supply", GREY)
    d.words(20, 318, "are one. No servo is powered", GREY)
    d.words(20, 336, "from USB. Long chains: power at", GREY)
    d.words(20, 354, "both ends, or several ports.", GREY)
    return d


def limits() -> Drawing:
    """The way of a goal through limits and gate to the servo, and the limits that each keeps."""
    d = Drawing(900, 430, "Joint limits and the safety gate between a goal and a servo")
    d.box(20, 30, 165, 80, "motion, text,\ntargets of a program\n(any angles)")
    d.box(250, 30, 165, 80, "retargeting\nlimits in time,\nself-contact")
    d.box(480, 30, 165, 80, "gate\nlast before the bytes,\nin the bus process", STOP)
    d.box(710, 30, 165, 80, "servo\nits own limits\nand watchdog")
    for x in (185, 415, 645):
        d.line(f"{x},70 {x + 62},70", INK, 2, arrow=True)
    d.words(680, 136, "every setpoint, every cycle, whoever made it", STOP, anchor="end")
    d.words(680, 154, "brakes where two parts would touch", STOP, anchor="end")
    d.words(705, 136, "stops by itself when the", GREY)
    d.words(705, 154, "bus falls silent, if it can", GREY)
    left, right, top = 120, 780, 250
    d.words(20, top - 40, "one joint, with position_limit_deg of robot.toml", INK, 14)
    d.line(f"{left - 60},{top} {right + 60},{top}", GREY, 2)
    for x, words, colour in (
        (left - 40, "end stop", GREY), (left, "lowest", STOP), (left + 130, "park", GREY), (450, "rest", GREY),
        (right, "highest", STOP), (right + 40, "end stop", GREY),
    ):  # fmt: skip
        d.line(f"{x},{top - 12} {x},{top + 12}", colour, 4 if colour == STOP else 2)
        d.words(x, top + (30 if words != "end stop" else -20), words, colour, anchor="middle")
    d.parts.append(f"<rect x='{left}' y='{top - 6}' width='{right - left}' height='12' fill='{DATA}' opacity='0.25'/>")
    d.words(450, top - 14, "goals lie here, always", DATA, anchor="middle")
    points = " ".join(
        f"{left + 6 * k},{400 - 70 * min(1.0, 6 * k / 110, (right - left - 6 * k) / 110) ** 0.5:.1f}"
        for k in range((right - left) // 6 + 1)
    )
    d.line(points, STOP, 3)
    d.line(f"{left},400 {right},400", GREY, 1)
    d.words(
        450,
        322,
        "greatest speed: velocity limit, less near a limit, so that the joint can always brake before it",
        STOP,
        anchor="middle",
    )
    d.words(450, 418, "position of the joint", GREY, anchor="middle")
    return d


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    for name, drawing in (("wiring", wiring()), ("limits", limits())):
        (folder / f"{name}.svg").write_text(drawing.svg(), encoding="utf-8")
