"""Meshes with local time steps, against the scheme run step by step."""

from __future__ import annotations

from fractions import Fraction
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
    axis = np.asarray(lines, dtype=float)
    n = len(axis)
    points = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    a, b, c, d = i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1
    return points, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def refined() -> tuple[Array, npt.NDArray[np.int64]]:
    return square(np.concatenate([np.linspace(0, 0.2, 9)[:-1], np.linspace(0.2, 1, 17)]))


def graded() -> tuple[Array, npt.NDArray[np.int64]]:
    """Elements of three sizes."""
    return square([0, 0.25, 0.5, 0.75, 1, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8])


def dense(waves: kickdrift.mesh.Waves) -> tuple[Array, Array]:
    """M^-1 K, and 1 where a degree of freedom is fine."""
    arrays, n = waves.system.arrays, len(waves.nodes)
    matrix = np.zeros((n, n))
    ends = arrays["hessian0.indptr"].astype(int)
    for i in range(n):
        at = slice(ends[i], ends[i + 1])
        matrix[i, arrays["hessian0.indices"][at].astype(int)] = arrays["hessian0.data"][at]
    fine = np.zeros(n)
    fine[arrays["fine0"].astype(int)] = 1
    return matrix / arrays["masses"][:, None], fine


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
        read, other = kickdrift.mesh.waves(path), kickdrift.mesh.waves((points, cells))
        assert np.allclose(read.limits, other.limits)
        assert read.system.decide().stable == other.system.decide().stable


@pytest.mark.parametrize("form", ["vtu", "vtk"])
def test_modes_on_the_mesh_are_read_back_with_their_numbers(tmp_path: Path, form: str) -> None:
    meshio = pytest.importorskip("meshio")
    waves = kickdrift.mesh.waves(refined(), substeps=2, courant=1.05)
    verdict = waves.system.decide()
    assert verdict.stable is False
    path = waves.save_modes(tmp_path / f"modes.{form}", verdict)
    found = meshio.read(path)
    points, cells = refined()
    assert np.array_equal(found.points[:, :2], points) and not found.points[:, 2].any()
    assert np.array_equal(found.cells_dict["triangle"], cells)
    assert np.array_equal(found.cell_data["substeps"][0], waves.substeps)
    modes = [mode for part in verdict.data["parts"] for mode in part["instabilities"]]
    assert modes and {f"mode_{n}" for n in range(1, len(modes) + 1)} <= set(found.point_data)
    rates = [abs(complex(mode["lambda"]["re"], mode["lambda"]["im"])) for mode in modes]
    worst = modes[int(np.argmax(rates))]
    field = found.point_data["mode_1"]
    assert np.array_equal(field[waves.nodes], worst["shape"])
    assert np.abs(field).max() == 1 and not np.delete(field, waves.nodes).any()
    # It is what grows: an eigenvector of the scheme's step to the accuracy of its iteration.
    a, fine = dense(waves)
    dt = float(Fraction(waves.system.document["potentials"][0]["step"]))
    y, d = np.asarray(worst["shape"]), dt / 2
    still = a @ ((1 - fine) * y)
    q = y - d * d / 2 * (still + a @ (fine * y))
    turned = 2 * (2 * q - y - d * d * (still + a @ (fine * q)))
    quotient = (y @ turned) / (y @ y)
    assert np.linalg.norm(turned - quotient * y) < 0.1 * np.linalg.norm(turned) and abs(quotient) > 2


def test_modes_of_what_does_not_grow_or_of_another_system_are_refused(tmp_path: Path) -> None:
    pytest.importorskip("meshio")
    waves = kickdrift.mesh.waves(refined(), substeps=2, courant=0.5)
    for verdict in (
        waves.system.decide(),
        kickdrift.mesh.waves(square(np.linspace(0, 1, 5)), courant=2).system.decide(),
    ):
        with pytest.raises(kd.KickdriftError) as error:
            waves.save_modes(tmp_path / "modes.vtu", verdict)
        assert error.value.field == "verdict"
    worse = kickdrift.mesh.waves(refined(), substeps=2, courant=1.05)
    with pytest.raises(kd.KickdriftError) as error:
        worse.save_modes(tmp_path / "modes.strange", worse.system.decide())
    assert error.value.field == "path"


def element_by_element(waves: kickdrift.mesh.Waves, dt: float, p: int) -> float:
    """The largest multiplier of a period of AVI, each class of elements kicking when its own step is over."""
    n, arrays = len(waves.nodes), waves.system.arrays
    fast, slow = (np.zeros((n, n)), np.zeros((n, n)))
    for k, matrix in enumerate((fast, slow)):
        ends = arrays[f"hessian{k}.indptr"].astype(int)
        for i in range(n):
            at = slice(ends[i], ends[i + 1])
            matrix[i, arrays[f"hessian{k}.indices"][at].astype(int)] = arrays[f"hessian{k}.data"][at]
    fast, slow = (matrix / arrays["masses"][:, None] for matrix in (fast, slow))
    x, v = np.eye(n, 2 * n), np.eye(n, 2 * n, n)
    for tick in range(p):
        v = v - dt / p * (fast @ x) - (dt * (slow @ x) if tick == 0 else 0)
        x = x + dt / p * v
    return float(np.abs(np.linalg.eigvals(np.concatenate([x, v]))).max())


def test_avi_on_a_mesh_is_stable_where_its_elements_run_are() -> None:
    lts = kickdrift.mesh.waves(refined(), substeps=2)
    told = []
    # Of sparse stiffnesses the first stable region is told, and here nothing above it.
    for courant in (0.4, 0.6, 0.8, 0.95, 1.1, 1.6):
        waves = kickdrift.mesh.waves(refined(), scheme="avi", substeps=2, courant=courant)
        assert np.array_equal(waves.substeps, lts.substeps) and waves.cfl == lts.cfl
        step = Fraction(waves.system.document["potentials"][1]["step"])
        largest = element_by_element(waves, float(step), 2)
        verdict = waves.system.decide()
        told.append(verdict.proven)
        if verdict.proven:
            assert verdict.stable == (largest < 1 + 1e-7), (courant, largest)
    assert told[:2] == [True, True]


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"speed": 0.0}, "speed"),
        ({"density": [1.0, 2.0]}, "density"),
        ({"substeps": 0}, "substeps"),
        ({"courant": -1}, "courant"),
        ({"fixed": "edge"}, "fixed"),
        ({"fixed": [10**6]}, "fixed"),
        ({"scheme": "midpoint"}, "scheme"),
        ({"scheme": "avi", "substeps": (2, 2)}, "substeps"),
        ({"scheme": "avi", "substeps": 1}, "substeps"),
    ],
)
def test_what_makes_no_sense_is_refused(change: dict[str, object], field: str) -> None:
    with pytest.raises(kd.KickdriftError) as error:
        kickdrift.mesh.waves(refined(), **change)
    assert error.value.field == field
