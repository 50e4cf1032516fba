"""Frames of a performance with caption, time and legend, and the contact sheet made of some of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from daemon.pictures.performance import Performance
from daemon.pictures.scene import COLOURS, VIEWS, Scene

Show = Literal["both", "robot", "person"]
_INK, _PALE_INK = (40, 44, 52), (110, 116, 126)
INSTANTS = 8
"""Number of pictures in a row of a contact sheet."""
_PANEL_PX, _LABEL_PX = (300, 320), 28
_DEPTH_SHARE = 0.6
"""Share of the hands' other movement above which movement forward and back adds a view from the side."""


def frames(performance: Performance, show: Show, view: str, size_px: tuple[int, int]) -> Iterator[Image.Image]:
    """Every frame of a performance, in order.

    Args:
        performance: the performance to draw.
        show: the robot, the person, or both side by side; a run has no person.
        view: a name of `scene.VIEWS`.
        size_px: width and height of a frame.

    Raises:
        NoOpenGLError: OpenGL without a screen is missing.
    """
    with_person = show != "robot" and performance.person_m is not None
    with Scene(performance.robot if show != "person" else None, size_px, person=with_person) as scene:
        for frame in range(len(performance)):
            picture = _frame(scene, performance, frame, show, view)
            _write_on(picture, performance, frame, with_person, show)
            yield picture


def contact_sheet(performances: Sequence[Performance], show: Show = "both", view: str = "half") -> Image.Image:
    """Eight instants of each performance: the person above, the robot below; also from the side where depth matters."""
    rows: list[Image.Image] = []
    for performance in performances:
        views = [view, *(["side"] if view != "side" and _depth_matters(performance) else [])]
        rows.append(_title(performance))
        if show != "robot" and performance.person_m is not None:
            rows += [_row(performance, "person", v) for v in views]
        if show != "person":
            rows += [_row(performance, "robot", v) for v in views]
    rows.append(_legend_row())
    sheet = Image.new("RGB", (max(r.width for r in rows), sum(r.height for r in rows)), "white")
    top = 0
    for row in rows:
        sheet.paste(row, (0, top))
        top += row.height
    return sheet


def instants(n_frames: int) -> list[int]:
    """The frames in a contact sheet: equally spaced from the first to the last."""
    return [round(k * (n_frames - 1) / (INSTANTS - 1)) for k in range(INSTANTS)]


def _row(performance: Performance, show: Show, view: str) -> Image.Image:
    width, height = _PANEL_PX
    row = Image.new("RGB", (width * INSTANTS, height + _LABEL_PX), "white")
    ImageDraw.Draw(row).text((8, 4), f"{show}, from the {_FROM[view]}", _PALE_INK, _font(16))
    with Scene(performance.robot if show == "robot" else None, _PANEL_PX, person=show == "person") as scene:
        for k, frame in enumerate(instants(len(performance))):
            picture = _frame(scene, performance, frame, show, view)
            ImageDraw.Draw(picture).text((8, 6), f"{frame / performance.fps:.1f} s", _PALE_INK, _font(16))
            row.paste(picture, (k * width, _LABEL_PX))
    return row


_FROM = {"front": "front", "half": "front, a little to its left", "side": "left"}


def _frame(scene: Scene, performance: Performance, frame: int, show: Show, view: str) -> Image.Image:
    person, faces, goal = performance.person_m, performance.head_faces, performance.goal_rad
    return Image.fromarray(
        scene.draw(
            VIEWS[view],
            performance.robot_rad[frame] if show != "person" else None,
            goal[frame] if goal is not None and show != "person" else None,
            person[frame] if person is not None and show != "robot" else None,
            faces[frame] if faces is not None and show != "robot" else None,
        )
    )


def _write_on(picture: Image.Image, performance: Performance, frame: int, with_person: bool, show: Show) -> None:
    pen = ImageDraw.Draw(picture)
    size = max(14, picture.height // 24)
    pen.text((size, size * 0.8), performance.captions[frame], _INK, _font(size * 1.2))
    pen.text(
        (picture.width - size, size * 0.8), f"{frame / performance.fps:.1f} s", _PALE_INK, _font(size), anchor="ra"
    )
    named = performance.robot.name if show != "person" else ""
    if performance.goal_rad is not None and show != "person":
        named += " (transparent: goal)"
    pen.text(
        (size, picture.height - size * 1.8),
        f"{named}{', person' if with_person and named else ''}",
        _PALE_INK,
        _font(size),
    )
    _legend(pen, picture.width - size, round(picture.height - size * 1.8), size)


def _legend(pen: ImageDraw.ImageDraw, right: float, top: float, size: int) -> None:
    """Draw the colours of the sides, from right to left."""
    for side in ("right", "left"):
        text = f"its {side}"
        right -= pen.textlength(text, _font(size))
        pen.text((right, top), text, _PALE_INK, _font(size))
        right -= size * 0.9
        colour = tuple(round(255 * c) for c in COLOURS[side])
        pen.ellipse((right, top + size * 0.3, right + size * 0.7, top + size), fill=colour)
        right -= size


def _title(performance: Performance) -> Image.Image:
    row = Image.new("RGB", (_PANEL_PX[0] * INSTANTS, 44), "white")
    texts = list(dict.fromkeys(c for c in performance.captions if c))
    title = f"{'; '.join(texts)}   ({performance.robot.name}, {performance.duration_s:.1f} s)"
    ImageDraw.Draw(row).text((8, 8), title, _INK, _font(24))
    return row


def _legend_row() -> Image.Image:
    row = Image.new("RGB", (_PANEL_PX[0] * INSTANTS, 36), "white")
    _legend(ImageDraw.Draw(row), row.width - 10, 8, 16)
    return row


def _depth_matters(performance: Performance) -> bool:
    """Whether the person's hands move much forward and back, which a view from the front hides."""
    if performance.person_m is None:
        return False
    spans = np.ptp(performance.person_m[:, -2:], axis=0)  # wrists: left and right, x left, y up, z forward
    return bool((spans[:, 2] > _DEPTH_SHARE * np.hypot(spans[:, 0], spans[:, 1])).any() and spans[:, 2].max() > 0.15)


def _font(size: float) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(round(size))
