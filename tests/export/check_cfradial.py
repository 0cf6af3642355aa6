"""Opens volumes as a scientist would, with netCDF4 and with xarray, and compares every gate.

Usage: check_cfradial.py PROGRAM LEVEL2_FILE GOLDEN_JSON
Writes each volume of the file with PROGRAM, on one range axis and with --own-ranges, and compares
sweeps, radials and moments with the results of an independent decoder: the count of each state, the
minimum, maximum and mean of the values, and the CRC of the codes, which this script restores from
values and states.
"""
import datetime
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import zlib

import netCDF4
import numpy as np
import xarray

VALID, BELOW_THRESHOLD, RANGE_FOLDED, NO_DATA, FIRST_FILTER_FLAG = 0, 1, 2, 3, 16
UNITS = {"REF": "dBZ", "VEL": "m/s", "SW": "m/s", "ZDR": "dB", "PHI": "degree", "RHO": "1",
         "CFP": "dB"}


def same(found, expected, what):
    assert found == expected, f"{what}: {found} and not {expected}"


def near(found, expected, tolerance, what):
    assert abs(found - expected) <= tolerance, f"{what}: {found} and not {expected}"


def time_of(text):
    return datetime.datetime.fromisoformat(text.rstrip("Z"))


def export(program, level2_file, directory, options):
    """Returns the facts that info prints, and the path of each volume of the file."""
    path = directory + "/out.nc"
    command = [program, "info", level2_file, "--json", *options, "--to", path]
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode == 0:
        facts = json.loads(ran.stdout)
        same(facts["written"], path, "written")
        return facts, [path]
    same(ran.returncode, 2, "exit status, " + ran.stderr)
    asked = re.search(r"holds (\d+) volumes; choose one with --volume 1 to \1", ran.stderr)
    assert asked, ran.stderr
    same(ran.stdout, "", "facts when nothing was written")
    paths = [f"{directory}/{number}.nc" for number in range(1, int(asked[1]) + 1)]
    for number, path in enumerate(paths, 1):
        ran = subprocess.run(command[:-1] + [path, "--volume", str(number)], check=True,
                             capture_output=True)
    return json.loads(ran.stdout), paths


def fields_of(data, moment):
    return [name for name, variable in data.variables.items()
            if getattr(variable, "moment", None) == moment and not name.endswith("_status")]


def placement(data, name, sweep):
    """Returns the index of a sweep's first element, and how many elements each gate fills."""
    if name + "_gate_repeats" not in data.variables:
        return 0, 1
    return int(data[name + "_gate_start"][sweep]), int(data[name + "_gate_repeats"][sweep])


def check_axis(data, name, sweep, expected, what):
    """Checks the centers of the gates of a field."""
    axis = data[data[name].dimensions[1]]
    same(axis.standard_name, "projection_range_coordinate", what)
    same(axis.units, "meters", what)
    step = axis.meters_between_gates
    same(axis[0], axis.meters_to_center_of_first_gate, what + " first gate")
    assert np.all(np.diff(axis[:]) == step), what + " spacing"
    start, repeats = placement(data, name, sweep)
    same(step * repeats, expected["gate_spacing_m"], what + " spacing")
    if name + "_first_gate" not in data.variables:
        same(axis[start], expected["first_gate_m"], what + " first gate")
        return
    same(data[name + "_first_gate"][sweep], expected["first_gate_m"], what + " first gate")
    # Centers on the axis are inside the measured gate, or on its far edge.
    offsets = axis[start:start + repeats] - expected["first_gate_m"]
    half = expected["gate_spacing_m"] / 2
    assert np.all((offsets > -half) & (offsets <= half)), f"{what} is at {offsets}"
    same(data[name].dimensions[1], "range", what)


class SweepField:
    """One sweep of one field: the values that netCDF4 gives, and the restored raw codes."""

    def __init__(self, data, name, rows, sweep):
        self.values = data[name][rows]
        self.states = np.ma.getdata(data[name + "_status"][rows]).astype(int)
        raw = data[name]
        raw.set_auto_maskandscale(False)
        packed = raw[rows].astype(int)
        raw.set_auto_maskandscale(True)
        masked = np.ma.getmaskarray(self.values)
        assert np.array_equal(masked, self.states != VALID), name + ": masked but for values"
        assert np.all(packed[masked] == raw._FillValue), name + ": _FillValue but for values"
        self.codes = packed
        self.codes[self.states == BELOW_THRESHOLD] = 0
        self.codes[self.states == RANGE_FOLDED] = 1
        flags = self.states >= FIRST_FILTER_FLAG
        self.codes[flags] = self.states[flags] - FIRST_FILTER_FLAG
        self.take_measured(*placement(data, name, sweep), name)
        there = self.states != NO_DATA
        self.gates = there.sum(axis=1)
        columns = np.arange(there.shape[1])
        assert np.array_equal(there, columns < self.gates[:, None]), name + ": gaps in a radial"

    def take_measured(self, start, repeats, name):
        """Keeps each measured gate once, and checks that its repetitions are equal."""
        repeats = max(repeats, 1)
        assert np.all(self.states[:, :start] == NO_DATA), name + ": values before the first gate"
        width = (self.states.shape[1] - start) // repeats
        end = start + width * repeats
        assert np.all(self.states[:, end:] == NO_DATA), name + ": half a gate"
        parts = [array[:, start:end].reshape(len(array), width, repeats)
                 for array in (self.codes, self.states)]
        for part in parts:
            assert np.all(part == part[:, :, :1]), name + ": a gate differs from its repetition"
        self.codes, self.states = (part[:, :, 0] for part in parts)
        self.values = self.values[:, start:end:repeats]


def check_values(fields, expected, what):
    values = np.concatenate([field.values.compressed() for field in fields])
    same(values.size, expected["valid"], what + " valid")
    if values.size:
        near(values.min(), expected["min"], 1e-6 * max(1, abs(expected["min"])), what + " min")
        near(values.max(), expected["max"], 1e-6 * max(1, abs(expected["max"])), what + " max")
        mean = values.mean(dtype=np.float64)
        near(mean, expected["mean"], 1e-6 * max(1, abs(expected["mean"])), what + " mean")


def check_codes(fields, expected, what):
    codes = np.concatenate([field.codes[field.states != NO_DATA] for field in fields])
    same(codes.size, expected["n_codes"], what + " codes")
    same(np.count_nonzero(codes == 0), expected["code0"], what + " code 0")
    same(np.count_nonzero(codes == 1), expected["code1"], what + " code 1")
    gates = sum(field.gates for field in fields)  # a radial has gates of one field
    same(np.count_nonzero(gates), expected["n_radials"], what + " radials")
    same(gates[gates > 0].min(), expected["gates_min"], what + " fewest gates")
    same(gates.max(), expected["gates_max"], what + " most gates")
    crc = 0
    size = {8: ">u1", 16: ">u2"}[expected["word_size"]]
    for radial in range(len(gates)):
        for field in fields:
            row = field.codes[radial, :field.gates[radial]]
            crc = zlib.crc32(row.astype(size).tobytes(), crc)
    same(f"{crc:08x}", expected["crc32"], what + " CRC of the codes")


def check_moment(data, moment, sweep, rows, expected, what):
    fields = [(name, SweepField(data, name, rows, sweep)) for name in fields_of(data, moment)]
    fields = [(name, field) for name, field in fields if np.any(field.gates)]
    assert fields, what + " is missing"
    name = fields[0][0]
    check_axis(data, name, sweep, expected, what)
    same(data[name].units, UNITS[moment], what)
    same(data[name].ancillary_variables, name + "_status", what)
    same(data[name].level2_scale, expected["scale"], what + " scale")
    same(data[name].level2_offset, expected["offset"], what + " offset")
    fields = [field for _, field in fields]
    check_values(fields, expected, what)
    check_codes(fields, expected, what)
    if moment == "CFP":
        states = np.concatenate([field.states.ravel() for field in fields])
        flags = np.count_nonzero(states >= FIRST_FILTER_FLAG + 2)
        same(flags, expected["code_2_to_7"], what + " flags")
        assert not np.any((states == BELOW_THRESHOLD) | (states == RANGE_FOLDED)), what


def check_radials(data, rows, expected, what):
    azimuth, elevation = data["azimuth"][rows], data["elevation"][rows]
    same(len(azimuth), expected["n_radials"], what + " radials")
    near(azimuth[0], expected["first_azimuth"], 1e-3, what + " first azimuth")
    near(azimuth[-1], expected["last_azimuth"], 1e-3, what + " last azimuth")
    near(elevation.mean(dtype=np.float64), expected["mean_elevation"], 1e-3, what + " elevation")
    same(data["radial_status"][rows][0] & 127, expected["first_status"], what + " status")
    nyquist = 0
    if "nyquist_velocity" in data.variables:
        nyquist = np.ma.filled(data["nyquist_velocity"][rows], 0)[0]
    near(nyquist, expected["nyquist_velocity"], 1e-2, what + " Nyquist velocity")
    times = data["time"]
    for place, name in ((0, "start_time"), (-1, "end_time")):
        found = netCDF4.num2date(times[rows][place], times.units, times.calendar)
        error = datetime.datetime.fromisoformat(found.isoformat()) - time_of(expected[name])
        near(error.total_seconds(), 0, 1e-5, what + " " + name)


def check_sweep(data, sweep, expected):
    what = f"sweep {expected['index']}"
    first, last = data["sweep_start_ray_index"][sweep], data["sweep_end_ray_index"][sweep]
    rows = slice(first, last + 1)
    same(data["sweep_number"][sweep], sweep, what)
    same(data["elevation_number"][sweep], expected["elevation_number"], what + " elevation number")
    if expected.get("vcp_elevation") is not None:
        near(data["fixed_angle"][sweep], expected["vcp_elevation"], 1e-3, what + " fixed angle")
    same(netCDF4.chartostring(data["sweep_mode"][sweep]), "azimuth_surveillance", what)
    check_radials(data, rows, expected, what)
    for moment in UNITS:
        if moment in expected["moments"]:
            check_moment(data, moment, sweep, rows, expected["moments"][moment], f"{what} {moment}")
            continue
        for name in fields_of(data, moment):
            states = np.ma.getdata(data[name + "_status"][rows])
            assert np.all(states == NO_DATA), f"{what} has no {moment}"


def check_file(data, golden):
    assert data.Conventions.startswith("CF-1.7 CF/Radial"), data.Conventions
    same(data.version, "1.4", "version")
    same(data.source_file, golden["file"], "source file")
    if golden["vcp"] is not None:
        same(data.scan_id, golden["vcp"], "VCP")
    for name in ("latitude", "longitude", "altitude", "volume_number", "time_coverage_start"):
        assert name in data.variables, name
    same(bool(np.ma.is_masked(data["latitude"][:])), data.instrument_name == "unknown", "position")
    names = set(data.field_names.split(",")) - {""}
    same({name for name in data.variables if hasattr(data[name], "moment")}, names, "field_names")
    for name in names:
        assert data[name].dimensions[0] == "time"
        same(data[name].coordinates, "elevation azimuth " + data[name].dimensions[1], name)


def check_documented(data):
    """Checks that docs/export.md names every variable, dimension and attribute of the file."""
    page = pathlib.Path(__file__).parents[2] / "docs" / "export.md"
    prose = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    known = set(re.findall(r"`([^`]+)`", prose))
    found = set(data.variables) | set(data.dimensions) | set(data.ncattrs())
    for name in found:
        plain = re.sub(r"_\d+(?=$|_status$|_gate_|_first_)", "", name)
        plain = re.sub(r"^[A-Z]+_(?=gate_|first_)", "REF_", plain)
        if plain.removesuffix("_status") in UNITS:
            plain = plain.removesuffix("_status")
        assert plain in known, f"{name} is not in {page}"


def check_xarray(path, sweeps):
    with xarray.open_dataset(path) as dataset:
        same(dataset.sizes["sweep"], len(sweeps), "sweeps in xarray")
        starts, ends = dataset["sweep_start_ray_index"], dataset["sweep_end_ray_index"]
        for moment in UNITS:
            names = [name for name, array in dataset.data_vars.items()
                     if array.attrs.get("moment") == moment and not name.endswith("_status")]
            arrays = [dataset[name].load() for name in names]
            for array in arrays:
                assert {"time", "azimuth", "elevation", array.dims[1]} <= set(array.coords)
            for sweep, expected in enumerate(sweeps):
                rows = slice(int(starts[sweep]), int(ends[sweep]) + 1)
                weights = [1 / max(1, int(dataset[name + "_gate_repeats"][sweep]))
                           if name + "_gate_repeats" in dataset else 1 for name in names]
                counts = [round(int(array[rows].notnull().sum()) * weight, 6)
                          for array, weight in zip(arrays, weights)]
                golden = expected["moments"].get(moment, {"valid": 0})
                same(sum(counts), golden["valid"], f"xarray: sweep {sweep} {moment} valid")
                if golden["valid"]:
                    total = sum(float(array[rows].sum(dtype=np.float64)) * weight
                                for array, weight in zip(arrays, weights))
                    tolerance = 1e-5 * max(1, abs(golden["mean"]))
                    near(total / golden["valid"], golden["mean"], tolerance,
                         f"xarray: sweep {sweep} {moment} mean")
        if sweeps:
            error = dataset["time"].values[0] - np.datetime64(time_of(sweeps[0]["start_time"]))
            near(float(error / np.timedelta64(1, "s")), 0, 1e-5, "xarray: time")


def check_export(program, level2_file, golden, options):
    with tempfile.TemporaryDirectory() as directory:
        facts, paths = export(program, level2_file, directory, options)
        same(facts["n_sweeps"], golden["n_sweeps"], "sweeps that info tells of")
        rest = golden["sweeps"]
        for path in paths:
            with netCDF4.Dataset(path) as data:
                check_file(data, golden)
                check_documented(data)
                count = len(data.dimensions["sweep"])
                sweeps, rest = rest[:count], rest[count:]
                same(len(data.dimensions["time"]), sum(s["n_radials"] for s in sweeps), "radials")
                for sweep, expected in enumerate(sweeps):
                    check_sweep(data, sweep, expected)
                if not options:
                    # 2026-11-28: Py-ART and xradar read the fields on `range` alone.
                    same([name for name in data.dimensions if name.startswith("range_")], [],
                         "further axes")
            check_xarray(path, sweeps)
        same(len(rest), 0, "sweeps that were not written")


def main():
    program, level2_file, golden_file = sys.argv[1:4]
    with open(golden_file, encoding="utf-8") as file:
        golden = json.load(file)
    for options in ([], ["--own-ranges"]):
        check_export(program, level2_file, golden, options)


if __name__ == "__main__":
    main()
