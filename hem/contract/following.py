"""Who is told of every edit, and what an edit means for a render mesh."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Handles, Points
from hem.contract.surveying import Surveying
from hem.edit import Edit


class Following(Surveying, abstract=True):
    """Subscribers and their edits."""

    def subscribe(self, callback: Callable[[Edit], Any]) -> Callable[[], None]:
        """Have ``callback`` called with every ``Edit`` once it is done -> a way to end that.

        All are called, in the order they subscribed, even if one of them raises; what the first of
        them raised is raised then.
        """
        self._subscribers.append(callback)

        def unsubscribe() -> None:
            if callback in self._subscribers:
                self._subscribers.remove(callback)

        return unsubscribe

    @cached_property
    def _subscribers(self) -> list[Callable[[Edit], Any]]:
        return []

    def _publish(self, edit: Edit) -> None:
        tell_all(self._subscribers, edit)

    def copy_touched(self, touched: ArrayLike, points: Points, indices: Handles) -> None:
        """Write what an edit touched into the arrays of a render mesh, clockwise. O(edit).

        ``points`` (n, 3) and ``indices`` (m, 3) have a row for every vertex and face there ever
        was; what is dead becomes zeros.
        """
        entries, out = np.asarray(touched, np.int64), self._out["face"]
        self._copy_touched(entries, points, indices, out, *self.records)

    @cached_property
    def _copy_touched(self) -> Callable[..., None]:
        uses, k = self._uses["face_vertices"], self.kernels
        return uses.copy_touched(k["face_exists"], k["coordinate"])


def tell_all(listeners: Iterable[Callable[[Any], Any]], told: Any) -> None:
    """Call every listener, even if one of them raises; then raise what the first of them raised."""
    failures = []
    for listener in tuple(listeners):
        try:
            listener(told)
        except Exception as failure:
            failures.append(failure)
    if failures:
        raise failures[0]
