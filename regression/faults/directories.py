"""The directory of a run: files that cannot be written, and whose they are. Cases of faults.py."""
import os
import pathlib
import re
import resource

from runs import SHORT, SLOW, MACHINE, expect, Run, judge_files, summary, claims_success, judge_failure

# One of each kind of file that a run can write.
ALL_FILES = ["--set", "output.probes={peak: {largest: von_mises}, line: {from: [0.5, 0.5, 0], to: [0.5, 0.5, 2]}}",
             "--set", "output.interior={points: [[0.5, 0.5, 0.5]], planes: {middle: {point: [0.5, 0.5, 0.5], normal: [0, 1, 0]}}}"]


def written(options, scratch):
    """{name: bytes} of all files that a run on one rank writes, those among them that are gone at its end."""
    sizes, words, out = {}, scratch / "written.txt", scratch / "out"
    run = Run(options, SHORT, out, arguments=ALL_FILES, environment={"LD_PRELOAD": options.full_disk, "FULL_DISK": f"{out}/", "FULL_DISK_LIST": str(words)})
    expect(run.wait() == 0, f"listed: {run.said}")
    for line in words.read_text().splitlines():
        size, path = line.split(" ", 1)
        if path.endswith(".part"):
            name = pathlib.Path(path).name.removesuffix(".part")
            sizes[name] = sizes.get(name, 0) + int(size)
    left = {path.name for path in out.iterdir()}
    expect(left <= sizes.keys(), f"files written where no full disk is played: {sorted(left - sizes.keys())}")
    for kind in ("blocks.1.vtm", "probes.csv", "probe.line.csv", "interior.csv", "plane.middle.pvd", "restart.1.h5", "results.1.h5", "contact.pvd"):
        expect(kind in sizes, f"no {kind} among the files: {sorted(sizes)}")
    return sizes


def disk_full(options, scratch):
    """At each file that a run writes, at its beginning, middle and near its end, and on one rank of several: exit status 4, the file and the cause
    are named, the directory can be used again."""
    runs = [(1, 0, name, after) for name, size in sorted(written(options, scratch).items()) for after in sorted({0, size // 2, size * 9 // 10})]
    runs += [(2, 1, "results.1.h5", 0), (2, 1, "contact.1_1.vtu", 100), (2, 0, "solution.1.pvtu", 100), (2, 0, "summary.json", 100),
             (3, 2, "results.1.h5", 0), (3, 2, "solution.2_2.vtu", 100)]
    for ranks, victim, name, after in runs:
        environment = {"LD_PRELOAD": options.full_disk, "FULL_DISK": f"/{name}.part", "FULL_DISK_RANK": str(victim), "FULL_DISK_AFTER": str(after)}
        run = Run(options, SHORT, scratch / "out", ranks, arguments=ALL_FILES if ranks == 1 else (), environment=environment)
        status = run.wait()
        who = f"disk full at {name} after {after} bytes, rank {victim} of {ranks}"
        judge_failure(run, status, who, f"{name}: cannot be written")
        expect("o space" in run.said, f"{who}: no cause:\n{run.said}")
        expect(not (run.directory / "mortise.lock").exists(), f"{who}: the lock is left")
    print(f"{len(runs)} runs with a full disk", flush=True)
    # The kernel's own limit, at sizes that hit one file or the other.
    for size in (0, 3000, 20000):
        run = Run(options, SHORT, scratch / "out", prepare=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
        judge_failure(run, run.wait(), f"files up to {size} bytes", "cannot be")
    run = Run(options, SHORT, scratch / "out", 2)
    expect(run.wait() == 0 and summary(scratch / "out")["converged"], f"the next run in the same directory fails:\n{run.said}")


def unwritable(options, scratch):
    """A directory that cannot be made, or written: exit status 4 before anything is computed."""
    (scratch / "file").write_text("x")
    (scratch / "taken/results.h5").mkdir(parents=True)
    for place in (scratch / "file", scratch / "file/out", scratch / "taken", pathlib.Path("/proc/out")):
        run = Run(options, SHORT, place)
        expect(run.wait() == MACHINE and str(place) in run.said and "factorization" not in run.said, f"{place}: {run.said}")
    if os.geteuid() != 0:
        (scratch / "closed").mkdir(mode=0o555)
        run = Run(options, SHORT, scratch / "closed", 2)
        expect(run.wait() == MACHINE and "ermission" in run.said, f"closed directory: {run.said}")


def stale(options, scratch):
    """What an earlier run left is gone, or says that it is not of this run."""
    out = scratch / "out"
    expect(Run(options, SHORT, out, 3, ["--set", "steps[0].increments=4"]).wait() == 0, "the first run fails")
    expect((out / "results.3.h5").exists() and (out / "solution.4_2.vtu").exists(), "the first run has no such files")
    expect(Run(options, SHORT, out).wait() == 0, "the second run fails")
    left = sorted(path.name for path in out.iterdir())
    expect(all(re.fullmatch(r"blocks(\.[12](\.vtm|\.b\d+_0\.vtu)|\.pvd)", name) for name in left if name.startswith("blocks")), f"left: {left}")
    left = [name for name in left if not name.startswith("blocks")]
    expect(left == sorted(["contact.1_0.vtu", "contact.2_0.vtu", "contact.pvd", "deck.yaml", "history.csv", "results.1.h5", "results.h5",
                           "solution.1_0.vtu", "solution.2_0.vtu", "solution.pvd", "summary.json"]), f"left: {left}")
    for status, setting, cause in ((1, "loads[0].pressure=much", "much"), (1, "loads[0].boundary=nowhere", "nowhere"),
                                   (2, "solver.max_multiplications=1", "max_multiplications"),
                                   (3, "supports=[]", "body")):
        expect(Run(options, SHORT, out).wait() == 0, "the run before fails")
        run = Run(options, SHORT, out, arguments=["--set", setting])
        found = run.wait()
        expect(found == status and cause in run.said, f"{setting}: exit status {found}, expected {status}\n{run.said}")
        expect(not claims_success(out), f"{setting}: the summary before is taken for its own")
        if status == 1:  # nothing was computed: what was there stays
            expect((out / "summary.old.json").exists() and (out / "results.h5").exists(), f"{setting}: results before it are gone")
    # A check is no run.
    expect(Run(options, SHORT, out).wait() == 0 and not (out / "summary.old.json").exists(), "an old summary is left")
    expect(Run(options, SHORT, out, arguments=["--check"]).wait() == 0 and claims_success(out), "--check touches results")


def own_files(options, scratch):
    """Files of the user are neither overwritten nor deleted, whatever their name or the way to them."""
    deck = SHORT.read_text()
    folder, link = scratch / "real", scratch / "link"
    folder.mkdir()
    link.symlink_to(folder)
    for name in ("x.part", "notes.txt.part", "model.yaml", "solution_best.vtu"):
        (folder / name).write_text(deck)
    (scratch / "elsewhere.json").write_text("mine")
    (folder / "summary.json").symlink_to(scratch / "elsewhere.json")
    run = Run(options, folder / "x.part", folder)
    expect(run.wait() == 0, run.said)
    for name in ("x.part", "notes.txt.part", "model.yaml", "solution_best.vtu"):
        expect((folder / name).read_text() == deck, f"{name} has changed")
    expect((scratch / "elsewhere.json").read_text() == "mine", "written through a link")
    for path in folder.iterdir():
        path.unlink()
    (folder / "deck.yaml").write_text(deck)
    os.link(folder / "deck.yaml", scratch / "twin.yaml")
    (scratch / "soft.yaml").symlink_to(folder / "deck.yaml")
    for given, place in ((folder / "deck.yaml", folder), (link / "deck.yaml", folder), (folder / "deck.yaml", link),
                         (scratch / "twin.yaml", folder), (scratch / "soft.yaml", link), (SHORT, folder)):
        run = Run(options, given, place)
        expect(run.wait() == 1 and "would replace" in run.said, f"{given} into {place}: {run.said}")
        expect((folder / "deck.yaml").read_text() == deck, f"{given} into {place}: the deck has changed")
    expect(sorted(path.name for path in folder.iterdir()) == ["deck.yaml"], "more than the deck is left")
    # A mesh under the name of a result.
    mesh = folder / "results.h5"
    mesh.write_text("a mesh")
    (folder / "deck.yaml").rename(folder / "model.yaml")
    run = Run(options, folder / "model.yaml", folder, arguments=["--set", "mesh={file: results.h5}"])
    expect(run.wait() == 1 and mesh.read_text() == "a mesh", f"mesh: {run.said}")


def two_runs(options, scratch):
    """The second run into a directory says who is there, and leaves everything as it is; when the first one is gone, it may."""
    for ranks, states in ((1, 8), (2, 15)):  # a few seconds: the second run starts and ends within them
        slower = ["--set", f"steps=[{{name: shear, scale: {{shear: 1}}, increments: {states}}}]"]
        first = Run(options, SLOW, scratch / "out", ranks, slower)
        expect(first.has("mortise.lock"), "no lock")
        second = Run(options, SHORT, scratch / "out", ranks)
        expect(second.wait() == MACHINE and "another run writes there, process " in second.said, f"second: {second.said}")
        expect(first.wait() == 0 and len(summary(scratch / "out")["steps"]) == states, f"first: {first.said}")
        judge_files(scratch / "out", "two runs")
    first = Run(options, SLOW, scratch / "out")
    expect(first.has("mortise.lock"), "no lock")
    first.process.kill()
    first.wait()
    second = Run(options, SHORT, scratch / "out")
    expect(second.wait() == 0 and not (scratch / "out/mortise.lock").exists(), f"after one that was killed: {second.said}")
