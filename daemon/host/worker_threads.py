"""How the worker threads of matrix products wait for their next piece of work."""

from __future__ import annotations

from collections.abc import Mapping

WORKER_THREADS: Mapping[str, str] = {"OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive", "GOMP_SPINCOUNT": "3000"}
"""Environment variables, as in the Makefile: one thread unless more are asked for.

Idle workers sleep, since in a busy loop they would take a core from other processes, but only after some microseconds: one that
slept at once would have to be woken for each product. Ten minutes of story on two threads take 1.37 s so, 1.40 s with workers that
never sleep, and 1.75 to 2.0 s with ones that sleep at once.
"""
