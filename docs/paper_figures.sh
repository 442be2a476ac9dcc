#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
#
# Renders the pictures of docs/paper_figures.md into a folder (default out/figures).
set -euo pipefail
root=$(cd -- "$(dirname -- "$0")/.." && pwd)
out=${1:-$root/out/figures}
nightcity=$root/nightcity
mkdir -p "$out"

"$nightcity" generate --preset paper-4x4 -o "$out/city.usda"
# Figure 10 wants a view that no preset has: an artist's layer adds the camera.
cat >"$out/figures.usda" <<'USDA'
#usda 1.0
(
    defaultPrim = "City"
    metersPerUnit = 1
    subLayers = [@./city.usda@]
    upAxis = "Z"
)
over "City"
{
    over "Cameras"
    {
        def Camera "hidden"
        {
            float focalLength = 35
            float horizontalAperture = 36
            float verticalAperture = 19.9
            double3 xformOp:translate = (-30, -85, 15)
            float3 xformOp:rotateXYZ = (90, 0, 0)
            uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ"]
        }
    }
}
USDA
"$nightcity" export "$out/figures.usda" -o "$out/city.scene"

render() {
    local name=$1
    shift
    "$nightcity" render "$out/city.scene" --model paper --method march --size 640x354 \
        --quiet "$@" -o "$out/$name.jpg"
}
for steps in 5 25 40 100; do
    render "figure8-$steps" --camera close --subdivisions "$steps"
done
render figure9-far --camera far25 --pixel-samples 16
render figure9-close --camera close --pixel-samples 16
render figure9-inside --camera inside --pixel-samples 16
render figure10-hidden --camera hidden --pixel-samples 16
