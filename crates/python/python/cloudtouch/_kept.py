"""Bodies that stay prepared, for all threads that ask about them."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Any, Generic, Hashable, TypeVar

Prepared = TypeVar("Prepared")


class Kept(Generic[Prepared]):
    """What was used last, by its name. Threads share it, as those of Dask do: none waits but for the body it asks for."""

    def __init__(self, limit: int) -> None:
        if limit < 1:
            raise ValueError(f"keep is {limit}: at least one body stays prepared")
        self.limit = limit
        self._known: OrderedDict[Hashable, _Place[Prepared]] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, name: Hashable, make: Callable[[], Prepared]) -> Prepared:
        with self._lock:
            place = self._known.setdefault(name, _Place())
            self._known.move_to_end(name)
        # Made once for all threads that ask for it, and without holding up those that ask for another.
        with place.lock:
            try:
                prepared = place.prepared = make() if place.prepared is None else place.prepared
            except BaseException:
                with self._lock:
                    if self._known.get(name) is place:
                        del self._known[name]
                raise
        with self._lock:
            while len(self._known) > self.limit:
                self._known.popitem(last=False)
        return prepared

    def __reduce__(self) -> tuple[Any, ...]:
        # A worker prepares what it is asked about.
        return (Kept, (self.limit,))


class _Place(Generic[Prepared]):
    """A body, once it is prepared."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.prepared: Prepared | None = None
