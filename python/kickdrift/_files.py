"""Files read up to a size: a device without an end is no input."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from kickdrift._errors import KickdriftError
from kickdrift._numbers import written

#: The longest text, in bytes, as for the program.
_LONGEST = 1 << 30


def text_of(path: str | PathLike[str], remedy: str, else_in: str = "utf-8") -> str:
    """The text of a file in UTF-8 or else in another code, its lines ended as Python has them.

    Raises
    ------
    KickdriftError
        A file that cannot be read, that has a zero byte, as devices and binary files do, or more bytes than any input.
    """
    try:
        found = bytearray()
        with Path(path).open("rb") as file:
            while piece := file.read(1 << 16):
                found += piece
                if b"\0" in piece:
                    raise ValueError("it holds a zero byte: it is no text")
                if len(found) > _LONGEST:
                    raise ValueError(f"it has more than {_LONGEST >> 20} MiB")
        try:
            text = found.decode()
        except UnicodeDecodeError:
            text = found.decode(else_in)
        return text.replace("\r\n", "\n").replace("\r", "\n")
    except (OSError, TypeError, ValueError) as cause:
        raise KickdriftError(written("path", path), "not read", f"{cause}: {remedy}") from cause
