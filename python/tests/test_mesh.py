"""Meshes with local time steps, against the scheme run step by step."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import kickdrift as kd

pytest.importorskip("scipy")
import kickdrift.mesh

Array = npt.NDArray[np.float64]


def square(lines: npt.ArrayLike) -> tuple[Array, npt.NDArray[np.int64]]:
    """A square between these grid lines, two triangles to a cell."""
    own = np.asarray(lines, dtype=float)
    n = len(own)
    points = np.stack(np.meshgrid(own, own, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    a, b, c, d = i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1
    return points, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def refined() -> tuple[Array, npt.NDArray[np.int64]]:
    return square(np.concatenate([np.linspace(0, 0.2, 9)[:-1], np.linspace(0.2, 1, 17)]))


def dense(waves: kickdrift.mesh.Waves) -> tuple[Array, Array]:
    """M^-1 K, and 1 where a degree of freedom is fine."""
    arrays, n = waves.system.arrays, len(waves.nodes)
    own = np.zeros((n, n))
    ends = arrays["hessian0.indptr"].astype(int)
    for i in range(n):
        at = slice(ends[i], ends[i + 1])
        own[i, arrays["hessian0.indices"][at].astype(int)] = arrays["hessian0.data"][at]
    fine = np.zeros(n)
    fine[arrays["fine0"].astype(int)] = 1
    return own / arrays["masses"][:, None], fine


def longest(a: Array, fine: Array, dt: float, p: int, steps: int = 4000) -> float:
    """How far the scheme of Diaz and Grote comes from a small start."""
    d, rng = dt / p, np.random.default_rng(1)
    before = now = rng.normal(size=len(a))
    for _ in range(steps):
        still = a @ ((1 - fine) * now)
        q0, q1 = now, now - d * d / 2 * (still + a @ (fine * now))
        for _ in range(p - 1):
            q0, q1 = q1, 2 * q1 - q0 - d * d * (still + a @ (fine * q1))
        before, now = now, 2 * q1 - before
    return float(np.abs(now).max())


def test_the_certified_limit_is_that_of_the_scheme_run() -> None:
    waves = kickdrift.mesh.waves(refined(), substeps=2, courant=0.5)
    assert set(waves.substeps) == {1, 2}
    verdict = waves.system.decide()
    assert verdict.stable
    assert verdict.local_steps is not None
    first = verdict.local_steps["first_unstable"]
    a, fine = dense(waves)
    # Elements' own limits are no more than that of the whole, all with one step.
    assert waves.limits.min() <= verdict.local_steps["plain_limit"]["hi"]
    assert np.isclose(2 / np.sqrt(np.linalg.eigvals(a).real.max()), verdict.local_steps["plain_limit"]["lo"], rtol=1e-5)
    assert longest(a, fine, 0.999 * first["lo"], 2) < 1e3
    far = 1.05 * waves.cfl
    worse = kickdrift.mesh.waves(refined(), substeps=2, step=f"{far:.6g}").system.decide()
    assert worse.stable is False
    assert longest(a, fine, far, 2, 300) > 1e3


def test_a_mesh_of_gmsh_is_the_same_as_its_arrays(tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    points, cells = refined()
    flat = np.pad(points, ((0, 0), (0, 1)))
    for name in ("gmsh22", "gmsh"):
        path = tmp_path / f"{name}.msh"
        meshio.write(path, meshio.Mesh(flat, [("triangle", cells)]), file_format=name, binary=False)
        own, other = kickdrift.mesh.waves(path), kickdrift.mesh.waves((points, cells))
        assert np.allclose(own.limits, other.limits)
        assert own.system.decide().stable == other.system.decide().stable


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"speed": 0.0}, "speed"),
        ({"density": [1.0, 2.0]}, "density"),
        ({"substeps": 0}, "substeps"),
        ({"courant": -1}, "courant"),
        ({"fixed": "edge"}, "fixed"),
        ({"fixed": [10**6]}, "fixed"),
    ],
)
def test_what_makes_no_sense_is_refused(change: dict[str, object], field: str) -> None:
    with pytest.raises(kd.KickdriftError) as error:
        kickdrift.mesh.waves(refined(), **change)
    assert error.value.field == field
