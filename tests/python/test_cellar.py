"""Reads, in Python, catalogs and caches that the command line has made."""

import pathlib
import pickle
import tempfile
import unittest

import numpy as np

import stormcellar
from cellar import DATA, PROGRAM, make_cache, make_catalog


def xarray_or_skip(test):
    try:
        import xarray
    except ImportError:
        test.skipTest("xarray is not installed")
    return xarray


@unittest.skipUnless(DATA and PROGRAM, "needs STORMCELLAR_DATA and STORMCELLAR_PROGRAM")
class Catalogs(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        storm = pathlib.Path(DATA) / "volumes/KTLX19990503_235621.gz"
        sequence = sorted((pathlib.Path(DATA) / "sequence-kbgm").iterdir())
        self.catalog = stormcellar.Catalog(make_catalog(self.folder.name, [storm, *sequence[:2]]))

    def test_volumes_are_found_by_station_and_time(self):
        self.assertEqual([volume.station for volume in self.catalog], ["KBGM", "KBGM", "KTLX"])
        first, second = self.catalog.volumes("KBGM")
        self.assertLess(first.start, second.start)
        self.assertEqual(self.catalog.volumes("KBGM", start=second.start), [second])
        self.assertEqual(self.catalog.volumes("KBGM", end=second.start - np.timedelta64(1, "ms")), [first])
        self.assertEqual(self.catalog.volumes("KTLX", "2001-01-01"), [])
        with self.assertRaises(stormcellar.Error) as caught:
            self.catalog.volumes("KFWS")
        self.assertEqual(caught.exception.code, "not_found")

    def test_a_volume_opens(self):
        (entry,) = self.catalog.volumes("KTLX")
        self.assertEqual((entry.state, entry.vcp, entry.number, entry.complete), ("complete", 11, 1, True))
        volume = entry.open()
        self.assertEqual(volume.start, entry.start)
        self.assertEqual(len(volume.sweeps), entry.sweeps)
        self.assertEqual(sum(len(sweep.radials) for sweep in volume.sweeps), entry.radials)

    def test_a_missing_catalog_is_an_error(self):
        with self.assertRaises(stormcellar.Error) as caught:
            stormcellar.Catalog(pathlib.Path(self.folder.name) / "nothing")
        self.assertEqual(caught.exception.code, "not_found")


@unittest.skipUnless(DATA and PROGRAM, "needs STORMCELLAR_DATA and STORMCELLAR_PROGRAM")
class Caches(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.path = make_cache(cls.folder.name, (pathlib.Path(DATA) / "sequence-kbgm").iterdir(), "2005-08-22",
                              "2005-08-23")
        cls.cache = stormcellar.Cache(cls.path)

    def test_domains_moments_and_times(self):
        self.assertEqual(self.cache.domains(), ["KBGM"])
        self.assertEqual(self.cache.moments("KBGM"), ["REF"])
        times = self.cache.times("KBGM")
        self.assertEqual(len(times), 5)
        self.assertTrue((np.diff(times) > np.timedelta64(0)).all())
        np.testing.assert_array_equal(self.cache.times("KBGM", start=times[1], end=times[2]), times[1:3])
        self.assertEqual(len(self.cache.times("KBGM", "VEL")), 0)

    def test_the_newest_grid_until_a_time(self):
        times = self.cache.times("KBGM")
        self.assertEqual(self.cache.grid("KBGM").time, times[-1])
        self.assertEqual(self.cache.grid("KBGM", time=times[2] + np.timedelta64(1, "s")).time, times[2])
        with self.assertRaisesRegex(stormcellar.Error, "1999") as caught:
            self.cache.grid("KBGM", time="1999-01-01")
        self.assertEqual(caught.exception.code, "not_found")

    def test_grids_are_read_when_their_cells_are_used(self):
        xarray_or_skip(self)
        dataset = self.cache.open("KBGM")
        self.assertEqual(dict(dataset["REF"].sizes), {"time": 5, "z": 32, "y": 115, "x": 115})
        self.assertFalse(dataset["REF"].variable._in_memory)
        times = self.cache.times("KBGM")
        for i, time in enumerate(times):
            grid = self.cache.grid("KBGM", time=time)
            np.testing.assert_array_equal(dataset["REF"][i].values, grid.values())
            np.testing.assert_array_equal(dataset["REF_status"][i].values, grid.states())
        self.assertGreater(float(dataset["REF"].isel(z=3).max()), 30)

    def test_any_index_gives_the_cells_of_numpy(self):
        xarray_or_skip(self)
        lazy = self.cache.open("KBGM")["REF"]
        whole = pickle.loads(pickle.dumps(lazy)).load().values
        for index in ((2, 3, 50, 60), (slice(1, 4), 3, slice(None), 60),
                      (slice(None), slice(2, 9, 3), 50, slice(60, 65)),
                      (4, slice(None, None, -1), slice(10, 12), slice(None)), (slice(0, 0), 1, 2, 3)):
            np.testing.assert_array_equal(lazy[index].values, whole[index])
        np.testing.assert_array_equal(lazy.isel(time=[3, 0], y=[7, 7, 90], x=4).values,
                                      whole[[3, 0]][:, :, [7, 7, 90], 4])

    def test_errors(self):
        with self.assertRaises(stormcellar.Error) as caught:
            stormcellar.Cache(self.path / "nothing")
        self.assertEqual(caught.exception.code, "not_found")
        self.assertEqual(self.cache.moments("../KBGM"), [])

    def test_a_grid_with_other_cells_is_an_error(self):
        xarray_or_skip(self)
        with tempfile.TemporaryDirectory() as folder:
            path = make_cache(folder, (pathlib.Path(DATA) / "sequence-kbgm").iterdir(), "2005-08-22", "2005-08-23",
                              spacing_km=10)
            files = [sorted(cache.rglob("*.scg"))[0] for cache in (self.path, path)]
            files[1].write_bytes(files[0].read_bytes())
            dataset = stormcellar.Cache(path).open("KBGM")
            self.assertFalse(np.isnan(dataset["REF"][1]).all())
            with self.assertRaisesRegex(stormcellar.Error, "other cells"):
                dataset["REF"][0].load()


if __name__ == "__main__":
    unittest.main()
