"""How far long work is: a bar, lines in a log, or a function of the caller's."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from typing import TypeAlias

from kickdrift._errors import KickdriftError
from kickdrift._errors import shown as said

Progress: TypeAlias = Callable[[int, int], None]
"""Called with what is done and what there is in all."""


def bar(done: int, total: int, what: str = "columns") -> None:
    """A bar on standard error; where that is no terminal, as in a log, four lines in all."""
    if not sys.stderr.isatty():
        if 4 * done // total > 4 * (done - 1) // total:
            print(f"{done} of {total} {what}", file=sys.stderr, flush=True)
        return
    drawn = "#" * (30 * done // total)
    end = "\n" if done == total else ""
    print(f"\r[{drawn:30}] {done} of {total} {what}", end=end, file=sys.stderr, flush=True)


def shown(progress: Progress | bool | None, what: str = "columns") -> Progress | None:
    """Who is called: a bar, the function given, or nobody."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return partial(bar, what=what)
    if not callable(progress):
        raise KickdriftError("progress", said(progress), "give True, or what is called with how much is done and all")
    return progress
