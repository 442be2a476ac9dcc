# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Writes prims into a layer through Sdf, with every attribute typed by its schema.

The Usd API takes minutes for 20,000 siblings; Sdf takes seconds but believes every name it is
given, so ``PrimWriter`` looks each name up and refuses what no schema of the prim knows.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np
from pxr import Sdf, Tf, Usd

# The numpy type whose bytes a Vt array takes as they are.
_ELEMENTS: dict[str, type] = {
    "BoolArray": np.bool_,
    "IntArray": np.int32,
    "Int64Array": np.int64,
    "FloatArray": np.float32,
    "Vec2fArray": np.float32,
    "Vec3fArray": np.float32,
    "QuatfArray": np.float32,  # x, y, z, real
    "QuathArray": np.float16,
}


class UnknownAttributeError(TypeError):
    """A writer named an attribute that no schema of its prim has: a mistake in the program."""


@cache
def _definition(type_name: str, schemas: tuple[str, ...]) -> Usd.PrimDefinition:
    registry = Usd.SchemaRegistry()
    if schemas:
        return registry.BuildComposedPrimDefinition(type_name, list(schemas))
    return registry.FindConcretePrimDefinition(type_name)


@cache
def _attribute_type(
    type_name: str, schemas: tuple[str, ...], name: str
) -> tuple[Sdf.ValueTypeName, Sdf.Variability]:
    spec = _definition(type_name, schemas).GetSchemaAttributeSpec(name)
    if spec is None:
        prim = " with ".join(filter(None, [type_name or "a prim", ", ".join(schemas)]))
        raise UnknownAttributeError(f"{prim} has no attribute {name}")
    return spec.typeName, spec.variability


@cache
def _element(type_name: Sdf.ValueTypeName) -> tuple[type, type] | None:
    """The Vt class of an array type and the numpy type that it takes; None for other types."""
    if not type_name.isArray:
        return None
    array = type(type_name.defaultValue)
    return array, _ELEMENTS.get(array.__name__)


def _usd_value(type_name: Sdf.ValueTypeName, value: Any) -> Any:
    found = _element(type_name)
    if found is None:
        return value
    array, element = found
    if element is None:
        return array(value)
    return array.FromNumpy(np.ascontiguousarray(value, dtype=element))


class PrimWriter:
    """One prim of a layer under construction.

    parent: the prim or layer that holds it. type_name: "" for a prim that another layer types.
    schemas: applied API schemas, written as prepended.
    """

    def __init__(
        self,
        parent: PrimWriter | Sdf.Layer,
        name: str,
        type_name: str = "",
        schemas: Iterable[str] = (),
        specifier: Sdf.Specifier = Sdf.SpecifierDef,
    ) -> None:
        holder = parent.spec if isinstance(parent, PrimWriter) else parent
        self.spec = Sdf.PrimSpec(holder, name, specifier, type_name)
        self._type_name, self._schemas = type_name, tuple(schemas)
        if self._schemas:
            applied = Sdf.TokenListOp.Create(prependedItems=list(self._schemas))
            self.spec.SetInfo("apiSchemas", applied)

    @property
    def path(self) -> Sdf.Path:
        return self.spec.path

    def set(self, name: str, value: Any) -> None:
        """Set an attribute of the prim's type or applied schemas; arrays may come from numpy."""
        type_name, variability = _attribute_type(self._type_name, self._schemas, name)
        self._author(name, type_name, value, variability)

    def sample(self, name: str, values: Mapping[int, Any]) -> None:
        """Set time samples of an attribute that has been set: values by frame."""
        type_name, _ = _attribute_type(self._type_name, self._schemas, name)
        self._sample(name, type_name, values)

    def sample_transform(self, values: Mapping[int, Any]) -> None:
        """As ``sample``, for the matrix that ``place(transform=...)`` has set."""
        self._sample("xformOp:transform", Sdf.ValueTypeNames.Matrix4d, values)

    def _sample(self, name: str, type_name: Sdf.ValueTypeName, values: Mapping[int, Any]) -> None:
        path = self.spec.path.AppendProperty(name)
        for frame, value in values.items():
            self.spec.layer.SetTimeSample(path, float(frame), _usd_value(type_name, value))

    def set_primvar(
        self, name: str, type_name: Sdf.ValueTypeName, value: Any, interpolation: str
    ) -> None:
        """Set ``primvars:name``, whose type no schema fixes."""
        attribute = self._author(f"primvars:{name}", type_name, value)
        attribute.SetInfo("interpolation", interpolation)

    def place(self, **operations: tuple[Sdf.ValueTypeName, Any]) -> None:
        """Set transform operations in this order, outermost first: translate, then scale."""
        names = [f"xformOp:{name}" for name in operations]
        for name, (type_name, value) in zip(names, operations.values(), strict=True):
            self._author(name, type_name, value)
        self.set("xformOpOrder", names)

    def relate(self, name: str, targets: Sequence[Sdf.Path]) -> None:
        """Set a relationship of the prim's type or applied schemas."""
        if _definition(self._type_name, self._schemas).GetSchemaRelationshipSpec(name) is None:
            # A material is bound through relationships that no schema lists by name.
            if not (name == "material:binding" and "MaterialBindingAPI" in self._schemas):
                raise UnknownAttributeError(f"{self.path} has no relationship {name}")
        relationship = Sdf.RelationshipSpec(self.spec, name, custom=False)
        relationship.targetPathList.explicitItems = list(targets)

    def _author(
        self,
        name: str,
        type_name: Sdf.ValueTypeName,
        value: Any,
        variability: Sdf.Variability = Sdf.VariabilityVarying,
    ) -> Sdf.AttributeSpec:
        attribute = Sdf.AttributeSpec(self.spec, name, type_name, variability)
        attribute.default = _usd_value(type_name, value)
        return attribute


def identifier(name: str) -> bool:
    """Whether ``name`` can name a prim."""
    return bool(Tf.IsValidIdentifier(name))
