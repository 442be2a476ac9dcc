# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""UsdPreviewSurface materials and display colours as Lambertian reflectances and textures."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom, UsdShade

from nightcity.errors import SceneError
from nightcity.export.open_stage import Source
from nightcity.export.records import NONE, RECORDS
from nightcity.export.textures import linear_from_srgb, read_texels

GREY = (0.5, 0.5, 0.5)
_UNAUTHORED_DIFFUSE = (0.18, 0.18, 0.18)  # UsdPreviewSurface's own default
Colour = tuple[float, float, float]
TextureKey = tuple[str, str]  # resolved path, colour space


@dataclass(frozen=True, slots=True)
class Surface:
    """One material of the flat scene. primvar: the texture coordinates' name, None untextured."""

    index: int
    primvar: str | None = None


@dataclass
class MaterialTable:
    """Every material that a surface uses, once: its reflectance and the key of its texture.

    rows: each with its index. textures: (height, width, 4) uint8 by resolved path and colour
    space, in the order of the file.
    """

    rows: dict[tuple[Colour, TextureKey | None], int] = field(default_factory=dict)
    textures: dict[TextureKey, NDArray[np.uint8]] = field(default_factory=dict)

    def row(self, colour: Colour, texture: TextureKey | None) -> int:
        """The index of a material, new or not."""
        return self.rows.setdefault((colour, texture), len(self.rows))

    def take_in(self, other: MaterialTable) -> NDArray[np.int64]:
        """Add another table; (rows of the other,) where each of them is now."""
        for key, texels in other.textures.items():
            self.textures.setdefault(key, texels)
        return np.array([self.row(*row) for row in other.rows], dtype=np.int64)

    def records(self) -> tuple[NDArray, NDArray]:
        """The arrays ``material`` and ``texel``."""
        places: dict[TextureKey | None, tuple[int, int, int]] = {None: (NONE, 0, 0)}
        count = 0
        for key, texels in self.textures.items():
            places[key] = count, texels.shape[1], texels.shape[0]
            count += places[key][1] * places[key][2]
        materials = np.zeros(len(self.rows), RECORDS["material"])
        for (reflectance, texture), row in self.rows.items():
            materials[row] = reflectance, *places[texture]
        texel = np.zeros(count, RECORDS["texel"])
        if self.textures:
            texel["rgba"] = np.concatenate([t.reshape(-1, 4) for t in self.textures.values()])
        return materials, texel


class Materials:
    """Reads the materials of a stage into a table."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._surfaces: dict[str, Surface | None] = {}
        self.table = MaterialTable()

    def of_material(self, material: UsdShade.Material) -> Surface | None:
        """The surface of a bound material; None, with a note, where it is no preview surface."""
        prim = material.GetPrim()
        source_prim = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        key = str(source_prim.GetPath())
        if key not in self._surfaces:
            self._surfaces[key] = self._read(material)
        return self._surfaces[key]

    def of_colour(self, colour: Colour, where: object) -> Surface:
        """A plain surface."""
        return Surface(self._row(colour, None, where))

    def of_display_colour(self, prim: Usd.Prim, face_count: int) -> list[tuple[Surface, object]]:
        """What a prim without material shows: surfaces, each with its faces (None: all)."""
        primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayColor")
        values = primvar.ComputeFlattened(self._source.time) if primvar else None
        if values is None or len(values) == 0:
            self._source.notes.about(
                "Surfaces without material or displayColor are taken as grey 0.5", prim.GetPath()
            )
            return [(self.of_colour(GREY, prim.GetPath()), None)]
        colours = np.array(values, dtype=np.float64)
        if primvar.GetInterpolation() == UsdGeom.Tokens.uniform and len(colours) == face_count:
            unique, face_colour = np.unique(colours, axis=0, return_inverse=True)
            return [
                (self.of_colour(tuple(colour), prim.GetPath()), np.flatnonzero(face_colour == i))
                for i, colour in enumerate(unique.tolist())
            ]
        if len(np.unique(colours, axis=0)) > 1:
            self._source.notes.about(
                "A displayColor that varies over a face is taken as its mean", prim.GetPath()
            )
        return [(self.of_colour(tuple(colours.mean(axis=0).tolist()), prim.GetPath()), None)]

    def untextured(self, index: int, where: object) -> int:
        """The material itself, or one of its texture's mean colour, with a note."""
        reflectance, texture = list(self.table.rows)[index]
        if texture is None:
            return index
        self._source.notes.about("A textured ground is taken as its texture's mean", where)
        texels = self.table.textures[texture].reshape(-1, 4)[:, :3]
        mean = linear_from_srgb(texels / 255.0).mean(axis=0)
        return self._row(tuple((mean * reflectance).tolist()), None, where)

    def _row(self, colour: Colour, texture: TextureKey | None, where: object) -> int:
        if not np.isfinite(colour).all():
            raise SceneError(f"{where}: its colour {colour} is not finite")
        clipped = tuple(min(max(float(np.float32(c)), 0.0), 1.0) for c in colour)
        if not np.allclose(clipped, colour, rtol=0, atol=1e-6):
            self._source.notes.about("Reflectances outside 0 to 1 are clipped", where)
        return self.table.row(clipped, texture)

    def _read(self, material: UsdShade.Material) -> Surface | None:
        path, notes = material.GetPath(), self._source.notes
        shader = material.ComputeSurfaceSource()[0]
        if not shader or shader.GetShaderId() != "UsdPreviewSurface":
            notes.about("Materials without a UsdPreviewSurface are replaced by displayColor", path)
            return None
        self._note_what_is_lost(shader, path)
        value, texture = self._producer(shader.GetInput("diffuseColor"))
        if texture is None:
            return Surface(self._row(value or _UNAUTHORED_DIFFUSE, None, path))
        return self._textured(texture, path)

    def _note_what_is_lost(self, shader: UsdShade.Shader, path: Sdf.Path) -> None:
        emission, texture = self._producer(shader.GetInput("emissiveColor"))
        if texture is not None or (emission is not None and max(emission) > 0):
            self._source.notes.about(
                "Emissive surfaces do not shine; give them windows or a RectLight", path
            )
        opacity, texture = self._producer(shader.GetInput("opacity"))
        if texture is not None or (opacity is not None and opacity < 1):
            self._source.notes.about("Surfaces that are not opaque are taken as opaque", path)

    def _producer(
        self, shader_input: UsdShade.Input | None
    ) -> tuple[object, UsdShade.Shader | None]:
        """The value that an input ends at, or the shader that computes it."""
        if not shader_input:
            return None, None
        attributes = shader_input.GetValueProducingAttributes()
        if not attributes:
            return None, None
        if UsdShade.Utils.GetType(attributes[0].GetName()) == UsdShade.AttributeType.Output:
            return None, UsdShade.Shader(attributes[0].GetPrim())
        return self._source.value(attributes[0].GetPrim(), attributes[0].GetName()), None

    def _textured(self, texture: UsdShade.Shader, material: Sdf.Path) -> Surface | None:
        path, notes = texture.GetPath(), self._source.notes
        asset = self._producer(texture.GetInput("file"))[0]
        if texture.GetShaderId() != "UsdUVTexture" or asset is None:
            notes.about(
                "A diffuseColor that is no UsdUVTexture with a file is replaced by displayColor",
                material,
            )
            return None
        space = str(self._producer(texture.GetInput("sourceColorSpace"))[0] or "auto")
        scale = self._producer(texture.GetInput("scale"))[0] or (1.0, 1.0, 1.0, 1.0)
        bias = self._producer(texture.GetInput("bias"))[0]
        if bias is not None and any(bias[i] != 0 for i in range(3)):
            notes.about("The bias of a texture is left out", path)
        for name in ("wrapS", "wrapT"):
            if self._producer(texture.GetInput(name))[0] not in ("repeat", None, "useMetadata"):
                notes.about("Every texture repeats, whatever its wrap mode", path)
        placed = self._place_texture(asset, space, path)
        row = self._row(tuple(scale)[:3], placed, path)
        return Surface(row, self._primvar(texture))

    def _place_texture(self, asset: Sdf.AssetPath, space: str, path: Sdf.Path) -> TextureKey:
        key = (asset.resolvedPath, space)
        if not asset.resolvedPath or key not in self.table.textures:
            self.table.textures[key] = read_texels(asset, space, str(path))
        return key

    def _primvar(self, texture: UsdShade.Shader) -> str:
        """Name of the texture coordinates: what the primvar reader asks for, usually st."""
        reader = self._producer(texture.GetInput("st"))[1]
        if reader and reader.GetShaderId() == "UsdTransform2d":
            self._source.notes.about("A UsdTransform2d is left out", reader.GetPath())
            reader = self._producer(reader.GetInput("in"))[1]
        name = self._producer(reader.GetInput("varname"))[0] if reader else None
        return str(name or "st")
