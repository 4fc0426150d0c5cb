"""Runs to be disturbed, and what must hold for whatever they leave."""
import contextlib
import json
import os
import pathlib
import signal
import subprocess
import time

HERE = pathlib.Path(__file__).resolve().parent
SHORT, SLOW, PLATES = HERE / "short.yaml", HERE / "slow.yaml", HERE / "plates.yaml"
LIMIT = 120
MACHINE, INTERRUPTED = 4, 130

failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)
        print("FAILED:", what, flush=True)


class Run:
    """A run of the program, to be waited for or disturbed."""

    def __init__(self, options, deck, directory, ranks=1, arguments=(), environment=None, prepare=None, stdout=None):
        command = [options.mortise, str(deck), "--output", str(directory), *arguments]
        if ranks > 1:
            command = [options.mpiexec, "--oversubscribe", "--quiet", "-n", str(ranks)] + command
        self.directory, self.ranks = pathlib.Path(directory), ranks
        settings = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                        OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", **(environment or {}))
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=stdout or subprocess.PIPE, stderr=subprocess.PIPE,
                                        env=settings, preexec_fn=prepare)

    def wait(self):
        """The exit status; None if it hangs."""
        status = None
        try:
            said = self.process.communicate(timeout=LIMIT)
            status = self.process.returncode
        except subprocess.TimeoutExpired:
            for pid in self.rank_pids() + [self.process.pid]:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
            said = self.process.communicate()
        self.said = b"".join(text or b"" for text in said).decode(errors="replace")
        return status

    def rank_pids(self):
        if self.ranks == 1:
            return [self.process.pid]
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            with contextlib.suppress(OSError, ValueError, IndexError):
                if int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1]) == self.process.pid:
                    found.append(int(entry.name))
        return found

    def has(self, name, timeout=LIMIT):
        """Waits until the file is there, or the run has ended."""
        end = time.monotonic() + timeout
        while time.monotonic() < end and self.process.poll() is None:
            if (self.directory / name).exists():
                return True
            time.sleep(0.002)
        return (self.directory / name).exists()


def judge_files(directory, who):
    """Every file under a final name is whole."""
    for path in pathlib.Path(directory).glob("*"):
        if path.name.endswith(".part") or path.name == "mortise.lock" or path.is_dir():
            continue
        data = path.read_bytes()
        whole = {".vtu": data.rstrip().endswith(b"</VTKFile>"), ".pvtu": data.endswith(b"</VTKFile>\n"), ".pvd": data.endswith(b"</VTKFile>\n"),
                 ".vtm": data.endswith(b"</VTKFile>\n"),
                 ".h5": data.startswith(b"\x89HDF\r\n\x1a\n") and len(data) >= int.from_bytes(data[40:48], "little"),
                 ".csv": data.endswith(b"\n"), ".yaml": data.endswith(b"\n")}.get(path.suffix, True)
        if path.suffix == ".json":
            with contextlib.suppress(ValueError):
                json.loads(data)
                continue
            whole = False
        expect(whole, f"{who}: {path.name} is not whole")
        if path.suffix in (".pvd", ".vtm", ".pvtu"):
            for piece in data.decode().split('Source="' if path.suffix == ".pvtu" else 'file="')[1:]:
                expect((path.parent / piece.split('"')[0]).exists(), f"{who}: {path.name} opens what is not there")


def summary(directory):
    path = pathlib.Path(directory) / "summary.json"
    return json.loads(path.read_text()) if path.exists() else None


def identity(path):
    """Of a file, as long as nobody writes it anew; None if there is none."""
    return (found.st_ino, found.st_mtime_ns) if path.exists() and (found := path.stat()) else None


def claims_success(directory):
    found = summary(directory)
    return found is not None and (found["converged"] is not False or found["exit_status"] == 0)


def judge_failure(run, status, who, cause=""):
    expect(status == MACHINE, f"{who}: exit status {status}, expected {MACHINE}\n{run.said}")
    expect(cause in run.said, f"{who}: does not say {cause!r}:\n{run.said}")
    expect(not claims_success(run.directory), f"{who}: summary.json claims success")
    expect(not list(run.directory.glob("*.part")), f"{who}: leaves temporary files")
    judge_files(run.directory, who)
