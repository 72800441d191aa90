"""What was computed, kept in a file: work that was cut short goes on from there.

A file is a line that says what it is, a digest of what all of it is about, and records: a digest of what a record is
of, the count of its doubles, a checksum, the doubles. Each is written in one piece behind the others; of a file that
was cut short anywhere all whole records stand.
"""

from __future__ import annotations

import os
import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from hashlib import blake2b
from io import FileIO
from os import PathLike
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from kickdrift._errors import KickdriftError
from kickdrift._rigid import Doubles

Part: TypeAlias = "str | float | npt.NDArray[Any]"

_MAGIC = b"kickdrift journal 1\n"
_DIGEST, _HEAD = 32, 32 + 8 + 4


def _digest(parts: tuple[Part, ...]) -> bytes:
    whole = blake2b(digest_size=_DIGEST)
    for part in parts:
        encoded = part.encode() if isinstance(part, str) else np.asarray(part).tobytes()
        # With its length, so that no two lists of parts are one text.
        whole.update(len(encoded).to_bytes(8, "little") + encoded)
    return whole.digest()


@dataclass(frozen=True, eq=False)
class Journal:
    """Doubles by what they are of; ``names`` are part of that for all that is asked here."""

    path: Path
    places: dict[bytes, tuple[int, int]]
    names: tuple[Part, ...] = ()

    @staticmethod
    def at(path: str | PathLike[str] | None, *about: Part) -> Journal | None:
        """The journal in the file about this, which is made if there is none; None without a path.

        Raises
        ------
        KickdriftError
            A file about something else, or that is no such file; one that cannot be read and written.
        """
        if path is None:
            return None
        name, head = Path(path), _MAGIC + _digest(about)
        try:
            with name.open("a+b", buffering=0) as file:
                file.seek(0)
                begin = file.read(len(head))
                if not head.startswith(begin):
                    is_other = begin.startswith(_MAGIC)
                    what = "keeps the work on other positions or another system" if is_other else "holds something else"
                    raise KickdriftError("resume", str(name), f"{what}: name another file, or delete it")
                if begin != head:
                    file.truncate(0)
                    file.write(head)
                return Journal(name, _records(file, len(head)))
        except OSError as error:
            raise _failed(name, error.strerror) from error

    def under(self, *names: Part) -> Journal:
        """The same file, asked about something narrower."""
        return replace(self, names=(*self.names, *names))

    def kept(self, compute: Callable[[], Doubles], *about: Part) -> Doubles:
        """What was computed of this, in the shape that it has; computed now and kept where it is not there yet.

        Raises
        ------
        KickdriftError
            Where the file cannot be read or written any more.
        """
        key = _digest((*self.names, *about))
        try:
            if key in self.places:
                place, count = self.places[key]
                with self.path.open("rb") as file:
                    file.seek(place)
                    shape, values = np.split(np.frombuffer(file.read(8 * count)), [_AXES])
                return values.reshape([int(length) for length in shape if length >= 0]).copy()
            found = np.array(compute(), dtype=np.float64, order="C")
            shape = np.full(_AXES, -1.0)
            shape[: found.ndim] = found.shape
            data = np.concatenate([shape, found.ravel()]).tobytes()
            record = key + (len(data) // 8).to_bytes(8, "little") + _checksum(key + data) + data
            # Unbuffered: what is written is there, whatever becomes of this process.
            with self.path.open("ab", buffering=0) as file:
                if file.write(record) < len(record):
                    raise _failed(self.path, "no space is left")
                self.places[key] = (file.tell() - len(data), len(data) // 8)
            return found
        except OSError as error:
            raise _failed(self.path, error.strerror) from error


#: Axes of an array, at most.
_AXES = 3


def _failed(path: Path, why: str | None) -> KickdriftError:
    return KickdriftError("resume", str(path), f"cannot be read and written: {why}")


def _checksum(content: bytes) -> bytes:
    return zlib.crc32(content).to_bytes(4, "little")


def _records(file: FileIO, begin: int) -> dict[bytes, tuple[int, int]]:
    """Where the doubles of each record are, and how many; what a record that was cut short left is cut off."""
    places, end = {}, file.seek(0, os.SEEK_END)
    place = file.seek(begin)
    while place + _HEAD <= end:
        head = file.read(_HEAD)
        key, count = head[:_DIGEST], int.from_bytes(head[_DIGEST : _DIGEST + 8], "little")
        if place + _HEAD + 8 * count > end or head[_DIGEST + 8 :] != _checksum(key + file.read(8 * count)):
            break
        places[key] = (place + _HEAD, count)
        place += _HEAD + 8 * count
    file.truncate(place)
    return places
