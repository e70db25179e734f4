"""A study: every experiment on every structure, into one run folder.

First what the experiments need is compiled, and what is only counted is counted, on all cores. Then
one worker takes times, alone, because what runs beside is timed with it. A worker has many jobs: it
takes seconds to begin.
"""

import hashlib
import os
import shutil
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import closing, contextmanager, suppress
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from itertools import count as counting
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from threading import Event
from time import monotonic
from typing import Any

from experiments import require_known
from experiments.harness import BASE, PRESETS, REPEATS, allowed_cores, own_mesh
from experiments.runs import store
from experiments.runs.catalog import PART_OF, tables
from experiments.runs.catalog import experiments as catalog
from experiments.runs.provenance import describe, machine_id, now
from experiments.runs.run import RUNS
from experiments.runs.worker import AGAIN, COMPILE, Job, WorkerDiedError, end_of_log, perform
from hem.errors import MeshError, MeshWarning
from structures import NAMED, REGISTRY

ROOT = Path(__file__).parents[2]
COMPILED = "hem", "structures", "experiments/harness", "experiments/peers"  # sources, some in C++
ON = " on "  # between a preset and one's own mesh, in the name of what was measured
SAME = "python", "numpy", "numba"  # the versions that times depend on
MOSTLY = 0.5  # part of disturbed cases above which measuring them again will not be calmer
REPEATING_SHARE = 0.5  # of the time that all cases took, at most, to measure disturbed ones again


class Observer:
    """Is told how a study goes on; this one keeps it to itself."""

    def compiled(self, structure: str, done: int, total: int) -> None:
        """The kernels of a structure are compiled, of ``done`` out of ``total`` by now."""

    def measured(self, job: Job, done: int) -> None:
        """So many cases of a job are finished."""

    def repeating(self, cases: int, seconds: float) -> None:
        """So many disturbed cases are measured once more, for so long at most."""

    def say(self, text: str) -> None:
        """Something a user should know."""


class StudyFailedError(RuntimeError):
    """Some cases failed; the message names the jobs and shows what they printed."""


def begin(
    preset: str, root: Path = RUNS, structures: Sequence[str] = (), experiments: Sequence[str] = (),
    *, seed: int = Job.seed, pin: bool = True, mesh: str | None = None, repair: bool = False,
) -> Path:  # fmt: skip
    """A new run folder, named by the time and the preset, with what is known before it runs.

    ``structures``, ``experiments``: just these, all of them for none; an experiment with or without
    ``bench_``. ``seed``: of the order of the cases; ``pin``: whether to stay on one core. ``mesh``:
    one's own to measure on, see ``hem.find_mesh``. Raises ValueError for a name that there is not,
    and where nothing is left to measure, MeshError for a mesh that none of the structures holds,
    CannotWriteError. Warns of structures that are skipped, as they do not hold it.
    """
    tables()  # what is wrong with one is told before anything is measured
    short = [name.removeprefix("bench_") for name in called(experiments)]
    require_known("experiment", short, [name.removeprefix("bench_") for name in catalog()])
    others = [it for name in short for it in catalog()[f"bench_{name}"].structures]
    require_known("structure", structures, list(dict.fromkeys([*NAMED, *others])))
    require_known("preset", [preset], PRESETS)
    chosen = {"structures": list(structures), "experiments": [f"bench_{name}" for name in short]}
    name = f"{datetime.now(UTC).strftime('%Y%m%d-%H%M%S')}-{preset}"
    folder = _new_folder(root, f"{name}-{own_mesh.called(mesh)}" if mesh is not None else name)
    try:
        known = {**describe(preset), **chosen, "seed": seed, "pin": pin}
        if mesh is not None:
            refusals = own_mesh.keep_versions(folder, mesh, repair)
            known["structures"] = _holding(mesh, refusals, known["structures"])
            known["preset"] += ON + own_mesh.called(mesh)  # what is compared is of one mesh
        store.write_meta(folder, known)
        if not plan(folder):
            of = (f"{it} is of {', '.join(catalog()[f'bench_{it}'].structures)}" for it in short)
            raise ValueError(f"there is nothing to measure: {'; '.join(of)}")
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    return folder


def _holding(mesh: str, refusals: Mapping[str, Exception], chosen: list[str]) -> list[str]:
    """The chosen structures, all for none, that can hold a mesh; warns of what is skipped."""
    asked = chosen or list(REGISTRY)
    holding = [name for name in asked if name not in refusals]
    skipped = [name for name in asked if name in refusals]
    if not skipped:
        return chosen
    titles = ", ".join(REGISTRY[name].title for name in skipped)
    words = f"{mesh} cannot be held by {titles}: {refusals[skipped[0]]}"
    repair = "--repair makes a surface of it"
    if not holding:
        raise MeshError(f"{words}; {repair}")
    warnings.warn(f"{words}; these are skipped, and {repair}", MeshWarning, stacklevel=3)
    return holding


def _new_folder(root: Path, name: str) -> Path:
    """A folder that nobody else has: of two studies in one second the later gets a number."""
    with store.writing(root):
        root.mkdir(parents=True, exist_ok=True)
        for suffix in ("", *(f"-{k}" for k in range(2, 1_000))):
            with suppress(FileExistsError):
                (root / f"{name}{suffix}").mkdir()
                return root / f"{name}{suffix}"
    raise store.CannotWriteError(f"{root} has a thousand runs called {name}: clear it up")


def called(experiments: Sequence[str]) -> list[str]:
    """The files of experiments, each once, with or without ``bench_`` or of one that has parts."""
    said = (f"bench_{name.removeprefix('bench_')}" for name in experiments)
    return list(dict.fromkeys(PART_OF.get(name, name) for name in said))


def begun(folder: Path) -> dict[str, Any]:
    """How a run was begun. Raises ResultsError for what is reduced to a baseline."""
    meta = store.read_meta(folder)
    if not {"experiments", "structures", "seed", "pin"} <= meta.keys():
        raise store.ResultsError(f"{folder} holds what is kept of a run, which cannot be resumed")
    return meta


def preset_of(meta: Mapping[str, Any]) -> str:
    """The name of a run's preset, whatever mesh it is on."""
    return str(meta["preset"]).partition(ON)[0]


def plan(folder: Path) -> list[Job]:
    """All jobs of a run, in the order of the experiments."""
    meta, mesh = begun(folder), own_mesh.of_run(folder)
    preset, wanted, chosen = preset_of(meta), meta["experiments"], meta["structures"]
    named = set(chosen) <= set(NAMED)  # and no library: then these are measured alone
    extent = PRESETS[preset].on(*mesh) if mesh else PRESETS[preset]
    jobs = [
        Job(name, structure, preset, int(meta["seed"]), bool(meta["pin"]), mesh)
        for name, declared in catalog().items()
        if (name in wanted if wanted else not (declared.by_name or name in extent.skipped))
        for structure in declared.structures
        if not chosen or structure in chosen or (structure not in NAMED and named)
    ]
    return [job for job in jobs if job.ids]


def run(folder: Path, observer: Observer | None = None) -> None:
    """Measure what the folder lacks, and mark the run finished.

    Raises StudyFailedError when everything else is measured, InUseError if another process measures
    into the folder, CannotWriteError once results cannot be kept, and KeyboardInterrupt as it
    comes; what is finished stays in any case.
    """
    observer = observer or Observer()
    with prepared(folder, observer.say):
        jobs = [job for job in plan(folder) if job.left(folder)]
        failures: list[str] = []

        def measure(group: list[Job], stop: Event) -> None:
            failures.extend(_measure(folder, group, observer, stop))

        compile_and_count(folder, jobs, observer.compiled, measure)
        if timed := [job for job in jobs if job.timed]:
            measure(timed, Event())
        if failures:
            raise StudyFailedError("\n\n".join(failures))
        finish(folder)


def compile_and_count(
    folder: Path, jobs: Sequence[Job], compiled: Callable[[str, int, int], None],
    count: Callable[[list[Job], Event], None],
) -> None:  # fmt: skip
    """Compile what timed jobs need, and do those that only count, on all cores.

    ``compiled`` is told of each structure whose kernels are ready; ``count`` does the jobs of one
    experiment, until the event is set. What cannot be compiled, its measurement will tell.
    """
    timed = [it for it in jobs if it.timed and it.structure in catalog()[it.experiment].compiled]
    # What the others are compared with comes first.
    timed.sort(key=lambda job: (job.structure != BASE, job.structure))
    by_structure = (list(it) for _, it in groupby(timed, attrgetter("structure")))
    groups = [it for it in by_structure if not _stamp(it).exists()]
    by_experiment = groupby((job for job in jobs if not job.timed), attrgetter("experiment"))
    stop, numbers = Event(), counting(1)

    def tell(structure: str) -> None:
        compiled(structure, next(numbers), len(groups))

    cores = len(allowed_cores()) or os.cpu_count() or 1
    with ThreadPoolExecutor(cores) as pool:
        shares = [groups[i::cores] for i in range(min(cores, len(groups)))]
        running = [pool.submit(_compile, folder, it, tell, stop) for it in shares]
        running += [pool.submit(count, list(it), stop) for _, it in by_experiment]
        try:
            for future in as_completed(running):
                future.result()
        finally:
            stop.set()
            pool.shutdown(cancel_futures=True)


def _compile(
    folder: Path, groups: list[list[Job]], compiled: Callable[[str], None], stop: Event
) -> None:
    """Compile for one structure after another, in one process: they share what has no records."""
    if groups[0][0].structure == BASE:
        groups = [it[::-1] for it in groups]  # the others ask for its operations, after queries
    waiting = {it[0].structure: it for it in groups}
    while waiting and not stop.is_set():
        jobs = [job for it in waiting.values() for job in it]
        worker = perform(folder, jobs, COMPILE, stop)
        with suppress(WorkerDiedError, OSError), closing(worker) as done:
            for structure, finished in groupby(done, attrgetter("structure")):
                if any(stop.is_set() for _ in finished):
                    return
                stamp = _stamp(waiting.pop(structure))
                with suppress(OSError):  # where the sources are, nobody may be allowed to write
                    stamp.parent.mkdir(exist_ok=True)
                    stamp.touch()
                compiled(structure)
        if waiting:  # what killed the process does not keep the others from being compiled
            del waiting[next(iter(waiting))]


def _stamp(jobs: list[Job]) -> Path:
    """The file that is there if what jobs of one structure need was compiled of these sources."""
    text = " ".join([jobs[0].structure, *(job.experiment for job in jobs)])
    digest = hashlib.blake2b(_sources() + text.encode(), digest_size=8).hexdigest()
    return ROOT / "hem" / "__pycache__" / f"compiled-{digest}"


@cache
def _sources() -> bytes:
    """A digest of everything that is compiled, and of what compiles it."""
    files = (path for room in COMPILED for path in sorted((ROOT / room).rglob("*")))
    content = b"".join(it.read_bytes() for it in files if it.suffix in (".py", ".cpp"))
    where = os.environ.get("NUMBA_CACHE_DIR", "")
    return hashlib.blake2b(content + f"{version('numba')} {where}".encode()).digest()


def _measure(folder: Path, jobs: list[Job], observer: Observer, stop: Event) -> list[str]:
    """Measure jobs -> which failed, and why."""
    begin = monotonic()
    done = Counter({job: len(job.ids) - len(job.left(folder)) for job in jobs})
    try:
        with closing(perform(folder, jobs, stop=stop)) as finished:
            for job in finished:
                done[job] += 1
                observer.measured(job, done[job])
                if stop.is_set():
                    return []
    except WorkerDiedError as error:
        left = [] if stop.is_set() else [job for job in jobs if job.left(folder)]
        failures = [f"{job}:\n{error}" for job in left[:1]]
        for job in left[1:]:  # what killed the worker does not keep the others from being measured
            if not stop.is_set():
                failures += _measure(folder, [job], observer, stop)
    else:
        names = ", ".join(str(job) for job in jobs if job.left(folder))
        failures = [f"{names}:\n{end_of_log(folder, jobs[0])}"] if names else []
    now = monotonic()
    if stop.is_set():
        return []
    with suppress(WorkerDiedError):
        _measure_again(folder, jobs, now + REPEATING_SHARE * (now - begin), observer)
    return failures


def _measure_again(folder: Path, jobs: list[Job], until: float, observer: Observer) -> None:
    """Measure disturbed cases once more, each time in a new process, while there is time.

    Not where most cases are: as busy as that, the machine is busy again.
    """
    for _ in range(REPEATS):
        files = {job: job.file(folder) for job in jobs}
        again = [job for job, file in files.items() if file.disturbed]
        cases = sum(len(file.cases) for file in files.values())
        disturbed = sum(len(file.disturbed) for file in files.values())
        if not again or disturbed > MOSTLY * cases:
            return
        observer.repeating(disturbed, until - monotonic())
        with closing(perform(folder, again, AGAIN)) as finished:
            for _ in finished:
                if monotonic() > until:
                    return


@contextmanager
def prepared(folder: Path, say: Callable[[str], None], elsewhere: bool = False) -> Iterator[None]:
    """A folder for oneself, with room and nothing damaged.

    ResultsError if it was begun with other code or, unless what is timed is timed ``elsewhere``,
    on another machine.
    """
    with store.lock_run(folder):
        store.require_room(folder)
        begun = bool(store.case_files(folder))
        for path in store.set_aside_damaged(folder):
            say(f"{path.name} was damaged and is set aside; its cases are measured again")
        meta = store.read_meta(folder)
        if begun:
            here = describe(preset_of(meta))
            if differ := _differences(meta, here, elsewhere):
                raise store.ResultsError(
                    f"{folder} was begun {', '.join(differ)}: what they measure does not belong "
                    "together; go back to that to resume it, or begin a new run"
                )
            state = {it: here[it] for it in ("commit", "dirty")}
            resumed = [*meta.get("resumed", []), {"at": now(), **state}]
            dirty = meta.get("dirty") or state["dirty"]
            store.write_meta(folder, {**meta, "dirty": dirty, "resumed": resumed})
        yield


def _differences(meta: Mapping[str, Any], here: Mapping[str, Any], elsewhere: bool) -> list[str]:
    """What a run was begun with that is different here, in words."""
    differ, was = [], meta.get("commit")
    if was and was != here["commit"]:
        differ.append(f"at commit {was[:12]}, and this is {here['commit'][:12]}")
    if not elsewhere and machine_id(meta["machine"]) != machine_id(here["machine"]):
        differ.append(f"on another machine ({meta['machine'].get('cpu')})")
    for name in SAME:
        if (it := meta["versions"].get(name)) != here["versions"].get(name):
            differ.append(f"with {name} {it}, and this is {here['versions'].get(name)}")
    return differ


def finish(folder: Path, machine: dict[str, Any] | None = None) -> None:
    """Mark a run as finished: what it has, which is held against it; or another ``machine``."""
    paths, meta = store.case_files(folder), store.read_meta(folder)
    files = {str(it.relative_to(folder)): len(store.CaseFile.at(it).measurements) for it in paths}
    more = {"files": files, "finished": now(), "machine": machine or meta["machine"]}
    store.write_meta(folder, {**meta, **more})
