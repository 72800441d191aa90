"""The same thing may be written in several ways, and results are read in one."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import kickdrift as kd

STEPS = [("0.5fs", "4fs")]
MORSE = {"OH": "morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008"}
TWO_STAGES = "K(b) D(1/2) K(1-2*b) D(1/2) K(b)"


def test_an_enclosure_has_its_ends_by_name_by_attribute_and_unpacked() -> None:
    verdict = kd.decide(lambda1=1, lambda2="1/25", h1="1/2", h2=3)
    lo, hi = verdict.trace
    assert (lo, hi) == (verdict.trace["lo"], verdict.trace.hi) == tuple(verdict.trace)
    system = kd.System({"masses": [1], "potentials": [{"step": 3, "springs": [[0, None, 1]]}]}).decide()
    assert system.growth_bounds is not None and system.growth_bounds["lo"] == system.growth_bounds[0] > 0
    # A row's is a mapping with the same names.
    assert set(kd.tongues("3/2", rho="1/25")[0]["lower"]) >= set(verdict.trace._fields)
    for same in (copy.copy(verdict.trace), pickle.loads(pickle.dumps(verdict.trace))):
        assert same == verdict.trace and same["hi"] == hi
    stable = kd.decide(lambda1=1, lambda2=0, h1=1, h2=1).bias
    assert stable is not None and stable["in_drifts"].lo == stable[1][0]
    with pytest.raises(TypeError):
        verdict.trace["middle"]


def test_named_things_are_a_mapping_or_pairs() -> None:
    named = {"OH": "10fs", "slow": "40fs"}
    assert kd.advise(named, steps=STEPS) == kd.advise(list(named.items()), steps=STEPS)
    with pytest.raises(kd.KickdriftError, match="by name"):
        kd.advise([("OH", "10fs"), ("OH", "40fs")], steps=STEPS)
    by_text = kd.family(TWO_STAGES, parameter="b=0.15..0.25:1/20")
    assert kd.family(TWO_STAGES, parameter={"b": (0.15, 0.25, 0.05)}) == by_text
    assert kd.family(TWO_STAGES, parameter=[("b", ("3/20", "1/4", "1/20"))]) == by_text
    with pytest.raises(kd.KickdriftError, match=r"parameter\[b\]"):
        kd.family(TWO_STAGES, parameter={"b": (0.15, 0.25)})


def test_a_step_and_what_acts_at_it_stand_in_either_order() -> None:
    stiff, soft = [[400.0]], [[1.0]]
    one = kd.System.from_hessians([1.0], {"stiff": ("1/40", stiff), "soft": ("1/10", soft)})
    other = kd.System.from_hessians([1.0], [("stiff", (stiff, "1/40")), ("soft", (np.array(soft), 0.1))])
    assert one.decide() == other.decide()


def test_how_many_bonds_there_are_and_how_hot_reach_the_question() -> None:
    hot = {"bonds": MORSE, "bond_count": 3, "temperature": 310, "length": "1ns"}
    few = kd.advise({"slow": "40fs"}, steps=STEPS, levers=False, **hot)
    assert few.data["input"]["bonds"] == "3" and few.data["input"]["temperature"].startswith("310")
    with pytest.raises(kd.KickdriftError, match="bond_count"):
        kd.advise({"slow": "40fs"}, steps=STEPS, bonds=1700)
    with pytest.raises(kd.KickdriftError, match=r"bonds=\{"):
        kd.advise({"OH": "10fs"}, steps=STEPS, bond_count=1700)
    with pytest.raises(kd.KickdriftError, match="bond_count = 'many'"):
        kd.advise({"OH": "10fs"}, steps=STEPS, bond_count="many")


def test_families_are_an_integer_a_pair_or_a_text() -> None:
    by_text = kd.tongues("7/3", rho="1/25", a="1..1")
    assert kd.tongues("7/3", rho="1/25", a=1) == kd.tongues("7/3", rho="1/25", a=(1, 1)) == by_text
    assert kd.curves(a=(0, 1), b=1, samples=9) == kd.curves(a="0..1", b="1..1", samples=9)


def test_an_enclosure_of_a_row_is_a_range() -> None:
    rows = kd.tongues("7/3", rho="1/25", lambda1=1)
    assert [row["m"] for row in kd.tongues("7/3", rho="1/25", lambda1=1, h1=rows[2]["lower"]["h1"])] == [3]


@pytest.mark.parametrize("ask", [lambda r: kd.tongues(r, rho="1/25"), lambda r: kd.half(r, s=1, rho="1/25")])
def test_a_float_that_stands_for_a_fraction_is_answered_with_it(ask) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(kd.KickdriftError, match="write '7/3'"):
        ask(7 / 3)
    assert ask(2.5) == ask("5/2")


def test_arrays_in_a_systems_document_mean_what_they_print() -> None:
    matrix = [["0.3", "-0.3"], ["-0.3", "0.3"]]
    made = kd.System(
        {"masses": np.ones(2), "potentials": [{"step": 1, "stiffness": np.array([[0.3, -0.3], [-0.3, 0.3]])}]}
    )
    told = kd.System({"masses": [1, 1], "potentials": [{"step": 1, "stiffness": matrix}]})
    assert made.decide().data["parts"] == told.decide().data["parts"]
    with pytest.raises(kd.KickdriftError, match=r"stiffness\[0\]\[1\]"):
        kd.System({"masses": [1], "potentials": [{"step": 1, "stiffness": np.array([[1.0, np.nan]])}]}).decide()
    with pytest.raises(kd.KickdriftError, match=r"System\.read"):
        kd.System("system.json")  # type: ignore[arg-type]


def test_a_scan_has_the_verdicts_of_its_points() -> None:
    def system(step: object) -> kd.System:
        return kd.System({"masses": [1], "potentials": [{"name": "bond", "step": step, "springs": [[0, None, 1]]}]})

    found = system(1).scan({"potentials.bond.step": ("1/2", 3, "1/2")})
    assert found.stable.tolist() == [system(row["x"]).decide().stable for row in found]
    assert found == system(1).scan("potentials.bond.step=1/2..3:1/2")
    both = system(1).scan({"outer": (1, 2, 1), "masses.0": (1, 3, 1)})
    assert len(both) == 6 and both[0]["y"] == "1"
    with pytest.raises(kd.KickdriftError, match="over"):
        system(1).scan({})
    assert len(system(1).intervals((1, 5), path="masses.0")) >= 1


def test_a_word_and_a_family_print_their_answer() -> None:
    assert "order        2 on oscillators" in str(kd.word("K(1/2) D(1) K(1/2)"))
    assert "best " in str(kd.family(TWO_STAGES, parameter="b=0.15..0.25:1/20", minimize="error"))
    assert repr(kd.methods()).endswith("methods)")
