# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Runs in Mitsuba's own environment: single scattering along given rays, in passes.

    python -P mitsuba_program.py SCENE.npz RESULT.npy SAMPLES PASSES

RESULT holds (PASSES, N) means over SAMPLES paths a ray, W m^-2 sr^-1.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

import drjit
import mitsuba
import numpy as np

mitsuba.set_variant("llvm_ad_mono")

_BLACK = {"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.0}}
_SINGLE = 2  # edges of the longest path: camera, haze, window


def main(source: str, result: str, samples: str, passes: str) -> None:
    """See the file's docstring."""
    data = np.load(source)
    haze = mitsuba.load_dict(
        {
            "type": "homogeneous",
            "sigma_t": {"type": "uniform", "value": float(data["extinction"])},
            "albedo": {"type": "uniform", "value": float(data["albedo"])},
            "phase": {"type": "isotropic"},
        }
    )
    with tempfile.TemporaryDirectory() as folder:
        scene = _scene(data, haze, Path(folder))
    _check_one_side(scene, data)
    origins = data["origins"]
    inside = bool(np.all((origins > data["lo"]) & (origins < data["hi"])))
    integrator = mitsuba.load_dict(
        {"type": "volpathmis", "max_depth": _SINGLE, "rr_depth": 1000, "hide_emitters": True}
    )
    means, started = [], time.monotonic()
    for seed in range(int(passes)):
        means.append(_pass(scene, integrator, data, haze if inside else None, int(samples), seed))
        seconds = time.monotonic() - started
        print(f"mitsuba: pass {seed + 1} of {passes}, {seconds:.0f} s", file=sys.stderr, flush=True)
    np.save(result, np.array(means))


def _scene(data: np.lib.npyio.NpzFile, haze: object, folder: Path) -> object:
    walls = folder / "walls.ply"
    _write_ply(data["vertices"], data["faces"], walls)
    transform = mitsuba.ScalarTransform4f
    lo, hi = data["lo"], data["hi"]
    scene = {
        "type": "scene",
        "walls": {"type": "ply", "filename": str(walls), "bsdf": _BLACK},
        "haze": {
            "type": "cube",
            "to_world": transform()
            .translate(((lo + hi) / 2).tolist())
            .scale(((hi - lo) / 2).tolist()),
            "bsdf": {"type": "null"},
            "interior": haze,
        },
    }
    # Windows of one radiance are one mesh: an emitter of its own for each window makes Mitsuba
    # ten times slower.
    for number, radiance in enumerate(np.unique(data["radiance"])):
        corners = data["corners"][data["radiance"] == radiance]
        first = 4 * np.arange(len(corners))[:, None]
        triangles = np.concatenate([first + [0, 1, 2], first + [0, 2, 3]])
        file = folder / f"windows{number}.ply"
        _write_ply(corners.reshape(-1, 3), triangles, file)
        scene[f"windows{number}"] = {
            "type": "ply",
            "filename": str(file),
            "face_normals": True,
            "bsdf": _BLACK,
            "emitter": {"type": "area", "radiance": {"type": "uniform", "value": float(radiance)}},
        }
    return mitsuba.load_dict(scene)


def _write_ply(vertices: np.ndarray, faces: np.ndarray, path: Path) -> None:
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(f"{value:.9g}" for value in vertex) for vertex in vertices]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces]
    path.write_text("\n".join(lines) + "\n")


def _check_one_side(scene: object, data: np.lib.npyio.NpzFile) -> None:
    """A window sends light outwards only, and of the radiance given: half a millimetre off it."""
    corners, radiance = data["corners"][0], float(data["radiance"][0])
    centre = 0.25 * corners[0] + 0.25 * corners[1] + 0.3 * corners[2] + 0.2 * corners[3]
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[1])
    normal /= np.linalg.norm(normal)
    for side, expected in ((1.0, radiance), (-1.0, 0.0)):
        ray = mitsuba.Ray3f(
            mitsuba.Point3f((centre + side * 5e-4 * normal).tolist()),
            mitsuba.Vector3f((-side * normal).tolist()),
        )
        hit = scene.ray_intersect(ray)
        found = float(hit.emitter(scene).eval(hit)[0][0])
        if not np.isclose(found, expected, rtol=1e-4):
            raise SystemExit(f"a window's side {side:+g} sends {found}, not {expected}")


def _pass(
    scene: object,
    integrator: object,
    data: np.lib.npyio.NpzFile,
    haze: object,
    samples: int,
    seed: int,
) -> np.ndarray:
    """Means (N,) of ``samples`` paths a ray; ``haze``: what the rays start in, or None."""
    count = len(data["origins"])
    sampler = mitsuba.load_dict({"type": "independent"})
    sampler.seed(seed, count * samples)
    ray_number = drjit.arange(mitsuba.UInt32, count * samples) // samples
    origin = _gather(mitsuba.Point3f, data["origins"], ray_number)
    direction = _gather(mitsuba.Vector3f, data["directions"], ray_number)
    ray = mitsuba.RayDifferential3f(mitsuba.Ray3f(origin, direction))
    value = integrator.sample(scene, sampler, ray, haze, True)[0]
    paths = np.array(value).reshape(count, samples)
    if not np.all(np.isfinite(paths)):
        raise SystemExit("Mitsuba found a path that is not finite")
    return paths.mean(axis=1, dtype=np.float64)


def _gather(kind: type, values: np.ndarray, index: object) -> object:
    return kind(
        *(
            drjit.gather(mitsuba.Float, mitsuba.Float(values[:, axis].astype(np.float32)), index)
            for axis in range(3)
        )
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
