"""The program ``kickdrift``, as it is on the path of an environment that has this package."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from kickdrift import _native


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows the program's name; those of the process unless given.

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
    return _native.main(["kickdrift", *(sys.argv[1:] if arguments is None else arguments)])
