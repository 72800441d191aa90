"""The program ``kickdrift``, as it is on the path of an environment that has this package."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence

from kickdrift import _native


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows the program's name, for a process of its own; this process's arguments unless given.

    Returns
    -------
    int
        The exit code: 0 done, 1 unstable (with ``--exit-code``), 2 error, which is one line on standard error.

    Examples
    --------
    >>> import kickdrift as kd
    >>> kd.main(["verdict", "--lambda1", "1", "--lambda2", "0", "--h1", "1", "--h2", "1", "--exit-code", "--quiet"])
    0
    """
    if arguments is None:
        return _native.main(["kickdrift", *sys.argv[1:]])
    # In a process of its own: the program ends its process where it is stopped by a signal.
    return subprocess.call([sys.executable, "-m", "kickdrift", *arguments])
