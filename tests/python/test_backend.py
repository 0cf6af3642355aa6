"""Opens real volumes through xarray's engine, and as radars of Py-ART if these are installed."""

import importlib.util
import pathlib
import unittest

import numpy as np

from cellar import DATA

STORM = pathlib.Path(DATA or "") / "volumes/KTLX19990503_235621.gz"
BUSY = pathlib.Path(DATA or "") / "volumes/KLBB20160601_150025_V06"


@unittest.skipUnless(DATA and importlib.util.find_spec("xarray"), "no real volumes, or no xarray")
class Engine(unittest.TestCase):
    def setUp(self):
        import xarray

        from stormcellar.backend import StormcellarBackendEntrypoint

        self.xarray, self.engine = xarray, StormcellarBackendEntrypoint

    def test_a_group_is_a_sweep(self):
        third = self.xarray.open_dataset(BUSY, engine=self.engine, group="sweep_3")
        self.assertEqual(int(third["sweep_number"]), 3)
        self.assertIn("VRADH", third)
        self.assertNotIn("DBZH", self.xarray.open_dataset(BUSY, engine=self.engine, drop_variables=["DBZH"]))
        self.assertIn("latitude", self.xarray.open_dataset(BUSY, engine=self.engine, group="/").coords)
        with self.assertRaisesRegex(ValueError, "sweep_99"):
            self.xarray.open_dataset(BUSY, engine=self.engine, group="sweep_99")

    def test_xarray_finds_the_installed_engine(self):
        if "stormcellar" not in self.xarray.backends.list_engines():
            self.skipTest("the package is not installed")
        self.assertIn("DBZH", self.xarray.open_dataset(BUSY, engine="stormcellar", group="sweep_0"))
        self.assertIn("DBZH", self.xarray.open_dataset(BUSY))  # by its name

    def test_trees(self):
        if not hasattr(self.xarray, "DataTree"):
            self.skipTest("this xarray has no trees")
        tree = self.xarray.open_datatree(BUSY, engine=self.engine)
        self.assertEqual(tree["sweep_0/DBZH"].dims, ("azimuth", "range"))

    def test_names_of_volumes_are_known(self):
        guess = self.engine().guess_can_open
        for name in (STORM, BUSY, "KLOT20220317_000842_V06", "x/Level2_KFTG_20150430_1419.ar2v"):
            self.assertTrue(guess(name), name)
        for name in ("model.nc", "KLOT", "KLOT20220317.nc", 7):
            self.assertFalse(guess(name), name)


@unittest.skipUnless(DATA and importlib.util.find_spec("pyart"), "no real volumes, or no Py-ART")
class PyArt(unittest.TestCase):
    def test_py_art_reads_the_same(self):
        import pyart

        import stormcellar

        for path in (BUSY, STORM):
            ours = stormcellar.Volume(path).to_pyart()
            theirs = pyart.io.read_nexrad_archive(str(path))
            self.assertEqual(ours.nsweeps, theirs.nsweeps)
            self.assertEqual(ours.nrays, theirs.nrays)
            np.testing.assert_allclose(ours.azimuth["data"], theirs.azimuth["data"], atol=1e-3)
            np.testing.assert_allclose(ours.time["data"] - ours.time["data"][0],
                                       theirs.time["data"] - theirs.time["data"][0], atol=2e-3)
            if path == BUSY:  # Py-ART knows no place of a radar of 1999
                self.assertAlmostEqual(float(ours.latitude["data"][0]), float(theirs.latitude["data"][0]), 3)
            for name in theirs.fields:
                # Py-ART interpolates the reflectivity of 1999, because its gates are longer than
                # those of other moments.
                if path == BUSY or name != "reflectivity":
                    compare_field(self, ours, theirs, name)


def compare_field(case, ours, theirs, name):
    """Compares the values at the places that both radars have."""
    columns = np.rint((theirs.range["data"] - ours.range["data"][0]) / np.diff(ours.range["data"][:2])[0]).astype(int)
    inside = (columns >= 0) & (columns < ours.ngates)
    mine = ours.fields[name]["data"][:, columns[inside]]
    right = theirs.fields[name]["data"][:, inside]
    both = ~np.ma.getmaskarray(mine) & ~np.ma.getmaskarray(right)
    close = np.isclose(np.ma.getdata(mine)[both], np.ma.getdata(right)[both], atol=0.01)
    case.assertGreater(int(both.sum()), 10_000, name)
    case.assertGreater(close.mean(), 0.999, name)


if __name__ == "__main__":
    unittest.main()
