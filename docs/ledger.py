#!/usr/bin/env python3
"""What each kind of answer is checked against: ledger.py prints it from the tests, and fails where a kind has no test.

A line of comment above a test enters it: ``// Ledger: KIND; CASES; AGAINST``. Every number in CASES stands in the test itself, or in
the ``with_cases`` before it; SEED is the constant of its file. Tests that are ignored run once a week:
``cargo test --release --locked -- --ignored | docs/ledger.py ran`` keeps the days on which they passed in data/published/long-tests.txt.
"""

import re
import sys
from datetime import datetime, timezone
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DAYS = ROOT / "data" / "published" / "long-tests.txt"
KINDS = [
    "verdict", "label", "growth", "edges", "closings", "bands", "words", "friction", "exact systems", "two levels", "many levels",
    "sparse levels", "local time stepping", "asynchronous elements", "non-conservative forces", "along the orbit", "rigid motions",
    "advice", "aperture",
]
ENTRY = re.compile(r"^ *// Ledger: ([^;]+); ([^;]+); (.+)$", re.MULTILINE)
NUMBER = re.compile(r"(?<!\w)\d[\d_]*")


def entries():
    """Kind, cases, against, test, is_weekly; by file and place."""
    for path in sorted([*ROOT.glob("tests/**/*.rs"), *ROOT.glob("crates/**/*.rs")]):
        text = path.read_text(encoding="utf-8")
        for found in ENTRY.finditer(text):
            kind, cases, against = found.groups()
            function = re.compile(r"\bfn (\w+)").search(text, found.end())
            begin = text[found.end() : function.start()]
            rest = re.split(r"#\[test\]|// Ledger", text[function.start() :])[0]
            configured = re.findall(r"with_cases\((\d+)\)", text[: found.start()])[-1:]
            seed = re.search(r"const SEED: u64 = ([\d_]+);", text)
            missing = [n for n in NUMBER.findall(cases) if n not in NUMBER.findall(rest) + configured]
            if kind not in KINDS or "#[test]" not in begin or missing or ("SEED" in cases and not seed):
                sys.exit(f"{path.relative_to(ROOT)}: {found[0].strip()}: not a kind, not a test, or not in it: {missing}")
            cases = cases.replace("SEED", seed[1].replace("_", "") if seed else "")
            cases = NUMBER.sub(lambda n: f"{int(n[0]):,}" if "_" in n[0] else n[0], cases)
            yield kind, cases, against, f"{path.relative_to(ROOT).as_posix()}: {function[1]}", "#[ignore" in begin


def days():
    """The day on which each long test passed last."""
    lines = DAYS.read_text(encoding="utf-8").splitlines() if DAYS.exists() else []
    return dict(reversed(line.split(" ", 1)) for line in lines)


def ran(output):
    """Enters today for the long tests that passed in this output of cargo."""
    passed = set(re.findall(r"^test (?:\w+::)*(\w+) \.\.\. ok", output, re.MULTILINE))
    known, today = days(), datetime.now(timezone.utc).date().isoformat()
    for _, _, _, test, is_weekly in entries():
        if is_weekly and test.split(": ")[1] in passed:
            known[test] = today
    DAYS.write_text("".join(f"{day} {test}\n" for test, day in sorted(known.items())), encoding="utf-8")


def main():
    if sys.argv[1:] == ["ran"]:
        return ran(sys.stdin.read())
    found, known = list(entries()), days()
    for kind in KINDS:
        of_kind = [entry for entry in found if entry[0] == kind]
        if not of_kind:
            sys.exit(f"no test is entered for {kind}")
        print(kind)
        for _, cases, against, test, is_weekly in of_kind:
            passed = f"passed on {known[test]}" if test in known else "no run on record"
            last = f" (weekly; {passed})" if is_weekly else ""
            print(f"  {cases}{last}, against {against}\n    {test}")


if __name__ == "__main__":
    main()
