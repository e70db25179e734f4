"""Who is told of what happens to something, and for how long."""

from collections.abc import Callable
from typing import Any

Listener = Callable[[Any], Any]


class Listeners(list[Listener]):
    """Those who are told, in the order they subscribed."""

    __slots__ = ()

    def subscribe(self, callback: Listener) -> Callable[[], None]:
        """Have ``callback`` told from now on -> a way to end that, which may be called twice."""
        self.append(callback)
        subscribed = [callback]

        def unsubscribe() -> None:
            if subscribed and callback in self:
                self.remove(subscribed.pop())

        return unsubscribe

    def tell(self, what: Any) -> None:
        """Call them all, even if one of them raises; then raise what the first of them raised.

        An interrupt, too: whoever was not told of something would be out of step from then on. Who
        ended it meanwhile is not called.
        """
        failures = []
        for listener in tuple(self):
            try:
                if listener in self:
                    listener(what)
            except BaseException as failure:
                failures.append(failure)
        if failures:
            raise failures[0]
