"""What keeps a picture from being drawn."""

from __future__ import annotations

from daemon.errors import DaemonError


class NoOpenGLError(DaemonError):
    """No OpenGL that draws without a screen could be loaded."""


class FilmError(DaemonError):
    """A film cannot be written: an unknown kind of file, or a library that is not installed."""
