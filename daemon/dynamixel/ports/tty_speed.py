"""The actual speed of a tty, also a speed that termios has no name for (4,500,000 baud)."""

from __future__ import annotations

import fcntl
import struct
import termios

_TCGETS2 = 0x802C542A
"""`ioctl` that reads `struct termios2`: Linux on x86, arm and riscv (asm-generic/termbits.h)."""
_TERMIOS2 = struct.Struct("=4I20B2I")
_SPEEDS = {getattr(termios, name): int(name[1:]) for name in dir(termios) if name[0] == "B" and name[1:].isdigit()}


def tty_speed(fd: int) -> int | None:
    """Baud that is set on an open tty; None where the system cannot tell."""
    buffer = bytearray(_TERMIOS2.size)
    try:
        fcntl.ioctl(fd, _TCGETS2, buffer)
    except OSError:
        return _SPEEDS.get(termios.tcgetattr(fd)[5])
    return int(_TERMIOS2.unpack(buffer)[-1])
