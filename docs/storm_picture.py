# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Draws a stage with Hydra Storm inside Blender: ``python storm_picture.py STAGE CAMERA OUT.png``.

Run it with a Python 3.11 that has ``bpy==5.0.1`` from PyPI, in an environment of its own (400 MB,
GPL, used for the picture in usdview.md and nothing else). Storm then draws Blender's translation
of the stage. Haze is left out, as it has the purpose ``render``.
"""

from __future__ import annotations

import sys

import bpy

SIZE = (960, 530)
SKY = (0.05, 0.08, 0.16, 1.0)  # the only light beside the windows, linear


def main() -> None:
    stage, camera, picture = sys.argv[1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="hydra_storm")
    bpy.ops.wm.usd_import(filepath=stage, import_render=False, import_guide=False)
    scene = bpy.context.scene
    scene.camera = bpy.data.objects[camera]
    scene.world = bpy.data.worlds.new("night")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = SKY
    scene.render.engine = "HYDRA_STORM"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.film_transparent = True
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


main()
