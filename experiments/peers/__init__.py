"""Other libraries, measured as our structures are: one file per library, and ours beside them.

``PEERS`` has every library by the name of its file. ``installed`` and ``missing`` tell which can be
measured here; nothing of a library is imported before it is. ``experiments/bench_peers.py`` says
what is measured of them, and ``measuring`` does it.
"""

from experiments.peers.measuring import PART, ask_each
from experiments.peers.outcome import as_given
from experiments.peers.peer import (
    ALGORITHMS,
    BATCHED,
    BUILD,
    BULK,
    BYTES,
    LOOPED,
    SINGLE,
    SIX,
    Lazy,
    Peer,
)
from experiments.peers.registry import OURS, PEERS, installed, missing
from experiments.peers.trials import BAD_INPUT, told_by_child

__all__ = [
    "ALGORITHMS", "BAD_INPUT", "BATCHED", "BUILD", "BULK", "BYTES", "LOOPED", "OURS", "PART",
    "PEERS", "SINGLE", "SIX", "Lazy", "Peer", "as_given", "ask_each", "installed", "missing",
    "told_by_child",
]  # fmt: skip
