"""Random and mutated byte strings into both roles of both codecs: only the named error, and the next good packet found.

A thousand strings a codec by default; the million of the acceptance test is a soak: make soak, or
`pytest -m soak tests/daemon/dynamixel/codec/test_fuzz.py`.
"""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.group import FastGroupReply, GroupReply
from daemon.dynamixel.codec.packet import Instruction, Packet
from daemon.errors import PacketError

IDS = [1, 2, 3]


def _pieces(rng: random.Random) -> list[bytes]:
    """Good packets of all kinds, to be mutated."""
    data = rng.choice([rng.randbytes(10), bytes(rng.choices([0xFF, 0xFD, 0], k=10))])
    return [
        packet.ping(rng.randrange(253)), packet.read(1, 132, 4), packet.write(1, 116, data), packet.sync_read(126, 10, IDS),
        packet.sync_write(116, 10, [(i, data) for i in IDS]), packet.bulk_read([(1, 126, 10)]),
        packet.bulk_write([(1, 116, data)]), b"".join(packet.status(i, 0, data) for i in IDS),
        packet.fast_status([packet.Part(i, 0, data) for i in IDS]), packet1.ping(1), packet1.write(1, 30, data),
        packet1.sync_write(30, 10, [(i, data) for i in IDS]), packet1.bulk_read([(1, 36, 6)]), packet1.status(1, 0, data),
    ]  # fmt: skip


def _mutated(rng: random.Random) -> bytes:
    raw = bytearray(rng.choice(_pieces(rng)))
    for _ in range(rng.randrange(1, 4)):
        at, kind = rng.randrange(len(raw) + 1), rng.randrange(5)
        if kind == 0 and at < len(raw):
            raw[at] ^= 1 << rng.randrange(8)
        elif kind == 1:
            del raw[at : at + rng.randrange(1, 6)]
        elif kind == 2:
            raw[at:at] = rng.randbytes(rng.randrange(1, 6))
        elif kind == 3:
            raw[at:at] = rng.choice([packet.HEADER, packet.STUFFED, packet1.HEADER, b"\xff\xff\xfd\x00\x01\xff\x0f"])
        else:
            raw = raw[:at] + raw[: len(raw) - at]
        if not raw:
            raw = bytearray(b"\xff")
    return bytes(raw)


Feed = Callable[[bytes], list[Packet]]
Codec = tuple[str, Callable[[], Feed], Callable[[Packet], object], bytes, Packet]
CODECS: list[Codec] = [
    ("2.0 controller", lambda: packet.PacketDecoder().feed, lambda p: packet.fast_parts(p, [10] * 3),
     packet.status(9, 0x80, b"\1\2"), Packet(9, 0x55, b"\1\2", 0x80)),
    ("2.0 servo", lambda: packet.PacketDecoder().feed, packet.accesses, packet.read(9, 7, 1), Packet(9, Instruction.READ, b"\7\0\1\0")),
    ("1.0 controller", lambda: packet1.PacketDecoder(answers=True).feed, lambda p: packet1.error_text(p.error),
     packet1.status(9, 4, b"\1\2"), Packet(9, 0x55, b"\1\2", 4)),
    ("1.0 servo", lambda: packet1.PacketDecoder(answers=False).feed, packet1.accesses, packet1.read(9, 7, 1), Packet(9, Instruction.READ, b"\7\1")),
]  # fmt: skip


def fuzz(codec: Codec, n: int, seed: int) -> None:
    rng = random.Random(seed)
    _, make, understand, good_raw, good = codec
    group, fast = GroupReply(IDS, 10), FastGroupReply(IDS, 10)
    for i in range(n):
        raw = rng.randbytes(rng.randrange(120)) if i % 2 else _mutated(rng)
        feed = make()
        found = feed(raw)
        for p in found:
            try:
                understand(p)
            except PacketError:
                pass
        group.parse(raw)
        fast.parse(raw)
        # A packet that was no packet (one checksum byte in 256 is right by chance) may have swallowed the first copy.
        assert good in feed(good_raw) or good in feed(good_raw + good_raw), (i, raw.hex())


@pytest.mark.parametrize("codec", CODECS, ids=lambda c: c[0])
def test_a_thousand_strings(codec: Codec) -> None:
    fuzz(codec, 1000, 1)


@pytest.mark.soak
@pytest.mark.parametrize("codec", CODECS, ids=lambda c: c[0])
def test_a_million_strings(codec: Codec) -> None:
    fuzz(codec, 250_000, 2)
