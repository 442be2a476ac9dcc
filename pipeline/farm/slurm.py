# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity farm submit --engine slurm``: a job as job arrays, one step after the other."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from nightcity.errors import NightcityError
from nightcity.farm.check import CHECKED, images
from nightcity.farm.job import FarmStep, step_named
from nightcity.farm.template import CHECK, EXPORT, FRAMES
from nightcity.frames import parse_frames


@dataclass(frozen=True)
class Submission:
    """``template`` and ``values``: the job. ``options``: of sbatch, for every step (partition,
    account, ...). ``retries``: of a task. ``only_missing``: of an earlier submission, only what
    has not become an image."""

    template: Path
    values: Mapping[str, str]
    options: Sequence[str] = ()
    retries: int = 2
    only_missing: bool = False


def submit(job: Submission, steps: list[FarmStep]) -> list[str]:
    """Submit the steps; returns a line for each array, with its id. Raises NightcityError."""
    chosen = {step.name: list(range(len(step.tasks))) for step in steps}
    if job.only_missing:
        chosen[EXPORT] = []
        missing = _missing_frames(step_named(steps, CHECK, job.template))
        chosen[FRAMES] = [
            index
            for index, task in enumerate(step_named(steps, FRAMES, job.template).tasks)
            if missing & set(parse_frames(task.values["Frame"]))
        ]
    largest = _largest_array()
    logs = job.template.with_suffix(".logs").absolute()
    logs.mkdir(exist_ok=True)
    submitted: dict[str, list[str]] = {}
    lines = []
    for step in steps:
        before = [i for name in step.after for i in submitted.get(name, [])]
        submitted[step.name] = []
        for base in range(0, len(step.tasks), largest):
            numbers = [n - base for n in chosen[step.name] if base <= n < base + largest]
            if numbers:
                job_id = _sbatch(job, step, base, numbers, before, logs)
                submitted[step.name].append(job_id)
                lines.append(f"{step.name}: job {job_id}, {len(numbers)} tasks")
        submitted[step.name] = submitted[step.name] or before  # a step with nothing to do
    return lines


def _missing_frames(check: FarmStep) -> set[int]:
    """The frames whose images are not there, by the job's own check."""
    command = check.tasks[0].command
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in CHECKED:
        raise NightcityError(f"{CHECK}: {done.stderr.strip()}")
    missing = set(re.findall(r"^missing (.*)$", done.stdout, re.MULTILINE))
    if done.returncode and not missing:
        raise NightcityError(f"{CHECK}: {done.stderr.strip()}")
    return {frame for frame, image in images(check).items() if str(image) in missing}


def _largest_array() -> int:
    """Tasks of an array: MaxArraySize is one more than the largest index."""
    shown = _call(["scontrol", "show", "config"])
    found = re.search(r"^MaxArraySize\s*=\s*(\d+)", shown, re.MULTILINE)
    if not found:
        raise NightcityError("scontrol show config names no MaxArraySize")
    return max(1, int(found[1]))


def _sbatch(
    job: Submission,
    step: FarmStep,
    base: int,
    numbers: list[int],
    before: list[str],
    logs: Path,
) -> str:
    # The check also runs, and names what is missing, where frames failed.
    condition = "afterany" if step.name == CHECK else "afterok"
    command = ["sbatch", "--parsable", f"--job-name={step.name}", f"--array={_ranges(numbers)}"]
    command += [f"--output={logs}/%x.%A.%a.log", "--requeue", "--kill-on-invalid-dep=yes"]
    if before:
        command.append(f"--dependency={condition}:{':'.join(before)}")
    task = ["nightcity", "farm", "task", str(job.template.absolute()), "--step", step.name]
    task += ["--retries", str(0 if step.name == CHECK else job.retries)]
    for name, value in job.values.items():
        task += ["-p", f"{name}={value}"]
    number = f'--number "$(({base} + SLURM_ARRAY_TASK_ID))"'
    # exec: what Slurm stops is the task itself, not a shell that waits for it.
    script = f"#!/bin/sh\nexec {shlex.join(task)} {number}\n"
    return _call([*command, *job.options], script).strip().partition(";")[0]


def _ranges(numbers: list[int]) -> str:
    """0,1,2,5 as 0-2,5."""
    parts: list[list[int]] = []
    for number in numbers:
        if parts and number == parts[-1][1] + 1:
            parts[-1][1] = number
        else:
            parts.append([number, number])
    return ",".join(f"{a}-{b}" if b > a else str(a) for a, b in parts)


def _call(command: list[str], text: str | None = None) -> str:
    if shutil.which(command[0]) is None:
        raise NightcityError(f"{command[0]} is not on the PATH: submit from a host of the cluster")
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    if done.returncode:
        raise NightcityError(f"{command[0]}: {done.stderr.strip() or done.returncode}")
    return done.stdout
