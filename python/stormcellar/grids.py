"""Grids of volumes as NumPy arrays and xarray datasets."""

from __future__ import annotations

import ctypes
import enum
import typing

import numpy as np
import numpy.typing as npt

from . import _library
from ._library import Handle, call, sized
from .volume import volume_of

if typing.TYPE_CHECKING:
    from collections.abc import Iterable

    import xarray

    from .volume import Source, Volume


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


class Grid:
    """A grid of one moment, about its center on WGS84.

    `moment`, `unit`, `spacing_m`, `center` (latitude and longitude in degrees), `time` (start of the volume, or instant
    of a mosaic), `start` and `end` (of the radials used) describe it. `x_m`, `y_m` and `levels_m` are the places of the
    cells: meters to the east and to the north of the center, and above mean sea level.

    `projection` is azimuthal_equidistant; grids of a cache may also have lambert_conformal (with `parallels_deg`) or
    latitude_longitude, which has `spacing_deg`, `longitudes_deg` and `latitudes_deg` instead of places in meters.
    Places that a grid does not have are NaN.

    >>> grid = stormcellar.grid(FILE, columns=100, rows=80, spacing_m=2000, levels_m=[1000, 2500])
    >>> grid
    <Grid REF, 100 x 80 x 2 cells of 2000 m>
    >>> int(grid.x_m[0]), int(grid.y_m[-1]), grid.unit
    (-99000, 79000, 'dBZ')
    """

    moment: str
    unit: str
    shape: tuple[int, int, int]
    projection: str
    spacing_m: float
    spacing_deg: float
    parallels_deg: tuple[float, float]
    center: tuple[float, float]
    time: np.datetime64
    start: np.datetime64
    end: np.datetime64
    x_m: npt.NDArray[np.float64]
    y_m: npt.NDArray[np.float64]
    longitudes_deg: npt.NDArray[np.float64]
    latitudes_deg: npt.NDArray[np.float64]
    levels_m: npt.NDArray[np.float64]

    def __init__(self, pointer: ctypes.c_void_p):
        self._handle = Handle("grid", pointer)
        facts = sized(_library.GridFacts)
        call("grid_describe", pointer, ctypes.byref(facts))
        self.moment, self.unit = facts.moment.decode(), facts.unit.decode()
        self.shape = (facts.levels, facts.rows, facts.columns)
        self.projection = facts.projection.decode()
        self.spacing_m, self.spacing_deg = facts.spacing_m, facts.spacing_deg
        self.parallels_deg = tuple(facts.parallels_deg)
        self.center = (facts.center_latitude_deg, facts.center_longitude_deg)
        self.time, self.start, self.end = (np.datetime64(time, "ms")
                                           for time in (facts.time_ms, facts.start_ms, facts.end_ms))
        east, north = (np.arange(count) - (count - 1) / 2 + offset for count, offset in
                       ((facts.columns, facts.offset_x_cells), (facts.rows, facts.offset_y_cells)))
        spacing_m, spacing_deg = self.spacing_m or np.nan, self.spacing_deg or np.nan
        self.x_m, self.y_m = spacing_m * east, spacing_m * north
        self.longitudes_deg = self.center[1] + spacing_deg * east
        self.latitudes_deg = self.center[0] + spacing_deg * north
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
        in meters (lat and lon in degrees for a latitude_longitude grid). Needs xarray.

        >>> dataset = stormcellar.grid(FILE, columns=100, rows=80, levels_m=[1000]).to_dataset()
        >>> dict(dataset["REF"].sizes)
        {'z': 1, 'y': 80, 'x': 100}
        """
        import xarray as xr

        return xr.Dataset(self._variables(self.values(), self.states()),
                          coords={**self._coordinates(), "time": ((), self.time.astype("datetime64[ns]"))})

    def _variables(self, values, states, *before):
        """Returns the variables of a dataset with these cells, whose dimensions begin with `before`."""
        in_degrees = self.projection == "latitude_longitude"
        dimensions = (*before, "z", "lat", "lon") if in_degrees else (*before, "z", "y", "x")
        flags = {"long_name": f"State of the cells of {self.moment}",
                 "flag_values": np.array([int(state) for state in CellState], "u1"),
                 "flag_meanings": " ".join(state.name for state in CellState)}
        origin = {"latitude_of_projection_origin": self.center[0]}
        mappings = {"latitude_longitude": {},
                    "lambert_conformal": origin | {"longitude_of_central_meridian": self.center[1],
                                                   "standard_parallel": self.parallels_deg},
                    "azimuthal_equidistant": origin | {"longitude_of_projection_origin": self.center[1]}}
        name = self.projection + ("_conic" if self.projection == "lambert_conformal" else "")
        return {self.moment: (dimensions, values, {"units": self.unit, "grid_mapping": "crs"}),
                f"{self.moment}_status": (dimensions, states, flags),
                "crs": ((), 0, {"grid_mapping_name": name} | mappings[self.projection])}

    def _coordinates(self):
        height = {"z": ("z", self.levels_m, {"units": "m", "standard_name": "altitude", "positive": "up"})}
        if self.projection == "latitude_longitude":
            return height | {
                "lat": ("lat", self.latitudes_deg, {"units": "degrees_north", "standard_name": "latitude"}),
                "lon": ("lon", self.longitudes_deg, {"units": "degrees_east", "standard_name": "longitude"})}
        return height | {"y": ("y", self.y_m, {"units": "m", "standard_name": "projection_y_coordinate"}),
                         "x": ("x", self.x_m, {"units": "m", "standard_name": "projection_x_coordinate"})}

    def __repr__(self) -> str:
        return f"<Grid {self.moment}, {self.shape[2]} x {self.shape[1]} x {self.shape[0]} cells of " \
               f"{self.spacing_m or self.spacing_deg:g} {'m' if self.spacing_m else 'degrees'}>"


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
    volume = volume_of("grid", source, options, moments=moment, threads=threads)
    asked = grid_options(moment, columns, rows, spacing_m, levels_m, center, interpolation, mean_of_cell, average_in_z,
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

    `overlap`: mean, maximum, nearest or distance-weighted, the default where the moment allows it: a radar at the
    distance r has the weight exp(-r^2 / length_m^2), by default with 250 km. The other arguments are those of grid().

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
    volumes = [volume_of("mosaic", source, options, moments=moment, threads=threads) for source in sources]
    asked = grid_options(moment, columns, rows, spacing_m, levels_m, center, interpolation, mean_of_cell, average_in_z,
                     threads)
    call("mosaic_make", _pointers(volumes), len(volumes), ctypes.byref(asked), ctypes.byref(rule),
         ctypes.byref(pointer))
    return Grid(pointer)


def _pointers(objects):
    return (ctypes.c_void_p * len(objects))(*(one._handle.pointer.value for one in objects))


def grid_options(moment, columns, rows, spacing_m, levels_m, center, interpolation, mean_of_cell, average_in_z,
                 threads):
    heights = np.ascontiguousarray([] if levels_m is None else levels_m, "f8")
    asked = sized(_library.GridOptions, moment=moment.encode(), columns=columns, rows=rows, spacing_m=spacing_m,
                  levels_m=heights.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) if heights.size else None,
                  level_count=heights.size, has_center=center is not None,
                  interpolation=interpolation.encode() if interpolation else None, mean_of_cell=mean_of_cell,
                  average_in_z=average_in_z, threads=threads)
    if center is not None:
        asked.center_latitude_deg, asked.center_longitude_deg = center
    return asked
