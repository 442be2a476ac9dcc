# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The methods of the renderer, with the settings that the sweeps give them."""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass, replace
from functools import cache

from nightcity.errors import UsageError
from nightcity.render import renderer


@dataclass(frozen=True)
class Model:
    """The switches of the physics; a method that knows the paper's model only gets that."""

    visibility: str = "full"
    emitter: str = "isotropic"
    scattering: str = "single"
    lights: str = "all"

    def options(self) -> list[str]:
        """For nightcity-render."""
        return [
            *("--lights", self.lights, "--visibility", self.visibility),
            *("--emitter", self.emitter, "--scattering", self.scattering),
        ]


PLAIN = Model()


class NotAskedError(Exception):
    """A method does not know the physics of a sweep."""


@dataclass(frozen=True)
class Method:
    """One curve of every picture."""

    name: str
    options: tuple[str, ...]
    colour: str
    marker: str
    paper_only: bool = False  # knows the paper's model alone
    panes_only: bool = False  # asked of panes alone: all lights, full visibility, single scattering
    replicas: int = 1  # of a single ray, side by side: a noisy method's are independent
    orders: bool = False  # knows multiple scattering
    on_device: bool = True

    def nearest(self, model: Model) -> Model:
        """The physics to ask instead, of shots that the judge can judge with any windows."""
        return Model(emitter="pane") if self.panes_only and model == PLAIN else model

    def arguments(self, model: Model) -> list[str]:
        """For nightcity-render; NotAskedError where the method does not know the model."""
        if self.panes_only and model != Model(emitter="pane"):
            raise NotAskedError
        physics = ["--model", "paper"] if self.paper_only else model.options()
        return ["--method", self.name, *self.options, *physics]

    def with_option(self, name: str, value: float) -> Method:
        """The same with one of its options changed."""
        options = list(self.options)
        options[options.index(name) + 1] = f"{value:g}"
        return replace(self, options=tuple(options))


METHODS = {
    method.name: method
    for method in (
        Method("march", ("--subdivisions", "25"), "#c0504d", "s", paper_only=True),
        Method("gauss", ("--tolerance", "0.001"), "#2f6db5", "o"),
        Method("field", ("--tolerance", "0.01"), "#3a8f4d", "^", panes_only=True),
        Method("path", ("--samples", "256"), "#8064a2", "x", replicas=128, orders=True),
        Method("reference", ("--tolerance", "0.001"), "#404040", ".", on_device=False),
    )
}
JUDGE = METHODS["reference"].with_option("--tolerance", 1e-5)  # exact to 1e-6


@cache
def known_methods() -> tuple[str, ...]:
    """Names of METHODS that the renderer at hand knows."""
    text = subprocess.run([renderer(), "--help"], capture_output=True, text=True, check=True).stdout
    found = re.search(r"--method ([a-z,| ]+)=", text)
    names = re.findall(r"\w+", found.group(1)) if found else []
    return tuple(name for name in METHODS if name in names)


def choose_methods(names: list[str] | None) -> tuple[str, ...]:
    """Those asked for, in the order of METHODS; all that the renderer knows where none is."""
    known = known_methods()
    for name in names or ():
        if name not in known:
            raise UsageError(f"--methods {name} is not known; there is {', '.join(known)}")
    return tuple(name for name in known if not names or name in names)
