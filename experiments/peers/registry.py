"""Every library that has a file in this room."""

from collections.abc import Collection
from importlib import import_module
from pathlib import Path

from experiments.peers.peer import Peer

OURS = "ours"
"""The file of our own half-edge mesh, which stands beside the libraries."""
_FILES = (path.stem for path in (Path(__file__).parent / "libraries").glob("[!_]*.py"))
PEERS: dict[str, Peer] = {
    name: import_module(f"experiments.peers.libraries.{name}").PEER
    for name in sorted(_FILES, key=lambda name: (name != OURS, name))
}
"""By the name of its file; ours first."""


def installed() -> list[str]:
    """The libraries that can be measured here, ours among them."""
    return [name for name, it in PEERS.items() if it.version]


def missing(wanted: Collection[str] = PEERS) -> dict[str, str]:
    """Those of the wanted ones that cannot: by title the command that installs them."""
    # A library that no distribution of Python has is compiled.
    by = {it: "apt-get install" if PEERS[it].told_version else "pip install" for it in wanted}
    absent = [it for it in wanted if not PEERS[it].version]
    return {PEERS[it].title: f"{by[it]} {PEERS[it].distribution}" for it in absent}
