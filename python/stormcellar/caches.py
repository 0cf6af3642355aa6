"""Caches of grids."""

from __future__ import annotations

import ctypes
import os
import typing

import numpy as np
import numpy.typing as npt

from . import _library
from ._library import Error, Handle, call, sized
from .catalogs import query
from .grids import Grid

if typing.TYPE_CHECKING:
    import xarray

    from .catalogs import Time


class Cache:
    """A cache of grids, which a service may write meanwhile: the directory `cache` of stormcellard. A domain is a
    region, or a station with its own grids.

    >>> cache = stormcellar.Cache(CACHE)
    >>> cache.domains()
    ['KTLX']
    >>> cache.grid("KTLX", time="1999-05-04")
    <Grid REF, 115 x 115 x 32 cells of 4000 m>
    """

    def __init__(self, path: str | os.PathLike[str]):
        pointer = ctypes.c_void_p()
        call("cache_open", os.fsencode(path), ctypes.byref(pointer))
        self._handle = Handle("cache", pointer)

    def domains(self) -> list[str]:
        """Returns the domains.

        >>> stormcellar.Cache(CACHE).domains()
        ['KTLX']
        """
        return list(dict.fromkeys(domain for domain, *_ in self._list(None, None, None, None)))

    def moments(self, domain: str) -> list[str]:
        """Returns the moments of a domain.

        >>> stormcellar.Cache(CACHE).moments("KTLX")
        ['REF']
        """
        return list(dict.fromkeys(moment for _, moment, *_ in self._list(domain, None, None, None)))

    def times(self, domain: str, moment: str = "REF", start: Time | None = None,
              end: Time | None = None) -> npt.NDArray[np.datetime64]:
        """Returns the times of the grids from `start` to `end`, both included, rising, in UTC.

        >>> stormcellar.Cache(CACHE).times("KTLX").astype("datetime64[s]").tolist()
        [datetime.datetime(1999, 5, 3, 23, 56, 21)]
        """
        times = [time for *_, time, _ in self._list(domain, moment, start, end)]
        return np.array(times, "i8").view("datetime64[ms]")

    def grid(self, domain: str, moment: str = "REF", time: Time | None = None) -> Grid:
        """Returns the newest grid, or the newest at or before `time`. Raises Error (not_found) if there is none.

        >>> stormcellar.Cache(CACHE).grid("KTLX").shape
        (32, 115, 115)
        """
        found = self._list(domain, moment, None, time)
        if not found:
            raise Error(f"there is no grid of {moment} of domain '{domain}'{f' until {time}' if time else ''}",
                        "not_found")
        return _read(found[-1][-1])

    def open(self, domain: str, moment: str = "REF", start: Time | None = None,
             end: Time | None = None) -> xarray.Dataset:
        """Returns the grids from `start` to `end` as an xarray.Dataset with the variables MOMENT and MOMENT_status and
        the dimensions time, z, y, x. A grid is read when its cells are used. The newest grid is read at once, because
        it has the places of the cells. Raises Error if there is no grid, and later if a grid has other cells than the
        newest: then select times by `start`. Needs xarray.

        >>> dataset = stormcellar.Cache(CACHE).open("KTLX")
        >>> dict(dataset["REF"].sizes)
        {'time': 1, 'z': 32, 'y': 115, 'x': 115}
        >>> float(dataset["REF"].max()) > 50
        True
        """
        from .lazy import open_lazily

        found = self._list(domain, moment, start, end)
        if not found:
            raise Error(f"there is no grid of {moment} of domain '{domain}' in these times", "not_found")
        return open_lazily([time for *_, time, _ in found], [path for *_, path in found], _read)

    def _list(self, domain, moment, start, end):
        """Returns domain, moment, time in milliseconds and path of each grid."""
        pointer, count = ctypes.c_void_p(), ctypes.c_size_t()
        call("cache_list", self._handle.pointer, ctypes.byref(query(domain, moment, start, end)),
             ctypes.byref(pointer), ctypes.byref(count))
        grids = Handle("grid_list", pointer)
        facts = sized(_library.GridFileFacts)
        found = []
        for i in range(count.value):
            call("grid_list_describe", grids.pointer, i, ctypes.byref(facts))
            found.append((facts.domain.decode(), facts.moment.decode(), facts.time_ms, facts.path))
        return found


def _read(path):
    pointer = ctypes.c_void_p()
    call("grid_read", path, ctypes.byref(pointer))
    return Grid(pointer)
