"""Merges real volumes in Python, and compares the mosaic with the file of the command line."""

import importlib.util
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import stormcellar
from cellar import DATA, PROGRAM


@unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
class Mosaics(unittest.TestCase):
    files = sorted((pathlib.Path(DATA or "") / "mosaic-northeast").glob("K[BE]*"))

    @unittest.skipUnless(PROGRAM, "no command line: set STORMCELLAR_PROGRAM")
    @unittest.skipUnless(importlib.util.find_spec("netCDF4"), "netCDF4 is not installed")
    def test_the_command_line_makes_the_same_cells(self):
        import netCDF4

        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "mosaic.nc"
            subprocess.run([PROGRAM, "grid", *self.files, "--spacing-km", "2", "-o", path], check=True,
                           capture_output=True)
            with netCDF4.Dataset(path) as dataset:
                theirs = np.squeeze(dataset["REF"][:].filled(np.nan))
                states = np.squeeze(np.ma.getdata(dataset["status"][:]))
        ours = stormcellar.mosaic(self.files, spacing_m=2000)
        np.testing.assert_array_equal(ours.states(), states)
        is_value = states == stormcellar.CellState.value
        self.assertGreater(int(is_value.sum()), 10_000)
        np.testing.assert_array_equal(ours.values()[is_value], theirs[is_value])

    def test_grids_of_the_same_cells_are_merged_as_they_are(self):
        place = {"center": (42.6, -75), "columns": 100, "rows": 60, "spacing_m": 4000, "levels_m": [1500, 3000]}
        grids = [stormcellar.grid(file, **place) for file in self.files]
        merged = stormcellar.mosaic(grids, overlap="maximum")
        self.assertEqual(merged.shape, (2, 60, 100))
        expected = np.fmax(*(grid.values() for grid in grids))
        np.testing.assert_allclose(merged.values(), expected, atol=0.2501)
        with self.assertRaisesRegex(stormcellar.Error, "different cells"):
            stormcellar.mosaic([grids[0], stormcellar.grid(self.files[1])])

    def test_errors(self):
        with self.assertRaises(stormcellar.Error) as caught:
            stormcellar.mosaic([])
        self.assertEqual(caught.exception.code, "bad_argument")
        with self.assertRaisesRegex(stormcellar.Error, "median"):
            stormcellar.mosaic(self.files, overlap="median")


if __name__ == "__main__":
    unittest.main()
