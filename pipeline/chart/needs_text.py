# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a scene needs, in plain words: HTML for the page."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from html import escape

from nightcity.chart.needs import Change, Needs
from nightcity.chart.recommend import NOISE_SHARE, Recommendation
from nightcity.chart.settings import FULL, PAPER, SINGLE
from nightcity.chart.shot import Shot
from nightcity.chart.switch_cost import Cost, Ratio


def as_html(needs: Needs, shot: Shot) -> str:
    """A table of switches, what each tolerance needs of them, and commands that meet it."""
    rows = "".join(_switch_row(change) for change in needs.changes)
    head = "".join(
        f'<th scope="col">{text}</th>'
        for text in (
            "without",
            "glow changes by",
            "95 of 100 pixels within",
            "pixels off by more than 2 %",
            "the same setting's time with it, to without",
        )
    )
    parts = [f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody>']
    parts.append("</table></div>")
    tolerances = dict.fromkeys(each.tolerance for each in needs.recommendations)
    parts += [_needed(needs.changes, tolerance) for tolerance in tolerances]
    parts.append("<h3>The cheapest settings that do it</h3>")
    parts += [_paragraph(each, needs, shot) for each in needs.recommendations]
    return "".join(parts)


def _switch_row(change: Change) -> str:
    cells = [
        escape(change.switch.words),
        f"{_signed(change.bias)} ± {_percent(change.interval)}",
        _percent(change.p95),
        _percent(change.beyond(0.02)),
        _cost(change.cost),
    ]
    return "<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"


def _cost(cost: Cost | None) -> str:
    if cost is None:
        return "no setting was timed with both"
    bake = f", bake {_ratio(cost.bake)}" if cost.bake else ""
    return escape(f"frame {_ratio(cost.frame)}{bake}: {cost.setting}")


def _ratio(ratio: Ratio) -> str:
    median, lowest, highest = (
        f"{value:.0f}" if value >= 9.5 else f"{value:.2f}"
        for value in (ratio.median, ratio.lowest, ratio.highest)
    )
    return f"x {median} ({lowest} to {highest})"


def _needed(changes: Sequence[Change], tolerance: float) -> str:
    """In words: which switches this tolerance cannot do without."""
    needed = [
        f"{change.switch.words} ({_percent(change.beyond(tolerance))})"
        for change in changes
        if change.p95 > tolerance
    ]
    others = [
        f"{change.switch.words} ({_percent(change.p95)} at 95 of 100 pixels)"
        for change in changes
        if change.p95 <= tolerance
    ]
    words = f"this scene needs {'; '.join(needed)}: in brackets the pixels that are off by more "
    words = words + "without." if needed else "this scene needs none of these."
    if others:
        words += f" It does without {'; '.join(others)}."
    return f"<p><b>At {_percent(tolerance)}</b> {escape(words)}</p>"


def _percent(share: float) -> str:
    value = 100 * share
    return f"{value:.0f} %" if value >= 99.5 else f"{value:.2g} %"


def _signed(share: float) -> str:
    return ("+" if share > 0 else "-") + _percent(abs(share))


def _paragraph(found: Recommendation, needs: Needs, shot: Shot) -> str:
    goal = (
        f"<b>Within {_percent(found.tolerance)} of "
        f"{'everything (the full model)' if found.model == FULL else 'single scattering'}:</b> "
    )
    if not found.options:
        return f"<p>{goal}no setting of this chart, which holds no paths of this model.</p>"
    if found.chosen:
        words = _chosen(found)
    else:
        words = _foretold(found) if found.samples else _NOT_CHARTED
    left_out = _left_out(found, needs)
    command = shlex.join(
        ["./nightcity", "render", f"{shot.scene.name}.usda", "--camera", shot.camera]
        + [*short_options(found.options), "-o", "frame.exr"]
    )
    return f"<p>{goal}{words} {left_out}</p><pre>{escape(command)}</pre>"


_NOT_CHARTED = (
    "no setting of this chart. gauss keeps its tolerance (docs/accuracy.md); here it was neither "
    "timed nor judged so fine."
)


def short_options(options: Sequence[str]) -> list[str]:
    """With --model instead of the switches, where a name stands for all of them."""
    for name, model in (("paper", PAPER), ("single", SINGLE), ("full", FULL)):
        if tuple(options[: len(model.options)]) == model.options:
            return ["--model", name, *options[len(model.options) :]]
    return list(options)


def _chosen(found: Recommendation) -> str:
    assert found.chosen is not None
    words = (
        f"{escape(found.chosen.point.name)}, {_seconds(found.chosen.steady_ms)} a frame here. "
        + _verdict(found)
    )
    if found.cheaper:
        words += f" Cheaper there and good enough: {escape(', '.join(found.cheaper))}."
    return words + _noise(found)


def _foretold(found: Recommendation) -> str:
    assert found.frame_ms is not None
    return (
        (
            f"no setting of this chart. Paths would take about {found.samples} a pixel, "
            f"{_seconds(found.frame_ms)} a frame here, as their noise foretells"
        )
        + (". Not rendered." if found.error is None else f". {_verdict(found)}")
        + _noise(found)
    )


def _verdict(found: Recommendation) -> str:
    assert found.error is not None
    kept = "holds" if found.error <= found.tolerance else "MISSES"
    return (
        f"On {found.pixels} pixels that the choice did not see it {kept}: {_percent(found.error)}."
    )


def _noise(found: Recommendation) -> str:
    if found.truth_noise <= NOISE_SHARE * found.tolerance:
        return ""
    return f" (The truth of this chart is itself noisy: {_percent(found.truth_noise)} of a pixel.)"


def _left_out(found: Recommendation, needs: Needs) -> str:
    model = found.chosen.point.model if found.chosen else found.model
    order = [change.switch.poorer for change in needs.changes]
    if model not in order:
        return ""
    missing = needs.changes[order.index(model) :]
    words = "; ".join(f"{change.switch.words} ({_signed(change.bias)})" for change in missing)
    return f"It leaves out {escape(words)}."


def _seconds(milliseconds: float) -> str:
    if milliseconds < 1000:
        return f"{milliseconds:.0f} ms"
    seconds = milliseconds / 1000
    for unit, size in (("s", 1), ("min", 60)):
        if seconds < 120 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 3600:.3g} h"
