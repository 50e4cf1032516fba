"""The files of a report's folder: one JSON file for each measurement, and whether it is still valid."""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import os
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any, cast

import msgspec

from daemon.bench.all_figures.process import Outcome
from daemon.bench.all_figures.table import Measurement
from daemon.bench.report import machine
from daemon.errors import CommandError

ROOT = Path(__file__).parents[3]
"""Path of the clone, or of the folder of installed packages."""
PACKAGES = ("mmm_core", "retarget", "daemon", "sim")
_NOT_MEASURED = ("daemon/bench/all_figures/",)
"""Prefixes of files that only make the report: changing them changes no figure."""
DIGITS = 12
MOST_CHARACTERS = 300
"""Number of characters that a record keeps, at most, of the last output of a failed command."""


class Record(msgspec.Struct, frozen=True, kw_only=True):
    """The stored result of a measurement.

    Attributes:
        name: name of the measurement.
        command: the command as typed.
        version: version of mmmd.
        commit: commit of the clone; "" without a clone.
        code: digest of the packages' files; measurements with equal digests measure the same code.
        machine: processor, cores, system, Python.
        date: date of the end, ISO 8601, UTC.
        seconds: wall time of the command.
        quick: whether small numbers were taken.
        others_took: share of the processors' time that other processes took; None where unknown.
        host_took: share that the host of a virtual machine took; None where unknown.
        status: exit status; None where the command exceeded its time limit.
        error: reason why there are no values; "" where there are values.
        values: the command's JSON.
    """

    name: str
    command: str
    version: str
    commit: str
    code: str
    machine: str
    date: str
    seconds: float
    quick: bool = False
    others_took: float | None = None
    host_took: float | None = None
    status: int | None = 0
    error: str = ""
    values: dict[str, Any] | None = None


@dataclass(frozen=True)
class Here:
    """The measured program and its machine: version, commit, digest of the code."""

    version: str
    commit: str
    code: str
    machine: str


def here(root: Path = ROOT) -> Here:
    """This installation on this machine."""
    return Here(importlib.metadata.version("mmmd"), _commit(root), _digest(root), machine())


def read_records(folder: Path, table: Sequence[Measurement]) -> dict[str, Record]:
    """The records of a folder, by name.

    Raises:
        CommandError: a file is not a record.
    """
    found: dict[str, Record] = {}
    for name in (m.name for m in table):
        path = folder / f"{name}.json"
        if path.is_file():
            try:
                found[name] = msgspec.json.decode(path.read_bytes(), type=Record)
            except msgspec.DecodeError as error:
                raise CommandError(f"bench all: {path}: {error}; remove it to measure it again") from None
    return found


def write_record(folder: Path, record: Record) -> None:
    """Write a record atomically."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{record.name}.json"
    draft = path.with_suffix(".draft")
    draft.write_bytes(msgspec.json.format(msgspec.json.encode(record), indent=1) + b"\n")
    os.replace(draft, path)


def why_again(record: Record | None, command: str, now: Here) -> str:
    """Reason why a measurement has to be made (again); "" where its record is valid."""
    if record is None:
        return "missing"
    if record.error:
        return f"failed before: {record.error}"
    if record.machine != now.machine:
        return "measured on another machine"
    if record.code != now.code:
        return f"measured with other code ({record.commit or record.version})"
    if record.command != command:
        return f"measured by `{record.command}`"
    return ""


def record_of(
    measurement: Measurement, command: str, outcome: Outcome, now: Here, date: datetime, *, quick: bool
) -> Record:
    """The record of a command's outcome: its JSON, or the reason why there is none.

    Args:
        measurement: the measurement.
        command: the command as typed.
        outcome: outcome of the command.
        now: the code and the machine before the command ran; values of code that changed meanwhile are not kept.
        date: date of the end.
        quick: whether small numbers were taken.
    """
    values, error = _values(measurement, outcome)
    if here().code != now.code:
        values, error = None, "the code was changed while it ran"
    return Record(
        name=measurement.name, command=command, version=now.version, commit=now.commit, code=now.code, machine=now.machine,
        date=date.isoformat(timespec="seconds"), seconds=round(outcome.seconds, 1), quick=quick,
        others_took=None if outcome.others_took is None else round(outcome.others_took, 3),
        host_took=None if outcome.host_took is None else round(outcome.host_took, 3),
        status=outcome.status, error=error, values=values,
    )  # fmt: skip


def _values(measurement: Measurement, outcome: Outcome) -> tuple[dict[str, Any] | None, str]:
    if outcome.status is None:
        return None, f"ended after {measurement.limit_s:g} s"
    try:
        values = json.loads(outcome.said)
    except ValueError:
        return None, f"status {outcome.status}: {outcome.last_lines[-MOST_CHARACTERS:] or 'it printed no JSON'}"
    if not isinstance(values, dict):
        return None, f"status {outcome.status}: it printed no JSON object"
    return _without(values, measurement.leave_out), ""


def _without(values: Any, keys: Sequence[str]) -> Any:
    if not isinstance(values, Mapping):
        return values
    kept = cast(Mapping[str, Any], values)
    return {key: _without(value, keys) for key, value in kept.items() if key not in keys}


def _commit(root: Path) -> str:
    """The short commit of a clone, with "-changed" where its packages differ from it; "" where there is no clone."""
    if not (root / ".git").exists():
        return ""
    try:
        commit = _git(root, "rev-parse", "--short=9", "HEAD").strip()
        changed = _git(root, "status", "--porcelain", "--untracked-files=no", "--", *PACKAGES).strip()
    except (OSError, subprocess.SubprocessError):
        return ""
    return commit + ("-changed" if changed else "")


def _git(root: Path, *words: str) -> str:
    return subprocess.run(
        ["git", "-C", str(root), *words], capture_output=True, text=True, check=True, timeout=30
    ).stdout


def _digest(root: Path) -> str:
    """Digest of the names and contents of the packages' files, except those that only make the report."""
    whole = hashlib.sha256()
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*")):
            name = path.relative_to(root).as_posix()
            if path.is_file() and "__pycache__" not in path.parts and not name.startswith(_NOT_MEASURED):
                whole.update(name.encode())
                whole.update(hashlib.sha256(path.read_bytes()).digest())
    return whole.hexdigest()[:DIGITS]
