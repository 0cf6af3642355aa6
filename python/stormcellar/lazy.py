"""Grids over time as xarray datasets whose cells are read on use."""

from __future__ import annotations

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing

from ._library import Error
from .grids import CellState


class _Grids:
    """Reads grids of the same cells. Keeps the last grid, because its values and states are often wanted together."""

    def __init__(self, paths, read):
        self._paths, self._read = paths, read
        self._last = (len(paths) - 1, read(paths[-1]))
        self.newest = self._last[1]

    def __reduce__(self):
        return _Grids, (self._paths, self._read)

    def at(self, index):
        last, grid = self._last
        if last == index:
            return grid
        grid = self._read(self._paths[index])
        if grid.shape != self.newest.shape or not all(
                np.array_equal(a, b, equal_nan=True) for a, b in zip(_places(grid), _places(self.newest))):
            raise Error(f"the grid of {grid.time} has other cells than the grid of {self.newest.time}", "unsupported")
        self._last = (index, grid)
        return grid


class _Cells(BackendArray):
    """The values or the states of grids, shape (time, z, y, x)."""

    def __init__(self, grids, count, dtype, cells_of):
        self.shape, self.dtype = (count, *grids.newest.shape), np.dtype(dtype)
        self._grids, self._cells_of = grids, cells_of

    def __getitem__(self, key):
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._outer)

    def _outer(self, key):
        times, cells = np.arange(self.shape[0])[key[0]], key[1:]
        if times.ndim == 0:
            return self._cells_of(self._grids.at(int(times)), cells)
        some = [self._cells_of(self._grids.at(int(time)), cells) for time in times]
        return np.stack(some) if some else self._cells_of(self._grids.newest, cells)[np.newaxis][:0]


def open_lazily(times, paths, read):
    """Returns the dataset of the grids with these times (in milliseconds) and paths."""
    grids = _Grids(paths, read)
    values, states = (indexing.LazilyIndexedArray(_Cells(grids, len(paths), dtype, cells_of))
                      for dtype, cells_of in (("f4", _values), ("u1", _states)))
    return xr.Dataset(grids.newest._variables(values, states, "time"),
                      coords={**grids.newest._coordinates(),
                              "time": ("time", np.array(times, "i8").view("M8[ms]").astype("M8[ns]"))})


def _places(grid):
    return (grid.center, grid.parallels_deg, grid.levels_m, grid.x_m, grid.y_m, grid.longitudes_deg, grid.latitudes_deg)


def _states(grid, key):
    """Returns the states at an orthogonal index."""
    cells = grid.states()
    for axis in reversed(range(3)):  # a number drops its axis, so begin with the last
        cells = cells[(slice(None),) * axis + (key[axis],)]
    return cells


def _values(grid, key):
    cells = grid._values.transpose(2, 0, 1)
    for axis in reversed(range(3)):
        cells = cells[(slice(None),) * axis + (key[axis],)]
    return np.where(_states(grid, key) == CellState.value, cells, np.float32(np.nan))
