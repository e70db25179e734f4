"""How kernels are run: single, batched, timed, counted, and by Python itself over objects.

How a query runs
----------------
A structure's file says once how its records answer a query for one element::

    @kernel
    def vertex_faces(m, v, out):    # records, handle, scratch -> how many were written to out

Everything else is derived. When the class is made, a ``Uses`` is put around each kernel; nothing is
compiled yet. It binds its kernel into one of the ``templates``, small loops with free names, and
compiles the two as one function, which Numba keeps on disk under a name with a digest of all files
and constants that it is made of. That happens the first time each of these is asked for:

- *single*, ``s.vertex_faces(7)``. Records and scratch are ``Pinned`` in memory as one image that
  compiled code reads by its address, so that a call hands over two integers instead of a dozen
  arrays (70 ns each). ``templates.single`` checks the handle, and that the scratch holds any answer
  to come, and calls the kernel; the answer is copied out of the scratch into a ``fresh`` array of
  NumPy's own. Where it is not so, or the handle is no plain ``int``, the slower way of a batch of
  one says what is wrong.
- *batched*, ``s.vertex_faces(array)``. All handles are checked first. ``templates.batch`` then runs
  in slices, one per core, each with its own room for the answers, which grows where it is too
  small; the parts are put together as a ``Ragged``.
- *timed*, ``s.sweep("vertex_faces", handles)``. All handles are checked first, which
  ``prepare_sweep`` does alone. ``templates.sweep`` then asks for every handle, writes every answer
  over the last and returns a checksum, so that nothing is optimized away. This is what the
  experiments time: no check, no allocation, no Python.
- *counted*, ``s.work("vertex_faces", handles)``. The kernel's Python source, and that of whatever
  it calls, runs over ``CountingArray``s: exactly how many elements are read, on any machine.
  ``s.reads("vertex_faces", 7)`` says which ones.

An operation runs likewise. ``templates.perform`` does one, or a whole row of them, until one is
refused or there is no room; then Python makes room, pins the larger arrays at the same address and
goes on. In a batch the next elements are read a few at a time before they are operated on, as reads
alone wait for memory side by side; what is timed for the study does without, as a program does that
edits here and there. ``operation_work`` counts. An algorithm of one's own, made of a structure's
queries and operations, is compiled by ``templates.run``.

Structures made of objects (``InterpretedUses``, ``Held``) run the same templates uncompiled. So do
those of arrays that are built to be stepped through (``UncompiledUses``).
"""

from hem.engine.counting import CountingArray, Read, interpreted, is_compiled, of_pythons_numbers
from hem.engine.objects import Held, InterpretedUses, UncompiledUses, counting
from hem.engine.pinned import Pinned
from hem.engine.templates import (
    AHEAD,
    BEGIN,
    CHECK,
    DO,
    END,
    ENDED,
    FORGET,
    KEEP,
    MODE,
    PERSIST,
    TELL,
    move,
)
from hem.engine.uses import Uses, kept, parts_of

__all__ = [
    "AHEAD", "BEGIN", "CHECK", "DO", "END", "ENDED", "FORGET", "KEEP", "MODE", "PERSIST", "TELL",
    "CountingArray", "Held", "InterpretedUses", "Pinned", "Read", "UncompiledUses", "Uses",
    "counting", "interpreted", "is_compiled", "kept", "move", "of_pythons_numbers", "parts_of",
]  # fmt: skip
