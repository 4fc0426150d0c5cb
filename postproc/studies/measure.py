"""Runs one program alone and measures it."""

import os
import pathlib
import signal
import subprocess
import time
from dataclasses import dataclass

SERIAL = {
    "OMP_NUM_THREADS": "1",
    "OMP_THREAD_LIMIT": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MORTISE_TERMINAL": "0",
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
}


@dataclass
class Measured:
    """CPU seconds (user and system of the process and of all it waited for), wall seconds, peak memory of its largest process in MB."""

    cpu: float
    wall: float
    memory: float
    status: int  # negative: the signal that ended it
    text: str  # the last it said


def run(command, directory, limit=None):
    """Runs `command` in `directory`, one thread each process, its words kept in `directory`/log. After `limit` seconds it is stopped: status -9."""
    log = pathlib.Path(directory) / "log"
    start = time.perf_counter()
    with open(log, "w") as sink:
        process = subprocess.Popen(
            command, cwd=directory, stdout=sink, stderr=subprocess.STDOUT, env=dict(os.environ, **SERIAL), start_new_session=True
        )
        try:
            status, usage = wait(process, start, limit)
        except BaseException:  # a session of its own hears no Ctrl-C
            os.killpg(process.pid, signal.SIGKILL)
            raise
    return Measured(usage.ru_utime + usage.ru_stime, time.perf_counter() - start, usage.ru_maxrss / 1e3, status, end_of(log))


def end_of(log, most=50_000):
    with open(log, "rb") as file:
        file.seek(max(0, log.stat().st_size - most))
        return file.read().decode(errors="replace")


def wait(process, start, limit):
    """Exit status and resources; polls only where there is a limit."""
    while True:
        number, status, usage = os.wait4(process.pid, os.WNOHANG if limit else 0)
        if number:
            process.returncode = os.waitstatus_to_exitcode(status)
            return process.returncode, usage
        if time.perf_counter() - start > limit:
            os.killpg(process.pid, signal.SIGKILL)
        time.sleep(0.02)
