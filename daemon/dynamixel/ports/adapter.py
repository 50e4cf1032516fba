"""Data of Linux about a serial adapter: its identity, its latency timer, and its path after a replug."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

SYSFS = Path("/sys")
GOOD_LATENCY_MS = 1
DEFAULT_LATENCY_MS = 16


@dataclass(frozen=True)
class Adapter:
    """Identity of a USB serial adapter, independent of its path."""

    vendor: str
    product: str
    serial: str


def adapter_at(device: str, sysfs: Path = SYSFS) -> Adapter | None:
    """The adapter at a device path; None where the device is no USB device."""
    folder = sysfs / "class" / "tty" / Path(os.path.realpath(device)).name / "device"
    if not folder.exists():
        return None
    for parent in (folder.resolve(), *folder.resolve().parents):
        if (parent / "idVendor").is_file():
            return Adapter(*(_text(parent / name) for name in ("idVendor", "idProduct", "serial")))
    return None


def device_of(adapter: Adapter, sysfs: Path = SYSFS, dev: Path = Path("/dev")) -> str | None:
    """Present path of an adapter; None when it is not plugged in, or cannot be told from others of its kind (no serial number)."""
    if not adapter.serial:
        return None
    for tty in sorted((sysfs / "class" / "tty").glob("*")):
        device = dev / tty.name
        if adapter_at(str(device), sysfs) == adapter:
            return str(device)
    return None


def latency_timer_ms(device: str, sysfs: Path = SYSFS) -> int | None:
    """Milliseconds for which an FTDI adapter holds back an unfilled packet; None where there is no such timer."""
    text = _text(sysfs / "class" / "tty" / Path(os.path.realpath(device)).name / "device" / "latency_timer")
    return int(text) if text.isdigit() else None


def latency_remedy(device: str) -> str:
    """The commands that set the latency timer: now, and permanently."""
    name = Path(os.path.realpath(device)).name
    now = f"echo {GOOD_LATENCY_MS} | sudo tee /sys/class/tty/{name}/device/latency_timer"
    rule = f'ACTION=="add", SUBSYSTEM=="usb-serial", ATTR{{latency_timer}}="{GOOD_LATENCY_MS}"'
    return f"{now}; for good: echo '{rule}' | sudo tee /etc/udev/rules.d/99-latency.rules"


def latency_advice(device: str, sysfs: Path = SYSFS) -> str:
    """The delay of answers by an adapter and its remedy, in words; empty when the delay is short, or there is no timer."""
    timer_ms = latency_timer_ms(device, sysfs)
    if timer_ms is None or timer_ms <= GOOD_LATENCY_MS:
        return ""
    return f"{device} keeps answers back for up to {timer_ms} ms; run: {latency_remedy(device)}"


def _text(path: Path) -> str:
    try:
        return path.read_text("ascii", "replace").strip()
    except OSError:
        return ""
