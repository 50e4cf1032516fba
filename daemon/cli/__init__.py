"""`mmmd`, the command line; `main` is its entry point."""

from daemon.cli.program import main

__all__ = ["main"]
