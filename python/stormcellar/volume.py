"""Volumes, sweeps and moments as NumPy arrays.

Units: degrees, meters, m/s, times as datetime64[ms] in UTC, values in the unit of the moment. Heights are above mean
sea level. An unknown number is NaN, an unknown time NaT.
"""

from __future__ import annotations

import ctypes
import enum
import os
import typing

import numpy as np
import numpy.typing as npt

from . import _library, sources
from ._library import Error, Handle, call, sized

if typing.TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import pyart.core

    Words = typing.Union[str, Iterable[str]]
    File = typing.Union[str, os.PathLike, bytes, typing.BinaryIO]
    Source = typing.Union[File, Sequence[File]]


class State(enum.IntEnum):
    """The state of a gate. Only `value` has a value.

    >>> State(2).name
    'range_folded'
    """

    value = 0
    below_threshold = 1
    range_folded = 2
    no_data = 3
    ambiguous = 4


_RADIAL = np.dtype([("time", "datetime64[ms]"), ("azimuth_deg", "f4"), ("elevation_deg", "f4"), ("nyquist_mps", "f4"),
                    ("unambiguous_range_m", "f4"), ("status", "i4"), ("azimuth_number", "i4")])


class Moment:
    """One moment of a sweep: rows of gates, one row for each radial, in the order of arrival.

    `name`, `unit`, `first_gate_m` (slant range to the center of the first gate), `gate_spacing_m`, `scale`, `offset`
    and `first_valid_code` are as in the file: value = (code - offset) / scale, or the code if the scale is 0. The
    values are in single precision. Source: ICD 2620002.

    >>> moment = stormcellar.Volume(FILE).sweeps[0].moments["REF"]
    >>> moment
    <Moment REF, 367 x 460 gates of 1000 m>
    >>> moment.scale, moment.offset, moment.unit
    (2.0, 66.0, 'dBZ')
    """

    name: str
    unit: str
    first_gate_m: int
    gate_spacing_m: int
    scale: float
    offset: float
    first_valid_code: int
    shape: tuple[int, int]

    def __init__(self, handle: Handle, sweep: int, number: int, radials: int):
        facts = sized(_library.MomentFacts)
        call("moment_describe", handle.pointer, sweep, number, ctypes.byref(facts))
        self._handle, self._sweep, self._number = handle, sweep, number
        self.name, self.unit = facts.name.decode(), facts.unit.decode()
        self.first_gate_m, self.gate_spacing_m = facts.first_gate_m, facts.gate_spacing_m
        self.scale, self.offset, self.first_valid_code = facts.scale, facts.offset, facts.first_valid_code
        self.shape = (radials, facts.gates)
        self._dtype = np.dtype("u1" if facts.code_bytes == 1 else "u2")

    @property
    def ranges_m(self) -> npt.NDArray[np.float32]:
        """Slant ranges to the centers of the gates in meters, shape (gates,).

        >>> [int(range_m) for range_m in stormcellar.Volume(FILE).sweeps[1].moments["VEL"].ranges_m[:3]]
        [-375, -125, 125]
        """
        return self.first_gate_m + self.gate_spacing_m * np.arange(self.shape[1], dtype="f4")

    def codes(self) -> npt.NDArray[typing.Any]:
        """Returns the codes of the file, shape (radials, gates), uint8 or uint16: a view that cannot be written and
        keeps the volume alive.

        >>> int(stormcellar.Volume(FILE).sweeps[0].moments["REF"].codes().max())
        191
        """
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

    def values(self) -> npt.NDArray[np.float32]:
        """Returns the values, float32, shape (radials, gates). Gates without a value are NaN; states() says why.

        >>> float(np.nanmax(stormcellar.Volume(FILE).sweeps[0].moments["REF"].values()))
        62.5
        """
        values = np.empty(self.shape, "f4")
        call("moment_values", self._handle.pointer, self._sweep, self._number, values.ctypes.data, values.size)
        return values

    def states(self) -> npt.NDArray[np.uint8]:
        """Returns the states of the gates (State), uint8, shape (radials, gates).

        >>> moment = stormcellar.Volume(FILE).sweeps[1].moments["VEL"]
        >>> [State(int(state)).name for state in np.unique(moment.states())]
        ['value', 'below_threshold', 'range_folded']
        """
        states = np.empty(self.shape, "u1")
        call("moment_states", self._handle.pointer, self._sweep, self._number, states.ctypes.data, states.size)
        return states

    def __repr__(self) -> str:
        return f"<Moment {self.name}, {self.shape[0]} x {self.shape[1]} gates of {self.gate_spacing_m} m>"


class Sweep:
    """One sweep: `elevation_deg` (the mean of its radials), `fixed_angle_deg` (of the pattern), `elevation_number`
    (the cut of the pattern, from 1), `radials` (a structured array, one row for each radial in the order of arrival:
    time, azimuth_deg, elevation_deg, nyquist_mps, unambiguous_range_m, status, azimuth_number) and `moments`, by name.

    If radials of a sweep differ in their gates, `moments` has the gates of the first kind, and `kinds` has all kinds.

    >>> sweep = stormcellar.Volume(FILE).sweeps[1]
    >>> sweep
    <Sweep 1, 0.5 degrees, 367 radials: VEL SW>
    >>> print(sweep.radials["time"][0], round(float(sweep.radials["nyquist_mps"][0]), 1))
    1999-05-03T23:56:41.262 26.1
    """

    number: int
    elevation_deg: float
    fixed_angle_deg: float
    elevation_number: int
    radials: npt.NDArray[typing.Any]
    moments: dict[str, Moment]
    kinds: list[Moment]

    def __init__(self, handle: Handle, number: int):
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

    def __repr__(self) -> str:
        return f"<Sweep {self.number}, {self.elevation_deg:.1f} degrees, {len(self.radials)} radials: " \
               f"{' '.join(self.moments)}>"


class Volume:
    """A volume of a Level II file of any year, compressed or not.

    `source` is a path, bytes, an open file (read from its position), a list of chunks (sources.joined), or a station
    with `time`. For a station, the last volume that began before the time is fetched from the public bucket, or from
    the address `bucket`, and a line is logged (sources.fetched). `moments` ("REF VEL", or a list) leaves out all
    other moments. `volume` is the number in a file of several volumes, from 1. Raises Error for a file that cannot be
    read; a damaged file gives what is whole, and `problems` says what is lost or unusual.

    `station`, `latitude_deg`, `longitude_deg`, `altitude_m` (of the antenna), `start` (datetime64[ms]), `vcp` (None if
    unknown), `complete`, `problems` (a list of lines), `volumes` (how many the file has) and `sweeps` describe it.

    >>> volume = stormcellar.Volume(FILE)
    >>> volume
    <Volume KTLX 1999-05-03T23:56:21.000, 16 sweeps>
    >>> volume.vcp, volume.complete, volume.problems
    (11, True, ['the radar reports: on auxiliary power'])
    >>> stormcellar.Volume(b"no radar data")
    Traceback (most recent call last):
    stormcellar._library.Error: ...
    """

    station: str
    latitude_deg: float
    longitude_deg: float
    altitude_m: float
    start: np.datetime64
    vcp: int | None
    complete: bool
    volumes: int
    sweeps: list[Sweep]
    problems: list[str]

    def __init__(self, source: Source, *, moments: Words | None = None, threads: int = 1, volume: int = 0,
                 station: str | None = None, time: typing.Any = None, bucket: str = sources.BUCKET):
        if time is not None:
            station = station or str(source).upper()
            source = sources.fetched(str(source), time, bucket)
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
        self._handle = Handle("volume", pointer)
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

    def derive(self, moments: Words, *, dealias: str | None = None, storm_motion: str | None = None,
               quality: float = 0.0) -> Volume:
        """Returns a copy of the volume with derived moments: "VELD" (dealiased velocity), "SRV" (storm-relative
        velocity), "AZSH" (azimuthal shear), "DIVG" (divergence), "POW" (probability of weather), "KDP" (specific
        differential phase), "RATE" (rain rate), "HCA" (classes of hydrometeors).

        `dealias`: auto, off, profile, region or anchored. `storm_motion`, for SRV: auto, right, left, mean, or
        "240/15", from 240 degrees at 15 m/s. `quality`: leaves out gates whose probability of weather is less.
        Accuracy: docs/velocity.md, docs/quality.md, docs/storms.md. Raises Error if the volume lacks what is needed.

        >>> stormcellar.Volume(FILE).derive("VELD").sweeps[1]
        <Sweep 1, 0.5 degrees, 367 radials: VEL SW VELD>
        """
        options = sized(_library.DeriveOptions, dealias=dealias.encode() if dealias else None,
                        storm_motion=storm_motion.encode() if storm_motion else None, quality=quality)
        pointer = ctypes.c_void_p()
        call("volume_derive", self._handle.pointer, _words(moments), ctypes.byref(options), ctypes.byref(pointer))
        derived = Volume.__new__(Volume)
        derived._take(pointer)
        there = {name for sweep in derived.sweeps for name in sweep.moments}
        for name in _words(moments).decode().split():
            if name not in there:
                raise Error(f"{name} cannot be derived: the volume lacks the moments that it needs", "not_found")
        return derived

    def to_pyart(self) -> pyart.core.Radar:
        """Returns the volume as a pyart.core.Radar (pyart_radar.to_pyart). Needs Py-ART.

        >>> radar = stormcellar.Volume(FILE).to_pyart()
        >>> radar.nsweeps, sorted(radar.fields)
        (16, ['reflectivity', 'spectrum_width', 'velocity'])
        """
        from .pyart_radar import to_pyart

        return to_pyart(self)

    def __repr__(self) -> str:
        return f"<Volume {self.station} {self.start}, {len(self.sweeps)} sweeps>"


def volume_of(function, source, options, **own):
    """Returns the volume of a source for a function of the package. `options` are further arguments for Volume; `own`
    are those of the function. Raises TypeError for an option that Volume does not have, and for any option if the
    source is a Volume, because it was already read."""
    unknown = set(options) - set(Volume.__init__.__kwdefaults__)
    if unknown:
        raise TypeError(f"{function}() got an unexpected keyword argument '{min(unknown)}'")
    if not isinstance(source, Volume):
        return Volume(source, **own, **options)
    if options:
        raise TypeError(f"{function}() takes '{min(options)}' only with a source that is not yet a Volume")
    return source


def fixed_angle(sweep: Sweep) -> float:
    """Returns the angle of the pattern in degrees, or the mean of the radials if the file has none.

    >>> round(fixed_angle(stormcellar.Volume(FILE).sweeps[0]), 1)
    0.5
    """
    return sweep.elevation_deg if np.isnan(sweep.fixed_angle_deg) else sweep.fixed_angle_deg


def _words(names):
    """Returns names as the library reads them: between blanks."""
    if names is None:
        return None
    return (names if isinstance(names, str) else " ".join(names)).encode()
