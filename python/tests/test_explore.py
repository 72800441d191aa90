"""The page in a notebook: what it asks is answered without a browser."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl

import numpy as np
import pytest

import kickdrift as kd
from kickdrift import _widget

FIGURE1: dict[str, Any] = {"lambda1": "pi^2", "lambda2": "pi^2/25"}


class Front:
    """A front end that asks by messages and keeps what comes back."""

    def __init__(self, page: Any, monkeypatch: pytest.MonkeyPatch) -> None:
        self.page = page
        self.answers: dict[str, tuple[dict[str, Any], bytes]] = {}
        monkeypatch.setattr(type(page), "send", self.keep)

    def keep(self, content: dict[str, Any], buffers: list[bytes]) -> None:
        self.answers[content["id"]] = content, buffers[0]

    def say(self, **content: str) -> None:
        self.page._handle_custom_msg(content, [])

    def answer(self, number: str) -> tuple[dict[str, Any], bytes]:
        end = time.monotonic() + 60
        while number not in self.answers and time.monotonic() < end:
            time.sleep(0.01)
        return self.answers[number]


@pytest.fixture
def front(monkeypatch: pytest.MonkeyPatch) -> Front:
    return Front(kd.explore(**FIGURE1), monkeypatch)


def test_a_point_is_the_verdict() -> None:
    told = kd.explore(**FIGURE1).ask("point", h1="1/10", h2="3/10")
    verdict = json.loads(kd.decide(**FIGURE1, h1="1/10", h2="3/10").to_json())
    assert verdict.items() <= told.items()


def test_a_tile_comes_as_bytes_of_the_map(front: Front) -> None:
    front.say(id="a-1", path="tile", query="unit=8/25&level=0&x=0&y=0&size=16")
    content, data = front.answer("a-1")
    assert (content["status"], content["type"], data[:4]) == (200, "application/octet-stream", b"KDT1")
    cells = np.frombuffer(data, np.uint8, offset=16).reshape(16, 16).T
    grid = kd.map(**FIGURE1, step="1/50", h1=("1/50", "16/50"), h2=("1/50", "16/50"))
    assert ((cells & 3) == 1).tolist() == (~grid.stable).tolist()


def test_files_of_the_page_are_answers_too(front: Front) -> None:
    front.say(id="a-1", path="fonts/LibertinusSerif-Regular.otf")
    front.say(id="a-2", path="../Cargo.toml")
    assert front.answer("a-1")[1][:4] == b"OTTO"
    assert front.answer("a-2")[0]["status"] == 404


#: A tile of 65,536 long periods: some seconds, if nobody stops it.
LONG = "unit=1/4&level=15&x=65536&y=65536"


def test_a_question_that_is_stopped_has_no_answer_and_ends_soon(front: Front) -> None:
    front.say(id="a-1", path="tile", query=LONG)
    time.sleep(0.2)
    front.say(stop="a-1")
    front.say(stop="a-1")
    start = time.monotonic()
    front.page._workers.shutdown(wait=True)
    assert time.monotonic() - start < 15
    assert front.answers == {}


def test_what_takes_too_long_is_cut_off_and_ends(front: Front, monkeypatch: pytest.MonkeyPatch) -> None:
    assert _widget._LONGEST == 30
    monkeypatch.setattr(_widget, "_LONGEST", 0.2)
    start = time.monotonic()
    front.say(id="a-1", path="tile", query=LONG)
    content, data = front.answer("a-1")
    assert content["status"] == 422
    assert json.loads(data)["too_costly"]["message"] == "this takes longer than half a minute"
    front.page._workers.shutdown(wait=True)
    with pytest.raises(kd.KickdriftError, match="longer than half a minute"):
        front.page.ask("tile", **dict(parse_qsl(LONG)))
    assert time.monotonic() - start < 25
    # One answer to a question.
    assert list(front.answers) == ["a-1"]


def test_closing_ends_all_work(front: Front) -> None:
    for number in range(12):
        front.say(id=f"a-{number}", path="tile", query=LONG)
    time.sleep(0.2)
    front.page.close()
    start = time.monotonic()
    front.page._workers.shutdown(wait=True)
    assert time.monotonic() - start < 40
    assert front.answers == {}


def test_the_page_leaves_the_notebook_its_looks() -> None:
    page = kd.explore(**FIGURE1, height=500)
    assert page.height == 500
    style = str(page._css)
    assert "@font-face" not in style
    # Every rule is below the page's own class, or of a document that is the page's.
    selectors = [line.split("{")[0] for line in style.splitlines() if line[:1] in (".", "#", "h", "b")]
    assert all("explore" in selector for selector in selectors)
    assert "export default" in str(page._esm)


def test_a_window_and_a_unit_are_what_the_page_begins_with() -> None:
    told = kd.explore(**FIGURE1, h1=(0, "1/4"), h2="1/2..1", unit="fs").ask("start")
    assert (told["window"], told["unit"], told["rho"]) == ([0, 0.25, 0.5, 1], "fs", "1/25")


def test_a_system_grows_where_its_verdict_says(tmp_path: Path) -> None:
    system = kd.System(
        {
            "masses": [1, 1],
            "potentials": [
                {"step": "1/10", "springs": [[0, 1, 10]]},
                {"step": "1/2", "springs": [[0, None, "1/2"]]},
            ],
        }
    )
    page = kd.explore(system=system)
    told = page.ask("system", samples=5)
    assert told["own"] == 0.5
    assert told["verdict"]["stable"] == system.decide().stable
    assert page.ask("start")["system"] is not None
    # Of a file too, with what its text refers to beside it.
    assert kd.explore(system=kd.System.read(system.save(tmp_path))).ask("system", samples=5) == told


@pytest.mark.parametrize(
    ("use", "field"),
    [
        (lambda: kd.explore(lambda1=1), "lambda2"),
        (lambda: kd.explore(lambda1="1/0", lambda2=1), "lambda1"),
        (lambda: kd.explore(**FIGURE1, h1=(0, 1)), "h2"),
        (lambda: kd.explore(**FIGURE1, h1="0..x", h2=(0, 1)), "h1"),
        (lambda: kd.explore(lambda1=1, system=kd.System({})), "lambda1"),
        (lambda: kd.explore(system=kd.System({})), "masses"),
        (lambda: kd.explore(**FIGURE1).ask("nothing"), "question"),
        (lambda: kd.explore(**FIGURE1).ask("point", h1="1"), "h2"),
        (lambda: kd.explore(**FIGURE1).ask("tile", unit=1, level=100, x=1 << 100, y=1 << 100), "tile"),
    ],
)
def test_what_is_wrong_is_named(use: Callable[[], Any], field: str) -> None:
    with pytest.raises(kd.KickdriftError) as caught:
        use()
    assert caught.value.field == field
