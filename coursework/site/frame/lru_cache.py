"""LRU cache: at most a given number of items; the least recently used are evicted."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Any


class LRUCache:
    """LRU cache of items, each computed at the first request for its key."""

    def __init__(self, most: int):
        self._most = most
        self._items: OrderedDict[Hashable, Any] = OrderedDict()
        self._lock = Lock()

    def get(self, key: Hashable, make: Callable[[], Any]) -> Any:
        """Return the item of a key; two concurrent requests for a new one may both compute it."""
        with self._lock:
            if key in self._items:
                self._items.move_to_end(key)
                return self._items[key]
        item = make()
        with self._lock:
            item = self._items.setdefault(key, item)
            while len(self._items) > self._most:
                self._items.popitem(last=False)
        return item

    def drop(self, key: Hashable) -> None:
        """Remove the item of a key, if there is one."""
        with self._lock:
            self._items.pop(key, None)
