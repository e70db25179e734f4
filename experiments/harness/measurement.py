"""One measured case, as a run keeps it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any


@dataclass
class Measurement:
    """One measured case.

    ``samples``: seconds per query and round (``kind`` "time"), accesses per query and handle
    ("work"), or bytes ("bytes"). ``handles``: queries per sample. ``working_set``: bytes of the
    structure's live records, or of the chased array in the latency experiment. ``valence``: that of
    the queried vertices where the experiment varies it. ``latency``: seconds per memory access in
    the working set, measured beside the case. ``calibration``: seconds per step of the calibration
    loop before each round. ``skipped``: why nothing was measured, else empty.
    ``noise``: how steady the machine was meanwhile, and how often the case was ``measured``.
    """

    id: str
    kind: str
    subject: str | None = None
    order: str | None = None
    family: str | None = None
    seed: int = 0
    vertices: int = 0
    edges: int = 0
    faces: int = 0
    valence_max: int = 0
    valence: int | None = None
    reference_bytes: int = 4
    working_set: int = 0
    handles: int = 0
    checked: bool = False
    latency: float | None = None
    samples: list[float] = field(default_factory=list)
    skipped: str = ""
    detail: dict[str, Any] = field(default_factory=dict)
    calibration: list[float] = field(default_factory=list)
    noise: dict[str, Any] = field(default_factory=dict)


Keep = Callable[[Measurement], None]
"""What an experiment hands its measurement to."""
