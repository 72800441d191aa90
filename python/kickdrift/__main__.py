"""``python -m kickdrift``: the program."""

from kickdrift._program import main

if __name__ == "__main__":
    raise SystemExit(main())
