"""Other libraries beside our half-edge mesh: queries, operations, building, algorithms, bytes.

Each as its manual has it used, through Python: a query asked of one element after the other at
random, and where a library has a call for it of all at once. Answers at a few elements are checked
against the triangle list before a query is timed, and all faces after building and operations; what
is compiled in C++ tells its answers, and how many elements operations leave, as it ends. Measured
only where it is asked for: ``hem study --peers``.
"""

from dataclasses import replace
from functools import partial

from experiments import peers
from experiments.harness import HUBS, OPERATIONS, Case, Experiment, Measurement, Preset, Timer
from experiments.peers import BUILD, BULK, BYTES, LOOPED, PEERS, SINGLE, SIX, Peer, measuring
from hem.contract import QUERIES

ALGORITHM_VERTICES = 20_000  # vertices at most of what algorithms are given
MOST_VALENCE = 1_024  # beyond, one answer in Python takes seconds


def sizes(preset: Preset, peer: Peer) -> list[int]:
    """Numbers of vertices that a library is measured at."""
    return [it for it in preset.sizes if not peer.objects or it <= common(preset)]


def common(preset: Preset) -> int:
    """The largest size that all are measured at, objects too."""
    return max(it for it in preset.sizes if it <= 3 * preset.object_vertices)


def cases(preset: Preset, structure: str) -> list[Case]:
    """What a library has a call for; nothing where it is not installed."""
    if structure not in peers.installed():
        return []
    peer, by_size = PEERS[structure], sizes(preset, PEERS[structure])
    valences = [it for it in preset.valences if it <= MOST_VALENCE]
    most = 10 * preset.object_vertices if peer.objects else preset.valence_faces
    hubs = partial(Case, structure, HUBS, min(preset.valence_faces, most))
    case = partial(Case, structure, preset.families[0])
    whole = {common(preset), max(it for it in by_size if it <= ALGORITHM_VERTICES)}
    asked = [*((it, SINGLE) for it in peer.single)]
    asked += [(it, LOOPED) for it in QUERIES if it in peer.loops]
    everywhere = [*asked, *((it, BULK) for it in peer.bulk), (BUILD, None)]
    done = [*((it, SINGLE) for it in peer.operations), *((it, BULK) for it in peer.batches)]
    looped = [it for it in (*peers.BATCHED, *SIX) if it in peer.loops]
    return [
        *(case(size, *it) for size in by_size for it in everywhere),
        *(hubs(*it, valence) for valence in valences for it in asked),
        *(case(common(preset), *it) for it in done),
        *(case(size, it) for size in whole for it in peer.algorithms),
        *(case(size, it, LOOPED) for size in by_size for it in looped),
        *(case(by_size[-1], it) for it in (BYTES, *peers.BAD_INPUT)),
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Measure one case; skipped where its library is installed and cannot be imported."""
    try:
        return _measure(case, preset, timer)
    except ImportError as error:
        return case.not_measured("time", f"cannot be imported: {error}")


def _measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Check and time a case; bytes and bad input are told by processes of their own."""
    what, peer = str(case.subject), PEERS[case.structure]
    version = {"version": peer.version}
    if what == BYTES or what in peers.BAD_INPUT:
        found = peers.told_by_child(case.structure, case.family, case.size)[what]
        if what != BYTES:
            return case.result("trial", None, detail={**version, "found": found})
        if found is None:
            return case.result(BYTES, None, skipped="the process that was weighed ended")
        return case.result(BYTES, None, [found], detail=version)
    given = case, preset, timer
    if case.order == LOOPED or (what == BUILD and BUILD in peer.loops):
        fields = measuring.read_looped(case, preset)
    elif what in QUERIES:
        ask = measuring.time_bulk if case.order == BULK else measuring.time_single
        fields = ask(*given) | measuring.beside(working_set(case, preset))
    elif what in OPERATIONS:
        fields = measuring.time_operations(*given, batched=case.order == BULK)
    elif what in peers.ALGORITHMS:
        fields = measuring.time_algorithm(*given)
    else:
        fields = measuring.time_building(*given)
    return replace(case.result("time", None, detail=version), **fields)


def working_set(case: Case, preset: Preset) -> int:
    """Bytes a case works on, as the largest mesh was weighed; its triangle list, where none was."""
    mesh, largest = case.mesh(), sizes(preset, PEERS[case.structure])[-1]
    weighed = peers.told_by_child(case.structure, preset.families[0], largest)[BYTES]
    if weighed is None:
        return sum(it.nbytes for it in peers.as_given(mesh))
    return round(weighed / largest * len(mesh.points))


IN_CPP = next(name for name, it in PEERS.items() if it.told_version)  # they share one program
EXPERIMENT = Experiment(
    title="Other libraries", cases=cases, measure=measure, copies=2, turn=90,
    structures=tuple(PEERS), by_name=True, compiled=frozenset((peers.OURS, IN_CPP)),
)  # fmt: skip
test_peers = EXPERIMENT.test
