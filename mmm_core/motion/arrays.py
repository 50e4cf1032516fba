"""Reads arrays from .npz and .npy files of unknown origin, with sizes checked before memory is allocated and one kind of error.

`numpy.load` trusts the header of a file, and lets the errors of zipfile and zlib through as they are.
"""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

MOST_BYTES = 64 << 20
"""Bytes of all arrays of a file together, unpacked: 40 minutes of motion with its features."""
MOST_ARRAYS = 4096
"""Arrays in a file at most."""
_LONGEST_HEADER = 10_000
"""Bytes of an array's header at most."""


class ArraysError(ValueError):
    """A file without usable arrays; the message names the finding."""


def read_npz(path: Path, most_bytes: int = MOST_BYTES) -> dict[str, NDArray[Any]]:
    """The arrays of an .npz, by name.

    Raises:
        ArraysError: the file is no .npz, is cut off, encrypted or packed in an unknown way, or holds objects or more than
            `most_bytes`.
        OSError: the file cannot be read.
    """
    try:
        with path.open("rb") as f, zipfile.ZipFile(f) as archive:
            members = archive.infolist()
            if len(members) > MOST_ARRAYS:
                raise ArraysError(f"{len(members)} arrays; allowed: {MOST_ARRAYS}")
            unpacked = sum(member.file_size for member in members)
            if unpacked > most_bytes:
                raise ArraysError(f"{unpacked} bytes, unpacked; allowed: {most_bytes}")
            found: dict[str, NDArray[Any]] = {}
            for member in members:
                with archive.open(member) as packed:
                    found[member.filename.removesuffix(".npy")] = _array(packed, member.file_size)
            return found
    except (OSError, ArraysError):
        raise
    except zipfile.BadZipFile as error:
        raise ArraysError("no npz: not even a zip archive" if not zipfile.is_zipfile(path) else f"{error}") from None
    except (
        Exception
    ) as error:  # zipfile (encrypted, unknown packing), zlib, lzma and numpy's header reader raise many kinds
        raise ArraysError(f"not a readable npz ({error})") from None


def read_npy(path: Path, most_bytes: int = MOST_BYTES) -> NDArray[Any]:
    """The array of an .npy.

    Raises:
        ArraysError: the file is no .npy, or holds objects or more than `most_bytes`.
        OSError: the file cannot be read.
    """
    size = path.stat().st_size
    if size > most_bytes:
        raise ArraysError(f"{size} bytes; allowed: {most_bytes}")
    try:
        with path.open("rb") as f:
            return _array(f, size)
    except (OSError, ArraysError):
        raise
    except Exception as error:
        raise ArraysError(f"not a readable npy ({error})") from None


def _array(f: IO[bytes], n_bytes: int) -> NDArray[Any]:
    """The array in the next `n_bytes` of a stream."""
    version = np.lib.format.read_magic(f)
    if version not in ((1, 0), (2, 0)):
        raise ArraysError(f"npy version {version}; allowed: 1.0, 2.0")
    read_header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, is_fortran, dtype = read_header(f, max_header_size=_LONGEST_HEADER)
    if dtype.hasobject:
        raise ArraysError("pickled objects")
    count = 1
    for n in shape:
        count *= int(n)
    if min(shape, default=0) < 0 or count * dtype.itemsize > n_bytes:
        raise ArraysError(f"an array of shape {shape} in {n_bytes} bytes")
    data = f.read(count * dtype.itemsize)
    if len(data) != count * dtype.itemsize:
        raise ArraysError(f"an array of shape {shape} that is cut off")
    return np.frombuffer(data, dtype).reshape(shape, order="F" if is_fortran else "C").copy()
