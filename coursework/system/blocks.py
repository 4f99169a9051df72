"""Computation on long arrays in blocks that fit the processor's cache."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

BLOCK = 32768  #: configurations computed together: a balance of the cost of calls and the size of the cache
PIECE = BLOCK  #: the same for a chain of quantities


def _keep_freed_memory() -> None:
    """Let the C library keep the memory of temporaries instead of handing it back after each of them.

    Otherwise every temporary array of a block is paged in again, at several times the cost of filling it.
    Freeing one large piece raises the threshold above which memory is handed back (dynamic in glibc,
    harmless elsewhere).
    """
    np.empty(31 << 17)


_keep_freed_memory()


def in_blocks(kernel: Callable[..., Sequence[np.ndarray]], *inputs: Any) -> tuple[np.ndarray, ...]:
    """Evaluate ``kernel(*inputs)`` block by block over the broadcast shape of the inputs.

    Parameters
    ----------
    kernel
        Takes the inputs, or pieces of them that broadcast in the same way, and returns real or complex
        arrays, one an output. Each element may depend on the elements of the same index only.
    inputs
        Numbers, or numpy arrays that broadcast. An axis along which an input does not vary is not expanded:
        ``n`` linkages of shape ``(n, 1)`` and ``m`` angles of shape ``(m,)`` give ``(n, m)``.

    Returns
    -------
    One array per output, of the broadcast shape, without warnings: undefined elements are NaN.
    """
    arrays = [given for given in inputs if np.ndim(given)]
    shape = np.broadcast_shapes(*{given.shape for given in arrays})
    with np.errstate(all="ignore"):
        if math.prod(shape) <= BLOCK:
            return tuple(_full_shape(part, shape) for part in kernel(*inputs))
        # An input with one value is passed as it is: cutting it costs more than using it.
        axes = [_varying(given, len(shape)) if np.size(given) > 1 else None for given in inputs]
        results: tuple[np.ndarray, ...] = ()
        for block in _places(shape):
            parts = kernel(*[_cut(g, a, block) for g, a in zip(inputs, axes, strict=True)])
            if not results:
                results = tuple(np.empty(shape, dtype=part.dtype) for part in parts)
            for result, part in zip(results, parts, strict=True):
                result[block] = part
    return results


def pieces(named: Mapping[str, Any]) -> tuple[list[str], list[slice]] | None:
    """Return the arrays to cut along their first axis and the slices to cut them by.

    The arrays broadcast. Those that vary along the first axis of their common shape are cut; the others are
    used whole with each piece. None if there are few elements or nothing to cut.
    """
    arrays = {name: given for name, given in named.items() if isinstance(given, np.ndarray) and given.ndim}
    shape = np.broadcast_shapes(*{given.shape for given in arrays.values()})
    if math.prod(shape) <= PIECE or shape[0] == 1:
        return None
    cut = [n for n, given in arrays.items() if given.ndim == len(shape) and given.shape[0] > 1]
    step = max(1, PIECE // math.prod(shape[1:]))
    return cut, [slice(start, start + step) for start in range(0, shape[0], step)]


def joined(
    compute: Callable[[slice], Mapping[str, Any]], places: Sequence[slice], length: int
) -> dict[str, Any]:
    """Compute the pieces and join them along the first axis; values that are no arrays stay.

    The pieces are independent. The threads of the process compute them where that is faster; the result does
    not depend on their number.
    """
    start = time.perf_counter()
    first = compute(places[0])
    alone = time.perf_counter() - start
    results = {name: _with_length(value, length) for name, value in first.items()}
    other_types: list[tuple[str, slice, np.ndarray]] = []

    def put(piece: slice, values: Mapping[str, Any]) -> None:
        for name, value in values.items():
            if np.ndim(value) == 0:
                continue
            if np.asarray(value).dtype == results[name].dtype:
                results[name][piece] = value
            else:
                other_types.append((name, piece, value))

    def fill(piece: slice) -> None:
        put(piece, compute(piece))

    put(places[0], first)
    _each(fill, places[1:], alone)
    # Texts of other lengths, for example: the result must hold them all.
    for name, piece, value in other_types:
        results[name] = results[name].astype(np.promote_types(results[name].dtype, value.dtype))
        results[name][piece] = value
    return results


def _each(fill: Callable[[slice], None], places: Sequence[slice], alone: float) -> None:
    """Call ``fill`` once for each piece, in threads if a trial of the first pieces beats ``alone``, the
    seconds of one.

    numpy runs in parallel only while it computes, not between calls: threads do not speed up many short
    calls, nor any call while other processes use the processors.
    """
    threads = processors()
    tried = 2 * threads
    if threads == 1 or len(places) <= tried or alone * len(places) < _NOTICED:
        for piece in places:
            fill(piece)
        return
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(threads) as pool:
        start = time.perf_counter()
        list(pool.map(fill, places[:tried]))
        pays = time.perf_counter() - start < _PAYS * alone * tried
        for _ in (pool.map if pays else map)(fill, places[tried:]):
            pass


_NOTICED = 0.2  #: seconds of work from which a trial of threads is worth its cost
_PAYS = 0.85  #: share of the time of places one by one below which threads are worth while


def processors() -> int:
    """Return the number of processors that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # only Linux knows the processors of this process
        return os.cpu_count() or 1


def _with_length(first: Any, length: int) -> Any:
    """Return an empty array of the full length for this first piece; a value that does not vary is returned
    as it is."""
    if np.ndim(first) == 0:
        return first
    return np.empty((length, *first.shape[1:]), dtype=first.dtype)


def _full_shape(part: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    return part if np.shape(part) == shape else np.array(np.broadcast_to(part, shape))


def _varying(given: np.ndarray, axes: int) -> tuple[int | None, ...]:
    """Return for each axis of the broadcast shape the axis of the input that varies along it, or None."""
    missing = axes - given.ndim
    return tuple(i - missing if i >= missing and given.shape[i - missing] > 1 else None for i in range(axes))


def _cut(given: np.ndarray, axes: tuple[int | None, ...] | None, block: tuple[slice, ...]) -> np.ndarray:
    if axes is None:
        return given
    missing = len(axes) - given.ndim
    every = slice(None)
    return given[tuple(every if a is None else s for a, s in list(zip(axes, block, strict=True))[missing:])]


def _places(shape: tuple[int, ...]) -> Iterator[tuple[slice, ...]]:
    """Yield slices that cover an array once, in order, each of at most ``BLOCK`` elements."""
    if len(shape) == 0:
        yield ()
        return
    inner = math.prod(shape[1:])
    if inner > BLOCK:
        for i in range(shape[0]):
            for rest in _places(shape[1:]):
                yield (slice(i, i + 1), *rest)
        return
    step = max(1, BLOCK // max(inner, 1))
    for start in range(0, shape[0], step):
        yield (slice(start, start + step), *[slice(None)] * (len(shape) - 1))
