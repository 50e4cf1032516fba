"""`mmmd install-service`: a systemd unit and a udev rule for the adapter."""

from __future__ import annotations

import getpass
import shutil
import sys
from pathlib import Path

from daemon.errors import CommandError

_UNIT = """\
[Unit]
Description=mmmd: text in, servo motion out
After=network.target
# Tried again without end: what a killed daemon left behind may keep the port for 30 s, an adapter may come back later.
StartLimitIntervalSec=0

[Service]
Type=notify
User={user}
ExecStart={mmmd} run --config {config} --log-json
WatchdogSec=10
TimeoutStartSec=180
# Signals go to the front alone. On SIGTERM it parks the robot and ends the others: at most park_timeout_s and 25 s more.
# When it is killed, the bus process has to live on: it holds, parks, goes limp, gives the port back and ends (30 s).
# With `mixed` or `control-group` systemd kills it at once, with torque on (systemd.kill(5)).
KillMode=process
TimeoutStopSec=45
# A generator without memory is started again by the front while the robot goes on; systemd would stop the service.
OOMPolicy=continue
# Again after a crash, a kill, a port in use (status 1). Not after bad use (2), and never by itself after a latched fault
# (3): a person has to look first.
Restart=on-failure
RestartPreventExitStatus=2 3
RestartSec=5
LimitRTPRIO=50
LimitMEMLOCK=infinity
NoNewPrivileges=yes
ProtectSystem=strict
# /tmp is shared: the lock of the port lies there, also for what a person starts and for a bus process that is left.
ReadWritePaths={state} /tmp
StateDirectory=mmmd

[Install]
WantedBy=multi-user.target
"""
_RULE = """\
# Adapters of Dynamixel buses (U2D2 and other FTDI; OpenRB-150, OpenCM): readable by group dialout, 1 ms latency timer.
SUBSYSTEM=="tty", ATTRS{idVendor}=="0403", ATTRS{idProduct}=="6014", GROUP="dialout", MODE="0660", SYMLINK+="dynamixel"
SUBSYSTEM=="usb-serial", DRIVER=="ftdi_sio", ATTR{latency_timer}="1"
SUBSYSTEM=="tty", ATTRS{idVendor}=="2f5d", GROUP="dialout", MODE="0660", SYMLINK+="dynamixel"
"""
_CONFIG = """\
# Settings of `mmmd run`; `mmmd config show` lists all and where each value comes from.
robot = "reference"
bus = "sim://"
auto_arm = false
"""


def install_service(
    root: Path = Path("/"), user: str = "", config: Path = Path("/etc/mmmd/mmmd.toml"), yes: bool = False
) -> int:
    """Write a systemd unit, a udev rule and a first configuration, and say what to do next. It asks before it writes.

    Example: sudo mmmd install-service --user pi

    Example, to look at the files: mmmd install-service --root trial

    Args:
        root: folder to write below, for packages and trials.
        user: user who runs the daemon; you when not given. Must be in group dialout.
        config: configuration that the service reads; one that exists is kept.
        yes: write without asking; below another --root nothing is asked.
    """
    user = user or getpass.getuser()
    found = Path(shutil.which("mmmd") or sys.argv[0]).absolute()
    files = {
        Path("etc/systemd/system/mmmd.service"): _UNIT.format(
            user=user, mmmd=found, config=config, state="/var/lib/mmmd"
        ),
        Path("etc/udev/rules.d/60-mmmd.rules"): _RULE,
        Path(*config.parts[1:]): _CONFIG,
    }
    if root == Path("/") and not yes and not _agreed([root / relative for relative in files]):
        return 1
    for relative, text in files.items():
        path = root / relative
        if text is _CONFIG and path.exists():
            continue
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, "utf-8")
        except OSError as error:
            raise CommandError(f"{path}: cannot be written ({error}); run with sudo, or name another --root") from error
        sys.stdout.write(f"wrote {path}\n")
    sys.stdout.write("next: edit the configuration, then\n  sudo udevadm control --reload && sudo udevadm trigger\n")
    sys.stdout.write("  sudo systemctl daemon-reload && sudo systemctl enable --now mmmd\n")
    return 0


def _agreed(paths: list[Path]) -> bool:
    """Whether the user agrees to files in the system's folders.

    Raises:
        CommandError: standard input is no terminal, so no one can be asked.
    """
    named = "\n".join(f"  {path}" for path in paths)
    if not sys.stdin.isatty():
        raise CommandError(
            f"install-service: it would write\n{named}\nand nobody can be asked here; --yes agrees, --root DIR tries it"
        )
    sys.stdout.write(f"This writes\n{named}\n(a configuration that exists is kept). Go on? [y/N] ")
    sys.stdout.flush()
    return sys.stdin.readline().strip().lower() in ("y", "yes")
