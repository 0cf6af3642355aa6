"""Catalogs of raw files."""

from __future__ import annotations

import ctypes
import dataclasses
import os
import typing

import numpy as np

from . import _library
from ._library import Handle, call, sized
from .volume import Volume

if typing.TYPE_CHECKING:
    import datetime
    from collections.abc import Iterator

    Time = typing.Union[str, np.datetime64, datetime.datetime]


@dataclasses.dataclass(frozen=True)
class CatalogEntry:
    """A volume in a raw file. `state` is that of the file: seen (not decoded yet), complete, partial, rejected or gone
    (deleted by its owner). `reason` says why a file is partial. `number` counts the volumes of the file, from 1.
    Unknown times are NaT, an unknown pattern is None.

    >>> entry = stormcellar.CatalogEntry(FILE, "KTLX", "complete", "", np.datetime64("1999-05-03T23:56:21"),
    ...                                  np.datetime64("NaT"), 0, 1, 11, 16, 5878, True)
    >>> entry.open(moments="REF")
    <Volume KTLX 1999-05-03T23:56:21.000, 16 sweeps>
    """

    path: str
    station: str
    state: str
    reason: str
    start: np.datetime64
    end: np.datetime64
    bytes: int
    number: int
    vcp: int | None
    sweeps: int
    radials: int
    complete: bool

    def open(self, **options: typing.Any) -> Volume:
        """Reads the volume, with the options of Volume.

        >>> entry = next(iter(stormcellar.Catalog(CATALOG)))
        >>> entry.open(moments="REF").station
        'KTLX'
        """
        return Volume(self.path, volume=self.number, **options)


class Catalog:
    """A catalog of raw files, which a service may write meanwhile: the directory `state/catalog` of stormcellard.

    >>> [entry.station for entry in stormcellar.Catalog(CATALOG)]
    ['KTLX']
    """

    def __init__(self, path: str | os.PathLike[str]):
        pointer = ctypes.c_void_p()
        call("catalog_open", os.fsencode(path), ctypes.byref(pointer))
        self._handle = Handle("catalog", pointer)

    def volumes(self, station: str | None = None, start: Time | None = None,
                end: Time | None = None) -> list[CatalogEntry]:
        """Returns the volumes of a station, or of all stations, that begin from `start` to `end`, both included, by
        station and start. Times are in UTC. Raises Error for a station that the catalog does not have.

        >>> [entry.vcp for entry in stormcellar.Catalog(CATALOG).volumes("KTLX", start="1999-05-03")]
        [11]
        """
        pointer, count = ctypes.c_void_p(), ctypes.c_size_t()
        call("catalog_list", self._handle.pointer, ctypes.byref(query(station, None, start, end)),
             ctypes.byref(pointer), ctypes.byref(count))
        files = Handle("file_list", pointer)
        return [_entry(files, i) for i in range(count.value)]

    def __iter__(self) -> Iterator[CatalogEntry]:
        return iter(self.volumes())


def query(name: str | None, moment: str | None, start: Time | None, end: Time | None) -> _library.Query:
    """Returns a query of the library.

    >>> query("KTLX", None, "1970-01-01T00:00:01", None).from_ms
    1000
    """
    first, last = (0 if time is None else int(np.datetime64(time, "ms").astype("i8")) for time in (start, end))
    return sized(_library.Query, name=name.encode() if name else None, moment=moment.encode() if moment else None,
                 from_ms=first, to_ms=last)


def _entry(files, index):
    facts = sized(_library.FileFacts)
    call("file_list_describe", files.pointer, index, ctypes.byref(facts))
    return CatalogEntry(os.fsdecode(facts.path), facts.station.decode(), facts.state.decode(),
                        facts.reason.decode(errors="replace"), np.datetime64(facts.start_ms, "ms"),
                        np.datetime64(facts.end_ms, "ms"), facts.bytes, facts.volume,
                        facts.vcp if facts.vcp >= 0 else None, facts.sweeps, facts.radials, bool(facts.complete))
