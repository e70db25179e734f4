"""Times queries in the tree that is first on its path, a round whenever it is asked for one.

``python interleaved_worker.py CALIBRATION VERTICES`` reads questions from standard input, JSON line
by line, and writes the answers likewise. Of the tree it knows the contract alone, so that old trees
answer, too; the calibration loop is that of the file ``CALIBRATION``, the same beside every tree.
"""

import json
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numba import njit

import hem
import structures

TRIES = 5


def main(calibration: str, vertices: int) -> None:
    """Answer until nobody asks any more.

    A ``structure`` and a ``query`` are made ready, to ask all elements so many ``times`` a round ->
    how many that are, and the seconds of a round; nothing times a round -> its seconds, and those
    of the calibration loop. What fails is answered by its ``error``.
    """
    loop: dict[str, Any] = {"__name__": "calibration"}
    exec(compile(Path(calibration).read_text("utf-8"), calibration, "exec"), loop)
    loop["compiled_walk"] = njit(loop["walk"])  # Numba's cache knows it by its own module's name
    mesh = hem.generate("torus", vertices)
    for line in sys.stdin:
        try:
            if question := json.loads(line):
                s, query = structures.build(question["structure"], mesh), question["query"]
                handles = np.tile(s.handles(query.split("_")[0]), question["times"])
                if hasattr(s, "prepare_sweep"):
                    sweep = s.prepare_sweep(query, handles).run
                else:  # an old tree, whose ``sweep`` checked no handles
                    sweep = partial(s.sweep, query, handles)
                sweep()  # compiles
                answer: Any = len(handles), min(_seconds(sweep) for _ in range(TRIES))
            else:
                reading = loop["calibration_loop"]()
                answer = _seconds(sweep), reading
        except Exception as error:  # the others can be timed all the same
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), flush=True)


def _seconds(call: Callable[[], Any]) -> float:
    begin = perf_counter()
    call()
    return perf_counter() - begin


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
