# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A job: a template with its parameters' values, as steps of tasks, each one command."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from openjd.model import (
    DocumentType,
    Job,
    Step,
    StepParameterSpaceIterator,
    SymbolTable,
    create_job,
    decode_job_template,
    document_string_to_object,
    preprocess_job_parameters,
)

from nightcity.errors import NightcityError, UsageError


@dataclass(frozen=True)
class Task:
    """One command. ``label``: the step's name and the values of its task parameters."""

    label: str
    values: Mapping[str, str]
    command: tuple[str, ...]


@dataclass(frozen=True)
class FarmStep:
    """Tasks that may run in any order, once all steps of ``after`` are done."""

    name: str
    after: tuple[str, ...]
    tasks: tuple[Task, ...]


def read_job(template: Path, values: Mapping[str, str]) -> list[FarmStep]:
    """The steps of a template, each after those that it depends on.

    ``values``: of job parameters; paths among them are relative to the current folder, those of
    the template to its own. Raises UsageError naming what the template or a value has wrong.
    """
    try:
        text = template.read_text()
    except OSError as error:
        raise UsageError(f"{template}: cannot be read: {error.strerror}") from None
    try:
        decoded = decode_job_template(
            template=document_string_to_object(document=text, document_type=DocumentType.YAML),
            supported_extensions=["TASK_CHUNKING"],
        )
        parameters = preprocess_job_parameters(
            job_template=decoded,
            job_parameter_values=dict(values),
            job_template_dir=template.absolute().parent,
            current_working_dir=Path.cwd(),
        )
        job = create_job(job_template=decoded, job_parameter_values=parameters)
        return _in_order([_read_step(job, step) for step in job.steps])
    except (ValueError, RuntimeError) as error:
        raise UsageError(f"{template}: {error}") from None


def step_named(steps: list[FarmStep], name: str, template: Path) -> FarmStep:
    """Raises NightcityError where the template has no such step."""
    for step in steps:
        if step.name == name:
            return step
    known = ", ".join(step.name for step in steps)
    raise NightcityError(f"{template}: has no step {name}; its steps are {known}")


def _read_step(job: Job, step: Step) -> FarmStep:
    job_values = SymbolTable()
    for name, parameter in (job.parameters or {}).items():
        job_values[f"Param.{name}"] = job_values[f"RawParam.{name}"] = parameter.value
    action = step.script.actions.onRun
    if step.script.embeddedFiles or step.stepEnvironments or job.jobEnvironments:
        raise ValueError(f"step {step.name}: files and environments in templates are not run here")
    tasks = []
    for values in StepParameterSpaceIterator(space=step.parameterSpace):
        symbols = SymbolTable(source=job_values)
        for name, value in values.items():
            symbols[f"Task.Param.{name}"] = symbols[f"Task.RawParam.{name}"] = value.value
        words = [action.command, *(action.args or [])]
        plain = {name: str(value.value) for name, value in values.items()}
        label = " ".join([step.name, *(f"{name} {value}" for name, value in plain.items())])
        tasks.append(Task(label, plain, tuple(word.resolve(symtab=symbols) for word in words)))
    after = tuple(dependency.dependsOn for dependency in step.dependencies or [])
    return FarmStep(step.name, after, tuple(tasks))


def _in_order(steps: list[FarmStep]) -> list[FarmStep]:
    """Each after those that it depends on; the library has refused circles."""
    ordered: list[FarmStep] = []
    while len(ordered) < len(steps):
        names = {step.name for step in ordered}
        ordered += [s for s in steps if s.name not in names and set(s.after) <= names][:1]
    return ordered
