"""Every library that has a file in this room."""

from collections.abc import Collection
from importlib import import_module
from pathlib import Path

from experiments.peers.peer import Peer

OURS = "ours"
"""The file of our own half-edge mesh, which stands beside the libraries."""


def _found() -> dict[str, Peer]:
    """By the name of its file; ours first."""
    files = sorted(path.stem for path in (Path(__file__).parent / "libraries").glob("[!_]*.py"))
    modules = {name: import_module(f"experiments.peers.libraries.{name}") for name in files}
    found = {name: it.PEER for name, it in modules.items()}
    return {name: found[name] for name in sorted(found, key=lambda name: name != OURS)}


PEERS: dict[str, Peer] = _found()


def installed() -> list[str]:
    """The libraries that can be measured here, ours among them."""
    return [name for name, it in PEERS.items() if it.version]


def missing(wanted: Collection[str] = PEERS) -> dict[str, str]:
    """Those of the wanted ones that cannot: by title the distribution that has them."""
    return {PEERS[it].title: PEERS[it].distribution for it in wanted if not PEERS[it].version}
