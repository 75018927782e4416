"""Students on a dask cluster of this machine: ``python -m tests.bench.cluster [--students 50,100,200] [--workers 1,2] [--works]``.

Each student gets a sheet as SVG, composed anew; with ``--works`` all that ``roster`` gives. First how many a minute, and the memory
of the workers before and after; then a worker is killed when a third is there, and the command itself, which is repeated. Workers
are processes of their own, one thread each.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic, sleep

from tmm_sheets import catalogue

PROJECT = "lugansk/cam_flat"
MANY = 100_000
UNWATCHED = {"DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "False"}
"""Without it a worker of dask keeps a third of a megabyte a second of what it was doing, up to an hour of it."""
RUN = [sys.executable, "-m", "tmm_sheets"]


@contextmanager
def cluster(workers: int) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """A scheduler with so many workers: its address, and the workers."""
    with tempfile.TemporaryDirectory() as folder:
        told = Path(folder, "scheduler.json")
        start = [sys.executable, "-m"]

        def begin(*arguments: str) -> subprocess.Popen[bytes]:
            return subprocess.Popen([*start, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                    env={**os.environ, **UNWATCHED})

        begun = [begin("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
                       "--scheduler-file", str(told))]
        try:
            while not told.exists():
                sleep(0.1)
            begun += [begin("distributed.cli.dask_worker", "--scheduler-file", str(told), "--nthreads", "1", "--no-nanny",
                            "--no-dashboard", "--local-directory", folder) for _ in range(workers)]
            from distributed import Client

            with Client(scheduler_file=str(told)) as client:
                client.wait_for_workers(workers, timeout=60)
                address = client.scheduler.address
            yield address, begun[1:]
        finally:
            for process in reversed(begun):
                process.kill()
                process.wait()


def memory(process: subprocess.Popen[bytes]) -> int:
    """Memory of a process, MB."""
    status = Path(f"/proc/{process.pid}/status").read_text("ascii")
    return int(next(line for line in status.splitlines() if line.startswith("VmRSS")).split()[1]) // 1024


class Batch:
    """So many students of a project in a folder."""

    def __init__(self, students: int, works: bool, folder: Path) -> None:
        self.folder, self.students = folder / "out", students
        if works:
            table = folder / "group.csv"
            table.write_text("student\n" + "".join(f"Student {n:04}\n" for n in range(students)), encoding="utf-8")
            self.command = [*RUN, "roster", str(table), "--task", PROJECT, "--format", "svg"]
        else:
            files = [folder / f"s{n:04}.toml" for n in range(students)]
            for file in files:
                file.write_text(catalogue.read(PROJECT).text, encoding="utf-8")
            names = folder / "names.txt"
            names.write_text("".join(f"{file}\n" for file in files), encoding="utf-8")
            self.command = [*RUN, "build", "--list", str(names), "--format", "svg"]
        self.command += ["--no-cache", "-o", str(self.folder)]

    def start(self, address: str) -> subprocess.Popen[str]:
        """Begin, or go on."""
        return subprocess.Popen([*self.command, "--dask", address], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    @property
    def done(self) -> dict[Path, int]:
        """Sheets that are there, and when they were written, ns."""
        return {path: path.stat().st_mtime_ns for path in self.folder.rglob("*.svg")} if self.folder.exists() else {}

    def wait(self, share: float) -> None:
        """Wait until a share of the sheets is there."""
        while len(self.done) < share * self.students:
            sleep(0.05)


def rate(workers: int, students: int, works: bool) -> tuple[float, str]:
    """Students a minute, and a line of the table."""
    with tempfile.TemporaryDirectory() as folder, cluster(workers) as (address, processes):
        Batch(workers, works, _below(folder, "warm")).start(address).communicate()
        batch, before = Batch(students, works, _below(folder, "all")), [memory(p) for p in processes]
        begin = monotonic()
        _, problems = (command := batch.start(address)).communicate()
        took = monotonic() - begin
        assert command.returncode == 0, problems
        after = [memory(p) for p in processes]
    many = 60 * students / took
    return many, f"| {workers} | {students} | {took:.1f} | {many:.0f} | {_listed(before)} | {_listed(after)} |"


def killed_worker(students: int, works: bool) -> str:
    """What becomes of the students of a worker that is killed when a third is there."""
    with tempfile.TemporaryDirectory() as folder, cluster(2) as (address, processes):
        batch = Batch(students, works, Path(folder))
        command = batch.start(address)
        batch.wait(1 / 3)
        processes[0].send_signal(signal.SIGKILL)
        there = len(batch.done)
        said, problems = command.communicate()
        ended = len(batch.done)
    return f"worker killed at {there} of {students}: status {command.returncode}, {ended} there; {_last(said, problems)}"


def killed_command(students: int, works: bool) -> str:
    """What the command does again after it was killed when a third was there."""
    with tempfile.TemporaryDirectory() as folder, cluster(2) as (address, _):
        batch = Batch(students, works, Path(folder))
        command = batch.start(address)
        batch.wait(1 / 3)
        command.kill()
        command.communicate()
        sleep(5)  # what is in the workers' hands
        there = batch.done
        command = batch.start(address)
        told, problems = command.communicate()
        again = sum(batch.done[path] != when for path, when in there.items())
        ended = f"repeated: status {command.returncode}, {len(batch.done)} there, {again} made again"
    return f"command killed, {len(there)} of {students} there; {ended}; {_last(told, problems)}"


def _last(said: str, problems: str) -> str:
    return (problems or said).strip().splitlines()[-1]


def _below(folder: str, name: str) -> Path:
    path = Path(folder, name)
    path.mkdir()
    return path


def _listed(some: list[int]) -> str:
    return ", ".join(map(str, some))


def _numbers(text: str) -> list[int]:
    return [int(part) for part in text.split(",")]


def main() -> None:
    """Measure, and print tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--students", type=_numbers, default=[50, 100, 200])
    parser.add_argument("--workers", type=_numbers, default=[1, 2])
    parser.add_argument("--works", action="store_true", help="all that roster gives, not one sheet")
    asked = parser.parse_args()
    print("| workers | students | s | students a minute | MB of each before | after |\n|---|---|---|---|---|---|")
    for workers in asked.workers:
        for students in asked.students:
            many, line = rate(workers, students, asked.works)
            print(line, flush=True)
    print(f"\nBy the last line {MANY:,} students take {MANY / many / 60:.0f} hours of {asked.workers[-1]} workers.")
    for trial in (killed_worker, killed_command):
        print(f"\n{trial(asked.students[0], asked.works)}", flush=True)


if __name__ == "__main__":
    main()
