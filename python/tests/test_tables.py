"""Tables, maps, systems: the program's documents, as Python's results."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import FrozenInstanceError
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import REPOSITORY

import kickdrift as kd
from kickdrift import _native

TABLES: list[tuple[Callable[[], kd.Table], list[str]]] = [
    (lambda: kd.tongues("5/3", rho="1/25"), ["tongues", "--ratio=5/3", "--rho=1/25"]),
    (
        lambda: kd.tongues("7/3", lambda1="pi^2", lambda2="pi^2/25", m=[3, 4], digits=30, columns=["growth", "exact"]),
        [
            "tongues",
            "--ratio=7/3",
            "--lambda1=pi^2",
            "--lambda2=pi^2/25",
            "--m=3,4",
            "--digits=30",
            "--columns=growth,exact",
        ],
    ),
    (
        lambda: kd.tongues(max_sum=6, rho="1/25", lambda1=1, h1=(0, 2), h2="0..3", a="0..1", b="-2..2"),
        [
            "tongues",
            "--max-sum=6",
            "--rho=1/25",
            "--lambda1=1",
            "--h1-range=0..2",
            "--h2-range=0..3",
            "--a=0..1",
            "--b=-2..2",
        ],
    ),
    (lambda: kd.closings("5/3", m=4), ["closings", "--ratio=5/3", "--m=4"]),
    (lambda: kd.closings(max_sum=8, rho=("1/100", 10)), ["closings", "--max-sum=8", "--rho-range=1/100..10"]),
    (lambda: kd.curves(a="0..1", b="-1..1", samples=7), ["curves", "--a=0..1", "--b=-1..1", "--samples=7"]),
    (lambda: kd.proposition(max=7), ["proposition", "--max=7"]),
    (
        lambda: kd.compare(max_sum=9, rho="1/25", samples=19, tolerance="1/10"),
        ["compare", "--max-sum=9", "--rho=1/25", "--samples=19", "--tolerance=1/10"],
    ),
]


@pytest.mark.parametrize("number", range(len(TABLES)))
def test_tables_are_those_of_the_program(program: Callable[..., str], number: int) -> None:
    ask, arguments = TABLES[number]
    table = ask()
    assert table.to_json() == program(*arguments, "--format", "json")
    assert table.to_csv() == program(*arguments, "--format", "csv")
    assert table.to_latex() == program(*arguments, "--format", "latex")
    assert table == ask() and hash(table) == hash(ask()) and table != 1
    points = sum(len(row["points"]) for row in table) if isinstance(table, kd.Curves) else len(table)
    assert len(table.to_pandas()) == points and len(table) == len(list(table)) == len(table[:])
    assert type(table).__name__ in repr(table) and table._repr_html_().count("<tr>") == min(len(table), 20) + 1
    with pytest.raises(FrozenInstanceError):
        table._json = ""  # type: ignore[misc]
    if len(table):
        with pytest.raises(TypeError):
            table[0]["m"] = 1  # type: ignore[index]
    if not isinstance(table, kd.Comparison | kd.Proposition):
        found = kd.recheck(table)
        assert found.holds and bool(found)


def test_a_changed_document_fails_its_recheck(tmp_path: Path) -> None:
    text = kd.tongues("5/3", rho="1/25").to_json()
    path = tmp_path / "tongues.json"
    path.write_text(text)
    assert kd.recheck(path).rows == kd.recheck(text).rows == 7
    document = json.loads(text)
    document["tongues"][2]["lower"]["lo"] *= 0.99
    document["tongues"][2]["lower"]["hi"] *= 0.99
    assert not kd.recheck(json.dumps(document)).holds
    with pytest.raises(kd.KickdriftError):
        kd.recheck(tmp_path / "nowhere.json")
    with pytest.raises(kd.KickdriftError):
        kd.recheck("{}")


@pytest.mark.parametrize(
    ("ask", "field"),
    [
        (lambda: kd.tongues(), "ratio"),
        (lambda: kd.tongues("5/3"), "rho"),
        (lambda: kd.tongues("5/3", max_sum=4, rho=1), "ratio"),
        (lambda: kd.tongues("5/3", rho=1, h1=(0, 1)), "lambda1"),
        (lambda: kd.tongues("5/3", rho=1, lambda1=1, h1=3), "h1"),
        (lambda: kd.tongues("5/3", rho=1, m="x"), "m"),
        (lambda: kd.tongues("5/3", rho=1, columns=["all"]), "columns"),
        (lambda: kd.closings(max_sum=1000), "max_sum"),
        (lambda: kd.closings("5/3", samples=1), "samples"),
        (lambda: kd.compare(lambda1=1), "flags"),
        (lambda: kd.map(lambda1=1, lambda2=1, h1=(0, 1), h2=(0, 1)), "step"),
        (lambda: kd.map(lambda1=1, lambda2=1, h1=(0, 1), h2="1", step=1), "h2"),
        (lambda: kd.map(lambda1=-1, lambda2=1, h1=(0, 1), h2=(0, 1), step=1), "lambda1"),
    ],
)
def test_bad_questions_are_refused_by_name(ask: Callable[[], Any], field: str) -> None:
    with pytest.raises(kd.KickdriftError) as caught:
        ask()
    assert caught.value.field == field
    assert caught.value.remedy and "--" not in str(caught.value)


def test_tongues_are_drawn() -> None:
    table = kd.tongues("7/3", rho="1/25", lambda1="pi^2", h1=(0, "2/pi"), h2=(0, "7/2"))
    assert table._repr_svg_() is not None and "<svg" in table.to_svg()[:400]
    assert kd.tongues("5/3", rho="1/25")._repr_svg_() is None
    assert len(table.plot().patches) == len(table)
    assert len(kd.curves(a="0..1", b="0..1").plot().lines) > 0


GRID = {"lambda1": "pi^2", "lambda2": "pi^2/25", "step": "1/25", "h1": ("1/25", "2/pi"), "h2": ("1/25", "7/2")}
FLAGS = ["--lambda1=pi^2", "--lambda2=pi^2/25", "--step=1/25", "--h1-range=1/25..2/pi", "--h2-range=1/25..7/2"]


@pytest.mark.parametrize(("label", "growth"), [(False, False), (True, False), (True, True)])
def test_maps_are_those_of_the_program(program: Callable[..., str], tmp_path: Path, label: bool, growth: bool) -> None:
    found = kd.map(**GRID, label=label, growth=growth)
    flags = FLAGS + ["--label"] * label + ["--growth"] * growth
    assert found.to_json() == program("map", *flags, "--format", "json")
    assert found.to_csv() == program("map", *flags, "--format", "csv")
    program("map", *flags, "--output", str(tmp_path / "map.npz"))
    archive = np.load(tmp_path / "map.npz")
    for name, values in found.arrays.items():
        np.testing.assert_array_equal(values, archive[name])
        assert values.dtype == archive[name].dtype
    assert [name.decode() for name in archive["verdict_names"]] == list(found.names)
    assert [name.decode() for name in archive["tier_names"]] == list(found.tier_names)


def test_a_map_without_unstable_pairs_has_the_same_document(program: Callable[..., str]) -> None:
    found = kd.map(lambda1=1, lambda2=0, step="1/3", h1=("1/3", 1), h2=("1/3", 1), threads=1)
    flags = ["--lambda1=1", "--lambda2=0", "--step=1/3", "--h1-range=1/3..1", "--h2-range=1/3..1"]
    assert found.to_json() == program("map", *flags, "--format", "json")


def test_a_map_is_shown_in_all_forms(program: Callable[..., str], tmp_path: Path) -> None:
    found = kd.map(**GRID, label=True, growth=True)
    assert found.to_xarray().growth_rate.values is found.growth_rate
    assert found.to_xarray().attrs["lambda2"] == "pi^2/25"
    frame = found.to_pandas()
    assert len(frame) == found.verdict.size and (frame.stable == found.stable.ravel()).all()
    assert (found.m[~found.stable & ~np.isnan(found.growth_rate)] >= 1).all()
    assert len(found.plot().images) == 1 and len(found.plot(colour="growth").images) == 1
    program("map", *FLAGS, "--output", str(tmp_path / "map.svg"))
    assert found.to_svg() == (tmp_path / "map.svg").read_text() == found._repr_svg_()
    assert "unstable" in found._repr_html_() and repr(found).startswith("Map(15 x 87")
    with pytest.raises(kd.KickdriftError, match="label=True"):
        _ = kd.map(**GRID).m


SYSTEMS = ["three-clocks", "fpu-quartic", "water4", "bar-resonant"]


@pytest.mark.parametrize("name", SYSTEMS)
def test_verdicts_on_systems_are_those_of_the_program(program: Callable[..., str], name: str) -> None:
    path = REPOSITORY / "data" / "scenes" / f"{name}.json"
    verdict = kd.System.read(path).decide()
    assert verdict.to_json() == program("system", str(path), "--format", "json")
    # The last line says where the rest is: in the other's own word.
    few = program("system", str(path), "--format", "text").replace("with --details", "in .details")
    assert f"{verdict}\n" == few
    assert f"{verdict.details}\n" == program("system", str(path), "--details", "--format", "text")
    assert verdict.data["stable"] == verdict.stable == bool(verdict) and verdict.kind == verdict.data["kind"]
    assert float(verdict.period) > 0 and verdict.proven in (True, False) and "SystemVerdict(" in repr(verdict)
    assert kd.recheck(verdict).holds
    assert len(verdict.plot().lines) == 3 and "<svg" in (verdict._repr_svg_())[:400]


def test_a_system_made_in_python_is_that_of_its_file(program: Callable[..., str], tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    root = rng.normal(size=(6, 6))
    system = kd.System.from_hessians(
        np.ones(6), {"fast": ("1/40", 400 * np.eye(6)), "slow": ("1/10", root @ root.T)}, accuracy=1e-7, title="made"
    )
    verdict = system.decide()
    path = system.save(tmp_path)
    assert verdict.to_json() == program("system", str(path), "--format", "json")
    assert kd.System.read(path).decide().to_json() == verdict.to_json()
    assert verdict.measured is not None and verdict.measured["accuracy"] == 1e-7
    assert kd.recheck(verdict).holds and kd.recheck(verdict.to_json(), folder=tmp_path).holds
    assert "made" in repr(system) and "fast: step 1/40" in repr(system)
    table = system.intervals(("1/100", "1/5"), resolution=1e-2)
    flags = ["system", str(path), "--intervals=outer=1/100..1/5", "--resolution=0.01"]
    assert table.to_json() == program(*flags, "--format", "json")
    assert table.to_csv() == program(*flags, "--format", "csv")
    assert "<svg" in table.to_svg()[:400]
    assert system.decide(accuracy=1e-3, keep_rigid=True, budget=10**9).stable in (True, False)


def test_arrays_are_taken_from_memory(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    stiff, soft = np.diag([400.0, 300.0]), np.array([[1.0, -1.0], [-1.0, 1.0]], order="F")
    system = kd.System.from_hessians([1.0, 2.0], {"stiff": ("1/40", stiff), "soft": ("1/10", soft)})
    written = kd.System.read(system.save(tmp_path)).decide()
    monkeypatch.setattr(kd.System, "save", None)
    assert system.decide().to_json() == written.to_json() and written.stable
    assert "<svg" in system.decide().to_svg() and kd.simulate(system, periods=3, displace="1/100").data is not None
    document = dict(system.document)
    with pytest.raises(kd.KickdriftError, match="is no array given: there are masses") as caught:
        kd.System(document, {"masses": np.ones(2)}).decide()
    assert (caught.value.field, caught.value.value) == ("potentials[0].stiffness", "hessian0")
    with pytest.raises(kd.KickdriftError, match="array of two axes"):
        kd.System(document, {**system.arrays, "hessian1": np.ones(4)}).decide()


def test_floats_in_a_system_mean_what_they_print() -> None:
    one = kd.System({"masses": [1.5], "potentials": [{"step": 0.1, "springs": [[0, None, np.float64(0.3)]]}]})
    steps = one.decide().data["input"]["system"]["potentials"][0]
    assert steps["step"] == "1/10" and steps["springs"][0][2] == "3/10"
    assert one.decide(exact=True).stable and one.decide().measured is None and one.decide().warnings == ()


def test_a_run_is_that_of_the_program(program: Callable[..., str]) -> None:
    path = REPOSITORY / "data" / "scenes" / "fpu-quartic.json"
    run = kd.simulate(kd.System.read(path), periods=20, displace=["1/100", 0, 0, 0], staggered=True)
    arguments = ["simulate", str(path), "--periods=20", "--displace=1/100,0,0,0", "--staggered", "--format", "json"]
    assert run.to_json() == program(*arguments) and repr(run) == "Run(20 periods)"
    with pytest.raises(kd.KickdriftError) as caught:
        kd.simulate(kd.System.read(path), displace=[1, 2])
    assert caught.value.field == "displace"


def test_systems_that_make_no_sense_are_refused(tmp_path: Path) -> None:
    (tmp_path / "bad.json").write_text("{")
    for path in ("bad.json", "none.json"):
        with pytest.raises(kd.KickdriftError):
            kd.System.read(tmp_path / path)
    with pytest.raises(kd.KickdriftError):
        kd.System({"masses": [1]}).decide()


def test_the_program_is_in_the_wheel(program: Callable[..., str], capfd: pytest.CaptureFixture[str]) -> None:
    assert program("--version").strip() == f"kickdrift {kd.__version__}"
    assert kd.main(["verdict", "--lambda1", "x"]) == 2
    assert "lambda1" in capfd.readouterr().err
    unstable = ["verdict", "--lambda1", "5", "--lambda2", "0", "--h1", "1", "--h2", "1", "--exit-code", "--quiet"]
    assert kd.main(unstable) == 1


def test_a_part_that_one_row_lacks_has_no_column_of_its_own() -> None:
    # The last tongue of 7/3 has no upper edge.
    found = kd.tongues("7/3", rho="1/25")
    assert found[-1]["upper"] is None
    frame = found.to_pandas()
    assert "upper_lo" in frame and not {"upper", "width", "growth"} & set(frame.columns)
    assert frame.upper_lo.isna().sum() == 1 and "<th>upper</th>" not in found._repr_html_()


def test_edges_are_arrays() -> None:
    found = kd.tongues("7/3", rho="1/25")
    assert found.lower.tolist() == [[row["lower"]["lo"], row["lower"]["hi"]] for row in found]
    assert found.upper[:-1].tolist() == [[row["upper"]["lo"], row["upper"]["hi"]] for row in found[:-1]]
    assert found[-1]["upper"] is None and np.isnan(found.upper[-1]).all()
    none = kd.tongues("7/3", rho="1/25", lambda1=1, h1=("1/1000", "1/500"))
    assert len(none) == 0 and none.lower.shape == (0, 2)
    closed = kd.closings("5/3")
    assert closed.s.shape == closed.rho.shape == (1, 2) and closed.s[0, 0] <= 2.75 <= closed.s[0, 1]
    system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
    stretches = system.intervals(("1/20", "1/5"))
    assert stretches.edges.shape == (5, 2) and (stretches.edges[1:, 0] == stretches.edges[:-1, 1]).all()
    curves = kd.curves(a="0..1", b="0..1", samples=7)
    assert sum(len(points) for points in curves.points.values()) == len(curves.to_pandas())
    for array in (found.lower, closed.rho, stretches.edges, curves.points[0, 1], found.column("m")):
        assert not array.flags.writeable


def test_a_column_is_an_array_of_numbers_or_of_texts() -> None:
    found = kd.tongues("7/3", rho="1/25", lambda1="pi^2")
    assert found.column("m").dtype == np.int64 and found.column("closed").dtype == np.bool_
    assert found.column("lower.h1").shape == (len(found), 2)
    assert found.column("lower.entry").tolist() == [row["lower"]["entry"] for row in found]
    assert np.isnan(found.column("growth.rate")[-1]) and found.column("growth.rate")[0] == found[0]["growth"]["rate"]
    with pytest.raises(kd.KickdriftError, match="there are p, q, m"):
        found.column("edge")
    with pytest.raises(kd.KickdriftError, match="there are lo, hi"):
        found.column("lower.h3")


WRITTEN: dict[str, tuple[Callable[[], Any], tuple[str, ...]]] = {
    "closings": (lambda: kd.closings("5/3"), ("to_json", "to_csv", "to_latex")),
    "comparison": (lambda: kd.compare(max_sum=6, rho="1/25", samples=9), ("to_json", "to_csv", "to_latex")),
    "intervals": (lambda: chain().intervals(("1/20", "1/10")), ("to_json", "to_csv", "to_latex")),
    "map": (lambda: kd.map(**GRID, label=True, growth=True), ("to_json", "to_csv", "to_svg")),
    "plain map": (lambda: kd.map(**GRID), ("to_json", "to_csv", "to_svg")),
    "tongues": (lambda: kd.tongues("5/3", rho="1/25"), ("to_json", "to_csv", "to_latex")),
    "run": (lambda: kd.simulate(chain(), periods=3, displace="1/100"), ("to_json",)),
    "verdict": (lambda: kd.decide(lambda1=1, lambda2=0, h1=1, h2=1), ("to_json", "to_csv", "to_latex")),
    "verdict on a system": (lambda: chain().decide(), ("to_json", "__str__")),
}


def chain() -> kd.System:
    return kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})


@pytest.mark.parametrize("name", WRITTEN)
def test_what_is_written_is_not_computed_again(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    ask, forms = WRITTEN[name]
    result = ask()
    for function in ("ask", "decide", "map", "verdicts"):
        monkeypatch.setattr(_native, function, None)
    assert all(getattr(result, form)() for form in forms)
