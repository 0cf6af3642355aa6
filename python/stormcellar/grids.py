"""Grids of volumes as NumPy arrays and xarray datasets."""

from __future__ import annotations

import ctypes
import enum
import typing
import weakref

import numpy as np
import numpy.typing as npt

from . import _library
from ._library import call, sized
from .volume import Volume

if typing.TYPE_CHECKING:
    from collections.abc import Iterable

    import xarray

    from .volume import Source


class CellState(enum.IntEnum):
    """The state of a cell. Only `value` has a value.

    >>> CellState(0).name
    'not_seen'
    """

    not_seen = 0
    no_echo = 1
    range_folded = 2
    value = 3
    ambiguous = 5


class _Handle:
    def __init__(self, pointer):
        self.pointer = pointer
        weakref.finalize(self, _library.free_grid, pointer)


class Grid:
    """A grid of one moment, on a plane about its center (azimuthal equidistant on WGS84).

    `moment`, `unit`, `spacing_m`, `center` (latitude and longitude in degrees), `time` (start of the volume), `start`
    and `end` (of the radials used) describe it. `x_m`, `y_m` and `levels_m` are the places of the cells: meters to the
    east and to the north of the center, and above mean sea level.

    >>> grid = stormcellar.grid(FILE, columns=100, rows=80, spacing_m=2000, levels_m=[1000, 2500])
    >>> grid
    <Grid REF, 100 x 80 x 2 cells of 2000 m>
    >>> int(grid.x_m[0]), int(grid.y_m[-1]), grid.unit
    (-99000, 79000, 'dBZ')
    """

    moment: str
    unit: str
    shape: tuple[int, int, int]
    spacing_m: float
    center: tuple[float, float]
    time: np.datetime64
    start: np.datetime64
    end: np.datetime64
    x_m: npt.NDArray[np.float64]
    y_m: npt.NDArray[np.float64]
    levels_m: npt.NDArray[np.float64]

    def __init__(self, pointer: ctypes.c_void_p):
        self._handle = _Handle(pointer)
        facts = sized(_library.GridFacts)
        call("grid_describe", pointer, ctypes.byref(facts))
        self.moment, self.unit = facts.moment.decode(), facts.unit.decode()
        self.shape = (facts.levels, facts.rows, facts.columns)
        self.spacing_m = facts.spacing_m
        self.center = (facts.center_latitude_deg, facts.center_longitude_deg)
        self.time, self.start, self.end = (np.datetime64(time, "ms")
                                           for time in (facts.time_ms, facts.start_ms, facts.end_ms))
        self.x_m, self.y_m = (self.spacing_m * (np.arange(count) - (count - 1) / 2) for count in self.shape[:0:-1])
        self.levels_m = self._array("grid_levels", ctypes.c_double, (facts.levels,))
        columns_first = (facts.rows, facts.columns, facts.levels)
        self._values = self._array("grid_values", ctypes.c_float, columns_first)
        self._states = self._array("grid_states", ctypes.c_uint8, columns_first)

    def _array(self, name, kind, shape):
        pointer = ctypes.POINTER(kind)()
        call(name, self._handle.pointer, ctypes.byref(pointer))
        memory = (kind * int(np.prod(shape))).from_address(ctypes.addressof(pointer.contents))
        memory._handle = self._handle
        array = np.frombuffer(memory, kind).reshape(shape)
        array.flags.writeable = False
        return array

    def values(self) -> npt.NDArray[np.float32]:
        """Returns the values, float32, shape (levels, rows, columns), from the bottom, the south and the west. Cells
        without a value are NaN; states() says why.

        >>> stormcellar.grid(FILE, columns=100, rows=80, levels_m=[1000, 2500]).values().shape
        (2, 80, 100)
        """
        return np.where(self._states == CellState.value, self._values, np.float32(np.nan)).transpose(2, 0, 1)

    def states(self) -> npt.NDArray[np.uint8]:
        """Returns the states of the cells (CellState), uint8, in the same shape: a view that cannot be written.

        >>> states = stormcellar.grid(FILE, columns=100, rows=80, levels_m=[20000]).states()
        >>> {CellState(int(state)).name for state in np.unique(states)} <= {"not_seen", "no_echo", "value"}
        True
        """
        return self._states.transpose(2, 0, 1)

    def to_dataset(self) -> xarray.Dataset:
        """Returns the grid as an xarray.Dataset with the variables MOMENT and MOMENT_status, and dimensions z, y, x
        in meters. Needs xarray.

        >>> dataset = stormcellar.grid(FILE, columns=100, rows=80, levels_m=[1000]).to_dataset()
        >>> dict(dataset["REF"].sizes)
        {'z': 1, 'y': 80, 'x': 100}
        """
        import xarray as xr

        dimensions = ("z", "y", "x")
        states = {"long_name": f"State of the cells of {self.moment}",
                  "flag_values": np.array([int(state) for state in CellState], "u1"),
                  "flag_meanings": " ".join(state.name for state in CellState)}
        plane = {"units": "m", "standard_name": "projection_x_coordinate"}
        return xr.Dataset(
            {self.moment: (dimensions, self.values(), {"units": self.unit, "grid_mapping": "crs"}),
             f"{self.moment}_status": (dimensions, self.states(), states),
             "crs": ((), 0, {"grid_mapping_name": "azimuthal_equidistant",
                             "latitude_of_projection_origin": self.center[0],
                             "longitude_of_projection_origin": self.center[1]})},
            coords={"z": ("z", self.levels_m, {"units": "m", "standard_name": "altitude", "positive": "up"}),
                    "y": ("y", self.y_m, plane | {"standard_name": "projection_y_coordinate"}),
                    "x": ("x", self.x_m, plane), "time": ((), self.time.astype("datetime64[ns]"))})

    def __repr__(self) -> str:
        return f"<Grid {self.moment}, {self.shape[2]} x {self.shape[1]} x {self.shape[0]} cells of {self.spacing_m:g} m>"


def grid(source: Volume | Source, moment: str = "REF", *, columns: int = 0, rows: int = 0, spacing_m: float = 0.0,
         levels_m: npt.ArrayLike | None = None, center: tuple[float, float] | None = None,
         interpolation: str | None = None, mean_of_cell: bool = False, average_in_z: bool = False, threads: int = 1,
         **options: typing.Any) -> Grid:
    """Grids a volume, or a file with the `options` of Volume, and returns a Grid.

    Defaults are those of the command line: 460 x 460 columns of 1 km about the radar, 32 levels from 0.5 to 16 km.
    `center`: latitude and longitude in degrees. `interpolation`: nearest, linear (default), eight-point or
    beam-weighted. `mean_of_cell`: the mean over each cell instead of a point. `average_in_z`: means of reflectivity in
    Z. The errors of each choice are measured in docs/accuracy.md: the default differs from the exact chain by 1.0 to
    1.5 dB rms in weather. Raises Error, also for a moment that the volume does not have.

    >>> stormcellar.grid(FILE, "VEL", columns=100, rows=100, center=(35.33, -97.49))
    <Grid VEL, 100 x 100 x 32 cells of 1000 m>
    """
    volume = source if isinstance(source, Volume) else Volume(source, moments=moment, threads=threads, **options)
    asked = _options(moment, columns, rows, spacing_m, levels_m, center, interpolation, mean_of_cell, average_in_z,
                     threads)
    pointer = ctypes.c_void_p()
    call("grid_make", volume._handle.pointer, ctypes.byref(asked), ctypes.byref(pointer))
    return Grid(pointer)


def mosaic(sources: Iterable[Grid | Volume | Source], moment: str = "REF", *, columns: int = 0, rows: int = 0,
           spacing_m: float = 0.0, levels_m: npt.ArrayLike | None = None, center: tuple[float, float] | None = None,
           interpolation: str | None = None, mean_of_cell: bool = False, average_in_z: bool = False, threads: int = 1,
           overlap: str | None = None, length_m: float = 0.0, **options: typing.Any) -> Grid:
    """Merges volumes or files of several radars, or of several times, and returns a Grid for one instant, the middle of
    the newest volumes, with the cells of `stormcellar grid FILE FILE`. Without `columns` and `rows`, the grid reaches
    230 km beyond the radars.

    `overlap`: mean, maximum, nearest or distance-weighted (where the moment allows it, the default: a radar at the
    distance r has the weight exp(-r^2 / length_m^2), by default with 250 km). The other arguments are those of grid().

    If `sources` are Grids of different radars with the same moment and the same cells, they are merged as they are:
    echo does not move to a common time, and arguments other than `overlap` and `length_m` do not count. Values are then
    rounded to 0.5 dBZ, or as the cache rounds the moment.

    >>> stormcellar.mosaic([FILE], columns=100, rows=80, levels_m=[1000])
    <Grid REF, 100 x 80 x 1 cells of 1000 m>
    """
    sources = list(sources)
    rule = sized(_library.MosaicOptions, overlap=overlap.encode() if overlap else None, length_m=length_m)
    pointer = ctypes.c_void_p()
    if sources and all(isinstance(source, Grid) for source in sources):
        call("grid_merge", _pointers(sources), len(sources), ctypes.byref(rule), ctypes.byref(pointer))
        return Grid(pointer)
    volumes = [source if isinstance(source, Volume) else Volume(source, moments=moment, threads=threads, **options)
               for source in sources]
    asked = _options(moment, columns, rows, spacing_m, levels_m, center, interpolation, mean_of_cell, average_in_z,
                     threads)
    call("mosaic_make", _pointers(volumes), len(volumes), ctypes.byref(asked), ctypes.byref(rule),
         ctypes.byref(pointer))
    return Grid(pointer)


def _pointers(objects):
    return (ctypes.c_void_p * len(objects))(*(one._handle.pointer.value for one in objects))


def _options(moment, columns, rows, spacing_m, levels_m, center, interpolation, mean_of_cell, average_in_z, threads):
    heights = np.ascontiguousarray([] if levels_m is None else levels_m, "f8")
    asked = sized(_library.GridOptions, moment=moment.encode(), columns=columns, rows=rows, spacing_m=spacing_m,
                  levels_m=heights.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) if heights.size else None,
                  level_count=heights.size, has_center=center is not None,
                  interpolation=interpolation.encode() if interpolation else None, mean_of_cell=mean_of_cell,
                  average_in_z=average_in_z, threads=threads)
    if center is not None:
        asked.center_latitude_deg, asked.center_longitude_deg = center
    return asked
