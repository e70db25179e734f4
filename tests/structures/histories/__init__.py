"""Random histories of meshes, and what must come of them, from the faces alone.

``actions`` chooses operations and does them to a structure; ``truth`` predicts them on a
``surface``, which is faces and nothing else; ``values`` are attributes, ``answers`` are queries and
steps; a ``world`` does it all to every structure at once, ``tests.structures.soak`` for hours.
"""
