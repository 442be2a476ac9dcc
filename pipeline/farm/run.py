# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity farm run``: the tasks of a job through Dask distributed."""

from __future__ import annotations

import contextlib
import logging
import tempfile
import uuid
from collections.abc import Iterator

from nightcity.errors import DeviceError, NightcityError, SceneError, UsageError
from nightcity.farm.check import CHECKED, name_unchecked
from nightcity.farm.job import FarmStep, Task
from nightcity.farm.task import HOPELESS, TaskFailed, is_stopped, run_command, stop_commands
from nightcity.farm.template import CHECK, EXPORT

_ERRORS = {2: UsageError, 3: SceneError, 4: DeviceError}
_TELLING = ("wrote ", "kept ", "missing ")  # how lines about finished images begin


def run_job(steps: list[FarmStep], scheduler: str | None, workers: int, retries: int) -> None:
    """Run every step, here on ``workers`` processes or on the Dask cluster at ``scheduler``.

    A task that fails is tried ``retries`` times more, unless its exit code says that this is
    useless; one whose worker died is given to another. Prints a line for each image. Raises the
    error of the tasks that failed at last, after the check has named the images that are missing.
    """
    run = uuid.uuid4().hex
    with _client(scheduler, workers) as client:
        client.subscribe_topic(run, lambda event: print(event[1], flush=True))
        try:
            _run_steps(client, steps, run, retries)
        finally:
            # Also where TERM ended the waiting: no command of this run outlives it.
            client.run(stop_commands, run)


@contextlib.contextmanager
def _client(scheduler: str | None, workers: int) -> Iterator[object]:
    import distributed

    with contextlib.ExitStack() as stack:
        if scheduler:
            try:
                client = distributed.Client(scheduler, timeout=30)
            except (OSError, ValueError) as error:
                raise NightcityError(f"--scheduler {scheduler}: {error}") from None
            yield stack.enter_context(client)
            return
        # Workers that die are said below, with what they did.
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        folder = stack.enter_context(tempfile.TemporaryDirectory(ignore_cleanup_errors=True))
        cluster = distributed.LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            memory_limit=0,
            dashboard_address=":0",  # any port: two jobs may run
            silence_logs=logging.CRITICAL,
            local_directory=folder,
        )
        stack.enter_context(cluster)
        yield stack.enter_context(distributed.Client(cluster))


def _run_steps(client: object, steps: list[FarmStep], run: str, retries: int) -> None:
    failures: dict[str, tuple[int, str]] = {}  # by step: exit code and message of the last
    for step in steps:
        broken = next((name for name in step.after if name in failures), None)
        if broken and not (step.name == CHECK and EXPORT not in failures):
            failures[step.name] = failures[broken]
            if step.name == CHECK:
                name_unchecked(step)
            continue
        failed = _run_step(client, step, run, retries)
        if failed and step.name == CHECK and failed[0] not in CHECKED:
            name_unchecked(step)
        if failed:
            failures[step.name] = failed
        elif broken:
            failures[step.name] = failures[broken]
    for code, message in failures.values():
        raise _ERRORS.get(code, NightcityError)(message)


def _run_step(client: object, step: FarmStep, run: str, retries: int) -> tuple[int, str] | None:
    """Run a step's tasks; exit code and message where some failed."""
    import distributed

    if step.name == CHECK:
        retries = 0
    futures = {
        client.submit(_work, task, run, key=f"{task.label}-{run}", retries=retries): task
        for task in step.tasks
    }
    failed = None
    for done, future in enumerate(distributed.as_completed(futures), 1):
        task = futures[future]
        code, said = _outcome(future)
        # Else Dask runs it again where the worker that keeps its result dies.
        future.release()
        if code:
            failed = code, f"{task.label}: {said.splitlines()[-1] if said else code}"
            print(f"failed: {task.label} (exit code {code})", flush=True)
        print(f"{step.name} {done}/{len(futures)}", flush=True)
    return failed


def _outcome(future: object) -> tuple[int, str]:
    import distributed

    try:
        return future.result()
    except TaskFailed as error:
        return error.args
    except distributed.KilledWorker:
        return 1, "every worker that tried it died"


def _work(task: Task, run: str) -> tuple[int, str]:
    """In a worker: run the task; raise where another try may help."""
    from distributed import get_worker

    worker = get_worker()

    def say(line: str) -> None:
        if line.startswith(_TELLING):
            worker.log_event(run, line)

    code, said = run_command(task.command, run, say)
    if code == 0 or is_stopped(run):
        return code, said
    worker.log_event(run, f"try failed: {task.label} (exit code {code}): {said}")
    if code in HOPELESS:
        return code, said
    raise TaskFailed(code, said)
