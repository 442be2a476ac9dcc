# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""One walk over the composed stage, instances and instancers included."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from nightcity.errors import SceneError
from nightcity.export.findings import Findings, Item
from nightcity.export.instancer import instance_masks, instance_transforms, prototype_indices
from nightcity.export.open_stage import Source
from nightcity.export.timeline import ALWAYS, Timeline
from nightcity.progress import Progress

_CHILDREN = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)
# Prototypes often stand below a class or an over, so that they are drawn nowhere else.
_PROTOTYPE_CHILDREN = Usd.TraverseInstanceProxies(
    Usd.PrimIsActive & Usd.PrimIsLoaded & Usd.PrimHasDefiningSpecifier
)
_RENDERED = {"default", "render"}
# The type that each of our schemas must be applied to.
_OWN_TYPES = {
    "NightcityWindowsAPI": ("windows", UsdGeom.PointInstancer),
    "NightcityMediaAPI": ("media", UsdGeom.Cube),
    "NightcityGroundAPI": ("ground", UsdGeom.Mesh),
}


@dataclass(frozen=True, slots=True)
class _Place:
    """What a prim inherits. matrix: (4, 4) to metres; purpose: None until one is authored."""

    matrix: NDArray[np.float64]
    visible: Timeline = ALWAYS
    purpose: str | None = None
    building: int = -1
    moving: str | None = None  # the highest ancestor that moves


def walk(source: Source, district: str | None = None) -> Findings:
    """Find everything that is exported: all that is loaded, or one district of it. Raises
    SceneError for a schema on the wrong type of prim and for transforms that are not finite."""
    top = source.stage.GetPrimAtPath(district or "/")
    total = sum(1 for _ in Usd.PrimRange(top, _CHILDREN))
    with Progress("reading the stage", total) as progress:
        walker = _Walker(source, source.root, _CHILDREN, (), progress)
        return walker.at(top) if district else walker.below(top)


class _Walker:
    """Walks a stage from its root, or one prototype of an instancer on its own."""

    def __init__(
        self,
        source: Source,
        root: NDArray[np.float64],
        children: Usd._PrimFlagsPredicate,
        prototypes: tuple[str, ...],
        progress: Progress,
    ) -> None:
        self._source, self._root, self._children = source, root, children
        self._prototypes = prototypes  # those that this walk is inside of
        self._progress = progress
        self._transforms = UsdGeom.XformCache(source.time)
        self._kinds: dict[str, str] = {}
        self._findings = Findings()

    def below(self, top: Usd.Prim) -> Findings:
        """Everything below ``top``."""
        return self._run([(child, _Place(self._root)) for child in self._reversed(top)])

    def at(self, top: Usd.Prim) -> Findings:
        """``top``, its own transform and what it inherits included, and everything below it."""
        place = _Place(self._root)
        if not self._prototypes:
            for path in top.GetPath().GetParentPath().GetPrefixes():
                ancestor = top.GetStage().GetPrimAtPath(path)
                if self._kind(ancestor) != "other":
                    place = self._place(ancestor, place)
        return self._run([(top, place)])

    def _run(self, stack: list[tuple[Usd.Prim, _Place]]) -> Findings:
        while stack:
            prim, inherited = stack.pop()
            place, descend = self._visit(prim, inherited)
            self._progress.advance()
            if descend:
                stack += [(child, place) for child in self._reversed(prim)]
        return self._findings

    def _reversed(self, prim: Usd.Prim) -> list[Usd.Prim]:
        return prim.GetFilteredChildren(self._children)[::-1]

    def _visit(self, prim: Usd.Prim, inherited: _Place) -> tuple[_Place, bool]:
        kind = self._kind(prim)
        schemas = prim.GetAppliedSchemas()
        place = inherited if kind == "other" else self._place(prim, inherited)
        if "NightcityBuildingAPI" in schemas and not place.visible.never:
            number = self._source.value(prim, "nightcity:buildingId", -1)
            self._findings.building_ids.append(number)
            place = replace(place, building=len(self._findings.building_ids) - 1)
        for schema in schemas:
            if schema in _OWN_TYPES:
                kind, wanted = _OWN_TYPES[schema]
                if not prim.IsA(wanted):
                    raise SceneError(
                        f"{prim.GetPath()}: {schema} belongs on a {wanted.__name__}, but is applied"
                        f" to a prim of type '{prim.GetTypeName()}'"
                    )
        if kind == "camera":
            self._camera(prim, place)
            return place, True
        if kind in ("group", "other"):
            return place, True
        rendered = (place.purpose or "default") in _RENDERED
        if rendered and not place.visible.never:
            self._collect(prim, kind, schemas, place)
        elif kind == "windows":
            self._findings.hidden_windows.append(prim)
        return place, kind not in ("windows", "instancer")

    def _kind(self, prim: Usd.Prim) -> str:
        name = prim.GetTypeName()
        kind = self._kinds.get(name)
        if kind is None:
            kind = self._kinds[name] = _kind_of(prim)
        return kind

    def _place(self, prim: Usd.Prim, inherited: _Place) -> _Place:
        source, changes = self._source, {}
        local, resets = self._transforms.GetLocalTransformation(prim)
        with np.errstate(invalid="ignore", over="ignore"):
            matrix = np.array(local) @ (self._root if resets else inherited.matrix)
        if not np.isfinite(matrix).all():
            raise SceneError(f"{prim.GetPath()}: its transform is not finite")
        if not source.still and (inherited.moving is None or resets):
            moves = source.varies(UsdGeom.Xformable(prim))
            changes["moving"] = str(prim.GetPath()) if moves else None
        visibility = prim.GetAttribute("visibility")
        if visibility.HasAuthoredValue():
            times = source.change_times(visibility)
            values = tuple(visibility.Get(time) != "invisible" for time in times)
            if not all(values):
                changes["visible"] = inherited.visible.both(Timeline(tuple(times), values))
        purpose = prim.GetAttribute("purpose")
        if purpose.HasAuthoredValue():
            changes["purpose"] = purpose.Get()
        return replace(inherited, matrix=matrix, **changes)

    def _camera(self, prim: Usd.Prim, place: _Place) -> None:
        if self._prototypes:
            self._source.notes.about(
                "Cameras inside an instancer's prototype are left out", prim.GetPath()
            )
            return
        self._add("camera", prim, place)

    def _collect(self, prim: Usd.Prim, kind: str, schemas: list[str], place: _Place) -> None:
        notes, first = self._source.notes, self._source.frames[0]
        if place.moving is not None:
            notes.about(f"What moves over time is taken where it is at frame {first}", place.moving)
        if place.visible.changes and kind in ("geometry", "media", "ground", "instancer"):
            notes.about(f"Animated visibility is taken at frame {first}", prim.GetPath())
        if kind not in ("windows", "light") and not place.visible.at(first):
            return
        if kind == "instancer":
            self._expand(prim, place)
            return
        if kind != "light" and "LightAPI" in schemas:
            notes.about("Light of geometry is left out, its surfaces are kept", prim.GetPath())
        self._add(kind, prim, place)

    def _add(self, kind: str, prim: Usd.Prim, place: _Place) -> None:
        self._findings.items[kind].append(
            Item(prim, place.matrix[None], np.array([place.building]), place.visible)
        )

    def _expand(self, prim: Usd.Prim, place: _Place) -> None:
        """Put the contents of the prototypes where the instances are."""
        source = self._source
        transforms = instance_transforms(source, prim, with_prototype=False)
        times, masks = instance_masks(source, prim, len(transforms))
        if len(times) > 1:
            source.notes.about(
                f"Animated invisibleIds are taken at frame {source.frames[0]}", prim.GetPath()
            )
        indices = prototype_indices(source, prim)
        targets = UsdGeom.PointInstancer(prim).GetPrototypesRel().GetForwardedTargets()
        for number, target in enumerate(targets):
            chosen = masks[0] & (indices == number)
            if chosen.any():
                contents = self._prototype(prim, str(target))
                world = transforms[chosen] @ place.matrix
                self._findings.add_copies(contents, world, place.building, place.visible)

    def _prototype(self, instancer: Usd.Prim, path: str) -> Findings:
        if path in self._prototypes:
            raise SceneError(f"{instancer.GetPath()}: its prototype {path} contains itself")
        top = instancer.GetStage().GetPrimAtPath(path)
        if not top:
            raise SceneError(f"{instancer.GetPath()}: there is no prim at its prototype {path}")
        inside = (*self._prototypes, path)
        if not top.IsActive():
            return Findings()
        return _Walker(self._source, np.eye(4), _PROTOTYPE_CHILDREN, inside, self._progress).at(top)


def _kind_of(prim: Usd.Prim) -> str:
    if prim.IsA(UsdGeom.PointInstancer):
        return "instancer"
    if prim.IsA(UsdGeom.Camera):
        return "camera"
    if prim.IsA(UsdGeom.Gprim):
        return "geometry"
    if prim.IsA(UsdGeom.Xformable) and "LightAPI" in prim.GetAppliedSchemas():
        return "light"
    return "group" if prim.IsA(UsdGeom.Imageable) else "other"
