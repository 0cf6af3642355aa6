"""Volumes as xarray datasets, in the layout of xradar 0.12 (FM 301, CfRadial 2).

One thing differs from xradar: a gate without a value is NaN (with packed=True it has a code that decodes to NaN), and
its state is in a variable of its own, `DBZH_status`; xradar gives echo below the threshold the value of the lowest code.
"""

from __future__ import annotations

import typing

import numpy as np
import xarray as xr

from .volume import State, fixed_angle, volume_of

if typing.TYPE_CHECKING:
    from .volume import Source, Volume, Words

# Our moments: name in FM 301, standard name, long name, unit. ICD 2620002; CfRadial 2.1, section 5.
_MOMENTS = {
    "REF": ("DBZH", "radar_equivalent_reflectivity_factor_h", "Equivalent reflectivity factor H", "dBZ"),
    "VEL": ("VRADH", "radial_velocity_of_scatterers_away_from_instrument_h",
            "Radial velocity of scatterers away from instrument H", "meters per seconds"),
    "SW": ("WRADH", "radar_doppler_spectrum_width_h", "Doppler spectrum width H", "meters per seconds"),
    "ZDR": ("ZDR", "radar_differential_reflectivity_hv", "Log differential reflectivity H/V", "dB"),
    "PHI": ("PHIDP", "radar_differential_phase_hv", "Differential phase HV", "degrees"),
    "RHO": ("RHOHV", "radar_correlation_coefficient_hv", "Correlation coefficient HV", "unitless"),
    "CFP": ("CCORH", "radar_clutter_correction_h", "Clutter Correction H", "dB"),
    "VELD": ("VRADDH", "radial_velocity_of_scatterers_away_from_instrument_h", "Dealiased radial velocity H",
             "meters per seconds"),
}
_STATES = {"flag_values": np.array([int(state) for state in State], "u1"),
           "flag_meanings": " ".join(state.name for state in State)}


def open_volume(source: Volume | Source, *, moments: Words | None = None, derive: Words = (), sort: bool = True,
                status: bool = True, packed: bool = False, **options: typing.Any) -> dict[str, xr.Dataset]:
    """Returns a volume as a dict of datasets: "/" and "/sweep_0", "/sweep_1" and so on, by the order of the file.

    `source` and `options` are those of Volume. `derive` names derived moments (Volume.derive). Rays are sorted by
    azimuth, or stay in the order of arrival with sort=False. Moments have dimensions (azimuth, range): float32 in
    their unit, or with packed=True the codes of the file with the attributes scale_factor and add_offset, as
    xarray.decode_cf() reads them. `status` adds the state of each gate as uint8, such as DBZH_status.

    A moment with longer gates than another of its sweep is repeated on the range axis of the finer one, if its gates
    begin and end there; else it has a range axis of its own, such as range_DBZH. Ranges and heights are in meters,
    angles in degrees, times in UTC. Raises the errors of Volume.

    >>> datasets = stormcellar.open_volume(FILE)
    >>> dict(datasets["/sweep_1"]["VRADH"].sizes)
    {'azimuth': 367, 'range': 920}
    >>> datasets["/"].attrs["scan_name"]
    'VCP-11'
    """
    if moments is not None:
        options["moments"] = moments
    volume = volume_of("open_volume", source, options)
    if derive:
        volume = volume.derive(derive)
    sweeps = {f"/sweep_{sweep.number}": _sweep_dataset(sweep, sort, status, packed) for sweep in volume.sweeps}
    return {"/": _root_dataset(volume), **sweeps}


def open_datatree(source: Volume | Source, **options: typing.Any) -> xr.DataTree:
    """Returns a volume as an xarray.DataTree. The arguments are those of open_volume(). Raises ImportError if xarray is
    older than 2024.10, which has no trees.

    >>> stormcellar.open_datatree(FILE)["sweep_0/DBZH"].attrs["units"]
    'dBZ'
    """
    if not hasattr(xr, "DataTree"):
        raise ImportError(f"xarray {xr.__version__} has no DataTree (2024.10 and later have it): use open_volume()")
    return xr.DataTree.from_dict(open_volume(source, **options))


def _text(time):
    return "" if np.isnat(time) else str(time.astype("datetime64[s]")) + "Z"


def _root_dataset(volume):
    times = [sweep.radials["time"] for sweep in volume.sweeps if len(sweep.radials)]
    start = min((time.min() for time in times), default=volume.start)
    end = max((time.max() for time in times), default=volume.start)
    names = [f"sweep_{sweep.number}" for sweep in volume.sweeps]
    return xr.Dataset(
        {
            "volume_number": 0,
            "platform_type": "fixed",
            "instrument_type": "radar",
            "time_coverage_start": _text(start),
            "time_coverage_end": _text(end),
            "sweep_group_name": ("sweep", names),
            "sweep_fixed_angle": ("sweep", [fixed_angle(sweep) for sweep in volume.sweeps]),
        },
        coords={
            "latitude": ((), volume.latitude_deg, {"units": "degrees_north", "standard_name": "latitude"}),
            "longitude": ((), volume.longitude_deg, {"units": "degrees_east", "standard_name": "longitude"}),
            "altitude": ((), volume.altitude_m, {"units": "meters", "standard_name": "altitude"}),
        },
        attrs={
            "Conventions": "ODIM_H5/V2_2, Cf/Radial-2.0",
            "instrument_name": volume.station,
            "scan_name": f"VCP-{volume.vcp}" if volume.vcp is not None else "",
            "source": "Level II",
            "comment": "; ".join(volume.problems),
        },
    )


def _sweep_dataset(sweep, sort, status, packed):
    order = np.argsort(sweep.radials["azimuth_deg"], kind="stable") if sort else slice(None)
    radials = sweep.radials[order]
    axis = min(sweep.moments.values(), key=lambda moment: moment.gate_spacing_m, default=None)
    axes = {}  # first gate, spacing and count by name
    if axis is not None:
        fitting = [_repeats(moment, axis) * moment.shape[1] for moment in sweep.moments.values()
                   if _repeats(moment, axis)]
        axes["range"] = (axis.first_gate_m, axis.gate_spacing_m, max(fitting, default=0))
    variables = {}
    for moment in sweep.moments.values():
        name = _MOMENTS.get(moment.name, (moment.name,))[0]
        repeats = _repeats(moment, axis)
        dimension = "range" if repeats else f"range_{name}"
        if not repeats:
            axes[dimension] = (moment.first_gate_m, moment.gate_spacing_m, moment.shape[1])
        width = axes[dimension][2]
        dimensions = ("azimuth", dimension)
        fitted = lambda array, beyond: _fitted(array[order], max(repeats, 1), width, beyond)
        if packed:
            variables[name] = (dimensions, fitted(moment.codes(), 0), _attributes(moment) | _packing(moment))
        else:
            variables[name] = (dimensions, fitted(moment.values(), np.nan), _attributes(moment))
        if status:
            variables[f"{name}_status"] = (dimensions, fitted(moment.states(), State.no_data),
                                           {"long_name": f"State of the gates of {name}", **_STATES})
    coordinates = {
        "azimuth": ("azimuth", radials["azimuth_deg"].astype("f8"),
                    {"standard_name": "ray_azimuth_angle", "units": "degrees", "axis": "radial_azimuth_coordinate"}),
        "elevation": ("azimuth", radials["elevation_deg"].astype("f8"),
                      {"standard_name": "ray_elevation_angle", "units": "degrees",
                       "axis": "radial_elevation_coordinate"}),
        "time": ("azimuth", radials["time"].astype("datetime64[ns]"), {"standard_name": "time"}),
    }
    for name, (first, spacing, count) in axes.items():
        coordinates[name] = (name, (first + spacing * np.arange(count)).astype("f4"),
                             {"units": "meters", "standard_name": "projection_range_coordinate",
                              "axis": "radial_range_coordinate", "spacing_is_constant": "true",
                              "meters_between_gates": spacing, "meters_to_center_of_first_gate": first})
    return xr.Dataset(
        {**variables, "sweep_mode": "azimuth_surveillance", "sweep_number": sweep.number, "prt_mode": "not_set",
         "follow_mode": "not_set", "sweep_fixed_angle": fixed_angle(sweep),
         "nyquist_velocity": ("azimuth", radials["nyquist_mps"], {"units": "meters per seconds"})},
        coords=coordinates)


def _repeats(moment, axis):
    """Returns how many gates of the axis a gate of the moment covers, or 0 if gates do not fit."""
    if min(moment.gate_spacing_m, axis.gate_spacing_m) <= 0 or moment.gate_spacing_m % axis.gate_spacing_m:
        return 0
    begin = 2 * moment.first_gate_m - moment.gate_spacing_m
    return moment.gate_spacing_m // axis.gate_spacing_m if begin == 2 * axis.first_gate_m - axis.gate_spacing_m else 0


def _fitted(array, repeats, width, beyond):
    """Returns the rows with each gate repeated, and filled up to the width."""
    if repeats > 1:
        array = np.repeat(array, repeats, axis=1)
    if array.shape[1] == width:
        return array
    full = np.full((array.shape[0], width), beyond, array.dtype)
    full[:, : array.shape[1]] = array
    return full


def _attributes(moment):
    if moment.name not in _MOMENTS:
        return {"units": moment.unit}
    _, standard_name, long_name, unit = _MOMENTS[moment.name]
    return {"standard_name": standard_name, "long_name": long_name, "units": unit}


def _packing(moment):
    scale = moment.scale or 1
    return {"scale_factor": 1 / scale, "add_offset": -moment.offset / scale if moment.scale else 0.0,
            "_FillValue": np.array(0, moment.codes().dtype)[()],
            "missing_value": np.arange(1, moment.first_valid_code, dtype=moment.codes().dtype)}
