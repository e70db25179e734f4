"""How much a study measures: the presets, as data.

They stand outside of their room so that a wrong name is told before anything heavy is imported.
"""

from dataclasses import dataclass, replace
from itertools import count, takewhile
from typing import Any, Self

HUBS = "hubs"  # the family of `hem.valence_mesh`; its size is in faces, its valence the hubs'
IRREGULAR = "isosurface"  # the family whose faces are numbered as irregularly as a model's

ORDERS = ("random", "consecutive")  # of handles that are asked for, and of faces to build of
ANSWERING = "until it answers"  # of what finds neighbors when asked: built and asked once
VALENCES = tuple(2**k for k in range(2, 13))
SECONDS_PER_FACE = 1e-9  # what a scan of the mesh takes at the least
LONGEST = 20  # times the seconds of a case that rounds may take where each searches the mesh
LARGEST_COUNTED = 100_000  # vertices of one's own mesh up to which accesses are counted
SMALLEST, LARGEST = 100, 1_000_000  # vertices of its coarsest and its finest version, about
COARSER = 4  # how many coarser versions there are at the most; each has a quarter of the faces
FINE_ENOUGH = 20_000  # vertices that finer versions have at the most; a first one may have LARGEST
NOT_OF_ONE_MESH = "bench_fracture", "bench_printed"  # bodies, and the thesis' listings


def _geometric(first: int, last: int, per_decade: float) -> tuple[int, ...]:
    sizes = (round(first * 10 ** (k / per_decade)) for k in count())
    return tuple(takewhile(lambda size: size <= last, sizes))


@dataclass(frozen=True)
class Preset:
    """One extent of a study, ``standard`` by default.

    Sizes are numbers of vertices, valences those of the asked vertices.
    ``families[0]`` is the judged one: its valence is the same at every size. Structures made of
    objects are operated on up to ``object_vertices``, asked and built of three times as many; what
    the thesis prints is built of ``printed_sizes``. Operations are done one by one at
    ``single_sizes``. ``operations``, ``workloads``: those that are measured, all for none;
    ``skipped``: experiments that are not part of it. A round is one sample; ``round_seconds`` is
    how long it should last, ``case_seconds`` what a case may take in all, but for ``fewest_rounds``
    that last long. ``valence_faces`` stay in the caches that a core has to itself: beyond,
    neighbors on the machine make cases of one curve differ threefold.
    """

    what: str
    families: tuple[str, ...] = ("torus", "sphere", "grid", "isosurface")
    sizes: tuple[int, ...] = _geometric(100, 1_000_000, 2)
    valences: tuple[int, ...] = VALENCES
    valence_faces: int = 65_536
    work_sizes: tuple[int, ...] = _geometric(100, 10_000, 2)
    work_faces: int = 16_384
    build_sizes: tuple[int, ...] = sizes
    build_reference_bytes: tuple[int, ...] = (4, 8)
    operation_sizes: tuple[int, ...] = sizes[1:]
    operation_faces: int = 65_536
    single_sizes: tuple[int, ...] = sizes[1::2]
    operations: tuple[str, ...] = ()
    workload_sizes: tuple[int, ...] = _geometric(100, 100_000, 2)
    workloads: tuple[str, ...] = ()
    real_time_sizes: tuple[int, ...] = (1_000, 10_000, 100_000, 1_000_000)
    fracture_sizes: tuple[int, ...] = _geometric(100, 100_000, 2)[1:]
    object_vertices: int = 3_200
    printed_sizes: tuple[int, ...] = _geometric(50, 900, 5)
    models: tuple[str, ...] = ("teapot", "cow", "bunny", "bone")
    rounds: int = 15
    fewest_rounds: int = 3
    round_seconds: float = 0.004
    case_seconds: float = 1.0
    latency_mib: int = 512
    skipped: tuple[str, ...] = ()

    def of(self, structure: str) -> Self:
        """The preset for one structure: smaller meshes where it is made of objects."""
        from structures import REGISTRY

        if structure not in REGISTRY or REGISTRY[structure].compiled:
            return self
        most = self.object_vertices
        operated = "single_sizes", "workload_sizes", "fracture_sizes", "real_time_sizes"
        limits = {"sizes": 3 * most, "build_sizes": 3 * most, **dict.fromkeys(operated, most)}
        smaller: dict[str, Any] = {
            name: tuple(size for size in getattr(self, name) if size <= limit)
            for name, limit in limits.items()
        }
        # A few interpreted operations last long enough, so the smallest mesh will do, too.
        smaller["operation_sizes"] = tuple(size for size in self.sizes if size <= most)
        smaller["valence_faces"] = min(self.valence_faces, 10 * most)
        smaller["operation_faces"] = min(self.operation_faces, most)
        return replace(self, **smaller)

    def on(self, mesh: str, sizes: tuple[int, ...]) -> Self:
        """The preset for one mesh at the sizes that there are of it; valences vary on the hubs."""
        few = tuple(it for it in sizes if it <= LARGEST_COUNTED)
        return replace(
            self, what=f"{self.what.partition(',')[0]}, on {mesh}", families=(mesh,), models=(),
            sizes=sizes, build_sizes=sizes, operation_sizes=sizes, single_sizes=sizes,
            workload_sizes=sizes, real_time_sizes=sizes, work_sizes=few,
            operations=(), workloads=(), skipped=NOT_OF_ONE_MESH,
        )  # fmt: skip

    def affordable_rounds(self, seconds: float) -> int:
        """How many rounds of so many seconds there is time for."""
        return min(self.rounds, max(self.fewest_rounds, int(self.case_seconds / seconds)))

    def why_too_slow(self, scans: float, faces: int, rounds: int) -> str:
        """Why a case that scans the mesh so often a round is skipped; empty if there is time."""
        seconds, allowed = scans * faces * SECONDS_PER_FACE, LONGEST * self.case_seconds
        why = f"would take {seconds:.0f} s a round or more; all rounds together get {allowed:.0f} s"
        return why if rounds * seconds > allowed else ""

    def work_points(self) -> list[tuple[str, int, int | None]]:
        """Where work is counted: family, size, valence; one family by size, the hubs by valence."""
        few = self.work_faces // 16  # so that a scan's work is the scan, not what it finds
        hubs = [(HUBS, self.work_faces, k) for k in self.valences if k <= few]
        return [*((self.families[0], size, None) for size in self.work_sizes), *hubs]


# fmt: off
PRESETS = {
    "smoke": Preset(
        what="a few small cases of everything, to see that it all works, some 2 minutes",
        families=("torus",), sizes=(100, 400), valences=(4, 8), valence_faces=64,
        work_sizes=(100, 400), work_faces=128, build_sizes=(100, 1_000),
        operation_sizes=(100, 400), operation_faces=256, single_sizes=(100,),
        workload_sizes=(100, 400), real_time_sizes=(400,), fracture_sizes=(100, 400),
        object_vertices=400, printed_sizes=(50, 100), models=("teapot",),
        rounds=5, round_seconds=0.0002, case_seconds=0.5, latency_mib=1,
    ),
    "quick": Preset(
        what="what decides the claims, on one family up to 100,000 vertices, some 3 minutes",
        families=("torus",), sizes=_geometric(100, 100_000, 4 / 3), valences=VALENCES[::2],
        work_sizes=_geometric(100, 3_200, 2), work_faces=8_192,
        build_sizes=_geometric(100, 100_000, 1), build_reference_bytes=(4,),
        operation_sizes=_geometric(100, 100_000, 4 / 3), operation_faces=32_768,
        operations=("split_edge", "split_face", "collapse_edge", "flip_edge"),
        single_sizes=(1_000,), real_time_sizes=(1_000, 10_000),
        workload_sizes=(1_000, 10_000), workloads=("vertex_normals", "impacts"),
        fracture_sizes=_geometric(100, 10_000, 1), object_vertices=1_100,
        printed_sizes=(50, 100, 200, 400), models=("teapot", "bunny"), skipped=("bench_fracture",),
        rounds=9, round_seconds=0.0015, case_seconds=0.25, latency_mib=32,
    ),
    "standard": Preset("one family of each kind up to 1,000,000 vertices, half an hour to two"),
    "full": Preset(
        what="every family up to 1,000,000 vertices with finer steps, some hours",
        families=("torus", "sphere", "grid", "cone", "terrain", "isosurface"),
        sizes=_geometric(100, 1_000_000, 4), work_sizes=_geometric(100, 32_000, 4),
        build_sizes=_geometric(100, 1_000_000, 4),
        operation_sizes=_geometric(100, 1_000_000, 4), operation_faces=131_072,
        single_sizes=_geometric(100, 1_000_000, 4)[::2],
        workload_sizes=_geometric(100, 100_000, 4),
        fracture_sizes=_geometric(100, 1_000_000, 2)[1:], object_vertices=10_000,
        printed_sizes=_geometric(50, 1_600, 6),
        models=("teapot", "cow", "airplane", "bunny", "bone"),
        rounds=25, round_seconds=0.01, case_seconds=5.0, latency_mib=1024,
    ),
}
# fmt: on
