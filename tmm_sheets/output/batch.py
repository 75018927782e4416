"""Many projects at once: a pool of processes, or the workers of a dask cluster; failures are collected, the rest goes on.

A project is built by the same code with the same inputs wherever that happens, so the bytes do not depend on the number
of workers. What is current stays (see :mod:`tmm_sheets.output.build_store`): an interrupted batch goes on where it stopped.
A student gets more than sheets: the note, an empty table for what is measured, the living page.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from contextvars import copy_context
from dataclasses import dataclass, replace
from importlib import import_module
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from tmm_sheets import catalogue, files, kept, quoting, spelling, words
from tmm_sheets.errors import BadInput, CannotBuild, Stopped
from tmm_sheets.kept import fingerprint, program
from tmm_sheets.output import with_room
from tmm_sheets.output.build_store import current, outlet, put, record_of
from tmm_sheets.output.building import Order, build
from tmm_sheets.task import title_entries
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

LARGEST_CHUNK = 25
"""Most projects of one task for a worker: a second or so of waiting for its result, and next to nothing for handing it over."""
CHUNKS_EACH = 64
"""Least number of tasks for each worker, so that all of them end together."""


@dataclass(frozen=True)
class Outcome:
    """What became of one project: ``problem`` is empty when all of it was built; counts of files, bytes of those made now.

    ``folder`` is that of a student, ``handed`` tells what of the rest that a student gets is there.
    """

    project: str
    problem: str = ""
    made: int = 0
    unchanged: int = 0
    size: int = 0
    warnings: tuple[str, ...] = ()
    folder: str = ""
    handed: tuple[tuple[str, bool], ...] = ()


class Task(NamedTuple):
    """A project of a batch, as it was called, and its folder in that of the batch; empty for one called after the project.

    A ``student``'s, with the ``group``, has the student's name on the sheets, and what a student gets beside them.
    """

    project: str
    folder: str
    student: str = ""
    group: str = ""


def one(task: Task, order: Order) -> Outcome:
    """Build one project into its folder; whatever goes wrong is told, not raised."""
    outcome = copy_context().run(_build_one, task, order)  # the languages it sets are its own
    return replace(outcome, folder=task.folder) if task.student else outcome


def _build_one(task: Task, order: Order) -> Outcome:
    words.set_reader(order.reader)
    if not order.kept:
        kept.forgo()
    warnings: list[str] = []
    try:
        return _built(task, order, warnings)
    except Exception as e:
        from tmm_sheets import defects

        file = Path(task.project)
        problem = defects.told(e, ("build", task.project), file if file.is_file() else None,
                               lambda path: _built(task._replace(project=str(path)), order, []))
        return Outcome(task.project, problem, warnings=tuple(warnings))


def _built(task: Task, order: Order, warnings: list[str]) -> Outcome:
    """The outcome of a project; what is to be said of it goes to ``warnings``, too."""
    variant = with_room(catalogue.read(task.project, order.corrected, guessed=bool(task.student)))  # a batch tells one line of each
    warnings += variant.warnings
    own = {key: text for key, text in (("student", task.student), ("group", task.group)) if text}
    names = replace(order.names, options={**order.names.options, **own})
    variant = names.filled(variant)
    folder = order.parent / (task.folder or files.folder_name(variant.stem))
    built = build(variant, order, order.outlet(folder))
    handed = dict[str, bool]()
    if task.student:
        handed, said = _hand_out(built.opened, folder, order.force, names.options)
        warnings += said
    warnings += built.warnings
    made = len(built.sizes)
    problem = "" if built.refused is None else str(built.refused)
    return Outcome(task.project, problem, made, len(built.paths) - made, sum(built.sizes.values()), tuple(warnings),
                   handed=tuple(handed.items()))


_ending = threading.Event()
"""In a process of the pool: no more projects are begun."""


def several(tasks: Sequence[Task], order: Order) -> list[Outcome]:
    """Build some projects one after the other: the work of one worker, up to the project in work when the batch is told to end."""
    return [one(task, order) for task in tasks if not _ending.is_set()]


def _start(told: Connection) -> None:
    """A process of the pool begins: signals are its parent's business, and it does not outlive its parent."""
    for name in ("SIGINT", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    # The pool ends the others so when one of them was killed.
    signal.signal(signal.SIGTERM, lambda *_: threading.Thread(target=_end).start())
    threading.Thread(target=_wait_for_end, args=(told,), daemon=True).start()


def _wait_for_end(told: Connection) -> None:
    """Wait until the parent tells the end of the batch, or is no more."""
    above = multiprocessing.parent_process()
    assert above is not None
    if above.sentinel not in wait([above.sentinel, told]):
        _ending.set()
        wait([above.sentinel])
    _end()


def _end() -> None:
    with files.WRITING:
        os._exit(1)


def _chunks(tasks: Sequence[Task], workers: int) -> list[Sequence[Task]]:
    size = max(1, min(LARGEST_CHUNK, len(tasks) // (workers * CHUNKS_EACH)))
    return [tasks[k : k + size] for k in range(0, len(tasks), size)]


def processors() -> int:
    """Processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def on(works: Sequence[Task], order: Order) -> Iterator[Outcome]:
    """Do tasks on a dask cluster where the order has a scheduler, else in so many processes, all processors unless told."""
    return run_on_dask(works, order, order.scheduler) if order.scheduler else carry_out(works, order)


def carry_out(works: Sequence[Task], order: Order) -> Iterator[Outcome]:
    """Do tasks in processes of their own; outcomes as they come.

    A signal that asks for the end lets each process finish the project in its hands.

    Raises
    ------
    Stopped
        after the outcomes, when such a signal came.
    """
    workers = min(order.jobs or processors(), len(works))
    if workers <= 1:
        for work in works:
            yield one(work, order)
        return
    chunks = _chunks(works, workers)
    context = multiprocessing.get_context("fork" if "fork" in multiprocessing.get_all_start_methods() else None)
    told, end = context.Pipe(duplex=False)
    with told, end, _caught_signals(lambda: end.send_bytes(b".")) as signals:
        try:
            with ProcessPoolExecutor(workers, context, initializer=_start, initargs=(told,)) as pool:
                tasks = {pool.submit(several, chunk, order): chunk for chunk in chunks}
                for task in as_completed(tasks):
                    try:
                        yield from task.result()
                    except BrokenProcessPool:
                        if not signals:  # they went to all processes then
                            why = tell("its process was killed, perhaps for want of memory: repeat the command with fewer --jobs")
                            yield from (Outcome(work.project, why) for work in tasks[task])
        except OSError:  # the system gives no more pipes or processes: those that began would wait for work for ever
            for process in multiprocessing.active_children():
                process.kill()
            raise
        if signals:
            raise Stopped(signals[0])


@contextmanager
def _caught_signals(act: Callable[[], None]) -> Iterator[list[int]]:
    """What signals ask for the end meanwhile; at the first ``act`` is called, the second ends the program at once."""
    found: list[int] = []

    def hear(number: int, _: object) -> None:
        if found:
            os._exit(128 + number)  # the processes of the pool notice
        found.append(number)
        act()

    before: dict[int, Any] = {}
    if threading.current_thread() is threading.main_thread():
        numbers = (getattr(signal, name, None) for name in ("SIGINT", "SIGTERM", "SIGHUP"))
        for number in (n for n in numbers if n is not None and signal.getsignal(n) != signal.SIG_IGN):
            before[number] = signal.signal(number, hear)
    try:
        yield found
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def run_on_dask(works: Sequence[Task], order: Order, address: str) -> Iterator[Outcome]:
    """Do tasks on a dask cluster whose workers have this program and see the same output folder.

    The tasks of a worker that is lost are done by the others.

    Raises
    ------
    BadInput
        when dask is not installed or no scheduler answers at the address.
    """
    try:
        from distributed import Client, as_completed as finished
    except ImportError:
        raise BadInput(tell("--dask needs dask.distributed"), hint=quoting.install("cluster")) from None
    try:
        client = Client(address, timeout=20)
    except (OSError, ValueError) as e:
        hint = tell("give the scheduler's address, such as tcp://127.0.0.1:8786")
        raise BadInput(tell("no dask scheduler answers at {address}: {why}").format(address=address, why=e), hint=hint) from None
    with client:
        chunks = _chunks(works, max(len(client.nthreads()), 1))
        order = replace(order, output=order.parent.absolute())
        tasks = {client.submit(several, chunk, order, pure=False): chunk for chunk in chunks}
        for task in finished(tasks):
            try:
                yield from task.result()
            except Exception as e:  # whatever a worker or the way to it died of
                lost = tell("its worker was lost: {error}").format(error=type(e).__name__)
                yield from (Outcome(work.project, lost) for work in tasks[task])


def chosen(projects: Sequence[str], families: Sequence[str], lists: Sequence[Iterable[str]]) -> tuple[str, ...]:
    """Names of a batch: those given, all of some families of shipped projects, and those of lists, one a line.

    Raises
    ------
    BadInput
        when a family is not known.
    """
    names = list(projects)
    if families:
        shipped = catalogue.shipped()
        for family in families:
            found = [name for name in shipped if family == "all" or name == family or name.startswith(f"{family}/")]
            if not found:
                known = dict.fromkeys(name.partition("/")[0] for name in shipped)
                hint = spelling.hint(family, known, written='"{}"') or tell(
                    "shipped are {known}; all takes every project").format(known=", ".join(known))
                raise BadInput(tell('no family "{family}"').format(family=family), hint=hint)
            names += found
    for lines in lists:
        names += (line.strip() for line in lines if line.strip() and not line.lstrip().startswith("#"))
    once: dict[str, str] = {}
    for name in names:
        once.setdefault(name if catalogue.is_shipped(name) else os.path.abspath(name), name)
    return tuple(once.values())


def folders(names: Iterable[str]) -> dict[str, str]:
    """The name of its folder for every project file of a batch: the file's own, after as many folders as tell it from others.

    Files whose paths do not tell them apart get numbers, in the order given. Shipped projects are called after themselves.
    """
    own = [name for name in names if not catalogue.is_shipped(name)]
    parts = {name: (*Path(os.path.abspath(name)).parts[1:-1], Path(name).stem) for name in own}
    taken = Counter(files.alike(files.folder_name(name)) for name in names if name not in parts)
    depth = dict.fromkeys(own, 1)
    while True:
        found = {name: files.folder_name("-".join(parts[name][-depth[name]:])) for name in own}
        count = taken + Counter(map(files.alike, found.values()))
        longer = [name for name in own if count[files.alike(found[name])] > 1 and depth[name] < len(parts[name])]
        if not longer:
            break
        for name in longer:
            depth[name] += 1
    alike = [name for name in own if count[files.alike(found[name])] > 1]
    found |= {name: files.folder_name(parts[name][-1]) for name in alike}
    used = {*taken, *(files.alike(found[name]) for name in own if name not in alike)}
    last = Counter[str]()
    for name in alike:
        base = found[name]
        while files.alike(found[name]) in used:
            last[base] += 1
            found[name] = f"{base}-{last[base] + 1}"
        used.add(files.alike(found[name]))
    return found


def tasks(projects: Sequence[str]) -> list[Task]:
    """A task for each project of a batch."""
    place = folders(projects)
    return [Task(project, place.get(project, "")) for project in projects]


def summary(done: Sequence[Outcome], parent: Path, seconds: float) -> str:
    """One line that tells what a batch came to."""
    built = [o for o in done if not o.problem]
    new = [o for o in built if o.made]
    count, size = sum(o.made for o in done), sum(o.size for o in done)
    some = sum(1 for o in done if o.problem and o.made + o.unchanged)
    counted = ((tell("{n} built"), len(new)), (tell("{n} unchanged"), len(built) - len(new)), (tell("{n} in part"), some),
               (tell("{n} failed"), len(done) - len(built) - some))
    return tell("{folder}: {parts}; {count} files, {size:.1f} MB of sheets in {seconds:.1f} s, {rate:.2g} projects/s").format(
        folder=parent, parts=", ".join(text.format(n=n) for text, n in counted if n), count=count, size=size / 1e6, seconds=seconds,
        rate=len(done) / seconds)


def table(failures: Sequence[Outcome], total: int) -> str:
    """The failures of a batch of ``total`` projects, a line each with its first reason; for each sheet where others are built."""
    width = max(len(f.project) for f in failures)
    some = sum(1 for f in failures if f.made + f.unchanged)
    heading = tell("not built: {n} of {total}, {some} of them in part") if some else tell("not built: {n} of {total}")
    lines = [heading.format(n=len(failures), total=total, some=some)]
    sheet = tell("sheet {n}").partition("{n}")[0]
    for f in sorted(failures, key=lambda f: f.project):
        first, *more = f.problem.splitlines()
        lines += [f"  {f.project:{width}}  {why}" for why in (first, *(line for line in more if line.startswith(sheet)))]
    return "\n".join(lines)


# --- what a student gets beside the sheets -----------------------------------------------------------------------------




def _hand_out(project: Project, folder: Path, force: bool, names: Mapping[str, str]) -> tuple[dict[str, bool], tuple[str, ...]]:
    """Write into the student's folder what can be made; which kinds are there now, and what is to be said of the others.

    ``names`` are those of the title blocks: as settings in the folder they are there for whatever is made in it later.
    """
    made, place = dict[str, bool](), outlet(folder)
    said, table = list[str](), title_entries.table(names)
    if force or not current(place, record_of(place), title_entries.FILE, fingerprint(table)):
        said += put(place, {title_entries.FILE: table.encode()}, force, fingerprint(table))[1]
    for kind, (name, make) in reversed(KINDS.items()):  # what the page asks for has all that the others ask for
        made_from = fingerprint(program(), words.paper(), words.reader(), project.variant.content, kind)
        # What somebody may have filled in stays whatever it was made from.
        if place.read(name) is not None if kind == "measured" else not force and current(place, record_of(place), name, made_from):
            made[kind] = True
            continue
        try:
            data = make(project)
        except (BadInput, CannotBuild) as e:
            made[kind] = False
            said.append(tell("{what}: {why}").format(what=kind, why=e))
            continue
        said += put(place, {name: data}, force, made_from)[1]
        made[kind] = True
    return made, tuple(said)


def _made_by(module: str, made: Callable[[Any, Project], bytes]) -> Callable[[Project], bytes]:
    """What makes something by a module that is imported when it is made."""
    return lambda project: made(import_module(f"tmm_sheets.{module}"), project)


KINDS: dict[str, tuple[str, Callable[[Project], bytes]]] = {
    "note": ("note.pdf", _made_by("note.note", lambda note, project: note.write(project, ("pdf",)).files["note.pdf"])),
    "measured": ("measured.csv", _made_by("compare.measured.measured_lengths", lambda lengths, project: lengths.table(project))),
    "page": ("page.html", _made_by("living.page", lambda living, project: living.page(project)[0].encode())),
}
"""What a student gets beside the sheets: the name of each file, and what makes it."""
