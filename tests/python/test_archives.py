"""Opens archives of real and simulated volumes as one tree, and compares each volume with what open_volume() gives."""

import concurrent.futures
import importlib.util
import itertools
import pathlib
import pickle
import shutil
import tempfile
import unittest
from unittest import mock

import numpy as np

from cellar import DATA, PROGRAM, make_catalog, run

HAS_XARRAY = importlib.util.find_spec("xarray") is not None

if HAS_XARRAY:
    import stormcellar
    from stormcellar import archives

LOW, LOW_DOPPLER = {"elevation_deg": 0.5, "waveform": "surveillance"}, {"elevation_deg": 0.5, "waveform": "doppler"}
MIDDLE, HIGH = {"elevation_deg": 4}, {"elevation_deg": 10}
STORM = """
[[storm]]
position_km = [-30, -40]
radii_km = [22, 18]
core_km = 4
top_km = 12
peak_dbz = 60
"""


def simulate(folder, minute, cuts, more=""):
    """Writes a volume of station XSYN that starts in this minute and has these cuts, and returns its file."""
    lines = ['[radar]', 'station = "XSYN"', 'latitude_deg = 35', 'longitude_deg = -97', 'altitude_m = 400',
             '[volumes]', 'count = 1', f'start = "2024-06-01T22:{minute:02}:00Z"', 'interval_s = 300']
    for cut in cuts:
        lines += ["[[cut]]", "azimuth_rate_deg_s = 30",
                  *(f"{key} = {value!r}".replace("'", '"') for key, value in cut.items())]
    scene, files = pathlib.Path(folder) / f"{minute}.toml", pathlib.Path(folder) / f"files{minute}"
    scene.write_text("\n".join(lines) + STORM + more)
    run("synth", scene, "-o", files)
    return next(files.iterdir())


def nearest(angles, azimuth, spacing):
    """Returns the index of the nearest ray, or None if none is near."""
    distances = np.abs((angles - azimuth + 180) % 360 - 180)
    return int(distances.argmin()) if distances.min() <= 0.75 * spacing else None


@unittest.skipUnless(HAS_XARRAY and DATA and PROGRAM, "needs xarray, STORMCELLAR_DATA and STORMCELLAR_PROGRAM")
class Archives(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def assert_same(self, group, step, sweep):
        """Compares every moment of a volume with a sweep of open_volume(..., sort=False)."""
        spacing = 360 / group.sizes["azimuth"]
        angles = sweep["azimuth"].values
        rows = [nearest(angles, azimuth, spacing) for azimuth in group["azimuth"].values]
        hit = np.array([row is not None for row in rows])
        rows = np.array([row or 0 for row in rows])
        moments = [name for name in sweep if f"{name}_status" in sweep]
        self.assertTrue(moments)
        for name in moments:
            ours, gates = group[name][step].values, sweep[name].shape[1]
            np.testing.assert_array_equal(ours[hit][:, :gates], sweep[name].values[rows][hit], name)
            self.assertTrue(np.isnan(ours[~hit]).all() and np.isnan(ours[:, gates:]).all(), name)
            states = group[f"{name}_status"][step].values
            np.testing.assert_array_equal(states[hit][:, :gates], sweep[f"{name}_status"].values[rows][hit], name)
            self.assertTrue((states[~hit] == stormcellar.State.no_data).all(), name)
        np.testing.assert_array_equal(group["time"][step].values[hit], sweep["time"].values[rows][hit])
        self.assertTrue(np.isnat(group["time"][step].values[~hit]).all())
        np.testing.assert_array_equal(group["ray_azimuth"][step].values[hit], angles[rows][hit].astype("f4"))
        np.testing.assert_array_equal(group["elevation"][step].values[hit], sweep["elevation"].values[rows][hit])
        return hit

    def assert_empty(self, group, step):
        self.assertTrue(np.isnan(group["DBZH"][step]).all())
        self.assertTrue((group["DBZH_status"][step] == stormcellar.State.no_data).all())
        self.assertTrue(np.isnat(group["time"][step]).all())

    def test_values_are_those_of_the_volumes(self):
        files = sorted((pathlib.Path(DATA) / "sequence-kbgm").iterdir())
        archive = stormcellar.open_archive(make_catalog(self.folder, files), "KBGM")
        starts = [stormcellar.Volume(file).start for file in files]
        np.testing.assert_array_equal(archive["/VCP-21/sweep_0"]["vcp_time"], np.array(starts, "M8[ns]"))
        for step, file in enumerate(files):
            datasets = stormcellar.open_volume(file, sort=False)
            for number in range(11):
                group = archive[f"/VCP-21/sweep_{number}"]
                hit = self.assert_same(group, step, datasets[f"/sweep_{number}"])
                self.assertGreater(hit.mean(), 0.9)
        self.assertAlmostEqual(float(archive["/"]["latitude"]), 42.2, 1)

    def test_a_sweep_is_decoded_from_its_records(self):
        for name, pattern, high in (("KLOT20220317_000842_V06", 35, 11), ("Level2_TSTL_20220213_2357.ar2v", 90, 15)):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(DATA) / "volumes" / name
                datasets = stormcellar.open_volume(file, sort=False)
                archive = stormcellar.open_archive(make_catalog(folder, [file]), datasets["/"].attrs["instrument_name"])
                with mock.patch.object(archives._Pattern, "_from_file", side_effect=AssertionError("a whole file")):
                    for number in (high, high - 1, 4):
                        self.assert_same(archive[f"/VCP-{pattern}/sweep_{number}"], 0, datasets[f"/sweep_{number}"])

    def test_repeated_and_dropped_sweeps_keep_their_places(self):
        """The largest volume has every sweep. Volumes with equally many sweeps repeat the low sweeps at different
        places. A sweep must not depend on the sweeps that were read before it."""
        volumes = {
            0: [LOW, LOW_DOPPLER, MIDDLE, LOW, LOW_DOPPLER, HIGH, LOW],
            1: [LOW, LOW_DOPPLER, MIDDLE, HIGH],
            2: [LOW, LOW_DOPPLER, MIDDLE],
            3: [LOW, LOW_DOPPLER, LOW, LOW_DOPPLER, MIDDLE, HIGH],
            4: [LOW, LOW_DOPPLER, MIDDLE, LOW, LOW_DOPPLER, HIGH],
            5: [LOW, LOW_DOPPLER, LOW, LOW, HIGH],
            6: [LOW, LOW_DOPPLER, MIDDLE, LOW, HIGH],
        }
        places = {0: [0, 1, 2, 3, 4, 5, 6], 1: [0, 1, 2, 5], 2: [0, 1, 2], 3: [0, 1, 3, 4, 2, 5], 4: [0, 1, 2, 3, 4, 5],
                  5: [0, 1, 3, 6, 5], 6: [0, 1, 2, 3, 5]}
        files = [simulate(self.folder, minute, cuts) for minute, cuts in volumes.items()]
        catalog = make_catalog(self.folder, files)
        datasets = [stormcellar.open_volume(file, sort=False) for file in files]
        for numbers in (range(7), (2, 6, 5), (3, 4)):
            archive = stormcellar.open_archive(catalog, "XSYN")
            for step, number in itertools.product(range(7), numbers):
                with self.subTest(step=step, number=number, numbers=numbers):
                    group = archive[f"/VCP-767/sweep_{number}"]
                    self.assertEqual(dict(group.sizes), {"vcp_time": 7, "azimuth": 360, "range": group["range"].size})
                    if number in places[step]:
                        self.assert_same(group, step, datasets[step][f"/sweep_{places[step].index(number)}"])
                    else:
                        self.assert_empty(group, step)

    def test_real_repeated_sweeps(self):
        """Low cuts are repeated after the tenth (MRLE). A part without the end of the volume has no high sweeps."""
        whole = b"".join(file.read_bytes() for file in sorted((pathlib.Path(DATA) / "chunks/L2D_230").iterdir()))
        files = [self.folder / "KLOT20210729_123848_V06", self.folder / "KLOT20210729_124848_V06"]
        files[0].write_bytes(whole)
        milliseconds = int.from_bytes(whole[16:20], "big") + 600_000
        part = whole[:16] + milliseconds.to_bytes(4, "big") + whole[20:]
        files[1].write_bytes(part[: len(part) * 5 // 6])
        archive = stormcellar.open_archive(make_catalog(self.folder, files), "KLOT")
        for step, file in enumerate(files):
            datasets = stormcellar.open_volume(file, sort=False)
            self.assertEqual(len(datasets) - 1 < 21, step == 1)
            for number in (0, 10, 11, 13, 14, 20):
                group = archive[f"/VCP-212/sweep_{number}"]
                if f"/sweep_{number}" in datasets:
                    self.assert_same(group, step, datasets[f"/sweep_{number}"])
                else:
                    self.assert_empty(group, step)
        self.assertGreater(archive["/VCP-212/sweep_10"]["time"][0].min(), archive["/VCP-212/sweep_0"]["time"][0].max())

    def test_other_rays_gates_and_moments_are_kept(self):
        fine = {**LOW, "azimuth_spacing_deg": 0.5}
        files = [simulate(self.folder, minute, [cut]) for minute, cut in enumerate((LOW, fine, LOW))]
        files += [pathlib.Path(DATA) / "volumes" / name
                  for name in ("KTLX20140101_000624.trimmed.ar2v", "KTLX20170101_030027_V06")]
        catalog = make_catalog(self.folder, files)
        simulated, real = (stormcellar.open_archive(catalog, station) for station in ("XSYN", "KTLX"))
        for archive, pattern, places in ((simulated, 767, [[1], [0], [1]]), (real, 32, [range(7)] * 2)):
            for step, numbers in enumerate(places):
                file = files[step if archive is simulated else 3 + step]
                datasets = stormcellar.open_volume(file, sort=False)
                for sweep, number in enumerate(numbers):
                    self.assert_same(archive[f"/VCP-{pattern}/sweep_{number}"], step, datasets[f"/sweep_{sweep}"])
        self.assert_empty(simulated["/VCP-767/sweep_0"], 2)
        self.assertNotIn("/VCP-32/sweep_7", getattr(real, "groups", real))

    def test_longer_radials_of_the_oldest_volume_are_kept(self):
        files = [simulate(self.folder, minute, [{**LOW, "waveform": waveform}])
                 for minute, waveform in enumerate(("batch", "doppler"))]
        group = stormcellar.open_archive(make_catalog(self.folder, files), "XSYN")["/VCP-767/sweep_0"]
        sweeps = [stormcellar.open_volume(file, sort=False)["/sweep_0"] for file in files]
        self.assertGreater(sweeps[0].sizes["range"], sweeps[1].sizes["range"])
        for step, sweep in enumerate(sweeps):
            self.assert_same(group, step, sweep)

    def test_missing_rays_have_no_values(self):
        gap = "\n[[instrument.missing_radials]]\nfrom_azimuth_deg = 30\nto_azimuth_deg = 40\n"
        file = simulate(self.folder, 0, [MIDDLE], gap)
        group = stormcellar.open_archive(make_catalog(self.folder, [file]), "XSYN")["/VCP-767/sweep_0"]
        hit = self.assert_same(group, 0, stormcellar.open_volume(file, sort=False)["/sweep_0"])
        self.assertEqual(list(group["azimuth"].values[~hit]), [30.5 + ray for ray in range(10)])

    def test_one_decoding_serves_all_moments_and_threads(self):
        files = sorted((pathlib.Path(DATA) / "sequence-kbgm").iterdir())
        catalog = make_catalog(self.folder, files)
        with mock.patch.object(archives, "_opened", wraps=archives._opened) as opened:
            archive = stormcellar.open_archive(catalog, "KBGM")
            self.assertEqual(opened.call_count, 2)
            group = archive["/VCP-21/sweep_9"]
            self.assertIn("...", repr(group))
            with concurrent.futures.ThreadPoolExecutor(8) as pool:
                names = ["DBZH", "VRADH", "WRADH_status", "time"] * 4
                values = list(pool.map(lambda name: group[name].values, names))
            self.assertEqual(opened.call_count, 2 + len(files))
            archive["/VCP-21/sweep_0"]["DBZH"][2].values
            self.assertEqual(opened.call_count, 2 + len(files))
        for value, name in zip(values, names):
            np.testing.assert_array_equal(value, values[names.index(name)])

    def test_any_index_gives_the_cells_of_numpy(self):
        files = sorted((pathlib.Path(DATA) / "sequence-kbgm").iterdir())
        lazy = stormcellar.open_archive(make_catalog(self.folder, files), "KBGM")["/VCP-21/sweep_9"]["DBZH"]
        whole = pickle.loads(pickle.dumps(lazy)).load().values
        for index in ((2, 3, 50), (slice(1, 4), 3, slice(None)), (slice(None), slice(2, 9, 3), 50),
                      (4, slice(None, None, -1), slice(10, 12)), (slice(0, 0), 1, 2), (slice(None, None, -2), 7, 9)):
            np.testing.assert_array_equal(lazy[index].values, whole[index])
        np.testing.assert_array_equal(lazy.isel(vcp_time=[3, 0], azimuth=[7, 7, 90], range=4).values,
                                      whole[[3, 0]][:, [7, 7, 90], 4])

    def test_changed_and_deleted_files_warn(self):
        files = [simulate(self.folder, minute, [LOW, HIGH]) for minute in range(3)]
        catalog = make_catalog(self.folder, files)
        archive = stormcellar.open_archive(catalog, "XSYN")
        entries = stormcellar.Catalog(catalog).volumes("XSYN")
        pathlib.Path(entries[0].path).unlink()
        shutil.copy(entries[2].path, entries[1].path)
        group = archive["/VCP-767/sweep_1"]
        for step, words in ((0, "cannot be read"), (1, "another volume")):
            with self.assertWarnsRegex(UserWarning, words):
                self.assert_empty(group, step)
        self.assert_same(group, 2, stormcellar.open_volume(files[2], sort=False)["/sweep_1"])

    def test_a_sweep_without_a_group_warns(self):
        """Of volumes with equally many sweeps, opening reads only the newest and the oldest."""
        middle = {"elevation_deg": 7}
        files = [simulate(self.folder, minute, [LOW, cut]) for minute, cut in enumerate((HIGH, middle, HIGH))]
        archive = stormcellar.open_archive(make_catalog(self.folder, files), "XSYN")
        with self.assertWarnsRegex(UserWarning, "left out sweep 1 of 7.0 degrees"):
            self.assert_empty(archive["/VCP-767/sweep_1"], 1)
        self.assert_same(archive["/VCP-767/sweep_0"], 1, stormcellar.open_volume(files[1], sort=False)["/sweep_0"])

    def test_times_are_chosen(self):
        files = [simulate(self.folder, minute, [LOW]) for minute in range(4)]
        shutil.copy(files[1], self.folder / "XSYN20240601_again")
        catalog = make_catalog(self.folder, [*files, self.folder / "XSYN20240601_again"])
        archive = stormcellar.open_archive(stormcellar.Catalog(catalog), "XSYN", "2024-06-01T22:01", "2024-06-01T22:02")
        self.assertEqual(archive["/VCP-767/sweep_0"].sizes["vcp_time"], 2)
        with self.assertRaises(stormcellar.Error) as caught:
            stormcellar.open_archive(catalog, "XSYN", start="2025-01-01")
        self.assertEqual(caught.exception.code, "not_found")


if __name__ == "__main__":
    unittest.main()
