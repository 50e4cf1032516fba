"""Errors of drawing pictures and films."""

from __future__ import annotations

from daemon.errors import DaemonError


class NoOpenGLError(DaemonError):
    """No OpenGL library that draws without a screen could be loaded."""


class FilmError(DaemonError):
    """A film cannot be written: an unknown kind of file, or a library that is not installed."""
