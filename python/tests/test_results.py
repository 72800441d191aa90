"""Results are frozen, copied as themselves and pickled; inputs that would be dropped in silence are refused."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kickdrift as kd
from kickdrift._held import Held
from kickdrift._monodromy import Monodromy
from kickdrift._native import palette
from kickdrift._orbit import monodromy

PAIR = {"lambda1": "pi^2", "lambda2": "pi^2/25"}
GRID: dict[str, Any] = PAIR | {"step": "1/25", "h1": ("1/25", "2/pi"), "h2": (1, "7/2")}
FAST, SLOW = np.diag([0.39, 0.41]), np.array([[0.02, 0.01], [0.01, 0.02]])


def molecule() -> kd.System:
    levels = {"fast": ("1/2", FAST), "slow": (4, SLOW)}
    return kd.System.from_hessians([1.0, 1.0], levels, time_unit="fs", notes=["a note"])


def springs() -> kd.System:
    return kd.System({"masses": [1], "potentials": [{"step": "1/10", "springs": [[0, None, 10]]}]})


def orbit() -> Monodromy:
    def force(positions: np.ndarray) -> np.ndarray:
        return np.asarray(-2.0 * positions)

    return monodromy({"all": force}, [Fraction(1, 10)], np.zeros((1, 3)), Held(np.ones(1)), 1e-3, "minimum")


RESULTS: dict[str, Callable[[], Any]] = {
    "Advice": lambda: kd.advise({"OH": "10fs", "slow": "40fs"}, steps=["0.5fs", "4fs"]),
    "Aperture": lambda: kd.aperture("OH:K=553kcal/mol/A^2,15.999,1.008", steps=4),
    "Closings": lambda: kd.closings(max_sum=5),
    "Comparison": lambda: kd.compare(max_sum=5, rho="1/25", samples=3),
    "Curves": lambda: kd.curves(a="0..1", b="0..1"),
    "Intervals": lambda: molecule().intervals(("1/2", 5), resolution=1e-2),
    "Map": lambda: kd.map(**GRID, label=True, growth=True),
    "Monodromy": orbit,
    "Number": lambda: kd.number("pi^2/25"),
    "Proposition": lambda: kd.proposition(max=3),
    "Recheck": lambda: kd.recheck(kd.proposition(max=3)),
    "Run": lambda: kd.simulate(springs(), periods=3),
    "System": molecule,
    "SystemAdvice": lambda: molecule().advise(),
    "SystemVerdict": lambda: molecule().decide(),
    "Tongues": lambda: kd.tongues("5/3", rho="1/25"),
    "Verdict": lambda: kd.decide(lambda1="pi^2", lambda2=0.04, h1="1/100", h2=0.98, friction="1/10", budget=10**6),
    "Verdicts": lambda: kd.verdicts(lambda1=1, lambda2=1, h1=[0.1, 0.2], h2=1),
}


def told(result: Any) -> list[Any]:
    """All that a result tells: its text, its document, its arrays."""
    arrays = getattr(result, "arrays", {})
    arrays = {**arrays, **{name: getattr(result, name) for name in ARRAYS if hasattr(type(result), name)}}
    document = result.to_json() if hasattr(result, "to_json") else None
    # The verdict about an orbit is no array.
    arrays = {name: array.tobytes() for name, array in arrays.items() if isinstance(array, np.ndarray)}
    return [repr(result), str(result), document, arrays]


ARRAYS = ("verdict", "tier", "stable_pairs", "h1_steps", "multipliers", "matrix", "growth_rates")


@pytest.mark.parametrize("name", RESULTS)
def test_every_result_is_copied_and_pickled(name: str) -> None:
    result = RESULTS[name]()
    assert type(result).__name__ == name
    # All that is computed when it is asked for is asked for: it must not stand in the way.
    before = told(result)
    for other in (copy.copy(result), copy.deepcopy(result), pickle.loads(pickle.dumps(result))):
        assert type(other) is type(result) and told(other) == before
    again = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(result))))
    assert told(again) == before


def test_a_copied_map_is_drawn_and_answers_as_before() -> None:
    found = kd.map(**GRID, growth=True)
    again = pickle.loads(pickle.dumps(found))
    assert again.to_svg() == found.to_svg() and again.to_csv() == found.to_csv()
    assert not again.verdict.flags.writeable and again.document == found.document


def arrays_of(name: str) -> dict[str, np.ndarray]:
    result = RESULTS[name]()
    fields = [field for field in dir(type(result)) if isinstance(getattr(type(result), field), property)]
    fields += ["multipliers", "matrix", "code", "tier", "half", "positions"]
    found = {field: getattr(result, field, None) for field in fields} | dict(getattr(result, "arrays", {}))
    return {field: value for field, value in found.items() if isinstance(value, np.ndarray)}


@pytest.mark.parametrize("name", ["Map", "Monodromy", "System", "SystemVerdict", "Verdicts"])
def test_arrays_of_results_cannot_be_written_to(name: str) -> None:
    found = arrays_of(name)
    assert found
    for field, array in found.items():
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
        assert not array.flags.writeable, field


def test_a_system_keeps_what_it_was_given() -> None:
    given = FAST.copy()
    system = kd.System.from_hessians([1.0, 1.0], {"fast": ("1/2", given), "slow": (4, SLOW)}, time_unit="fs")
    before = system.decide()
    given[0, 0] = 100.0
    assert system.decide() == before


HESSIANS: dict[str, Any] = {
    "complex": FAST + 1e-3j,
    "complex objects": (FAST + 1e-3j).astype(object),
    "masked": np.ma.masked_array(FAST, mask=np.eye(2, dtype=bool)),
    "text": "x",
    "ragged": [[1.0], [1.0, 2.0]],
    "nan": FAST * np.nan,
    "infinite": FAST + np.inf,
}


@pytest.mark.parametrize("kind", HESSIANS)
def test_hessians_that_would_lose_something_are_refused_by_name(kind: str) -> None:
    with pytest.raises(kd.KickdriftError) as caught:
        kd.System.from_hessians([1.0, 1.0], {"f": ("1/2", HESSIANS[kind]), "slow": (4, SLOW)})
    assert caught.value.field in ("f", "f[0]") and caught.value.value and caught.value.remedy


def test_positions_and_masses_are_finite_and_masked_steps_refused() -> None:
    for field, given in {"positions": {"positions": [[0, 0, np.nan]]}, "masses": {"masses": [np.inf]}}.items():
        with pytest.raises(kd.KickdriftError, match="not finite") as caught:
            kd.System.from_hessians(**({"masses": [1.0], "potentials": {"f": (1, np.eye(3))}} | given))
        assert caught.value.field == field
    with pytest.raises(kd.KickdriftError, match="masked") as caught:
        kd.verdicts(lambda1=1, lambda2=1, h1=np.ma.masked_array([0.1, 0.2], mask=[True, False]), h2=1)
    assert caught.value.field == "h1"
    with pytest.raises(kd.KickdriftError, match="not finite"):
        kd.System(dict(molecule().document), {"masses": [np.nan, 1.0]})


def test_accuracy_is_that_of_the_document() -> None:
    assert molecule().accuracy == 1e-6 and springs().accuracy is None
    assert kd.System.from_hessians([1.0], {"f": (1, [[1.0]])}, accuracy=1e-3).accuracy == 1e-3


def test_advice_is_asked_of_a_system_and_carries_its_warnings(tmp_path: Path) -> None:
    system = molecule()
    advice = kd.advise(system, steps=[("0.5fs", "5fs")])
    assert advice == system.advise(steps=[("0.5fs", "5fs")])
    assert advice.warnings[0] == "a note" and str(advice).splitlines()[3] == "warning: a note"
    assert str(system.decide()).startswith("warning: a note\n") and "warnings: 1" in repr(system.decide())
    with pytest.raises(kd.KickdriftError) as caught:
        kd.advise(system, hmr=3)
    # Heavy hydrogens are known by where they are.
    assert caught.value.field in ("masses", "positions")
    # A total that is not positive definite is warned of by the verdict, and so by the advice.
    bent = kd.System.from_hessians([1.0, 1.0], {"fast": ("1/2", FAST), "slow": (4, -SLOW * 30)}, time_unit="fs")
    assert any("positive definite" in warning for warning in bent.decide().warnings)
    assert bent.advise().warnings == bent.decide().warnings and "positive definite" in str(bent.advise())


@pytest.mark.parametrize("levers", [True, False])
def test_warnings_stand_between_what_is_advised_and_why(levers: bool) -> None:
    cheap, correction = [[0.5, 0], [0, 0.5]], [[0.02, 1e-4], [-1e-4, 0.02]]
    levels = {"cheap": ("1/2", cheap), "correction": (4, correction)}
    learned = kd.System.from_hessians([1, 1], levels, time_unit="fs", symmetric=False, notes=["a note"])
    for system in (molecule(), learned):
        lines = str(system.advise(levers=levers)).splitlines()
        place = lines.index("warning: a note")
        words = [line.partition(":")[0] for line in lines[:place]]
        assert words[0] == "advice" and set(words) <= {"advice", "limit", "longer"}
        assert lines[place + 1].startswith("4 fs ")


def test_steps_with_units_are_taken_in_the_systems_unit() -> None:
    given = {"fs": ("0.5fs", "0.004 ps"), "ps": ("0.5fs", "4000as"), "ns": (Fraction(1, 2 * 10**6), "4fs")}
    for unit, steps in given.items():
        levels = {"fast": (steps[0], FAST), "slow": (steps[1], SLOW)}
        system = kd.System.from_hessians([1.0, 1.0], levels, time_unit=unit)
        inner, outer = (kd.number(potential["step"]).fraction for potential in system.document["potentials"])
        scale = {"fs": 1, "ps": 1000, "ns": 10**6}[unit]
        assert (inner * scale, outer * scale) == (Fraction(1, 2), 4)
    with pytest.raises(kd.KickdriftError, match="time_unit"):
        kd.System.from_hessians([1.0], {"fast": ("0.5fs", [[1.0]])})
    with pytest.raises(kd.KickdriftError, match="positive"):
        kd.System.from_hessians([1.0], {"fast": (0, [[1.0]])})
    with pytest.raises(kd.KickdriftError, match="rational"):
        kd.System.from_hessians([1.0], {"fast": ("pi", [[1.0]])})


@pytest.mark.parametrize("where", [True, False])
@pytest.mark.parametrize("linear", [True, False])
def test_rigid_motions_are_projected_out_of_three_clocks_as_of_two(where: bool, linear: bool) -> None:
    """A free molecule whose Hessians know their rigid motions to rounding only is stable on three clocks too."""
    rng = np.random.default_rng(5)
    positions = rng.normal(size=(4, 3)) * ([1, 0, 0] if linear else [1, 1, 1])
    masses = rng.uniform(1, 20, size=4)

    def bonds(strength: float) -> np.ndarray:
        matrix = np.zeros((12, 12))
        for i in range(4):
            for j in range(i):
                along = (positions[i] - positions[j]) / np.linalg.norm(positions[i] - positions[j])
                row = np.zeros(12)
                row[3 * i : 3 * i + 3], row[3 * j : 3 * j + 3] = along, -along
                matrix += strength * np.outer(row, row)
        noise = rng.normal(size=(12, 12)) * 1e-9 * strength
        return matrix + noise + noise.T

    levels = {"a": ("1/100", bonds(100.0)), "b": ("1/50", bonds(10.0)), "c": ("1/25", bonds(1.0))}
    system = kd.System.from_hessians(masses, levels, positions=positions if where else None, accuracy=1e-7)
    # Bonds along a line leave bends alone: a null space of nine is larger than that of rigid motions.
    if linear and not where:
        with pytest.raises(kd.KickdriftError, match="9"):
            system.decide()
    else:
        verdict = system.decide()
        removed, by = 5 if linear else 6, "positions" if where else "common null space"
        assert verdict.measured["rigid_motions"]["count"] == removed
        assert verdict.measured["rigid_motions"]["found_by"] == by
        assert (verdict.stable and verdict.proven) or linear
    for clocks in ("abc", "ab"):
        chosen = {name: levels[name] for name in clocks}
        kept = kd.System.from_hessians(masses, chosen, positions=positions if where else None, keep_rigid=True)
        verdict = kept.decide()
        assert verdict.data["degrees_of_freedom"] == 12 and not (verdict.measured or {}).get("rigid_motions")


def test_drawings_have_the_programs_colours_and_legends() -> None:
    colours, families, growth = palette()
    assert len(families) == 8 and len(growth) == 256 and colours["unstable"] == colours["hyperbolic"]
    axes = kd.advise({"OH": "10fs", "slow": "40fs"}, steps=[("0.5fs", "4fs"), ("0.5fs", "5fs")]).plot()
    drawn = [text.get_text() for text in axes.get_legend().get_texts()]
    assert len(drawn) == len(set(drawn)) and {"unstable, proven", "recommended"} <= set(drawn)
    assert molecule().advise().plot().get_legend() is not None
    assert len(kd.map(**GRID).plot().get_legend().get_texts()) >= 1
    import matplotlib.colors

    shown = {matplotlib.colors.to_hex(patch.get_facecolor()) for patch in axes.patches}
    assert shown <= {colours["safe"], colours["caution"], colours["unstable"], matplotlib.colors.to_hex("0.92")}


def test_sparse_levels_are_decided_as_dense_ones_in_the_first_region() -> None:
    sparse = pytest.importorskip("scipy.sparse")
    rng = np.random.default_rng(3)
    count = 40
    # A row of particles on bonds of two lengths, held by weak walls: stiff within pairs, soft between them.
    bonds = np.diag(np.full(count, 2.0)) - np.diag(np.ones(count - 1), 1) - np.diag(np.ones(count - 1), -1)
    fast = np.kron(np.diag(rng.uniform(0.9, 1.1, count // 2)), [[4e5, -4e5], [-4e5, 4e5]])
    slow = 500.0 * bonds
    steps = ("0.5fs", "2.5fs")
    given = {"keep_rigid": True, "time_unit": "ps", "accuracy": 1e-8}
    names = ("bonds", "rest")
    dense = kd.System.from_hessians(
        np.ones(count), dict(zip(names, zip(steps, (fast, slow), strict=True), strict=True)), **given
    )
    matrices = (sparse.csr_matrix(fast), sparse.coo_array(slow))
    system = kd.System.from_hessians(
        np.ones(count), dict(zip(names, zip(steps, matrices, strict=True), strict=True)), **given
    )
    assert system.document["potentials"][0]["stiffness"] == {"npz": "arrays.npz", "csr": "hessian0"}
    decided, truth = system.decide(), dense.decide()
    assert decided.stable and truth.stable and decided.proven
    assert decided.measured is not None and truth.measured is not None
    found, edge = decided.measured["first_unstable"], truth.measured["first_unstable"]["lo"]
    assert found["lo"] <= edge < found["hi"] < 1.01 * found["lo"]
    assert pickle.loads(pickle.dumps(decided)).stable and kd.recheck(decided).holds
    with pytest.raises(kd.KickdriftError) as caught:
        system.intervals(("1/500", "1/200"))
    assert caught.value.field == "intervals"


@pytest.mark.parametrize("form", ["csr_matrix", "csc_matrix", "coo_matrix", "lil_matrix", "csr_array", "coo_array"])
def test_a_triangle_of_a_sparse_matrix_is_refused_with_its_entry_and_never_halved(form: str) -> None:
    sparse = pytest.importorskip("scipy.sparse")
    whole = np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -0.5], [0.0, -0.5, 2.0]])
    made = getattr(sparse, form)

    def system(matrix: np.ndarray) -> kd.System:
        potentials = {"fast": ("1/8", made(np.eye(3))), "slow": ("1/2", made(matrix))}
        return kd.System.from_hessians(np.ones(3), potentials, accuracy=1e-6, keep_rigid=True)

    for triangle in (np.tril(whole), np.triu(whole)):
        with pytest.raises(kd.KickdriftError) as caught:
            system(triangle)
        assert caught.value.field in ("slow[1, 0]", "slow[0, 1]") and caught.value.value == "-1.0"
        assert "is 0.0, and they differ by 1" in caught.value.remedy
        # What the remedy says is what was meant.
        mended = system(triangle + triangle.T - np.diag(triangle.diagonal()))
        assert np.array_equal(mended.arrays["hessian1.data"], system(whole).arrays["hessian1.data"])
    off = np.array([[0.0, 1e-3, 0.0], [0.0] * 3, [0.0] * 3])
    with pytest.raises(kd.KickdriftError, match=r"differ by 0\.001"):
        system(whole + off)
    # Within the accuracy it is split evenly, as a dense one.
    assert system(whole + 1e-4 * off).decide().proven
    with pytest.raises(kd.KickdriftError, match="of shape"):
        system(whole[:2])
