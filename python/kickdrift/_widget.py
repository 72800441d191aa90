"""The widget of `kickdrift.explore`: questions come as messages, answers go back as bytes."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from threading import Timer
from typing import Any
from urllib.parse import urlencode

import anywidget
import traitlets

from kickdrift import _native
from kickdrift._errors import KickdriftError

#: A page asks for six tiles at once; two more, so that what the pointer asks need not wait for them.
_AT_ONCE = 8

#: Seconds that a question may take, as the server has it.
_LONGEST = _native.Page.LONGEST

_FILES = _native.Page.of_springs("1", "1", None, None)


def _file(name: str) -> str:
    return _FILES.ask(name, "", _native.Stop())[2].decode()


@contextmanager
def _overdue(act: Callable[[], None]) -> Iterator[None]:
    """Does `act` once what is within takes longer than a question may."""
    timer = Timer(_LONGEST, act)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


class Explorer(anywidget.AnyWidget):
    """The page of the program as a widget; `ask` answers its questions without it."""

    _esm = _file("explore.js")
    # The faces come as answers: a notebook has no addresses for them.
    _css = "\n".join(line for line in _file("page.css").splitlines() if not line.startswith("@font-face"))
    height = traitlets.Int(640).tag(sync=True)

    def __init__(self, page: _native.Page, height: int) -> None:
        super().__init__(height=height)
        self._page = page
        self._stops: dict[str, _native.Stop] = {}
        self._workers = ThreadPoolExecutor(_AT_ONCE, thread_name_prefix="kickdrift-explore")
        self.on_msg(self._hear)

    def ask(self, question: str, **parameters: str | int) -> Any:
        """The answer to a question of the page: JSON as Python's, anything else as bytes.

        Raises
        ------
        KickdriftError
            A question that there is not, a bad parameter, or an answer that costs too much or takes longer than half a
            minute.
        """
        stop, late = _native.Stop(), []

        def end() -> None:
            late.append(True)
            stop.set()

        with _overdue(end):
            status, media, data = self._page.ask(question, urlencode(parameters), stop)
        if late and status != 200:
            status, media, data = self._page.overdue(question)
        body: Any = json.loads(data) if media == "application/json" else data
        if status == 200:
            return body
        if status == 404:
            raise KickdriftError("question", question, "the page asks no such question")
        error = body.get("error") or {"field": question, "value": None, "remedy": body["too_costly"]["message"]}
        raise KickdriftError(error["field"], error["value"], error["remedy"])

    def _hear(self, _: object, content: dict[str, Any], __: object) -> None:
        """A question with its number, answered beside the kernel's thread, which goes on hearing; or the end of one."""
        if "stop" in content:
            stop = self._stops.pop(content["stop"], None)
            if stop is not None:
                stop.set()
            return
        self._stops[content["id"]] = stop = _native.Stop()
        self._workers.submit(self._answer, content["id"], content["path"], content.get("query", ""), stop)

    def _answer(self, number: str, path: str, query: str, stop: _native.Stop) -> None:
        # One that was stopped while it waited is not begun.
        if number not in self._stops:
            return

        def late() -> None:
            # At once, however soon the work ends.
            self._reply(number, *self._page.overdue(path))
            stop.set()

        with _overdue(late):
            status, media, data = self._page.ask(path, query, stop)
        self._reply(number, status, media, data)

    def _reply(self, number: str, status: int, media: str, data: bytes) -> None:
        """An answer to a question that has none yet, and was not stopped."""
        if self._stops.pop(number, None) is not None:
            self.send({"id": number, "status": status, "type": media}, [data])

    def close(self) -> None:
        """Stop all work, and take the widget away."""
        for stop in list(self._stops.values()):
            stop.set()
        self._stops.clear()
        self._workers.shutdown(wait=False, cancel_futures=True)
        super().close()
