#!/usr/bin/env python3
"""Asks kickdrift what documents.txt says and writes what the manuscript needs into build/.

Each document is written once; numbers.tex makes every entry of numbers.txt a macro, provenance.tex is the table of all of
them with the commands that they come from.
"""

import json
import re
import shlex
import subprocess
import sys
import textwrap
import time
from fractions import Fraction
from math import gcd
from pathlib import Path

import parts

HERE = Path(__file__).parent
BUILD = HERE / "build"
PUBLISHED = "../data/published/"


def lines(name):
    """The fields of each line that is neither empty nor a comment."""
    for line in (HERE / name).read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            yield [field.strip() for field in line.split("|", 3)]


def ask(program, name, arguments):
    """Writes one document; the seconds that it took."""
    suffix = Path(name).suffix
    file = BUILD / (name if suffix else f"{name}.json")
    if arguments.startswith(PUBLISHED):
        return published(program, file, *arguments.split())
    form = {"": ["--format", "json"], ".tex": ["--format", "latex"], ".txt": ["--format", "text"]}.get(suffix, [])
    start = time.monotonic()
    command = [program, *shlex.split(arguments), *form, "--quiet", "--output", str(file)]
    subprocess.run(command, check=True, cwd=HERE)
    seconds = time.monotonic() - start
    if suffix == ".txt":
        # The tables behind the summary are left out; what a terminal folds, paper has to fold, too.
        summary = file.read_text().split("\n\n")[0].splitlines()
        folded = (textwrap.wrap(line, 92, subsequent_indent=" " * 13) for line in summary)
        file.write_text("\n".join(line for lines in folded for line in lines) + "\n")
    return seconds


def published(program, file, source, *arguments):
    """A document that is too long in the making for here, or what a script writes that asks the program."""
    start, source = time.monotonic(), HERE / source
    if source.suffix == ".py":
        with file.open("w") as out:
            subprocess.run([sys.executable, source, program, *arguments], check=True, stdout=out)
    else:
        file.write_text(source.read_text())
    return time.monotonic() - start


def find(document, path):
    """The value at a dotted path."""
    for key in path.split("."):
        document = document[int(key)] if isinstance(document, list) else document[key]
    return document


def value(document, path):
    """The same, where the path may be a sum or a quotient of two."""
    for sign, together in (("/", Fraction), ("+", lambda a, b: a + b)):
        if sign in path:
            return together(*(find(document, part) for part in path.split(sign)))
    return find(document, path)


def shown(found, form):
    """A value in LaTeX, between dollars."""
    kind, *digits = form.split()
    times = float(digits.pop().removeprefix("x")) if digits and digits[-1].startswith("x") else 1.0
    if kind == "count":
        found = len(found)
    if kind in ("integer", "count"):
        return f"{found:,}".replace(",", "\\,")
    if kind == "text":
        return found
    if kind == "rounded":
        return f"{float(f'{found:.{digits[0]}g}'):,.0f}".replace(",", "\\,")
    if kind == "all":
        return r"\text{all}" if found == 1 else f"{100 * float(found):.6f}\\,\\%"
    if isinstance(found, dict):
        # The ends agree in the digits shown, or the middle would claim more than is proven.
        lo, hi = (f"{found[end]:.{int(digits[0]) - 1}e}" for end in ("lo", "hi"))
        if abs(float(lo) - float(hi)) > 10.0 ** (1 - int(digits[0])) * abs(float(hi)) * 1.01:
            raise ValueError(f"{found} is not known to {digits[0]} digits")
        found = 0.5 * (found["lo"] + found["hi"])
    if kind == "percent":
        return f"{100 * float(found):.{digits[0]}f}\\,\\%"
    text = f"{times * found:.{digits[0]}g}"
    mantissa, _, power = text.partition("e")
    return f"{mantissa} \\times 10^{{{int(power)}}}" if power else mantissa


def references(name):
    """A macro for the label of each table of a document: its name, and a letter from the second one on."""
    labels = re.findall(r"\\label\{(tab:[^}]*)\}", (BUILD / name).read_text())
    stem = f"Ref{Path(name).stem.capitalize()}"
    return [f"\\newcommand{{\\{stem}{'' if n == 0 else chr(ord('A') + n)}}}{{\\ref{{{label}}}}}" for n, label in enumerate(labels)]


def counts(document):
    """The closings by p + q, in two columns: ratios, with min(p, q) > 2, with a closing, closings, below the Verlet limit."""
    rows = []
    for total in range(3, int(document["input"]["max_sum"]) + 1):
        ratios = [(p, total - p) for p in range(1, total) if gcd(p, total) == 1]
        own = [closing for closing in document["closings"] if closing["p"] + closing["q"] == total]
        ratios_closing = {(closing["p"], closing["q"]) for closing in own}
        assert ratios_closing <= set(ratios)
        below = sum(closing["below_verlet"] for closing in own)
        rows.append([total, len(ratios), sum(min(ratio) > 2 for ratio in ratios), len(ratios_closing), len(own), below])
    half = len(rows) // 2
    return "".join(" & ".join(map(str, left + right)) + r" \\" + "\n" for left, right in zip(rows[:half], rows[half:], strict=True))


def main(program):
    BUILD.mkdir(exist_ok=True)
    commands, seconds = dict(lines("documents.txt")), {}
    for name, arguments in commands.items():
        seconds[name] = ask(program, name, arguments)
        print(f"{seconds[name]:7.2f} s  {name}", flush=True)
    macros, rows = [], []
    for macro, name, path, form in lines("numbers.txt"):
        text = shown(value(json.loads((BUILD / f"{name}.json").read_text()), path), form)
        macros.append(f"\\newcommand{{\\{macro}}}{{\\ensuremath{{{text}}}}}")
        rows.append(f"\\texttt{{{macro}}} & ${text}$ & \\texttt{{{path.replace('_', chr(92) + '_')}}} & \\texttt{{{name}}} \\\\")
    (BUILD / "counts.tex").write_text(counts(json.loads((BUILD / "closings.json").read_text())))
    parts.write()
    macros += parts.runs_macros() + parts.blowups_macros()
    macros += [macro for name in commands if name.endswith(".tex") for macro in references(name)]
    pairs = json.loads((BUILD / "map1000.json").read_text())["pairs"]
    rate = f"{pairs / seconds['map1000'] / 1e6:.1f}"
    macros.append(f"\\newcommand{{\\PairsASecond}}{{\\ensuremath{{{rate}}}}}")
    (BUILD / "numbers.tex").write_text("\n".join(macros) + "\n")
    (BUILD / "provenance.tex").write_text("\n".join(rows) + "\n")
    escape = str.maketrans({"^": r"\^{}", "_": r"\_", "&": r"\&", "%": r"\%", "#": r"\#"})
    said = {name: arguments.removeprefix("../") if arguments.startswith(PUBLISHED) else f"kickdrift {arguments.replace('../data', 'data')}"
            for name, arguments in commands.items()}
    told = (rf"\item[{name}] \texttt{{{line.translate(escape)}}}" for name, line in said.items())
    (BUILD / "commands.tex").write_text("\n".join(told).replace("--", "-{}-") + "\n")


if __name__ == "__main__":
    main(str(Path(sys.argv[1]).resolve()))
