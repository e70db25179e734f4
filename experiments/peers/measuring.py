"""How a library is measured: asked, operated on, built, and given whole meshes.

What is checked before it is timed is warm by that: its first round counts.
"""

import signal
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from itertools import count
from typing import Any, NamedTuple

import numpy as np

import structures
from experiments import harness
from experiments.harness import Case, CheckFailedError, Preset, Timer, Watch, took
from experiments.peers.outcome import Arrays, as_given, check_counts, check_outcome, counted
from experiments.peers.peer import Peer
from experiments.peers.registry import PEERS
from hem.algorithms import vertex_normals
from hem.arrays import Array

CHECKED = 3
SEED = 23
MOST_HANDLES = 20_000
WARMUP = 1
"""Rounds that do not count."""
NOWHERE = np.zeros((0, 2), np.int64)
COSINE = 0.9
"""Of the angle between normals, at least: libraries weight faces differently."""
PART = 10
"""Simplified to one face of so many."""

Fields = dict[str, Any]


class Built(NamedTuple):
    """A library's mesh, and by element (k, ·) its vertices."""

    mesh: Any
    corners: dict[str, Array]


@lru_cache(maxsize=1)
def _built(case: Case) -> Built:
    peer, (points, triangles) = PEERS[case.structure], as_given(case.mesh())
    m = peer.build(points, triangles)
    ends = np.asarray(peer.ends(m)) if peer.ends else NOWHERE
    vertices = np.arange(len(points))[:, None]
    return Built(m, {"vertex": vertices, "edge": ends, "face": triangles})


def _mesh_of(case: Case) -> Built:
    """The library's mesh that a case is about, the last one that was built if it is that."""
    return _built(replace(case, subject=None, order=None))


def _numbers(case: Case, built: Built) -> Array:
    """The elements that a case asks, at random; where the valence varies those at hubs."""
    rows = built.corners[case.query.source]
    numbers = np.random.default_rng(SEED).permutation(len(rows))
    if case.hubs:
        numbers = numbers[(rows[numbers] < case.hubs).any(axis=1)]
    return numbers[:MOST_HANDLES]


def _check(case: Case, built: Built, numbers: Array, answers: list[Any]) -> None:
    """Compare what was answered at some elements with the triangle list."""
    peer, ends = PEERS[case.structure], built.corners["edge"]
    keys = ends[numbers] if case.query.source == "edge" else numbers
    named = partial(peer.named, built.mesh) if peer.named else ends.__getitem__
    harness.check_rows(peer.title, case.query, built.corners["face"], keys, answers, named)


def _ends_within(seconds: float, ask: Callable[[Any], Any], handle: Any) -> bool:
    """Whether a query of a library in Python ends so soon; it is stopped where it does not.

    Of no other library, as an alarm within compiled code leaves that in an unknown state.
    """
    if not hasattr(signal, "setitimer"):  # on Windows it ends when it ends
        return True

    def ring(*_: Any) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        ask(handle)
    except TimeoutError:
        return False
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    return True


def ask_each(ask: Callable[[Any], Any], handles: Sequence[Any]) -> None:
    """Ask one element after the other."""
    for handle in handles:
        ask(handle)


def time_single(case: Case, preset: Preset, timer: Timer) -> Fields:
    """Ask one element after the other, other ones every round, until all were asked."""
    peer, query, built = PEERS[case.structure], case.query, _mesh_of(case)
    numbers = _numbers(case, built)
    handles_of = partial(peer.handles, built.mesh, query.source)
    ask, few = peer.single[query.name](built.mesh), handles_of(numbers[:CHECKED].tolist())
    if peer.objects and not _ends_within(preset.case_seconds, ask, few[0]):
        return {"skipped": f"one query takes longer than the {preset.case_seconds} s of a case"}
    _check(case, built, numbers[:CHECKED], [ask(it) for it in few])
    seconds = took(ask_each, ask, few)[1] / CHECKED
    many = int(np.clip(preset.round_seconds / seconds, 1, len(numbers)))
    rounds = preset.affordable_rounds(seconds * many)
    handles = list(handles_of(numbers[: many * (rounds + WARMUP)].tolist()))
    windows = (np.arange(many) + many * k for k in count())

    def some() -> tuple[Any, ...]:
        return ask, [handles[it] for it in (next(windows) % len(handles)).tolist()]

    if len(handles) == len(numbers):  # they are asked again, and not all as for the first time
        ask_each(ask, handles)
    return timer(ask_each, setup=some, rounds=rounds, warmup=WARMUP, per=many).fields


def time_bulk(case: Case, preset: Preset, timer: Timer) -> Fields:
    """Ask of all elements at once -> seconds per element."""
    peer, built = PEERS[case.structure], _mesh_of(case)
    ask, per = peer.bulk[case.query.name], len(built.corners[case.query.source])
    rows, seconds = took(ask, peer.fresh(built.mesh))
    few = _numbers(case, built)[:CHECKED]
    _check(case, built, few, [harness.row(rows, it) for it in few.tolist()])
    kept: list[Any] = []  # so that freeing is not timed

    def ready() -> tuple[Any]:
        kept.clear()
        return (peer.fresh(built.mesh),)

    rounds = preset.affordable_rounds(seconds)
    return timer(
        lambda m: kept.append(ask(m)), setup=ready, rounds=rounds, warmup=0, per=per
    ).fields


def time_building(case: Case, preset: Preset, timer: Timer) -> Fields:
    """Build from arrays."""
    peer, given = PEERS[case.structure], as_given(case.mesh())
    m, seconds = took(peer.build, *given)
    _check_left(peer, "", given, NOWHERE, m)
    rounds = preset.affordable_rounds(seconds)
    return timer(peer.build, setup=lambda: given, rounds=rounds, warmup=0).fields


def _apart(case: Case) -> Array:
    """Elements to operate on, the same for all libraries, see ``operation_faces``."""
    faces = harness.operation_faces(case)
    if str(case.subject).endswith("face"):
        return faces
    ends = harness.pack_pairs(_mesh_of(case).corners["edge"])
    order = np.argsort(ends)
    wanted = harness.pack_pairs(case.mesh().triangles[faces][:, :2])
    return order[np.searchsorted(ends, wanted, sorter=order)]


def time_operations(case: Case, preset: Preset, timer: Timer, batched: bool) -> Fields:
    """Operate on elements far apart, of a new mesh every round -> seconds per operation."""
    peer, operation, given = PEERS[case.structure], str(case.subject), as_given(case.mesh())
    operate = (peer.batches if batched else peer.operations)[operation]
    element, numbers = operation.split("_")[1], _apart(case).tolist()
    places = np.random.default_rng(SEED).random((len(numbers), 3))

    def ready() -> tuple[Any, ...]:
        m = peer.build(*given)
        handles = peer.handles(m, element, numbers)
        if peer.make_room:
            peer.make_room(m, len(numbers))
        return m, handles, places

    m = peer.build(*given)  # without room, the making of which may operate
    done = operate(m, peer.handles(m, element, numbers), places)
    _require(peer, done == len(numbers), f"{done} of {len(numbers)} × {operation}")
    _check_left(peer, operation, given, _mesh_of(case).corners[element][numbers], m)
    rounds = preset.affordable_rounds(took(operate, *ready())[1])
    return timer(operate, setup=ready, rounds=rounds, warmup=0, per=done).fields


def time_algorithm(case: Case, preset: Preset, timer: Timer) -> Fields:
    """Give an algorithm a whole mesh, a new one every round -> seconds."""
    peer, name, given = PEERS[case.structure], str(case.subject), as_given(case.mesh())
    more = [len(given[1]) // PART] if name == "simplify" else []

    def ready() -> tuple[Any, ...]:
        return peer.build(*given), *more

    found, seconds = took(peer.algorithms[name], *ready())
    if name == "simplify":
        _require(peer, abs(found - more[0]) <= more[0] / PART, f"{found} faces for {more[0]}")
    elif name == "vertex_normals":
        ours = vertex_normals(structures.build(harness.BASE, case.mesh()))
        cosine = (np.asarray(found) * ours).sum(axis=1).min()
        _require(peer, cosine > COSINE, f"normals are turned by {np.arccos(cosine):.2f}")
    rounds = preset.affordable_rounds(seconds)
    return timer(peer.algorithms[name], setup=ready, rounds=rounds, warmup=0).fields


@lru_cache(maxsize=2)
def _looped(case: Case, rounds: int, whole: int) -> tuple[dict[str, list[float]], Fields]:
    """What compiled loops took on a mesh, by subject, and memory and noise beside; checked."""
    peer, given = PEERS[case.structure], as_given(case.mesh())
    assert peer.looped is not None  # or there is no such case
    watch = Watch()  # of every case that this tells of; others only read
    told = peer.looped(*given, case.hubs, rounds, whole)
    noise = watch.seen()
    harness.check_told(peer.title, given[1], told["answers"])
    for operation, (done, *left) in told["operated"].items():
        check_counts(peer.title, operation, counted(*given), done, left)
    return told["times"], {**beside(told["bytes"]), "noise": noise}


def read_looped(case: Case, preset: Preset) -> Fields:
    """Times that a program took of itself."""
    whole = 0 if case.valence else preset.fewest_rounds
    samples, memory = _looped(replace(case, subject=None, order=None), preset.rounds, whole)
    return {"samples": samples[str(case.subject)], "handles": 1, "checked": True, **memory}


def _check_left(peer: Peer, operation: str, given: Arrays, elements: Array, m: Any) -> None:
    assert peer.arrays is not None  # or there is no such case
    points, triangles = map(np.asarray, peer.arrays(m))
    check_outcome(peer.title, operation, given, elements, (points, triangles))


def _require(peer: Peer, holds: bool, otherwise: str) -> None:
    if not holds:
        raise CheckFailedError(f"{peer.title}: {otherwise}")


@lru_cache(maxsize=2)
def beside(working_set: int) -> Fields:
    """The latency, taken once for the cases of a mesh, which come together and within seconds."""
    return {"working_set": working_set, "latency": harness.latency_now(working_set)}
