# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Runs in Blender's own environment: Cycles, single scattering, passes until an error is reached.

    python -P cycles_program.py SCENE.npz RESULT.npz SAMPLES TARGET LIMIT

SCENE.npz also holds ``truth`` (N,) of its pixels and ``floor``, below which a relative error is
held against the floor. Each pass renders the whole image with SAMPLES samples a pixel and a seed
of its own; passes end when the median relative error of their mean is at most TARGET, or after
LIMIT seconds. RESULT holds ``means`` (P, N), one row a pass, W m^-2 sr^-1, and ``seconds`` (P,)
since the scene was begun.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np


def main(source: str, result: str, samples: str, target: str, limit: str) -> None:
    """See the file's docstring."""
    data = np.load(source)
    begun = time.monotonic()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    _settings(bpy.context.scene, data, int(samples))
    _camera(bpy.context.scene, data)
    _walls(data)
    _windows(data)
    _haze(data)
    means, seconds = [], []
    with tempfile.TemporaryDirectory() as folder:
        while not seconds or seconds[-1] < float(limit):
            means.append(_pass(bpy.context.scene, data, Path(folder), len(means)))
            seconds.append(time.monotonic() - begun)
            error = _median_error(np.mean(means, axis=0), data)
            print(
                f"cycles: {len(means) * int(samples)} samples, {seconds[-1]:.0f} s, median "
                f"error {100 * error:.2g} %",
                file=sys.stderr,
                flush=True,
            )
            if error <= float(target):
                break
    np.savez(result, means=np.array(means), seconds=np.array(seconds))


def _median_error(values: np.ndarray, data: np.lib.npyio.NpzFile) -> float:
    scale = np.maximum(data["truth"], data["floor"])
    return float(np.median(np.abs(values - data["truth"]) / scale))


def _settings(scene: bpy.types.Scene, data: np.lib.npyio.NpzFile, samples: int) -> None:
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = map(int, data["size"])
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.use_light_tree = True
    cycles.light_sampling_threshold = 0.0  # no light is left out
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.volume_bounces = 0  # single scattering
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1.0
    scene.world = bpy.data.worlds.new("night")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0


def _camera(scene: bpy.types.Scene, data: np.lib.npyio.NpzFile) -> None:
    if float(data["shift_x"]) or float(data["shift_y"]):
        raise SystemExit("a camera with a shifted frame; take one without")
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle_y = 2 * np.arctan(float(data["tan_half_fov"]))
    camera.clip_start, camera.clip_end = 0.01, 1e5
    placed = bpy.data.objects.new("camera", camera)
    matrix = np.eye(4)
    matrix[:3] = np.stack([data["right"], data["up"], -data["forward"], data["position"]], axis=1)
    placed.matrix_world = matrix.T.tolist()
    scene.collection.objects.link(placed)
    scene.camera = placed


def _add(name: str, vertices: np.ndarray, faces: list, material: bpy.types.Material) -> object:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], faces)
    mesh.materials.append(material)
    added = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(added)
    return added


def _material(name: str) -> tuple[bpy.types.Material, bpy.types.NodeTree, object]:
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial")


def _walls(data: np.lib.npyio.NpzFile) -> None:
    material, tree, output = _material("walls")
    black = tree.nodes.new("ShaderNodeBsdfDiffuse")
    black.inputs["Color"].default_value = (0, 0, 0, 1)
    tree.links.new(black.outputs[0], output.inputs["Surface"])
    _add("walls", data["vertices"], data["faces"].tolist(), material)


def _windows(data: np.lib.npyio.NpzFile) -> None:
    for number, radiance in enumerate(np.unique(data["radiance"])):
        corners = data["corners"][data["radiance"] == radiance]
        material, tree, output = _material(f"windows{number}")
        emission = tree.nodes.new("ShaderNodeEmission")
        emission.inputs["Strength"].default_value = float(radiance)
        dark = tree.nodes.new("ShaderNodeEmission")
        dark.inputs["Strength"].default_value = 0.0
        side = tree.nodes.new("ShaderNodeNewGeometry")
        mix = tree.nodes.new("ShaderNodeMixShader")
        tree.links.new(side.outputs["Backfacing"], mix.inputs[0])
        tree.links.new(emission.outputs[0], mix.inputs[1])
        tree.links.new(dark.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], output.inputs["Surface"])
        material.cycles.emission_sampling = "FRONT"
        quads = np.arange(4 * len(corners)).reshape(-1, 4).tolist()
        windows = _add(f"windows{number}", corners.reshape(-1, 3), quads, material)
        windows.visible_camera = False  # only what they send into the haze counts


def _haze(data: np.lib.npyio.NpzFile) -> None:
    material, tree, output = _material("haze")
    extinction, albedo = float(data["extinction"]), float(data["albedo"])
    scatter = tree.nodes.new("ShaderNodeVolumeScatter")
    scatter.inputs["Color"].default_value = (1, 1, 1, 1)
    scatter.inputs["Density"].default_value = extinction * albedo
    absorb = tree.nodes.new("ShaderNodeVolumeAbsorption")
    absorb.inputs["Color"].default_value = (0, 0, 0, 1)
    absorb.inputs["Density"].default_value = extinction * (1 - albedo)
    both = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(scatter.outputs[0], both.inputs[0])
    tree.links.new(absorb.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], output.inputs["Volume"])
    material.cycles.volume_sampling = "EQUIANGULAR"
    lo, hi = data["lo"], data["hi"]
    corners = np.array([[(lo, hi)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)])
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    _add("haze", corners, faces, material)


def _pass(
    scene: bpy.types.Scene, data: np.lib.npyio.NpzFile, folder: Path, seed: int
) -> np.ndarray:
    """Values (N,) of the pixels."""
    scene.cycles.seed = seed
    scene.render.filepath = str(folder / "pass.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath, check_existing=False)
    image.colorspace_settings.is_data = True
    width, height = map(int, data["size"])
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    rows = values.reshape(height, width, -1)[::-1, :, 0]  # Blender's first row is the lowest
    bpy.data.images.remove(image)
    return rows[data["pixels"][:, 1], data["pixels"][:, 0]].astype(np.float64)


if __name__ == "__main__":
    main(*sys.argv[1:])
