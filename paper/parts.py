"""Tables, figures and references of the manuscript that are made from documents in build/."""

import json
import re
from math import log
from pathlib import Path

from plot import BLUE, GREY, ORANGE, Plot

HERE = Path(__file__).parent
BUILD = HERE / "build"


def document(name):
    return json.loads((BUILD / f"{name}.json").read_text())


def grouped(number):
    return f"{number:,}".replace(",", "\\,")


def schedule():
    """Two clocks with h2/h1 = 5/3 over one period."""
    plot = Plot(120, 16, (0, 15, False), (0, 1, False))
    plot.path([(0, 6), (120, 6)])
    for step, size, colour in ((3, 3, BLUE), (5, 6, ORANGE)):
        for n in range(15 // step + 1):
            a, _ = plot.place(n * step, 0)
            plot.path([(a + (step == 5) * 0.35, 6 - size / 2), (a + (step == 5) * 0.35, 6 + size)], colour, 1.2)
    plot.path([(60, 0), (60, 13)], GREY, 0.6, "2 2")
    words = ((0, 1.5, "$0$", "t"), (120, 1.5, "$T=5h_1=3h_2$", "t"), (60, -0.5, "$T/2$", "t"), (12, 10, "$h_1$", ""), (20, 14, "$h_2$", ""))
    for a, b, text, anchor in words:
        plot.words(a, b, text, anchor)
    # Braces of one step of each clock.
    for b, width in ((8.3, 24), (12.3, 40)):
        plot.path([(0, b), (width, b)], GREY, 0.4)
    plot.path = lambda *_, **__: None  # No frame.
    return plot.latex(left=8, right=16, below=4, above=1)


def wrong():
    """Wrong verdicts of the plain loop over the distance from an edge."""
    found = document("plain")["near_edges"]
    plot = Plot(100, 46, (3e-16, 3e-8, True), (0, 50, False))
    plot.decades("x", "relative distance from the edge, in $s$")
    plot.axis("y", [0, 10, 20, 30, 40, 50], ["0", "10", "20", "30", "40", "50"], "wrong verdicts (\\%)")
    looks = [(BLUE, "square"), (BLUE, "open diamond"), (ORANGE, "triangle"), (GREY, "open square")]
    for n, (row, (colour, shape)) in enumerate(zip(found, looks, strict=True)):
        # In the middle of its decade.
        points = [(float(at["distance"]) / 10**0.5, 100 * at["wrong"] / row["places"]) for at in row["distances"]]
        name = f"$p/q={row['p']}/{row['q']}$"
        plot.series(points, colour, shape, name, (2e-11, 45 - 6 * n))
        a, b = plot.place(2e-11, 45 - 6 * n)
        plot.mark(a - 3, b, colour, shape)
    return plot.latex()


def periods():
    """The time of a verdict over the length of its period."""
    rows = document("periods")["rows"]
    plot = Plot(100, 52, (1e2, 1e17, True), (0.2, 1e5, True))
    plot.decades("x", "kicks in a period, $p+q$", 2)
    plot.decades("y", "time of a verdict ($10^{-6}\\,\\mathrm{s}$)")
    plot.series([(row["kicks"], row["microseconds"]) for row in rows], BLUE, "square", "certified", (3e11, 30))
    plain = [(row["kicks"], row["plain_microseconds"]) for row in rows if "plain_microseconds" in row]
    plot.series(plain, ORANGE, "open diamond", "plain loop, full period", (4e6, 2e4))
    return plot.latex()


def molecules():
    """Unstable intervals about the minimum, and rates at the steps that were run; all in fs."""
    plot = Plot(110, 42, (1.7, 8.5, False), (0, 18, False))
    for stretch in document("water4")["stretches"]:
        if stretch["verdict"] != "stable":
            shade = "0.78 0.82 0.90" if stretch["verdict"] == "unstable" else "0.90 0.90 0.90"
            (a, _), (b, height) = plot.place(1000 * stretch["lo"], 0), plot.place(1000 * stretch["hi"], 18)
            plot.path([(a, 0), (b, 0), (b, height), (a, height)], shade, 0.05, close="b")
    plot.axis("x", range(2, 9), [str(n) for n in range(2, 9)], "outer step (fs)")
    plot.axis("y", range(0, 19, 3), [str(n) for n in range(0, 19, 3)], "growth rate ($10^{-3}$ per fs)")
    rows = [(float(row["outer"]), row["minimum"], row["run"]) for row in document("runs")["rows"]]
    minimum = [(outer, rate) for outer, rate, _ in rows]
    plot.series(minimum, ORANGE, "open diamond", "about the minimum", (2.1, 15.5), line=False)
    plot.series([(outer, run) for outer, _, run in rows], BLUE, "square", "OpenMM's run", (2.1, 13), line=False)
    for y, colour, shape in ((15.5, ORANGE, "open diamond"), (13, BLUE, "square")):
        a, b = plot.place(2.1, y)
        plot.mark(a - 2, b, colour, shape)
    return plot.latex()


def share_alone(told, own):
    """The logarithm by which one motion's velocity at the run's start must grow to have the energy of the whole blown-up molecule."""
    return log(2 * told["blown"] / told["temperature"] * (3 * own["atoms"] - 6)) / 2


def blowups():
    """Time until a run from the orbit blew up over the rate that is predicted; the document's ps are 10^3 fs, its 1/ps 10^-3 per fs."""
    told = document("blowups")
    plot = Plot(100, 44, (0.1, 30, True), (0.1, 150, True))
    plot.decades("x", "predicted growth rate about the orbit ($10^{-3}$ per fs)")
    plot.decades("y", "time until the run blew up ($10^3$ fs)")
    end = told["length"]
    plot.path([plot.place(0.1, end), plot.place(30, end)], GREY, 0.5, "2 2")
    plot.words(*plot.place(27, 1.45 * end), "end of the runs", "r")
    looks = ((BLUE, "square", 8.5), (ORANGE, "diamond", 3.4))
    for own, (colour, shape, y) in zip(told["systems"], looks, strict=True):
        alone = share_alone(told, own)
        plot.path([plot.place(rate, alone / rate) for rate in (0.1, 29)], colour, 0.5)
        rows = [row["orbit"] for row in own["rows"] if not row["orbit"]["stable"]]
        for orbit in rows:
            blown = orbit["blown_up"]
            plot.mark(*plot.place(orbit["rate"], blown or end), colour, shape if blown else f"open {shape}")
        a, b = plot.place(2.6, y)
        plot.mark(a - 3, b, colour, shape)
        plot.words(a, b, own["system"], "l")
    return plot.latex()


def plain_rows():
    """Where the plain loop is wrong, grid by grid; a rule between the two oscillators."""
    lines, before = [], None
    for grid in document("plain")["grids"]:
        if before not in (None, grid["lambda1"]):
            lines.append(r"\midrule")
        before = grid["lambda1"]
        numbers = [grid["pairs"], grid["unstable"], grid["on_an_edge"], grid["trace"]["wrong"]]
        numbers += [one["wrong"] for one in grid["spectral_radius"]]
        lines.append(f"${grid['step']}$ & " + " & ".join(f"${grouped(number)}$" for number in numbers) + r" \\")
    return "\n".join(lines) + "\n"


def runs_rows():
    """Growth in OpenMM beside its prediction, 1/ps as 10^-3 per fs."""
    rows = document("runs")["rows"]
    rates = ("minimum", "orbit", "run")
    return "".join(" & ".join([row["outer"], str(row["inner"]), *(f"{row[rate]:.4f}" for rate in rates)]) + " \\\\\n" for row in rows)


def runs_macros():
    """How far the predictions about the minimum are off, and that those about the orbit are not."""
    rows = document("runs")["rows"]
    assert all(row["orbit"] == row["run"] for row in rows)
    wrong = [row["outer"] for row in rows if (row["minimum"] > 0) != (row["run"] > 0)]
    off = sorted(row["minimum"] / row["run"] - 1 for row in rows if row["run"] > 0)
    least, most = (f"{100 * one:.0f}\\,\\%" for one in (off[0], off[-1]))
    values = {"RunsWrong": ", ".join(wrong), "RunsSteps": len(rows), "RunsOffLeast": least, "RunsOffMost": most}
    return [f"\\newcommand{{\\{name}}}{{\\ensuremath{{{value}}}}}" for name, value in values.items()]


def blowups_rows():
    """Predictions beside runs from the minimum and from the orbit; a star where a run does what is not predicted of its own state."""
    def ran(predicted, found):
        blown, hottest = found["blown_up"], found["hottest"]
        star = "" if predicted["stable"] == (blown is None) else r"\rlap{$^*$}"
        return [f"{blown:.3g}{star}" if blown else f"none{star}", f"{hottest:.1f}" if blown is None else ""]

    def rate(found):
        return "0" if found["stable"] else f"{found['rate']:.2f}"

    lines = []
    for own in document("blowups")["systems"]:
        lines += [r"\midrule"] * bool(lines) + [rf"\multicolumn{{8}}{{@{{}}l}}{{{own['system']}, {own['atoms']} atoms}} \\"]
        for row in own["rows"]:
            minimum, orbit = row["minimum"], row["orbit"]
            cells = [row["outer"], str(row["inner_steps"]), rate(minimum), rate(orbit), *ran(minimum, row), *ran(orbit, orbit)]
            lines.append(" & ".join(cells) + r" \\")
    return "\n".join(lines) + "\n"


def blowups_macros():
    """How many predictions the runs bear out, which not, and how clearly."""
    told = document("blowups")
    waters, dipeptide = told["systems"]
    every = waters["rows"] + dipeptide["rows"]

    def wrong(rows, begin):
        """Where a run that begins there does not do what is predicted about it."""
        ran = {"minimum": lambda row: row, "orbit": lambda row: row["orbit"]}[begin]
        return [row for row in rows if row[begin]["stable"] != (ran(row)["blown_up"] is None)]

    slow, late = wrong(every, "orbit"), wrong(waters["rows"], "minimum")
    # What the text says in words.
    assert all(row["minimum"]["stable"] == row["orbit"]["stable"] for row in every)
    assert all(row in dipeptide["rows"] and not row["orbit"]["stable"] for row in slow)
    assert len(late) == 1 and late[0]["orbit"]["stable"]
    assert wrong(dipeptide["rows"], "minimum") == slow[1:]
    assert len(wrong(every, "minimum")) == len(slow)
    every_three = zip(dipeptide["rows"], dipeptide["rows"][1:], dipeptide["rows"][2:], strict=False)
    narrow, = (three for three in every_three if [row["orbit"]["blown_up"] is None for row in three] == [True, False, True])
    assert all((row["blown_up"] is None) == (row["orbit"]["blown_up"] is None) for row in narrow)
    assert len(waters["rows"]) == len(dipeptide["rows"])
    assert max(row["orbit"]["away"] for row in dipeptide["rows"]) < min(row["orbit"]["away"] for row in waters["rows"])
    stable = [row for row in every if row["orbit"]["stable"]]
    off = [max(abs(row["minimum"]["rate"] / row["orbit"]["rate"] - 1) for row in own["rows"] if not row["orbit"]["stable"])
           for own in told["systems"]]
    grown = [row["orbit"]["rate"] * row["orbit"]["blown_up"] for row in every if row["orbit"]["blown_up"]]
    alone = [share_alone(told, own) for own in told["systems"]]
    values = {
        "BlowSteps": len(every), "BlowEach": len(waters["rows"]), "BlowWaters": waters["atoms"] // 3,
        "BlowInner": f"{max(float(row['outer']) / row['inner_steps'] for row in every):.2g}",
        "BlowBefore": narrow[0]["outer"], "BlowNarrow": narrow[1]["outer"], "BlowAfter": narrow[2]["outer"],
        "BlowShare": f"{2 * told['blown'] / told['temperature']:.0f}",
        "BlowRight": len(every) - len(slow),
        "BlowSlow": r",\ ".join(row["outer"] for row in slow), "BlowLate": late[0]["outer"], "BlowLateTime": f"{late[0]['blown_up']:.3g}",
        "BlowAway": f"{late[0]['orbit']['away']:.2g}",
        "BlowStill": f"{max(row['orbit']['hottest'] for row in stable):.1f}",
        "BlowGrowing": f"{min(row['orbit']['hottest'] for row in slow):.0f}",
        "BlowSwing": f"{max(row['hottest'] for row in stable if row['hottest']):.0f}",
        "BlowOffWaters": f"{100 * off[0]:.0f}\\,\\%", "BlowOffDipeptide": f"{100 * off[1]:.0f}\\,\\%",
        "BlowLeast": f"{min(grown):.1f}", "BlowMost": f"{max(grown):.1f}",
        "BlowAloneWaters": f"{alone[0]:.1f}", "BlowAloneDipeptide": f"{alone[1]:.1f}",
        "BlowSlowGrown": f"{min(row['orbit']['rate'] for row in slow) * told['length']:.0f}",
        "BlowLength": f"{told['length']:.0f}", "BlowCold": f"{told['temperature']:.0f}", "BlowHot": f"{told['blown']:.0f}",
    }
    return [f"\\newcommand{{\\{name}}}{{\\ensuremath{{{value}}}}}" for name, value in values.items()]


def entries():
    """Every entry of the two lists of references by its key: its kind and its fields."""
    found = {}
    for name in ("paper.bib", "more.bib"):
        for kind, key, body in re.findall(r"^@(\w+)\{(\w+),\n(.*?)^\}", (HERE / name).read_text(), re.DOTALL | re.MULTILINE):
            fields = re.findall(r"(\w+)\s*=\s*\{((?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*)\}", body)
            found[key] = {"kind": kind, **dict(fields)}
    return found


def people(authors):
    """"Last, First" as initials before the name."""
    def one(author):
        last, _, first = author.partition(", ")
        initials = " ".join(name if "." in name else re.sub(r"^(\{?\\?.).*", r"\1.", name) for name in first.split())
        return f"{initials} {last}".strip()

    return ", ".join("others" if author == "others" else one(author) for author in authors.split(" and ")).replace(", others", " and others")


def reference(entry):
    """One entry, with its DOI or its number at arXiv."""
    parts = [people(entry["author"]) + "."]
    if entry["kind"] == "article":
        number = f"({entry['number']})" if "number" in entry else ""
        parts += [f"{entry['title']}.", rf"\emph{{{entry['journal']}}} {entry['volume']}{number}, {entry['pages']}, {entry['year']}."]
    else:
        place = rf"In \emph{{{entry['booktitle']}}}." if "booktitle" in entry else ""
        title = f"{entry['title']}." if place else rf"\emph{{{entry['title']}}}."
        parts += [title, place, f"{entry['publisher']}, {entry['year']}."]
    if "doi" in entry:
        parts.append(rf"\href{{https://doi.org/{entry['doi']}}}{{doi:\nolinkurl{{{entry['doi']}}}}}")
    elif "eprint" in entry:
        parts.append(rf"\href{{https://arxiv.org/abs/{entry['eprint']}}}{{arXiv:{entry['eprint']}}}")
    return " ".join(part for part in parts if part)


def references(name):
    """What a text cites, in the order in which it does."""
    cited = re.findall(r"\\cite\{([^}]*)\}", (HERE / f"{name}.tex").read_text())
    keys = list(dict.fromkeys(key.strip() for group in cited for key in group.split(",")))
    known = entries()
    items = (rf"\bibitem{{{key}}} {reference(known[key])}" for key in keys)
    return "\n".join([r"\begin{thebibliography}{99}\small\setlength\itemsep{1pt}", *items, r"\end{thebibliography}"]) + "\n"


def write():
    """All of them, into build/."""
    figures = {"schedule": schedule(), "wrong": wrong(), "periods": periods(), "molecules": molecules(), "blowup-times": blowups()}
    lists = {f"{name}-references": references(name) for name in ("paper", "supplement")}
    for name, text in {**figures, "plain": plain_rows(), "runs": runs_rows(), "blowups": blowups_rows(), **lists}.items():
        (BUILD / f"{name}.tex").write_text(text)
