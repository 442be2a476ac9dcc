# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The command line of ``nightcity farm``: parses and calls, nothing else."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from nightcity.errors import NightcityError, UsageError

_STAGES = (".usd", ".usda", ".usdc", ".usdz")


def add_farm(commands: argparse._SubParsersAction) -> None:
    """Add ``farm`` with its own commands."""
    farm = commands.add_parser("farm", help="a shot as a batch job, here or on a farm")
    parts = farm.add_subparsers(dest="part", required=True, metavar="COMMAND")
    for add in (_template, _run, _submit, _task):
        add(parts)


def _template(parts: argparse._SubParsersAction) -> None:
    command = parts.add_parser(
        "template",
        help="write an OpenJobDescription template",
        description="Writes a job: export, frames in chunks, check, contact sheet and movie. "
        "Every option not named here goes to nightcity-render.",
    )
    command.add_argument("stage", type=Path)
    command.add_argument("--job", type=Path, required=True, help="the template, .yaml")
    _add_shot(command, required=True)

    def run(options: argparse.Namespace) -> None:
        _need("yaml")
        _write_template(options, options.stage, options.job)
        print(options.job)

    command.set_defaults(run=run, passes_options_on=True)


def _add_shot(command: argparse.ArgumentParser, *, required: bool) -> None:
    command.add_argument(
        "-o", "--output", type=Path, required=required, help="the images, like out/frame.####.exr"
    )
    command.add_argument("--camera", default="", help="(default: the stage's)")
    command.add_argument("--frames", default="1", help="like 1-10 or 1-10x2,20 (default: 1)")
    command.add_argument("--chunk", type=int, default=1, help="frames a task (default: 1)")
    command.add_argument("--tiles", type=int, default=1, help="tiles a frame (default: 1)")
    command.add_argument("--lists", choices=("recomputed", "authored"), default="recomputed")


def _write_template(options: argparse.Namespace, stage: Path, job: Path) -> None:
    from nightcity.farm.template import Shot, write_template

    shot = Shot(
        scene=stage,
        output=options.output,
        camera=options.camera,
        frames=options.frames,
        chunk=options.chunk,
        tiles=options.tiles,
        lists=options.lists,
        options=options.renderer_options,
    )
    write_template(shot, job)


def _add_job(command: argparse.ArgumentParser, what: str = "the template, .yaml") -> None:
    command.add_argument("job", type=Path, help=what)
    command.add_argument(
        "-p",
        "--parameter",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a value of a job parameter, like Frames=1-4",
    )
    command.add_argument(
        "--retries", type=int, default=2, help="of a task that failed (default: %(default)s)"
    )


def _values(options: argparse.Namespace) -> dict[str, str]:
    values = {}
    for text in options.parameter:
        name, equals, value = text.partition("=")
        if not (name and equals):
            raise UsageError(f"-p {text}: give NAME=VALUE")
        values[name] = value
    return values


def _run(parts: argparse._SubParsersAction) -> None:
    command = parts.add_parser(
        "run",
        help="run a job through Dask, here or on a cluster",
        description="Runs a template. For a stage, its template is written first, with -o and the "
        "options of `farm template`, beside the folder of the images as FOLDER.job.yaml.",
    )
    _add_job(command, "the template, .yaml, or a stage")
    _add_shot(command, required=False)
    command.add_argument("--scheduler", help="address of a Dask scheduler (default: workers here)")
    command.add_argument(
        "--workers", type=int, default=2, help="renderers at once here (default: %(default)s)"
    )

    def run(options: argparse.Namespace) -> None:
        _need("openjd.model", "distributed")
        from nightcity.farm.job import read_job
        from nightcity.farm.run import run_job

        if options.workers < 1 or options.retries < 0:
            raise UsageError("--workers must be at least 1, --retries at least 0")
        steps = read_job(_job_of(options), _values(options))
        run_job(steps, options.scheduler, options.workers, options.retries)

    command.set_defaults(run=run, passes_options_on=True)


def _job_of(options: argparse.Namespace) -> Path:
    """The template named, or one written for the stage named."""
    if options.job.suffix not in _STAGES:
        if options.output or options.renderer_options:
            given = f"-o {options.output}" if options.output else options.renderer_options[0]
            raise UsageError(f"{given}: {options.job} is a template, which says that itself")
        return options.job
    if options.output is None:
        raise UsageError(f"{options.job}: -o is missing: its images, like out/frame.####.exr")
    _need("yaml")
    images = options.output.parent.absolute()
    shared = Path(os.path.commonpath([images.parent, options.job.absolute().parent]))
    job = shared / f"{images.name}.job.yaml"
    _write_template(options, options.job.absolute(), job)
    print(job, flush=True)
    return job


def _submit(parts: argparse._SubParsersAction) -> None:
    command = parts.add_parser(
        "submit",
        help="submit a job to a batch system",
        description="Submits a job. Every option not named here goes to sbatch.",
    )
    _add_job(command)
    command.add_argument("--engine", choices=("slurm",), required=True)
    command.add_argument(
        "--resubmit", action="store_true", help="only what an earlier submission did not finish"
    )

    def run(options: argparse.Namespace) -> None:
        _need("openjd.model")
        from nightcity.farm.job import read_job
        from nightcity.farm.slurm import Submission, submit

        values = _values(options)
        steps = read_job(options.job, values)
        submission = Submission(
            options.job, values, options.renderer_options, options.retries, options.resubmit
        )
        for line in submit(submission, steps):
            print(line)

    command.set_defaults(run=run, passes_options_on=True)


def _task(parts: argparse._SubParsersAction) -> None:
    command = parts.add_parser("task", help="run one task of a job here, as batch systems do")
    _add_job(command)
    command.add_argument("--step", required=True, help="name of the step")
    command.add_argument("--number", type=int, default=0, help="of the task, from 0")

    def run(options: argparse.Namespace) -> int:
        _need("openjd.model", "yaml")
        from nightcity.farm.check import CHECKED, name_unchecked
        from nightcity.farm.job import read_job, step_named
        from nightcity.farm.task import run_here
        from nightcity.farm.template import CHECK

        step = step_named(read_job(options.job, _values(options)), options.step, options.job)
        if not 0 <= options.number < len(step.tasks):
            raise UsageError(f"step {step.name} has {len(step.tasks)} tasks, from 0")
        code = run_here(step.tasks[options.number].command, options.retries, os.environ)
        if step.name == CHECK and code not in CHECKED:
            name_unchecked(step)
        return code

    command.set_defaults(run=run)


def _need(*modules: str) -> None:
    """Raises NightcityError where the farm's packages are not installed."""
    from importlib.util import find_spec

    for module in modules:
        try:
            found = find_spec(module)
        except ModuleNotFoundError:
            found = None
        if found is None:
            raise NightcityError(f"{module} is not installed: pip install 'nightcity[farm]'")
