"""Writes a sequence of pictures as a film: GIF by Pillow, MP4 (H.264) by PyAV."""

from __future__ import annotations

import importlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from daemon.pictures.errors import FilmError

GIF_FPS = 20.0
"""Frames a second of a GIF: it counts whole hundredths of a second, and many viewers show no frame for less than two."""
_GIF_COLOURS = 96


def write_film(pictures: Iterable[Image.Image], file: Path, fps: float) -> int:
    """Write the pictures at `fps` a second to `file`; return their number.

    The file is written completely or not at all.

    Raises:
        FilmError: the suffix is neither .gif nor .mp4, PyAV is missing, or there are no pictures.
    """
    writers = {".gif": _write_gif, ".mp4": _write_mp4}
    if file.suffix not in writers:
        raise FilmError(f"{file}: {file.suffix or 'no suffix'} is no film that mmmd writes; allowed are .gif and .mp4")
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(f".{file.stem}.part{file.suffix}")
    try:
        n = writers[file.suffix](pictures, part, fps)
        part.replace(file)
    finally:
        part.unlink(missing_ok=True)
    return n


def _write_gif(pictures: Iterable[Image.Image], file: Path, fps: float) -> int:
    every = max(1, round(fps / GIF_FPS))
    kept = [
        p.quantize(_GIF_COLOURS, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE) for p in list(pictures)[::every]
    ]
    if not kept:
        raise FilmError(f"{file}: no pictures to write")
    kept[0].save(file, save_all=True, append_images=kept[1:], duration=round(1000 * every / fps), loop=0, optimize=True)
    return len(kept)


def _write_mp4(pictures: Iterable[Image.Image], file: Path, fps: float) -> int:
    try:
        av: Any = importlib.import_module("av")  # its types are incomplete
    except ImportError as error:
        raise FilmError(f"{file}: .mp4 needs PyAV; `pip install mmmd[film]`, or write a .gif") from error
    n = 0
    with av.open(str(file), "w") as container:
        stream = None
        for picture in pictures:
            if stream is None:
                stream = container.add_stream("libx264", rate=round(fps), options={"crf": "20"})
                stream.width, stream.height, stream.pix_fmt = picture.width, picture.height, "yuv420p"
            container.mux(stream.encode(av.VideoFrame.from_ndarray(np.asarray(picture), format="rgb24")))
            n += 1
        if stream is None:
            raise FilmError(f"{file}: no pictures to write")
        container.mux(stream.encode())
    return n
