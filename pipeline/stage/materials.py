# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Writes materials that every USD viewer knows: UsdPreviewSurface without any gloss.

A texture is a UsdUVTexture read through the primvar ``st``, repeating, sRGB; its ``scale`` is the
material's reflectance. Windows are the same surface, black with an emissive colour.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf, UsdShade

from nightcity.city.model import Material
from nightcity.png_file import write_png
from nightcity.stage.attributes import PrimWriter

_COLOR, _FLOAT, _TOKEN = (
    Sdf.ValueTypeNames.Color3f,
    Sdf.ValueTypeNames.Float,
    Sdf.ValueTypeNames.Token,
)
# A Lambertian surface: no mirror part, whose colour is that of the specular workflow.
_MATTE = (
    ("useSpecularWorkflow", Sdf.ValueTypeNames.Int, 1),
    ("specularColor", _COLOR, Gf.Vec3f(0)),
    ("roughness", _FLOAT, 1.0),
)


def write_material(looks: PrimWriter, material: Material, texture_folder: str) -> None:
    """Write one material below ``looks``; its texture, if any, lies in ``texture_folder``."""
    prim, surface = _surface(looks, material.name)
    if material.texture is None:
        surface.set_input("diffuseColor", _COLOR, Gf.Vec3f(*material.reflectance))
        return
    reader = ShaderWriter(prim, "TextureCoordinates", "UsdPrimvarReader_float2")
    reader.set_input("varname", Sdf.ValueTypeNames.String, "st")
    texture = ShaderWriter(prim, "Texture", "UsdUVTexture")
    file = f"./{texture_folder}/{material.name}.png"
    texture.set_input("file", Sdf.ValueTypeNames.Asset, Sdf.AssetPath(file))
    texture.set_input("sourceColorSpace", _TOKEN, "sRGB")
    texture.set_input("wrapS", _TOKEN, "repeat")
    texture.set_input("wrapT", _TOKEN, "repeat")
    scale = Gf.Vec4f(*material.reflectance, 1)
    texture.set_input("scale", Sdf.ValueTypeNames.Float4, scale)
    texture.connect("st", Sdf.ValueTypeNames.Float2, reader.output("result", "Float2"))
    surface.connect("diffuseColor", _COLOR, texture.output("rgb", "Float3"))


def write_emissive_material(looks: PrimWriter, name: str, color: NDArray[np.float64]) -> Sdf.Path:
    """Write a black material that glows with ``color`` (3,), and return its path."""
    prim, surface = _surface(looks, name)
    surface.set_input("diffuseColor", _COLOR, Gf.Vec3f(0))
    surface.set_input("emissiveColor", _COLOR, Gf.Vec3f(*map(float, color)))
    return prim.path


def write_texture(material: Material, folder: Path) -> Path:
    """Write the material's texture as ``folder/NAME.png`` and return that path. Raises OSError."""
    path = folder / f"{material.name}.png"
    write_png(path, material.texture)
    return path


class ShaderWriter:
    """One shader node below a material; its inputs are typed by the caller, as Sdr knows them."""

    def __init__(self, material: PrimWriter, name: str, identifier: str) -> None:
        self._prim = PrimWriter(material, name, "Shader")
        self._prim.set("info:id", identifier)

    def set_input(self, name: str, type_name: Sdf.ValueTypeName, value: object) -> None:
        Sdf.AttributeSpec(self._prim.spec, f"inputs:{name}", type_name).default = value

    def connect(self, name: str, type_name: Sdf.ValueTypeName, source: Sdf.Path) -> None:
        spec = Sdf.AttributeSpec(self._prim.spec, f"inputs:{name}", type_name)
        spec.connectionPathList.explicitItems = [source]

    def output(self, name: str, type_name: str) -> Sdf.Path:
        """Declare an output and return its path."""
        kind = getattr(Sdf.ValueTypeNames, type_name)
        return Sdf.AttributeSpec(self._prim.spec, f"outputs:{name}", kind).path


def _surface(looks: PrimWriter, name: str) -> tuple[PrimWriter, ShaderWriter]:
    prim = PrimWriter(looks, name, "Material")
    surface = ShaderWriter(prim, "Surface", "UsdPreviewSurface")
    for matte in _MATTE:
        surface.set_input(*matte)
    output = Sdf.AttributeSpec(prim.spec, UsdShade.Tokens.outputsSurface, Sdf.ValueTypeNames.Token)
    output.connectionPathList.explicitItems = [surface.output("surface", "Token")]
    return prim, surface
