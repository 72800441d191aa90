"""Drawings on matplotlib's axes, in the colours of the program's figures."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from kickdrift import _native
from kickdrift._errors import required
from kickdrift._native import Number

if TYPE_CHECKING:
    from matplotlib.axes import Axes


COLOURS, FAMILIES, GROWTH = _native.palette()
"""Colours by what they stand for, those of families, and those of growth from weak to strong."""

#: Not to be recommended: the program hatches white paper.
_BEYOND = "0.92"


def axes(ax: Axes | None) -> Axes:
    """The axes given, or those of a new figure."""
    if ax is not None:
        return ax
    made: Axes = required("matplotlib.pyplot").figure(layout="constrained").add_subplot()
    return made


def tongues(rows: Sequence[Mapping[str, Any]], ax: Axes | None) -> Axes:
    """Bars from edge to edge in s, up to 4 unless all begin beyond."""
    canvas = axes(ax)
    end = 1.15 * max(row["lower"]["hi"] for row in rows) if rows else 4.0
    for place, row in enumerate(rows):
        lo = row["lower"]["lo"]
        hi = end if row["upper"] is None else row["upper"]["hi"]
        # A line about each bar: a tongue thinner than a pixel shows all the same.
        colour = FAMILIES[(row["a"] or 0) % len(FAMILIES)]
        canvas.barh(place, hi - lo, left=lo, color=colour, edgecolor=colour, linewidth=1.2)
    # Beyond s = 4 the fast clock alone is unstable.
    if any(row["lower"]["lo"] < 4 for row in rows):
        canvas.set_xlim(0, 4.2)
    canvas.set_yticks(range(len(rows)), [f"{row['p']}/{row['q']}, m = {row['m']}" for row in rows])
    canvas.set_xlabel(r"$s = h_1^2 \lambda_1$")
    return canvas


def closings(rows: Sequence[Mapping[str, Any]], ax: Axes | None) -> Axes:
    """A point a closing, with its ratio and label."""
    canvas = axes(ax)
    from matplotlib.ticker import LogLocator, NullFormatter

    for row in rows:
        at = tuple((row[name]["lo"] + row[name]["hi"]) / 2 for name in ("rho", "s"))
        canvas.plot(*at, "o", markersize=4, color=COLOURS["coexistence"])
        words = f"{row['p']}/{row['q']}, m = {row['m']}"
        canvas.annotate(words, at, xytext=(4, 3), textcoords="offset points", fontsize=7)
    canvas.set_xscale("log")
    canvas.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    canvas.xaxis.set_major_formatter("{x:g}")
    canvas.xaxis.set_minor_formatter(NullFormatter())
    canvas.set_xlabel(r"$\rho = \lambda_2/\lambda_1$")
    canvas.set_ylabel(r"$s = h_1^2 \lambda_1$")
    return canvas


def comparison(rows: Sequence[Mapping[str, Any]], ax: Axes | None) -> Axes:
    """A point a disagreement, a colour each kind of it."""
    canvas = axes(ax)
    on_grid = any("h1" in row for row in rows)
    points: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        at = (row["h1"], row["h2"]) if on_grid else (row["s"], f"{row['p']}/{row['q']}")
        points.setdefault(row["offence"] or "tan criterion", []).append((rounded(at[0]), rounded(at[1])))
    for colour, (offence, where) in zip(cycle(FAMILIES), sorted(points.items()), strict=False):
        canvas.plot(*zip(*where, strict=True), ".", markersize=4, color=colour, label=offence)
    if points:
        canvas.legend()
    canvas.set_xlabel("$h_1$" if on_grid else r"$s = h_1^2 \lambda_1$")
    canvas.set_ylabel("$h_2$" if on_grid else "$h_2/h_1$")
    return canvas


def rounded(exact: str) -> float:
    """An exact number of a document as a double."""
    return float(Number(exact))


def intervals(edges: npt.NDArray[np.float64], verdicts: npt.NDArray[np.object_], ax: Axes | None) -> Axes:
    """Stretches of the outer step: stable, unstable, not told."""
    canvas = axes(ax)
    colours = {"stable": COLOURS["safe"], "unstable": COLOURS["unstable"]}
    for verdict in dict.fromkeys(verdicts):
        lo, hi = edges[verdicts == verdict].T
        parts = list(zip(lo, hi - lo, strict=True))
        canvas.broken_barh(parts, (0, 1), color=colours.get(verdict, COLOURS["grey"]), label=verdict)
    canvas.set_yticks([])
    canvas.set_xlabel("outer step")
    canvas.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)
    return canvas


def run(document: Mapping[str, Any], ax: Axes | None) -> Axes:
    """The amplitude over time, and the growth that was predicted."""
    canvas, series = axes(ax), document["series"]
    time = np.array([sample["time"] for sample in series])
    amplitude = np.array([sample["amplitude"] for sample in series])
    canvas.plot(time, amplitude, color=FAMILIES[0], linewidth=0.8, label="amplitude")
    rate = document["growth_rate_predicted"]
    if rate:
        predicted = amplitude[-1] * np.exp(rate * (time - time[-1]))
        canvas.plot(time, predicted, "--", color=COLOURS["grey"], linewidth=1.2, label="predicted growth")
        canvas.set_yscale("log")
        canvas.legend()
    canvas.set_xlabel("time")
    canvas.set_ylabel("amplitude")
    return canvas


def curves(points: Mapping[tuple[int, int], npt.NDArray[np.float64]], ax: Axes | None) -> Axes:
    """One line a family."""
    canvas = axes(ax)
    for (a, _), family in points.items():
        canvas.plot(*family.T, color=FAMILIES[a % len(FAMILIES)], linewidth=0.8)
    canvas.set_xlabel("$h_1$")
    canvas.set_ylabel("$h_2$")
    return canvas


def verdicts(
    h1: npt.NDArray[np.float64],
    h2: npt.NDArray[np.float64],
    codes: npt.NDArray[np.uint8],
    names: Sequence[str],
    ax: Axes | None,
) -> Axes:
    """An image of verdicts over the (h1, h2) plane: what grows, edges and closings in their colours on white."""
    canvas = axes(ax)
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    shown = {"hyperbolic": "exponential growth", "parabolic": "linear growth", "coexistence": "closed tongue"}
    kinds = ["elliptic", *shown]
    kind = np.array([kinds.index(name.rstrip("+-")) for name in names])[codes]
    colours = ListedColormap(["white", *(COLOURS[name] for name in shown)])
    _image(canvas, h1, h2, kind, cmap=colours, vmin=-0.5, vmax=3.5)
    there = {name for number, name in enumerate(kinds) if (kind == number).any()}
    found = [Patch(color=COLOURS[name], label=words) for name, words in shown.items() if name in there]
    if found:
        canvas.legend(handles=found, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(found), frameon=False)
    return canvas


def growth(
    h1: npt.NDArray[np.float64], h2: npt.NDArray[np.float64], rates: npt.NDArray[np.float64], ax: Axes | None
) -> Axes:
    """An image of growth rates over the (h1, h2) plane, with a bar of colours."""
    canvas = axes(ax)
    from matplotlib.colors import ListedColormap

    image = _image(canvas, h1, h2, rates, cmap=ListedColormap(GROWTH), norm="log")
    if canvas.figure is not None:
        canvas.figure.colorbar(image, ax=canvas, label="growth rate")
    return canvas


def _image(
    canvas: Axes, h1: npt.NDArray[np.float64], h2: npt.NDArray[np.float64], values: npt.NDArray[Any], **how: Any
) -> Any:
    halves = [(x[-1] - x[0]) / max(len(x) - 1, 1) / 2 or 0.5 for x in (h1, h2)]
    extent = (h1[0] - halves[0], h1[-1] + halves[0], h2[0] - halves[1], h2[-1] + halves[1])
    canvas.set_xlabel("$h_1$")
    canvas.set_ylabel("$h_2$")
    return canvas.imshow(values.T, origin="lower", extent=extent, aspect="auto", interpolation="nearest", **how)


_PUBLISHED, _NOT, _PROVEN = "proven stable, beyond the published limit", "not to be recommended", "unstable, proven"


def _bars(canvas: Axes, place: int, parts: Sequence[tuple[float, float, str]]) -> None:
    """A row of bars, each kind once in the legend."""
    colours = {_PUBLISHED: COLOURS["caution"], _NOT: _BEYOND, _PROVEN: COLOURS["unstable"]}
    for lo, hi, kind in parts:
        if lo < hi:
            seen = kind in canvas.get_legend_handles_labels()[1]
            colour = colours.get(kind, COLOURS["safe"])
            canvas.barh(place, hi - lo, left=lo, color=colour, height=0.68, label="" if seen else kind)


def advice(document: Mapping[str, Any], ax: Axes | None) -> Axes:
    """Bars over the outer step of the first scheme.

    Proven for the band, proven beyond the published limit, not advised, unstable.
    """
    canvas = axes(ax)
    schemes = document["schemes"]
    rows = [row for row in document["rows"] if row["scheme"] == 1]
    published = _published(document)
    is_known = schemes[0]["status"] != "not told" and schemes[0]["needs"] is None
    alone = len(document["input"]["schemes"][0]) == 1
    outer = [float(Fraction(scheme["outer"])) for scheme in schemes]
    known = [row[f"{which}_{end}"] for row in rows for which in _INTERVALS for end in ("lower", "upper")]
    right = 1.12 * max([end["hi"] for end in known if end is not None] + outer)
    for place, row in enumerate(rows):
        edge = (row["first_lower"] or {"lo": 0.0})["lo"] * (1 - float(Fraction(document["input"]["band"])))
        edge = edge if is_known else 0.0
        least = min(edge, published)
        unstable = {(row[f"{which}_lower"]["lo"], (row[f"{which}_upper"] or {"hi": right})["hi"])
                    for which in _INTERVALS if row[f"{which}_lower"] and (alone or row[f"{which}_upper"])}  # fmt: skip
        parts = [(0.0, least, "proven stable, all periods in the band"), (least, edge, _PUBLISHED), (edge, right, _NOT)]
        _bars(canvas, place, parts + [(*ends, _PROVEN) for ends in sorted(unstable)])
    for number, step in enumerate(outer):
        canvas.axvline(step, color=COLOURS["ink"], linewidth=0.9, label="" if number else "the schemes' steps")
    if schemes[0]["safe"] is not None:
        safe = float(Fraction(schemes[0]["safe"]))
        canvas.axvline(safe, color=COLOURS["ink"], linestyle="--", linewidth=0.9, label="recommended")
    canvas.set_yticks(range(len(rows)), [row["mode"] for row in rows])
    canvas.set_xlim(0, right)
    canvas.set_xlabel("outer step" if "plain_time" in document["input"] else "outer step (fs)")
    canvas.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    return canvas


def _published(document: Mapping[str, Any]) -> float:
    """What bounds the outermost step beside linear theory: T/6.28 of its own forces, T/3 of the others."""
    last = len(document["input"]["schemes"][0])
    shortest = {clock: min(mode["period"]["lo"] for mode in document["modes"] if mode["clock"] == clock)
                for clock in {mode["clock"] for mode in document["modes"]}}  # fmt: skip
    is_lifted = last == 1 and ("harmonic" in document["input"] or "measured" in document)
    turn = [shortest[last] / (2 * math.pi)] if last in shortest and not is_lifted else []
    if last == 1:
        share = {row["mode"]: row["share"] for row in document.get("measured", []) if row["share"] is not None}
        part = 1 - float(Fraction(document["input"]["band"]))
        turn += [
            mode["period"]["lo"] * share[mode["name"]] * part for mode in document["modes"] if mode["name"] in share
        ]
    return min([period / 3 for clock, period in shortest.items() if clock < last] + turn, default=math.inf)


def system_advice(document: Mapping[str, Any], ax: Axes | None) -> Axes:
    """Bars over the outer step, a row a scheme: proven, the first unstable interval; the scheme's own step."""
    canvas, rows = axes(ax), document["rows"]
    right = 1.12 * max(max(float(Fraction(row["outer"])), row["first_upper"] or 0.0) for row in rows)
    for place, row in enumerate(rows):
        edge = row["band_edge"] or 0.0
        parts = [(0.0, edge, "proven stable, all periods in the band"), (edge, right, _NOT)]
        parts += [] if row["first"] is None else [(row["first"]["lo"], row["first_upper"] or right, _PROVEN)]
        _bars(canvas, place, parts)
        step = float(Fraction(row["outer"]))
        name = "" if place else "the schemes' steps"
        canvas.plot([step, step], [place - 0.4, place + 0.4], color=COLOURS["ink"], linewidth=1.2, label=name)
    canvas.set_yticks(range(len(rows)), [f"{float(Fraction(row['outer'])):g} fs, {row['status']}" for row in rows])
    canvas.set_xlim(0, right)
    canvas.set_xlabel("outer step (fs)")
    canvas.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    return canvas


def ladder(document: Mapping[str, Any], ax: Axes | None) -> Axes:
    """Growth over the multiples of the first scheme, and twice that without steps: where the steps add little."""
    canvas, without = axes(ax), document["growth_without_steps"]
    rungs = [rung for rung in document["ladder"] if rung["scheme"] == 1 and rung["growth_rate"] is not None]
    outer = [float(Fraction(rung["outer"])) for rung in rungs]
    middle = [(rung["growth_rate"]["lo"] + rung["growth_rate"]["hi"]) / 2 for rung in rungs]
    canvas.plot(outer, middle, "o-", color=COLOURS["ink"], linewidth=0.8, markersize=3, label="with the steps")
    if without is not None:
        most = document["times"] * without["lo"]
        canvas.axhspan(0, most, color=COLOURS["safe"], linewidth=0, label="at most twice the forces' own growth")
    canvas.set_xlabel("outer step (fs)")
    canvas.set_ylabel("growth (1/ps)")
    canvas.set_ylim(bottom=0)
    canvas.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    return canvas


def aperture(document: Mapping[str, Any], ax: Axes | None) -> Axes:
    """The aperture over the step; a step at which no start is lost stands at 40 kT."""
    canvas, rows, most = axes(ax), document["steps"], 40.0
    steps = np.array([row["h"] for row in rows])
    energy = {
        name: np.array([most if row[name] is None else row[name] for row in rows])
        for name in ("aperture", "half_aperture")
    }
    canvas.plot(steps, energy["half_aperture"], color=FAMILIES[0], linewidth=0.8, label="half of all phases are lost")
    canvas.plot(steps, energy["aperture"], ".-", color=COLOURS["ink"], markersize=3, label="some phase is lost")
    canvas.axhline(document["level"], color=COLOURS["parabolic"], linestyle="--", linewidth=1, label="ln N")
    for place in document["resonances"]:
        if place["h"] is not None and steps.min() <= place["h"] <= steps.max():
            canvas.axvline(place["h"], color=COLOURS["grey"], linestyle=":", linewidth=0.8)
            canvas.annotate(f"k = {place['k']}", (place["h"], most + 1), ha="center", fontsize=7)
    if "steps" in document["input"] and "h_range" in document["input"]:
        chosen = _chosen(document["input"]["steps"], steps)
        canvas.plot(steps[chosen], energy["aperture"][chosen], "o", color=COLOURS["ink"], label="the steps asked for")
    canvas.set_ylim(0, most + 4)
    canvas.set_xlabel("step (fs)")
    canvas.set_ylabel("energy (kT)")
    canvas.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    return canvas


def _chosen(texts: str, steps: npt.NDArray[np.float64]) -> list[int]:
    """The rows of the steps that were asked for one by one, in fs."""
    places = (float(Fraction(step.removesuffix("fs").strip())) for step in texts.split(",") if step.endswith("fs"))
    return [int(np.abs(steps - place).argmin()) for place in places]


_INTERVALS = ("first", "inside", "below", "above")


def multipliers(values: npt.NDArray[np.complex128], ax: Axes | None) -> Axes:
    """Multipliers in the complex plane with the unit circle."""
    canvas = axes(ax)
    turn = np.linspace(0, 2 * np.pi, 361)
    canvas.plot(np.cos(turn), np.sin(turn), color=COLOURS["grey"], linewidth=0.8)
    outside = np.abs(values) > 1 + 1e-9
    canvas.plot(values.real[~outside], values.imag[~outside], "o", markersize=3, color=COLOURS["ink"])
    canvas.plot(values.real[outside], values.imag[outside], "o", markersize=4, color=FAMILIES[3])
    canvas.set_aspect("equal")
    canvas.set_xlabel("Re")
    canvas.set_ylabel("Im")
    return canvas
