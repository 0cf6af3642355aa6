"""Opens exported volumes with the readers of each format, and compares every gate with our decoder.

ODIM_H5 is opened by h5py, CfRadial 2 by netCDF4 and xarray, UF by a reader of its own. Where they are installed, xradar
and Py-ART open the files, too.
"""

import contextlib
import importlib.util
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest
import warnings

import numpy as np

from cellar import DATA, PROGRAM

FILES = (
    "volumes/KTLX19910720_160529.gz",  # 1991; cut inside a message
    "volumes/KTLX19990503_235621.gz",  # REF at 1 km and VEL at 250 m, in split cuts and in one sweep
    "volumes/Level2_KLBB_single_chunk",  # part of a super-resolution sweep with PHI, RHO and CFP
    "volumes/Level2_TSTL_20220213_2357.ar2v",  # TDWR: REF at 300 m and at 150 m, no Nyquist velocity
    "volumes/KOKX20080109_141449.gz",  # gates that vary inside a sweep
    "volumes/KCRP20170826_044114.trimmed.ar2v",  # super-resolution, VEL in steps of 1 m/s
    "volumes/example_nexrad_archive_msg1.bz2",  # the position of the radar is unknown
    "mosaic-northeast/KBGM20100911_012056_V03.gz",  # REF at 250 m and at 1 km
)
FM301 = {"REF": "DBZH", "VEL": "VRADH", "SW": "WRADH", "ZDR": "ZDR", "PHI": "PHIDP", "RHO": "RHOHV", "CFP": "CCORH"}
UF = {"REF": "DZ", "VEL": "VR", "SW": "SW", "ZDR": "ZD", "PHI": "PH", "RHO": "RH", "CFP": "CF"}
PYART = {"REF": "reflectivity", "VEL": "velocity", "SW": "spectrum_width", "ZDR": "differential_reflectivity",
         "PHI": "differential_phase", "RHO": "cross_correlation_ratio"}
VALUE, BELOW, NO_DATA = 0, 1, 3


def has(module):
    return importlib.util.find_spec(module) is not None


def exact(kind):
    """Returns the values of one kind of gates in double precision; NaN for a gate without a value."""
    codes = kind.codes().astype(float)
    values = codes if kind.scale == 0 else (codes - kind.offset) / kind.scale
    return np.where(kind.states() == VALUE, values, np.nan)


def scaled(kind):
    return (1.0, 0.0) if kind.scale == 0 else (1 / kind.scale, -kind.offset / kind.scale)


@unittest.skipUnless(DATA and PROGRAM, "no real volumes, or no command line")
class Formats(unittest.TestCase):
    @contextlib.contextmanager
    def written(self, name, ending, *options):
        """Writes a file of FILES in a format, and gives our volume and the path."""
        import stormcellar

        with self.subTest(name, options=options), tempfile.TemporaryDirectory() as folder:
            source, path = pathlib.Path(DATA) / name, os.path.join(folder, "x" + ending)
            subprocess.run([PROGRAM, "info", source, "--to", path, *options], check=True, capture_output=True)
            yield stormcellar.Volume(source), path

    def close(self, found, expected, tolerance=0.0):
        np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance)


def seconds(times):
    return times.astype("datetime64[ms]").astype(np.int64) / 1000


@unittest.skipUnless(has("h5py"), "h5py is not installed")
class Odim(Formats):
    """The tables of ODIM_H5 2.4: groups, mandatory attributes and their types, and the codes of every gate."""

    def test_h5py_reads_every_gate(self):
        import h5py

        for name in FILES:
            with self.written(name, ".h5") as (volume, path):
                with h5py.File(path) as file:
                    self.check_root(file, volume)
                    names = sorted((key for key in file if key.startswith("dataset")), key=lambda key: int(key[7:]))
                    self.assertEqual(names, [f"dataset{number + 1}" for number in range(len(names))])
                    numbers = [int(file[name]["how"].attrs["scan_index"]) for name in names]
                    self.assertEqual(numbers, sorted(numbers))
                    self.assertEqual(set(numbers), set(range(1, len(volume.sweeps) + 1)))
                    for sweep in volume.sweeps:
                        scans = [file[name] for name, number in zip(names, numbers) if number == sweep.number + 1]
                        found = [kind for scan in scans for kind in self.check_scan(scan, sweep)]
                        wanted = [kind for kind in sweep.kinds if np.any(kind.states() != NO_DATA)]
                        self.assertEqual(len(found), len(wanted))
                        self.assertLessEqual({id(kind) for kind in wanted}, {id(kind) for kind in found})

    def text(self, group, name, expected=None):
        value = group.attrs[name]
        self.assertIsInstance(value, bytes, name)  # of fixed length
        if expected is not None:
            self.assertEqual(value.decode(), expected)
        return value.decode()

    def number(self, group, name, expected=None, kind=np.float64):
        value = group.attrs[name]
        self.assertIs(type(value), kind, name)
        if expected is not None:
            np.testing.assert_equal(value, expected, name)
        return value

    def check_root(self, file, volume):
        self.text(file, "Conventions", "ODIM_H5/V2_4")
        self.text(file["what"], "object", "PVOL")
        self.text(file["what"], "version", "H5rad 2.4")
        self.assertRegex(self.text(file["what"], "date") + self.text(file["what"], "time"), r"^\d{14}$")
        expected = f"^RAD:{volume.station},PLC:[^,:]+$" if volume.station else "^CMT:unknown radar$"
        self.assertRegex(self.text(file["what"], "source"), expected)
        for name, expected in (("lat", volume.latitude_deg), ("lon", volume.longitude_deg),
                               ("height", volume.altitude_m)):
            self.number(file["where"], name, expected)

    def check_scan(self, scan, sweep):
        order = np.argsort(sweep.radials["azimuth_deg"], kind="stable")
        radials = sweep.radials[order]
        self.text(scan["what"], "product", "SCAN")
        for end in ("start", "end"):
            self.assertRegex(self.text(scan["what"], end + "date") + self.text(scan["what"], end + "time"), r"^\d{14}$")
        where, how = scan["where"], scan["how"]
        self.number(where, "elangle")
        self.number(where, "nrays", len(radials), np.int64)
        self.number(where, "a1gate", list(order).index(0), np.int64)
        nyquist = float(sweep.radials["nyquist_mps"][0])
        self.assertEqual("NI" in how.attrs, nyquist > 0)
        if nyquist > 0:
            self.number(how, "NI", nyquist)
        start, stop = how.attrs["startazA"], how.attrs["stopazA"]
        self.assertTrue(np.all((start >= 0) & (start < 360) & (stop >= 0) & (stop < 360)))
        middle = (start + (stop - start) % 360 / 2 - radials["azimuth_deg"] + 180) % 360 - 180
        self.close(middle, np.zeros(len(radials)), 1e-12)
        self.close(how.attrs["elangles"], radials["elevation_deg"])
        for name in ("startazT", "stopazT"):
            self.close(how.attrs[name], seconds(radials["time"]), 1e-6)
        for name in scan:
            if name.startswith("data"):
                yield self.check_moment(scan[name], where, sweep, order)

    def check_moment(self, group, where, sweep, order):
        what = group["what"]
        moment = {odim: ours for ours, odim in FM301.items()}[self.text(what, "quantity")]
        spacing = self.number(where, "rscale")
        first = self.number(where, "rstart") + spacing / 2
        gain, offset = self.number(what, "gain"), self.number(what, "offset")
        self.number(what, "nodata", 1.0)
        self.number(what, "undetect", 0.0)
        data = group["data"][:]
        self.assertEqual(data.shape, (len(order), self.number(where, "nbins", kind=np.int64)))
        for kind in sweep.kinds:
            if (kind.name, kind.first_gate_m, kind.gate_spacing_m) != (moment, first, spacing):
                continue
            codes, states = kind.codes(), kind.states()
            expected = np.where(states == VALUE, codes.astype(int), np.where(states == BELOW, 0, 1))[order]
            if data.dtype != codes.dtype or (gain, offset) != scaled(kind):
                continue
            if np.array_equal(data[:, :codes.shape[1]], expected[:, :data.shape[1]]):
                self.assertTrue(np.all(data[:, codes.shape[1]:] == 1))
                self.assertTrue(np.all(expected[:, data.shape[1]:] == 1))
                return kind
        return self.fail(f"sweep {sweep.number}: no gates of ours are those of {group.name}")

    @unittest.skipUnless(has("xradar"), "xradar is not installed")
    def test_xradar_reads_every_value(self):
        import xradar

        for name in FILES:
            with self.written(name, ".h5") as (volume, path):
                tree = xradar.io.open_odim_datatree(path)
                number = 0
                for sweep in volume.sweeps:
                    order = np.argsort(sweep.radials["azimuth_deg"], kind="stable")
                    left = [kind for kind in sweep.kinds if np.any(kind.states() != NO_DATA)]
                    while left:
                        dataset = tree[f"sweep_{number}"].ds
                        number += 1
                        self.close(dataset["azimuth"], sweep.radials["azimuth_deg"][order], 1e-10)
                        for kind in [kind for kind in left if self.is_in(dataset, kind)]:
                            left = [other for other in left if other is not kind]
                            self.close(dataset["range"][:kind.shape[1]], kind.ranges_m[:dataset.sizes["range"]])
                            found, wanted = dataset[FM301[kind.name]].values, exact(kind)[order]
                            # xradar gives the value of code 0 to gates below the threshold.
                            found = np.where(found == scaled(kind)[1], np.nan, found)
                            width = min(found.shape[1], wanted.shape[1])
                            self.close(found[:, :width], wanted[:, :width], 1e-9)

    @staticmethod
    def is_in(dataset, kind):
        if FM301[kind.name] not in dataset or len(dataset["range"]) < 2:
            return False
        first, second = dataset["range"].values[:2]
        return (first, second - first) == (kind.first_gate_m, kind.gate_spacing_m)


@unittest.skipUnless(has("netCDF4"), "netCDF4 is not installed")
class Cfradial2(Formats):
    def test_netcdf4_reads_every_gate(self):
        import netCDF4

        for options in ((), ("--own-ranges",)):
            for name in FILES:
                with self.written(name, ".nc", "--format", "cfradial2", *options) as (volume, path):
                    with netCDF4.Dataset(path) as data:
                        self.assertIn("WMO CF-1.0", data.Conventions)
                        self.assertEqual(data.wmo__cf_profile, "FM 301-2022")
                        self.assertEqual(data.instrument_name, volume.station or "unknown")
                        names = list(data["sweep_group_name"][:])
                        self.assertEqual(names, [f"sweep_{sweep.number}" for sweep in volume.sweeps])
                        self.assertEqual(set(names), set(data.groups))
                        for name in ("latitude", "longitude", "altitude"):
                            known = getattr(volume, name + ("_m" if name == "altitude" else "_deg"))
                            np.testing.assert_equal(np.ma.filled(data[name][...], np.nan), np.float64(known))
                        for sweep, fixed in zip(volume.sweeps, data["sweep_fixed_angle"][:]):
                            group = data[f"sweep_{sweep.number}"]
                            self.assertEqual(group["sweep_fixed_angle"][...], fixed)
                            self.check_sweep(group, sweep, options)

    def check_sweep(self, group, sweep, options):
        import netCDF4

        self.assertEqual(group["sweep_number"][...], sweep.number)
        self.assertEqual(group["sweep_mode"][...], "azimuth_surveillance")
        self.assertIn(group["prt_mode"][...], ("fixed", "dual", "staggered", "not_set"))
        self.close(group["azimuth"][:], sweep.radials["azimuth_deg"])
        self.close(group["elevation"][:], sweep.radials["elevation_deg"])
        reference = netCDF4.num2date(0, group["time"].units).isoformat()
        since = (sweep.radials["time"] - np.datetime64(reference, "ms")).astype(np.int64) / 1000
        self.close(group["time"][:], since, 1e-9)
        nyquist = sweep.radials["nyquist_mps"]
        if "nyquist_velocity" in group.variables:
            nyquist = np.where(nyquist == 0, np.nan, nyquist)
            self.close(np.ma.filled(group["nyquist_velocity"][:], np.nan), nyquist)
        else:
            self.assertFalse(np.any(nyquist))
        fields = [name for name in group.variables if name + "_status" in group.variables]
        for kind in sweep.kinds:
            if np.any(kind.states() != NO_DATA):
                self.assertTrue(any(self.holds(group, name, kind, options) for name in fields), kind)

    def holds(self, group, name, kind, options):
        """Returns True if the field has the gates of this kind. Its repetitions must be equal."""
        field, status = group[name], group[name + "_status"]
        if field.moment != kind.name or (field.level2_scale, field.level2_offset) != (kind.scale, kind.offset):
            return False
        field.set_auto_maskandscale(False)
        start, repeats, first = 0, 1, int(group[field.dimensions[1]][0])
        if name + "_gate_repeats" in group.variables:
            start, repeats = int(group[name + "_gate_start"][...]), int(group[name + "_gate_repeats"][...])
            first = int(group[name + "_first_gate"][...])
        spacing = repeats * group[field.dimensions[1]].meters_between_gates
        if (first, spacing) != (kind.first_gate_m, kind.gate_spacing_m):
            return False
        self.assertFalse(options and repeats > 1)
        columns = start + repeats * np.arange(kind.shape[1])
        inside = columns < field.shape[1]
        codes, states = field[:][:, columns[inside]], np.ma.getdata(status[:])[:, columns[inside]]
        states = np.where(states >= 16, NO_DATA, states)
        if not np.array_equal(states, kind.states()[:, inside]):
            return False
        np.testing.assert_array_equal(codes, np.where(states == VALUE, kind.codes().astype(int)[:, inside], -1))
        np.testing.assert_array_equal(codes, field[:][:, columns[inside] + repeats - 1])
        self.close((field.scale_factor, field.add_offset), scaled(kind))
        return True

    @unittest.skipUnless(has("xarray"), "xarray is not installed")
    def test_xarray_opens_groups(self):
        import xarray

        for name in FILES:
            with self.written(name, ".nc", "--format", "cfradial2") as (volume, path):
                with xarray.open_dataset(path) as root:
                    self.assertEqual(root.sizes["sweep"], len(volume.sweeps))
                for sweep in volume.sweeps:
                    with xarray.open_dataset(path, group=f"sweep_{sweep.number}") as dataset:
                        self.check_values(dataset, sweep)

    @unittest.skipUnless(has("xradar"), "xradar is not installed")
    def test_xradar_reads_every_value(self):
        import xradar

        for name in FILES:
            with self.written(name, ".nc", "--format", "cfradial2") as (volume, path):
                tree = xradar.io.open_cfradial2_datatree(path)
                for sweep in volume.sweeps:
                    self.check_values(tree[f"sweep_{sweep.number}"].ds, sweep)

    @unittest.skipUnless(has("xradar"), "xradar is not installed")
    def test_xradar_reads_cfradial_1(self):
        import xradar

        for name in FILES:
            with self.written(name, ".nc") as (volume, path):
                tree = xradar.io.open_cfradial1_datatree(path)
                for sweep in volume.sweeps:
                    self.check_values(tree[f"sweep_{sweep.number}"].ds, sweep, dict(zip(FM301, FM301)))

    def check_values(self, dataset, sweep, names=None):
        """Compares the values of moments that have one kind of gates in the sweep, radials by azimuth."""
        names = names or FM301
        rows = np.lexsort((dataset["time"].values, dataset["azimuth"].values))
        order = np.lexsort((sweep.radials["time"], sweep.radials["azimuth_deg"]))
        for moment, kind in sweep.moments.items():
            if sum(other.name == moment for other in sweep.kinds) > 1 or not np.any(np.isfinite(exact(kind))):
                continue
            ranges = dataset["range"].values
            columns = np.rint((kind.ranges_m - ranges[0]) / (ranges[1] - ranges[0])).astype(int)
            inside = (columns >= 0) & (columns < len(ranges))
            array = dataset[names[moment]]
            if array.dims[1] != "range":
                continue
            wanted = exact(kind)[order][:, inside]
            self.close(array.values[rows][:, columns[inside]], wanted, 2e-7 * np.nanmax(np.abs(wanted)) + 1e-12)


def read_uf(path):
    """Yields each record of the file: a dict of header words, and the fields by name."""
    content = pathlib.Path(path).read_bytes()
    place = 0
    while place < len(content):
        (size,) = struct.unpack_from(">I", content, place)
        record = content[place + 4:place + 4 + size]
        assert struct.unpack_from(">I", content, place + 4 + size) == (size,), "the lengths differ"
        words = np.frombuffer(record, ">i2")
        assert record[:2] == b"UF" and words[1] == len(words), "no record of UF"
        place += size + 8
        at = words[4] - 1
        fields = {}
        assert words[at] == words[at + 2] and words[at + 1] == 1, "the radial is in several records"
        for number in range(words[at + 2]):
            name = record[2 * (at + 3 + 2 * number):][:2].decode()
            header = words[words[at + 4 + 2 * number] - 1:]
            data = words[header[0] - 1:header[0] - 1 + header[5]]
            assert len(data) == header[5] and header[18] == 16, name
            fields[name] = (header, data)
        yield record, words, fields


class Uf(Formats):
    def test_every_gate_is_there(self):
        for options in ((), ("--own-ranges",)):
            for name in FILES:
                with self.written(name, ".uf", *options) as (volume, path):
                    records = read_uf(path)
                    count = 0
                    for sweep in volume.sweeps:
                        kinds = [(kind, exact(kind), kind.states()) for kind in sweep.kinds]
                        for number, radial in enumerate(sweep.radials):
                            count += 1
                            record, words, fields = next(records)
                            self.check_header(record, words, volume, sweep, radial, count)
                            rows = [(kind, values[number]) for kind, values, states in kinds
                                    if np.any(states[number] != NO_DATA) or np.any(np.isfinite(values[number]))]
                            self.check_fields(fields, rows, radial, options)
                    self.assertIsNone(next(records, None))

    def check_header(self, record, words, volume, sweep, radial, count):
        self.assertEqual((words[5], words[7], words[9]), (count, count, sweep.number + 1))
        self.assertEqual(record[20:28].decode().strip(), volume.station)
        for first, degrees in ((18, volume.latitude_deg), (21, volume.longitude_deg)):
            if np.isnan(degrees):
                self.assertEqual(list(words[first:first + 3]), [-32768] * 3)
            else:
                found = words[first] + words[first + 1] / 60 + words[first + 2] / 64 / 3600
                self.assertAlmostEqual(found, degrees, delta=1 / 128 / 3600 + 1e-9)
        year, month, day, hour, minute, second = (int(word) for word in words[25:31])
        text = f"{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}"
        self.assertEqual(text, str(radial["time"].astype("datetime64[s]")))
        self.assertEqual(record[62:64], b"UT")
        self.assertAlmostEqual(words[32] / 64, radial["azimuth_deg"], delta=1 / 128)
        self.assertAlmostEqual(words[33] / 64, radial["elevation_deg"], delta=1 / 128)
        self.assertEqual((words[34], words[44]), (1, -32768))

    def check_fields(self, fields, rows, radial, options):
        held = set()
        for kind, wanted in rows:
            header, data = fields[UF[kind.name]]
            held.add(UF[kind.name])
            factor, first, spacing = int(header[1]), 1000 * int(header[2]) + int(header[3]), int(header[4])
            if kind.name == "VEL":
                nyquist = float(radial["nyquist_mps"])
                self.assertAlmostEqual(header[19] if nyquist == 0 else header[19] / factor,
                                       nyquist or -32768, delta=0.006)
            repeats = kind.gate_spacing_m // spacing
            self.assertEqual(repeats * spacing, kind.gate_spacing_m)
            if options:
                self.assertEqual((repeats, first), (1, kind.first_gate_m))
            values = np.where(data == -32768, np.nan, data / factor)
            if repeats == 1:
                offset = (kind.first_gate_m - first) // spacing
                self.assertEqual(first + offset * spacing, kind.first_gate_m)
            else:  # the element whose center is the first beyond the near edge of the gate
                offset = (2 * (kind.first_gate_m - first) - kind.gate_spacing_m) // (2 * spacing) + 1
            expected = np.full(len(data), np.nan)
            row = np.repeat(wanted, repeats)
            row = row[:len(data) - offset]
            expected[offset:offset + len(row)] = row
            self.assertTrue(np.all(np.isnan(np.repeat(wanted, repeats)[len(row):])))
            self.close(values, expected, 0.006 if kind.name == "PHI" else 1e-9)
        for name in set(fields) - held:
            # A radial may have CFP without a value: flags alone.
            self.assertTrue(not options or name == UF["CFP"], name)
            self.assertTrue(np.all(fields[name][1] == -32768), name)

    @unittest.skipUnless(has("pyart"), "Py-ART is not installed")
    def test_py_art_reads_every_value(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            import pyart

            for name in FILES:
                with self.written(name, ".uf") as (volume, path):
                    radar = pyart.io.read_uf(path)
                    self.assertEqual(radar.nsweeps, len(volume.sweeps))
                    self.close(radar.azimuth["data"], np.concatenate([s.radials["azimuth_deg"] for s in volume.sweeps]),
                               1 / 128)
                    # Py-ART takes the range in the file for the near edge of the first gate.
                    ranges = radar.range["data"] - radar.range["meters_between_gates"] / 2
                    for sweep, rows in zip(volume.sweeps, radar.iter_slice()):
                        for moment, kind in sweep.moments.items():
                            if moment in PYART and sum(other.name == moment for other in sweep.kinds) == 1:
                                self.check_py_art(radar.fields[PYART[moment]]["data"][rows], ranges, kind)

    def check_py_art(self, found, ranges, kind):
        columns = np.rint((kind.ranges_m - ranges[0]) / (ranges[1] - ranges[0])).astype(int)
        inside = (columns >= 0) & (columns < len(ranges))
        self.close(np.ma.filled(found[:, columns[inside]].astype(float), np.nan), exact(kind)[:, inside],
                   0.006 if kind.name == "PHI" else 1e-9)


if __name__ == "__main__":
    unittest.main()
