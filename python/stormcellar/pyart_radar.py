"""Volumes as radars of Py-ART."""

from __future__ import annotations

import typing

import numpy as np

from .volume import Volume, fixed_angle

if typing.TYPE_CHECKING:
    import pyart.core

# Py-ART's usual names of fields.
_FIELDS = {"REF": "reflectivity", "VEL": "velocity", "SW": "spectrum_width", "ZDR": "differential_reflectivity",
           "PHI": "differential_phase", "RHO": "cross_correlation_ratio", "CFP": "clutter_filter_power_removed",
           "VELD": "corrected_velocity", "KDP": "specific_differential_phase"}


def to_pyart(volume: Volume) -> pyart.core.Radar:
    """Returns the volume as a pyart.core.Radar, with Py-ART's usual names of fields.

    All rays share one range axis: that of the finest gates, out to the last gate of any moment. A place beyond the
    gates of a moment, or in a gate without a value, is masked. A place in a longer gate has the value of that gate.
    Units are those of the file; ranges are in meters, angles in degrees. Raises ValueError if there are no moments.
    """
    from pyart.config import get_metadata
    from pyart.core import Radar

    moments = [moment for sweep in volume.sweeps for moment in sweep.moments.values() if moment.gate_spacing_m > 0]
    if not moments:
        raise ValueError(f"{volume!r} has no moments")
    finest = min(moments, key=lambda moment: (moment.gate_spacing_m, moment.first_gate_m))
    step, first = finest.gate_spacing_m, finest.first_gate_m
    last = max(moment.first_gate_m + moment.gate_spacing_m * (moment.shape[1] - 0.5) for moment in moments)
    ranges = first + step * np.arange(int(np.ceil((last - first) / step)))
    rays = np.concatenate([sweep.radials for sweep in volume.sweeps])
    ends = np.cumsum([len(sweep.radials) for sweep in volume.sweeps])

    def described(name, data):
        return get_metadata(name) | {"data": data}

    start = rays["time"].min()
    time = described("time", (rays["time"] - start) / np.timedelta64(1, "s"))
    time["units"] = f"seconds since {start.astype('datetime64[s]')}Z"
    if (start - start.astype("datetime64[s]")) != np.timedelta64(0, "ms"):
        time["data"] = time["data"] + (start - start.astype("datetime64[s]")) / np.timedelta64(1, "s")
    axis = described("range", ranges.astype("f4"))
    axis |= {"meters_to_center_of_first_gate": float(first), "meters_between_gates": float(step)}
    fields = {name: described(name, _field(volume, moment, ranges, ends))
              for moment, name in _FIELDS.items() if any(moment in sweep.moments for sweep in volume.sweeps)}
    units = {moment.name: moment.unit for moment in moments if moment.name not in _FIELDS}
    fields |= {name: {"data": _field(volume, name, ranges, ends), "units": unit} for name, unit in units.items()}
    return Radar(
        time, axis, fields, {"instrument_name": volume.station, "vcp_pattern": volume.vcp,
                             "original_container": "NEXRAD Level II"}, "ppi",
        described("latitude", np.array([volume.latitude_deg])), described("longitude", np.array([volume.longitude_deg])),
        described("altitude", np.array([volume.altitude_m])),
        described("sweep_number", np.arange(len(volume.sweeps), dtype="i4")),
        described("sweep_mode", np.array(["azimuth_surveillance"] * len(volume.sweeps))),
        described("fixed_angle", np.array([fixed_angle(sweep) for sweep in volume.sweeps], "f4")),
        described("sweep_start_ray_index", np.concatenate([[0], ends[:-1]]).astype("i4")),
        described("sweep_end_ray_index", (ends - 1).astype("i4")),
        described("azimuth", rays["azimuth_deg"]), described("elevation", rays["elevation_deg"]),
        instrument_parameters={"nyquist_velocity": described("nyquist_velocity", rays["nyquist_mps"]),
                               "unambiguous_range": described("unambiguous_range", rays["unambiguous_range_m"])})


def _field(volume, name, ranges, ends):
    data = np.full((ends[-1], len(ranges)), np.nan, "f4")
    for sweep, end in zip(volume.sweeps, ends):
        if name not in sweep.moments:
            continue
        moment = sweep.moments[name]
        if moment.gate_spacing_m <= 0:
            continue
        gates = np.floor((ranges - moment.first_gate_m) / moment.gate_spacing_m + 0.5).astype(int)
        known = (gates >= 0) & (gates < moment.shape[1])
        data[end - len(sweep.radials):end, known] = moment.values()[:, gates[known]]
    return np.ma.array(data, mask=np.isnan(data), copy=False)
