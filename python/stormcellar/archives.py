"""The volumes of a station as one tree over time, decoded from their raw files when their values are used.

The sweeps of a volume decide to which group each of them belongs. Two sweeps are of one kind if their angles differ by
at most 0.15 degrees, both or neither measure velocity, and their azimuths and gates are spaced alike. Sweeps of one
kind in a volume (SAILS, MRLE, MPDA) differ by their order. So a low sweep that is repeated keeps its group wherever the
radar inserts it, and a volume without it, or a volume that AVSET ended early, has no values there. If the radar
restarted a cut, the try with the most rays counts.
"""

from __future__ import annotations

import collections
import concurrent.futures
import functools
import mmap
import os
import struct
import threading
import types
import typing
import warnings

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing

from ._library import Error
from .catalogs import Catalog
from .trees import _MOMENTS, _fitted, _repeats, _root_dataset, _sweep_dataset
from .volume import State, Volume, fixed_angle

if typing.TYPE_CHECKING:
    from .catalogs import Time

_ANGLE_TOLERANCE_DEG = 0.15
_GAP = 0.75  # A place farther from each ray than this part of the spacing was not measured.
_DECODED = 8  # volumes that an archive keeps in memory
_RECORD_RADIALS = 120  # in an LDM record of a volume of messages 31
_FIRST, _LAST = (0, 3, 5), (2, 4)  # states of the radials that begin and end a sweep


def open_archive(catalog: Catalog | str | os.PathLike[str], station: str, start: Time | None = None,
                 end: Time | None = None) -> xr.DataTree | dict[str, xr.Dataset]:
    """Returns the complete and partial volumes of a station that begin from `start` to `end`, both included, as an
    xarray.DataTree, or as a dict of datasets if xarray is older than 2024.10. `catalog` is a Catalog or its directory.

    Groups are "/VCP-212/sweep_0" and so on, in the order of the volume of the pattern with the most sweeps; sweeps that
    this volume lacks come last. Dimensions are (vcp_time, azimuth, range). Each volume is one step of vcp_time,
    its start. Moments, their states (DBZH_status) and units are those of open_volume(). Azimuths are a regular grid of
    0.5 or 1 degree, and each has the gates of the nearest ray; `time`, `elevation`, `nyquist_velocity` and
    `ray_azimuth` describe that ray. Where a ray or a sweep is missing, values are NaN and states no_data.

    Opening decodes the newest and the oldest volume of each pattern, number of sweeps and number of rays. Other
    volumes are decoded when their values are used, on all processors, and nothing is written to disk. The last 8
    volumes stay in memory. A file that cannot be read, or holds another volume than the catalog says, gives NaN and a
    warning. So does a sweep that no group fits. Raises Error (not_found) if there is no volume.

    >>> archive = stormcellar.open_archive(CATALOG, "KTLX")
    >>> velocity = archive["/VCP-11/sweep_1"]["VRADH"]
    >>> dict(velocity.sizes)
    {'vcp_time': 1, 'azimuth': 360, 'range': 920}
    >>> float(velocity.sel(vcp_time="1999-05-03").max())
    26.0
    """
    if not station:
        raise Error("open_archive() needs a station", "bad_argument")
    catalog = catalog if isinstance(catalog, Catalog) else Catalog(catalog)
    by_pattern = collections.defaultdict(list)
    for entry in _one_of_each_start(catalog.volumes(station, start, end)):
        by_pattern[entry.vcp].append(entry)
    groups, shelf = {}, _Shelf()
    for vcp, entries in sorted(by_pattern.items(), key=lambda item: (item[0] is None, item[0])):
        pattern = _Pattern(entries, shelf)
        if pattern.root is None:
            continue
        facts = {name: pattern.root.attrs[name] for name in ("Conventions", "instrument_name", "source")}
        groups["/"] = xr.Dataset(coords=pattern.root.coords, attrs=facts)
        for number, dataset in enumerate(pattern.datasets()):
            groups[f"/VCP-{'unknown' if vcp is None else vcp}/sweep_{number}"] = dataset
    if not groups:
        raise Error(f"the catalog has no volume of {station} in these times that can be read", "not_found")
    return xr.DataTree.from_dict(groups) if hasattr(xr, "DataTree") else groups


def _one_of_each_start(entries):
    """Returns the entries that can be read, one for each start: a volume may come in several files."""
    best = {}
    for entry in entries:
        if entry.state in ("complete", "partial") and entry.sweeps and not np.isnat(entry.start):
            known = best.setdefault(entry.start, entry)
            if (entry.complete, entry.radials) > (known.complete, known.radials):
                best[entry.start] = entry
    return list(best.values())


def _size(entry):
    """Returns the number of sweeps of a volume, and how many times 360 rays it has."""
    return entry.sweeps, round(entry.radials / 360)


class _Kind(typing.NamedTuple):
    """The kind of a sweep, by which volumes are compared."""

    angle_deg: float
    has_velocity: bool
    azimuth_spacing_deg: float
    first_gate_m: int
    gate_spacing_m: int

    def is_like(self, other):
        return self[1:] == other[1:] and abs(self.angle_deg - other.angle_deg) <= _ANGLE_TOLERANCE_DEG


def _kind_of(sweep):
    azimuths = np.sort(sweep.radials["azimuth_deg"])
    spacing = 0.5 if azimuths.size > 1 and np.median(np.diff(azimuths)) < 0.75 else 1.0
    axis = min(sweep.moments.values(), key=lambda moment: moment.gate_spacing_m)
    return _Kind(fixed_angle(sweep), "VEL" in sweep.moments, spacing, axis.first_gate_m, axis.gate_spacing_m)


def _cuts(volume):
    """Returns the sweeps of a volume, one for each cut of its pattern."""
    best = {}
    for sweep in volume.sweeps:
        if len(sweep.radials) and sweep.moments:
            known = best.setdefault(sweep.elevation_number, sweep)
            if len(sweep.radials) >= len(known.radials):
                best[sweep.elevation_number] = sweep
    return sorted(best.values(), key=lambda sweep: sweep.number)


class _Layout:
    """The variables of a group, without values."""

    def __init__(self, kind):
        self.kind, self.variables, self.axes, self.facts = kind, {}, {}, {}

    def join(self, sweep):
        """Adds moments and gates that other volumes of the group lack."""
        dataset = _sweep_dataset(sweep, False, True, False)
        self.facts = self.facts or {name: dataset[name].variable for name in dataset if dataset[name].ndim == 0}
        for name, variable in dataset.variables.items():
            if variable.ndim == 2:
                self.variables.setdefault(name, (variable.dims[1], variable.dtype, variable.attrs))
            elif name in dataset.dims and name != "azimuth":
                known = self.axes.setdefault(name, variable)
                if variable.size > known.size and variable.attrs == known.attrs:
                    self.axes[name] = variable


class _Shelf:
    """Keeps the last decoded volumes of an archive, so that all moments of a volume are decoded once."""

    def __init__(self):
        self._lock, self._decoded = threading.Lock(), collections.OrderedDict()

    def __reduce__(self):
        return _Shelf, ()

    def of(self, entry):
        """Returns the lock of a volume, and its decoded sweeps by their places; None for a missing sweep."""
        with self._lock:
            decoded = self._decoded.setdefault((entry.path, entry.number), (threading.Lock(), {}))
            self._decoded.move_to_end((entry.path, entry.number))
            while len(self._decoded) > _DECODED:
                self._decoded.popitem(last=False)
            return decoded


class _Pattern:
    """The volumes of one pattern, and the places of their sweeps: kinds and how often each has been seen before."""

    def __init__(self, entries, shelf):
        self._entries, self._shelf = entries, shelf
        self._kinds, self._layouts, self.root = [], [], None
        self._numbers = {}  # (index of the kind, occurrence): number of the place
        self._records = {}  # (size of a volume, place): first record, number of records, cut
        by_size = collections.defaultdict(list)
        whole = [entry for entry in entries if entry.complete]
        for entry in whole or entries:
            by_size[_size(entry)].append(entry)
        for _, some in sorted(by_size.items(), reverse=True):
            self._learn(some[::-1])
            self._learn(some[: len(some) - 1])  # the oldest may have other gates and moments than the newest

    def _learn(self, entries):
        """Adds the places of the sweeps of a volume: the first of three that can be read."""
        for entry in entries[:3]:
            volume = _opened(entry)
            if volume is None:
                continue
            self.root = _root_dataset(volume) if self.root is None else self.root
            record = 1
            for place, sweep in self._placed(volume, True):
                count = -(-len(sweep.radials) // _RECORD_RADIALS)
                self._records[_size(entry), place] = (record, count, sweep.elevation_number)
                record += count
            return

    def _nearest(self, kind):
        """Returns the index of the known kind that is like this one, or None."""
        alike = [i for i, known in enumerate(self._kinds) if known.is_like(kind)]
        return min(alike, key=lambda i: abs(self._kinds[i].angle_deg - kind.angle_deg), default=None)

    def _placed(self, volume, may_add=False):
        """Yields place and sweep of each cut; the place is None if the tree lacks it."""
        seen = collections.Counter()
        for sweep in _cuts(volume):
            kind = _kind_of(sweep)
            index = self._nearest(kind)
            if index is None and may_add:
                index = len(self._kinds)
                self._kinds.append(kind)
            key = (index, seen[index])
            seen[index] += 1
            if may_add and key not in self._numbers:
                self._numbers[key] = len(self._layouts)
                self._layouts.append(_Layout(self._kinds[index]))
            if may_add:
                self._layouts[self._numbers[key]].join(sweep)
            yield self._numbers.get(key), sweep

    def datasets(self):
        """Yields the dataset of each place."""
        starts = np.array([entry.start for entry in self._entries]).astype("M8[ns]")
        for place, layout in enumerate(self._layouts):
            spacing = layout.kind.azimuth_spacing_deg
            azimuths = (np.arange(round(360 / spacing)) + 0.5) * spacing
            lazy = functools.partial(self._lazy, place, azimuths.size)
            variables = {"sweep_number": place}
            for name, (dimension, dtype, attributes) in layout.variables.items():
                axis = layout.axes[dimension]
                gates = functools.partial(_gates, name, *(axis.attrs[fact] for fact in (
                    "meters_to_center_of_first_gate", "meters_between_gates")), axis.size)
                variables[name] = (("vcp_time", "azimuth", dimension), lazy(gates, dtype, axis.size), attributes)
            for name, field, dtype, attributes in _RAYS:
                variables[name] = (("vcp_time", "azimuth"), lazy(functools.partial(_rays, field), dtype), attributes)
            yield xr.Dataset({**layout.facts, **variables}, {
                "vcp_time": ("vcp_time", starts, {"standard_name": "time", "long_name": "Start of the volume"}),
                "azimuth": ("azimuth", azimuths, {"standard_name": "ray_azimuth_angle", "units": "degrees",
                                                  "axis": "radial_azimuth_coordinate"}),
                **layout.axes})

    def _lazy(self, place, azimuths, read, dtype, *gates):
        return indexing.LazilyIndexedArray(_Cells(self, place, read, dtype, (len(self._entries), azimuths, *gates)))

    def sweep(self, time, place):
        """Returns the sweep of a volume at a place and the row of each azimuth (-1: no ray), or None without a sweep."""
        entry = self._entries[time]
        lock, sweeps = self._shelf.of(entry)
        with lock:
            if place not in sweeps:
                sweeps.update(self._from_records(entry, place) or self._from_file(entry))
            return sweeps[place]

    def _from_records(self, entry, place):
        """Decodes only the records in which another volume of this size has this sweep. Returns None if they do not
        hold the whole sweep, or if the sweeps of its kind before it must be counted."""
        kind = self._layouts[place].kind
        first, count, cut = self._records.get((_size(entry), place), (0, 0, 0))
        must_count = first > 1 and (self._kinds.index(kind), 1) in self._numbers
        if not (count and entry.complete and entry.number == 1) or must_count:
            return None
        try:
            volume = Volume(_records_of(entry.path, first, count))
        except (Error, OSError, ValueError):
            return None
        sweeps = [sweep for sweep in volume.sweeps if sweep.elevation_number == cut]
        if len(sweeps) != 1 or (volume.start, volume.vcp) != (entry.start, entry.vcp) or not sweeps[0].moments:
            return None
        states, nearest = sweeps[0].radials["status"], self._nearest(_kind_of(sweeps[0]))
        if states[0] not in _FIRST or states[-1] not in _LAST or nearest is None or self._kinds[nearest] != kind:
            return None
        return {place: (sweeps[0], _rows(sweeps[0], kind.azimuth_spacing_deg))}

    def _from_file(self, entry):
        """Decodes the whole volume."""
        found = dict.fromkeys(range(len(self._layouts)))
        volume = _opened(entry)
        for place, sweep in self._placed(volume) if volume else ():
            if place is None:
                _warn(entry, f"left out sweep {sweep.number} of {fixed_angle(sweep):.1f} degrees: no group has it")
            else:
                found[place] = (sweep, _rows(sweep, self._layouts[place].kind.azimuth_spacing_deg))
        return found


def _warn(entry, reason):
    warnings.warn(f"{entry.path}: {reason}", stacklevel=2)


def _opened(entry):
    """Returns the volume, or None with a warning if the file does not have it."""
    try:
        volume = entry.open()
    except Error as error:
        _warn(entry, f"no values, because the file cannot be read: {error}")
        return None
    if (volume.start, volume.vcp) != (entry.start, entry.vcp):
        _warn(entry, "no values, because the file holds another volume than the catalog says")
        return None
    return volume


def _records_of(path, first, count):
    """Returns a file of the first LDM record, which has the pattern, and of `count` records from `first`."""
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as memory:
        if memory[:4] != b"AR2V":
            raise ValueError("no header before LDM records")
        begins = [24]
        while len(begins) <= first + count:
            word = memory[begins[-1]: begins[-1] + 4]  # size of the record, negative for the last one
            if len(word) < 4 or not any(word):
                raise ValueError("the file has fewer records")
            begins.append(begins[-1] + 4 + abs(struct.unpack(">i", word)[0]))
        return memory[: begins[1]] + memory[begins[first]: begins[first + count]]


def _rows(sweep, spacing):
    """Returns the row of the nearest ray for each azimuth of the regular grid, or -1 where no ray is near."""
    azimuths = sweep.radials["azimuth_deg"].astype("f8") % 360
    order = np.argsort(azimuths, kind="stable")
    around = np.concatenate([azimuths[order[-1:]] - 360, azimuths[order], azimuths[order[:1]] + 360])
    rows = np.concatenate([order[-1:], order, order[:1]])
    places = (np.arange(round(360 / spacing)) + 0.5) * spacing
    after = np.clip(np.searchsorted(around, places), 1, around.size - 1)
    nearest = np.where(places - around[after - 1] <= around[after] - places, after - 1, after)
    return np.where(np.abs(around[nearest] - places) <= _GAP * spacing, rows[nearest], -1)


# Name, field of Sweep.radials, type and attributes of the facts of rays.
_RAYS = (
    ("time", "time", "M8[ns]", {"standard_name": "time"}),
    ("ray_azimuth", "azimuth_deg", "f4", {"long_name": "Azimuth of the ray", "units": "degrees"}),
    ("elevation", "elevation_deg", "f4", {"standard_name": "ray_elevation_angle", "units": "degrees"}),
    ("nyquist_velocity", "nyquist_mps", "f4", {"units": "meters per seconds"}),
)


def _rays(field, sweep, rows, dtype):
    facts = sweep.radials[field].astype(dtype)[rows]
    facts[rows < 0] = _missing(dtype)
    return facts


def _missing(dtype):
    return np.timedelta64("NaT") if dtype.kind == "M" else State.no_data if dtype.kind == "u" else np.nan


def _gates(name, first, spacing, width, sweep, rows, dtype):
    """Returns the values or states of a moment on the axis of the group, or None if the sweep lacks it."""
    wanted = name.removesuffix("_status")
    moment = next((one for one in sweep.moments.values() if _MOMENTS.get(one.name, (one.name,))[0] == wanted), None)
    if moment is None:
        return None
    repeats = _repeats(moment, types.SimpleNamespace(first_gate_m=first, gate_spacing_m=spacing))
    if not repeats:
        warnings.warn(f"no values of {wanted} at {sweep.radials['time'][0]}: its gates differ from the group's")
        return None
    gates, room = (moment.states() if dtype.kind == "u" else moment.values())[rows], width // repeats
    if dtype.kind == "f" and np.isfinite(gates[:, room:]).any():
        warnings.warn(f"left out {wanted} at {sweep.radials['time'][0]} beyond the group's {width} gates")
    gates = _fitted(gates[:, :room], repeats, width, _missing(dtype))
    gates[rows < 0] = _missing(dtype)
    return gates


class _Cells(BackendArray):
    """A moment, its states, or a fact of rays at one place, shape (vcp_time, azimuth) or (vcp_time, azimuth, range)."""

    def __init__(self, pattern, place, read, dtype, shape):
        self.shape, self.dtype = shape, np.dtype(dtype)
        self._pattern, self._place, self._read = pattern, place, read

    def __getitem__(self, key):
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._outer)

    def _outer(self, key):
        times = np.arange(self.shape[0])[key[0]]
        if times.ndim == 0:
            return self._at(key[1:], times)
        cells = np.empty((times.size, *self._at(key[1:], None).shape), self.dtype)

        def fill(step):
            cells[step] = self._at(key[1:], times[step])

        with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
            list(pool.map(fill, range(times.size)))
        return cells

    def _at(self, key, time):
        """Returns the cells of a volume at an orthogonal index, or cells without values for no time."""
        found = None if time is None else self._pattern.sweep(int(time), self._place)
        cells = None if found is None else self._read(*found, self.dtype)
        if cells is None:
            cells = np.full(self.shape[1:], _missing(self.dtype), self.dtype)
        for axis in reversed(range(cells.ndim)):  # a number drops its axis, so begin with the last
            cells = cells[(slice(None),) * axis + (key[axis],)]
        return cells
