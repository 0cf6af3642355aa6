"""The functions of libstormcellar.so.0 (include/stormcellar.h) by ctypes."""

from __future__ import annotations

import ctypes
import os
import pathlib
import weakref
from ctypes import POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int, c_int32, c_int64, c_size_t, c_uint64, c_void_p

# The names of stormcellar_code, in the order of the header.
CODES = ("ok", "bad_argument", "not_found", "empty", "truncated", "corrupt", "unsupported", "not_level2", "not_a_file",
         "io", "exhausted", "busy", "no_space", "over_budget", "unmet", "permission", "internal")


class Error(Exception):
    """A failure of the library: one line for people, and `code`, a name of CODES, for programs.

    >>> try:
    ...     stormcellar.Volume("/nothing/here")
    ... except stormcellar.Error as error:
    ...     print(error.code)
    not_found
    """

    code: str

    def __init__(self, message: str, code: str):
        super().__init__(message)
        self.code = code


class ErrorStruct(Structure):
    _fields_ = [("code", c_int32), ("message", c_char * 1020)]


class ReadOptions(Structure):
    _fields_ = [("size", c_size_t), ("threads", c_int32), ("volume", c_int32), ("moments", c_char_p),
                ("station", c_char_p)]


class VolumeFacts(Structure):
    _fields_ = [("size", c_size_t), ("station", c_char * 8), ("latitude_deg", c_double), ("longitude_deg", c_double),
                ("altitude_m", c_double), ("start_ms", c_int64), ("vcp", c_int32), ("sweeps", c_int32),
                ("complete", c_int32), ("volumes", c_int32), ("problems", c_int32)]


class SweepFacts(Structure):
    _fields_ = [("size", c_size_t), ("elevation_deg", c_double), ("fixed_angle_deg", c_double),
                ("azimuth_spacing_deg", c_double), ("start_ms", c_int64), ("end_ms", c_int64),
                ("elevation_number", c_int32), ("radials", c_int32), ("moments", c_int32)]


class MomentFacts(Structure):
    _fields_ = [("size", c_size_t), ("name", c_char * 8), ("unit", c_char * 16), ("gates", c_int32),
                ("first_gate_m", c_int32), ("gate_spacing_m", c_int32), ("code_bytes", c_int32),
                ("first_valid_code", c_int32), ("scale", c_float), ("offset", c_float)]


class DeriveOptions(Structure):
    _fields_ = [("size", c_size_t), ("dealias", c_char_p), ("storm_motion", c_char_p), ("quality", c_double)]


class GridOptions(Structure):
    _fields_ = [("size", c_size_t), ("moment", c_char_p), ("columns", c_int32), ("rows", c_int32),
                ("spacing_m", c_double), ("levels_m", POINTER(c_double)), ("level_count", c_int32),
                ("has_center", c_int32), ("center_latitude_deg", c_double), ("center_longitude_deg", c_double),
                ("interpolation", c_char_p), ("mean_of_cell", c_int32), ("average_in_z", c_int32), ("threads", c_int32)]


class MosaicOptions(Structure):
    _fields_ = [("size", c_size_t), ("overlap", c_char_p), ("length_m", c_double)]


class LadderOptions(Structure):
    _fields_ = [("size", c_size_t), ("columns", c_int32), ("rounds", c_int32)]


class Rung(Structure):
    _fields_ = [("size", c_size_t), ("step", c_char_p), ("name", c_char_p), ("value_unit", c_char * 16),
                ("rung", c_int32), ("pareto", c_int32), ("time_s", c_double), ("kept_time_s", c_double),
                ("position_max_m", c_double), ("position_rms_m", c_double), ("value_rms", c_double),
                ("value_p95", c_double), ("value_p99", c_double), ("value_max", c_double),
                ("status_disagreement", c_double)]


class DrawOptions(Structure):
    _fields_ = [("size", c_size_t), ("product", c_char_p), ("moment", c_char_p), ("width", c_int32),
                ("height", c_int32), ("settings", POINTER(c_char_p)), ("setting_count", c_int32), ("format", c_int32),
                ("threads", c_int32)]


class PictureFacts(Structure):
    _fields_ = [("size", c_size_t), ("width", c_int32), ("height", c_int32), ("bytes", c_size_t)]


class GridFacts(Structure):
    _fields_ = [("size", c_size_t), ("moment", c_char * 8), ("unit", c_char * 16), ("columns", c_int32),
                ("rows", c_int32), ("levels", c_int32), ("mean_of_cell", c_int32), ("spacing_m", c_double),
                ("center_latitude_deg", c_double), ("center_longitude_deg", c_double), ("time_ms", c_int64),
                ("start_ms", c_int64), ("end_ms", c_int64), ("projection", c_char * 24), ("spacing_deg", c_double),
                ("parallels_deg", c_double * 2), ("offset_x_cells", c_double), ("offset_y_cells", c_double)]


class Query(Structure):
    _fields_ = [("size", c_size_t), ("name", c_char_p), ("moment", c_char_p), ("from_ms", c_int64), ("to_ms", c_int64)]


class FileFacts(Structure):
    _fields_ = [("size", c_size_t), ("path", c_char_p), ("reason", c_char_p), ("station", c_char * 8),
                ("state", c_char * 16), ("start_ms", c_int64), ("end_ms", c_int64), ("bytes", c_uint64),
                ("volume", c_int32), ("vcp", c_int32), ("sweeps", c_int32), ("radials", c_int32),
                ("complete", c_int32)]


class GridFileFacts(Structure):
    _fields_ = [("size", c_size_t), ("path", c_char_p), ("domain", c_char_p), ("moment", c_char * 8),
                ("time_ms", c_int64), ("bytes", c_uint64)]


def sized(kind, **values):
    """Returns a struct whose first member is its size."""
    return kind(size=ctypes.sizeof(kind), **values)


def _load():
    named = os.environ.get("STORMCELLAR_LIBRARY")
    beside = pathlib.Path(__file__).with_name("libstormcellar.so.0")
    return ctypes.CDLL(named or (str(beside) if beside.exists() else "libstormcellar.so.0"))


_library = _load()

# The arguments of each function before the error, which is always last.
_FUNCTIONS = {
    "volume_open": [c_char_p, POINTER(ReadOptions), POINTER(c_void_p)],
    "volume_from_bytes": [c_void_p, c_size_t, POINTER(ReadOptions), POINTER(c_void_p)],
    "volume_from_descriptor": [c_int, POINTER(ReadOptions), POINTER(c_void_p)],
    "volume_describe": [c_void_p, POINTER(VolumeFacts)],
    "volume_problem": [c_void_p, c_int32, c_char_p, c_size_t],
    "volume_derive": [c_void_p, c_char_p, POINTER(DeriveOptions), POINTER(c_void_p)],
    "sweep_describe": [c_void_p, c_int32, POINTER(SweepFacts)],
    "sweep_radials": [c_void_p, c_int32, c_void_p, c_size_t],
    "moment_describe": [c_void_p, c_int32, c_int32, POINTER(MomentFacts)],
    "moment_codes": [c_void_p, c_int32, c_int32, POINTER(c_void_p)],
    "moment_values": [c_void_p, c_int32, c_int32, c_void_p, c_size_t],
    "volume_draw": [c_void_p, POINTER(DrawOptions), POINTER(c_void_p)],
    "picture_describe": [c_void_p, POINTER(PictureFacts)],
    "picture_bytes": [c_void_p, POINTER(c_void_p)],
    "mosaic_make": [c_void_p, c_size_t, POINTER(GridOptions), POINTER(MosaicOptions), POINTER(c_void_p)],
    "moment_states": [c_void_p, c_int32, c_int32, c_void_p, c_size_t],
    "grid_make": [c_void_p, POINTER(GridOptions), POINTER(c_void_p)],
    "grid_describe": [c_void_p, POINTER(GridFacts)],
    "grid_levels": [c_void_p, c_void_p],
    "grid_values": [c_void_p, c_void_p],
    "grid_draw": [c_void_p, POINTER(DrawOptions), POINTER(c_void_p)],
    "grid_merge": [c_void_p, c_size_t, POINTER(MosaicOptions), POINTER(c_void_p)],
    "grid_states": [c_void_p, c_void_p],
    "grid_read": [c_char_p, POINTER(c_void_p)],
    "ladder_measure": [c_void_p, POINTER(GridOptions), POINTER(LadderOptions), POINTER(c_void_p), POINTER(c_size_t)],
    "ladder_describe": [c_void_p, c_size_t, POINTER(Rung)],
    "catalog_open": [c_char_p, POINTER(c_void_p)],
    "catalog_list": [c_void_p, POINTER(Query), POINTER(c_void_p), POINTER(c_size_t)],
    "file_list_describe": [c_void_p, c_size_t, POINTER(FileFacts)],
    "cache_open": [c_char_p, POINTER(c_void_p)],
    "cache_list": [c_void_p, POINTER(Query), POINTER(c_void_p), POINTER(c_size_t)],
    "grid_list_describe": [c_void_p, c_size_t, POINTER(GridFileFacts)],
}
for _name, _arguments in _FUNCTIONS.items():
    _function = getattr(_library, "stormcellar_" + _name)
    _function.argtypes = [*_arguments, POINTER(ErrorStruct)]
    _function.restype = c_int
for _name in ("volume", "grid", "picture", "catalog", "file_list", "cache", "grid_list", "ladder"):
    _function = getattr(_library, f"stormcellar_{_name}_free")
    _function.argtypes = [c_void_p]
    _function.restype = None
_library.stormcellar_version.restype = c_char_p


def call(name, *arguments):
    """Calls stormcellar_NAME. Raises Error if it fails."""
    error = ErrorStruct()
    code = getattr(_library, "stormcellar_" + name)(*arguments, ctypes.byref(error))
    if code != 0:
        raise Error(error.message.decode(errors="replace"), CODES[code] if code < len(CODES) else "internal")


class Handle:
    """Owns an object of the library, a "volume" for example, and frees it when nothing refers to it."""

    def __init__(self, kind, pointer):
        self.pointer = pointer
        weakref.finalize(self, getattr(_library, f"stormcellar_{kind}_free"), pointer)


def version() -> str:
    """Returns the version of the library.

    >>> len(version().split("."))
    3
    """
    return _library.stormcellar_version().decode()
