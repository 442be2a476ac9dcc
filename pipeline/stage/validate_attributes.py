# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of single attributes: known, applied to the right prim, in range."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from functools import cache

from pxr import Usd

from nightcity import schemas
from nightcity.stage.contents import NAMESPACE, PREFIX, PRIM_TYPES, Contents, authored_schemas
from nightcity.stage.finding import Finding, error, warning
from nightcity.stage.ranges import RANGES
from nightcity.stage.values import as_numbers, at, samples

_SHOWN = 3  # wrong values quoted


def check_schemas(contents: Contents) -> Iterator[Finding]:
    """Applied schemas exist and stand on the type of prim that they are for."""
    for prim in contents.ours:
        for name in authored_schemas(prim):
            wanted = PRIM_TYPES.get(name)
            if name.startswith(PREFIX) and name not in schemas.NAMES:
                yield error(
                    prim, "apiSchemas", f"there is no schema {name}{_nearest(name, schemas.NAMES)}"
                )
            elif wanted and prim.GetTypeName() != wanted:
                yield error(
                    prim,
                    "apiSchemas",
                    f"{name} belongs on a {wanted}, but the prim's type is"
                    f" '{prim.GetTypeName()}'; remove it or change the type",
                )


def check_names(contents: Contents) -> Iterator[Finding]:
    """Every property in our namespace belongs to a schema of its prim."""
    owners = _owners()
    for prim in contents.ours:
        applied = set(authored_schemas(prim))
        for authored in prim.GetAuthoredPropertiesInNamespace(NAMESPACE):
            name = authored.GetName()
            owner = owners.get(name)
            if owner is None:
                yield warning(
                    prim, name, f"no schema has it, so nothing reads it{_nearest(name, owners)}"
                )
            elif owner not in applied:
                yield error(prim, name, f"is not read, because the prim lacks {owner}; apply it")


def check_ranges(contents: Contents) -> Iterator[Finding]:
    """Every authored value lies in its range at all times; what has no default is there."""
    owners = _owners()
    by_schema: dict[str, list[str]] = {}
    for name in RANGES:
        by_schema.setdefault(owners[name], []).append(name)
    for prim in contents.ours:
        for schema in authored_schemas(prim):
            for name in by_schema.get(schema, ()):
                yield from _check_range(prim, name)


def _check_range(prim: Usd.Prim, name: str) -> Iterator[Finding]:
    allowed = RANGES[name]
    if not prim.GetAttribute(name).HasAuthoredValue():
        if allowed.required:
            yield error(prim, name, f"must be set; its range is: {allowed}")
        return
    for time, value in samples(prim, name):
        broken = allowed.broken(as_numbers(value))
        if len(broken):
            shown = ", ".join(f"{each:g}" for each in broken[:_SHOWN])
            more = f" and {len(broken) - _SHOWN} more" if len(broken) > _SHOWN else ""
            yield error(prim, name, f"is {shown}{more}{at(time)}; its range is: {allowed}")
            return


@cache
def _owners() -> dict[str, str]:
    """The schema of each property."""
    registry = Usd.SchemaRegistry()
    return {
        name: schema
        for schema in schemas.NAMES
        for name in registry.FindAppliedAPIPrimDefinition(schema).GetPropertyNames()
    }


def _nearest(name: str, known: object) -> str:
    near = difflib.get_close_matches(name, list(known), n=1)
    return f"; did you mean {near[0]}?" if near else ""
