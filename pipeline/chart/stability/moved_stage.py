# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A whole stage far from its own origin, through the exporter."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.lab import Lab
from nightcity.chart.stability.methods import JUDGE, PLAIN, Method
from nightcity.chart.stability.sweep import Axis, Errors, Failure, Sweep, joined, relative_errors

FloatArray = NDArray[np.float64]

# A street like that of views.py; translate in m and double precision moves all of it.
_STAGE = """#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Z"
)
def Xform "Moved"
{{
    double3 xformOp:translate = ({x!r}, {y!r}, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Cube "Wall"
    {{
        double size = 1
        double3 xformOp:translate = (7.5, 0, 8)
        double3 xformOp:scale = (5, 24, 16)
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
    }}
    def PointInstancer "Windows" (
        prepend apiSchemas = ["NightcityWindowsAPI"]
    )
    {{
        point3f[] positions = [(-4.75, -8, 5), (-4.75, 6, 9)]
        quatf[] orientationsf = [(0.70710677, 0, 0.70710677, 0), (0.70710677, 0, 0.70710677, 0)]
        int[] protoIndices = [0, 0]
        int64[] ids = [0, 1]
        rel prototypes = </Moved/Windows/Pane>
        uniform float2 nightcity:windowSize = (1, 1)
        float[] nightcity:power = [50]
        def Mesh "Pane"
        {{
        }}
    }}
    def Cube "Haze" (
        prepend apiSchemas = ["NightcityMediaAPI"]
    )
    {{
        double size = 1
        double3 xformOp:translate = (0, 0, 12)
        double3 xformOp:scale = (64, 64, 24)
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
        uniform int nightcity:mediaId = 0
        float nightcity:extinction = 0.03125
        float nightcity:albedo = 0.9
    }}
    def Camera "view"
    {{
        float2 clippingRange = (0.1, 1000)
        float focalLength = 20
        float horizontalAperture = 20
        float verticalAperture = 20
        double3 xformOp:translate = (0.5, -40, 8)
        float xformOp:rotateX = 90
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateX"]
    }}
}}
"""
_SIDE = 3  # pixels


def _moved(lab: Lab, method: Method, points: FloatArray) -> Errors:
    truth = lab.render_stage(_stage(0.0), JUDGE, PLAIN, _SIDE).value
    found = [lab.render_stage(_stage(x), method, PLAIN, _SIDE) for x in points]
    return joined([relative_errors(glow, truth) for glow in found])


def _stage(distance: float) -> str:
    return _STAGE.format(x=float(1.00012345 * distance), y=float(-0.77703217 * distance))


SWEEPS = (
    Sweep(
        name="moved-stage",
        title="The stage far from its origin: the flat scene has an origin of its own",
        axis=Axis(
            "distance from the origin, m",
            (0, 1, 10, 100, 1000, 5000, 10000, 20000, 50000, 100000),
            (100000,),
            scale="symlog",
        ),
        truth="judge at the origin",
        bar=0.01,
        measure=_moved,
        failures={"march": Failure("no visibility; equal steps", 0.01, 20)},
    ),
)
