"""Volumes, sweeps and moments as NumPy arrays.

Units: degrees, meters, m/s, times as datetime64[ms] in UTC, values in the unit of the moment. Heights are above mean
sea level. An unknown number is NaN, an unknown time NaT.
"""

import ctypes
import enum
import os
import weakref

import numpy as np

from . import _library, sources
from ._library import call, sized


class State(enum.IntEnum):
    """The state of a gate. Only `value` has a value."""

    value = 0
    below_threshold = 1
    range_folded = 2
    no_data = 3
    ambiguous = 4


_RADIAL = np.dtype([("time", "datetime64[ms]"), ("azimuth_deg", "f4"), ("elevation_deg", "f4"), ("nyquist_mps", "f4"),
                    ("unambiguous_range_m", "f4"), ("status", "i4"), ("azimuth_number", "i4")])


class _Handle:
    """Owns a volume of the library, and frees it when nothing refers to it."""

    def __init__(self, pointer):
        self.pointer = pointer
        weakref.finalize(self, _library.free_volume, pointer)


class Moment:
    """One moment of a sweep: rows of gates, one row for each radial, in the order of arrival.

    `name`, `unit`, `first_gate_m` (slant range to the center of the first gate), `gate_spacing_m`, `scale`, `offset`
    and `first_valid_code` are as in the file: value = (code - offset) / scale, or the code if the scale is 0. The
    values are in single precision. Source: ICD 2620002.
    """

    def __init__(self, handle, sweep, number, radials):
        facts = sized(_library.MomentFacts)
        call("moment_describe", handle.pointer, sweep, number, ctypes.byref(facts))
        self._handle, self._sweep, self._number = handle, sweep, number
        self.name, self.unit = facts.name.decode(), facts.unit.decode()
        self.first_gate_m, self.gate_spacing_m = facts.first_gate_m, facts.gate_spacing_m
        self.scale, self.offset, self.first_valid_code = facts.scale, facts.offset, facts.first_valid_code
        self.shape = (radials, facts.gates)
        self._dtype = np.dtype("u1" if facts.code_bytes == 1 else "u2")

    @property
    def ranges_m(self):
        """Slant ranges to the centers of the gates, shape (gates,)."""
        return self.first_gate_m + self.gate_spacing_m * np.arange(self.shape[1], dtype="f4")

    def codes(self):
        """Returns the codes of the file, shape (radials, gates), uint8 or uint16: a view that cannot be written and
        keeps the volume alive."""
        pointer = ctypes.c_void_p()
        call("moment_codes", self._handle.pointer, self._sweep, self._number, ctypes.byref(pointer))
        size = self.shape[0] * self.shape[1] * self._dtype.itemsize
        if size == 0:
            return np.empty(self.shape, self._dtype)
        memory = (ctypes.c_ubyte * size).from_address(pointer.value)
        memory._handle = self._handle
        codes = np.frombuffer(memory, self._dtype).reshape(self.shape)
        codes.flags.writeable = False
        return codes

    def values(self):
        """Returns the values, float32, shape (radials, gates). Gates without a value are NaN; states() says why."""
        values = np.empty(self.shape, "f4")
        call("moment_values", self._handle.pointer, self._sweep, self._number, values.ctypes.data, values.size)
        return values

    def states(self):
        """Returns the states of the gates (State), uint8, shape (radials, gates)."""
        states = np.empty(self.shape, "u1")
        call("moment_states", self._handle.pointer, self._sweep, self._number, states.ctypes.data, states.size)
        return states

    def __repr__(self):
        return f"<Moment {self.name}, {self.shape[0]} x {self.shape[1]} gates of {self.gate_spacing_m} m>"


class Sweep:
    """One sweep: `elevation_deg` (the mean of its radials), `fixed_angle_deg` (of the pattern), `elevation_number`
    (the cut of the pattern, from 1), `radials` (a structured array, one row for each radial in the order of arrival:
    time, azimuth_deg, elevation_deg, nyquist_mps, unambiguous_range_m, status, azimuth_number) and `moments`, by name.

    If radials of a sweep differ in their gates, `moments` has the gates of the first kind, and `kinds` has all kinds.
    """

    def __init__(self, handle, number):
        facts = sized(_library.SweepFacts)
        call("sweep_describe", handle.pointer, number, ctypes.byref(facts))
        self.number = number
        self.elevation_deg, self.fixed_angle_deg = facts.elevation_deg, facts.fixed_angle_deg
        self.elevation_number = facts.elevation_number
        self.radials = np.empty(facts.radials, _RADIAL)
        call("sweep_radials", handle.pointer, number, self.radials.ctypes.data, self.radials.size)
        self.kinds = [Moment(handle, number, i, facts.radials) for i in range(facts.moments)]
        self.moments = {}
        for moment in self.kinds:
            self.moments.setdefault(moment.name, moment)

    def __repr__(self):
        return f"<Sweep {self.number}, {self.elevation_deg:.1f} degrees, {len(self.radials)} radials: " \
               f"{' '.join(self.moments)}>"


class Volume:
    """A volume of a Level II file of any year, compressed or not.

    `source` is a path, bytes, an open file, which is read from its position, a list of chunks (sources.joined), or with
    `time` a station: then the volume that it began last before the time is fetched from the public bucket, or from
    the address `bucket`, and a line is logged (sources.fetched). `moments` ("REF VEL", or a list) leaves out all
    others. `volume` is the number in a file of several volumes, from 1. Raises Error for a file that cannot be read; a
    damaged file gives what is whole, and `problems` says what is lost.

    `station`, `latitude_deg`, `longitude_deg`, `altitude_m` (of the antenna), `start` (datetime64[ms]), `vcp` (None if
    unknown), `complete`, `problems` (a list of lines), `volumes` (how many the file has) and `sweeps` describe it.
    """

    def __init__(self, source, *, moments=None, threads=1, volume=0, station=None, time=None, bucket=sources.BUCKET):
        if time is not None:
            source, station = sources.fetched(source, time, bucket), station or source.upper()
        elif isinstance(source, (list, tuple)):
            source = sources.joined(source)
        options = sized(_library.ReadOptions, threads=threads, volume=volume, moments=_words(moments),
                        station=station.encode() if station else None)
        pointer = ctypes.c_void_p()
        if isinstance(source, (str, os.PathLike)):
            call("volume_open", os.fsencode(source), ctypes.byref(options), ctypes.byref(pointer))
        else:
            data = np.frombuffer(source.read() if hasattr(source, "read") else source, "u1")
            call("volume_from_bytes", data.ctypes.data, data.size, ctypes.byref(options), ctypes.byref(pointer))
        self._take(pointer)

    def _take(self, pointer):
        self._handle = _Handle(pointer)
        facts = sized(_library.VolumeFacts)
        call("volume_describe", pointer, ctypes.byref(facts))
        self.station = facts.station.decode()
        self.latitude_deg, self.longitude_deg = facts.latitude_deg, facts.longitude_deg
        self.altitude_m = facts.altitude_m
        self.start = np.datetime64(facts.start_ms, "ms")  # the unknown time of the library is NaT
        self.vcp = facts.vcp if facts.vcp >= 0 else None
        self.complete = bool(facts.complete)
        self.volumes = facts.volumes
        self.sweeps = [Sweep(self._handle, i) for i in range(facts.sweeps)]
        self.problems = [self._problem(i) for i in range(facts.problems)]

    def _problem(self, number):
        text = ctypes.create_string_buffer(1024)
        call("volume_problem", self._handle.pointer, number, text, len(text))
        return text.value.decode(errors="replace")

    def derive(self, moments, *, dealias=None, storm_motion=None, quality=0.0):
        """Returns a copy of the volume with derived moments: "VELD" (dealiased velocity), "SRV" (storm-relative
        velocity), "AZSH" (azimuthal shear), "DIVG" (divergence), "POW" (probability of weather), "KDP" (specific
        differential phase), "RATE" (rain rate), "HCA" (classes of hydrometeors).

        `dealias`: auto, off, profile, region or anchored. `storm_motion`, for SRV: auto, right, left, mean, or
        "240/15", from 240 degrees at 15 m/s. `quality`: leaves out gates whose probability of weather is less.
        Accuracy: docs/velocity.md, docs/quality.md, docs/storms.md. Raises Error if the volume lacks what is needed.
        """
        options = sized(_library.DeriveOptions, dealias=dealias.encode() if dealias else None,
                        storm_motion=storm_motion.encode() if storm_motion else None, quality=quality)
        pointer = ctypes.c_void_p()
        call("volume_derive", self._handle.pointer, _words(moments), ctypes.byref(options), ctypes.byref(pointer))
        derived = Volume.__new__(Volume)
        derived._take(pointer)
        return derived

    def to_pyart(self):
        """Returns the volume as a pyart.core.Radar (pyart_radar.to_pyart)."""
        from .pyart_radar import to_pyart

        return to_pyart(self)

    def __repr__(self):
        return f"<Volume {self.station} {self.start}, {len(self.sweeps)} sweeps>"


def _words(names):
    """Returns names as the library reads them: between blanks."""
    if names is None:
        return None
    return (names if isinstance(names, str) else " ".join(names)).encode()
