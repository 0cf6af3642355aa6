"""Grids real volumes in Python, and compares them with the file of the command line."""

import gc
import importlib.util
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import stormcellar
from cellar import DATA, PROGRAM


@unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
class Grids(unittest.TestCase):
    file = pathlib.Path(DATA or "") / "volumes/KTLX19990503_235621.gz"

    def test_cells_have_values_and_states(self):
        grid = stormcellar.grid(self.file, spacing_m=2000, columns=100, rows=80, levels_m=[1000, 2500, 4000])
        gc.collect()
        self.assertEqual(grid.shape, (3, 80, 100))
        np.testing.assert_array_equal(np.isnan(grid.values()), grid.states() != stormcellar.CellState.value)
        self.assertGreater(np.nanmax(grid.values()), 55)
        self.assertEqual(grid.x_m[0], -99_000)
        self.assertEqual(grid.y_m[-1], 79_000)
        np.testing.assert_array_equal(grid.levels_m, [1000, 2500, 4000])
        self.assertEqual(grid.time, np.datetime64("1999-05-03T23:56:21"))

    @unittest.skipUnless(PROGRAM, "no command line: set STORMCELLAR_PROGRAM")
    @unittest.skipUnless(importlib.util.find_spec("netCDF4"), "netCDF4 is not installed")
    def test_the_command_line_makes_the_same_cells(self):
        import netCDF4

        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "grid.nc"
            subprocess.run([PROGRAM, "grid", self.file, "-o", path], check=True, capture_output=True)
            with netCDF4.Dataset(path) as dataset:
                theirs = np.squeeze(dataset["REF"][:].filled(np.nan))
                states = np.squeeze(np.ma.getdata(dataset["status"][:]))
        ours = stormcellar.grid(self.file)
        np.testing.assert_array_equal(ours.states(), states)
        is_value = states == stormcellar.CellState.value
        self.assertGreater(int(is_value.sum()), 100_000)
        step = 0.51 * np.nanmin(np.diff(np.unique(theirs[is_value])))
        np.testing.assert_allclose(ours.values()[is_value], theirs[is_value], atol=step)

    def test_datasets_have_places_and_units(self):
        try:
            import xarray  # noqa: F401
        except ImportError:
            self.skipTest("xarray is not installed")
        dataset = stormcellar.grid(self.file, "VEL", columns=20, rows=20).to_dataset()
        self.assertEqual(dataset["VEL"].dims, ("z", "y", "x"))
        self.assertEqual(dataset["VEL"].attrs["units"], "m/s")
        self.assertEqual(dataset["crs"].attrs["grid_mapping_name"], "azimuthal_equidistant")
        self.assertEqual(float(dataset["z"][0]), 500)

    def test_errors(self):
        with self.assertRaises(stormcellar.Error) as caught:
            stormcellar.grid(self.file, "ZDR")
        self.assertEqual(caught.exception.code, "not_found")
        with self.assertRaisesRegex(stormcellar.Error, "cubic"):
            stormcellar.grid(self.file, interpolation="cubic")


if __name__ == "__main__":
    unittest.main()
