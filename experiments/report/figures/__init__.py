"""Every figure of the report: a run in, a figure out. A module for each kind, asked for by name.

``growth`` draws costs by size and ``claims`` a figure per claim; ``memory``, ``history``,
``real_time`` and ``accuracy`` are plots as well; ``meshes`` and ``fracture`` are pictures.
``drawings`` shows what structures record, as ``records`` reads it from them, and ``class_diagram``
the thesis' classes.
"""
