"""Runs the notebooks of python/examples as scripts, which must give no cause for warnings."""

import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import stormcellar
from cellar import DATA

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "python" / "examples"
STORM = "volumes/KTLX19990503_235621.gz"
SOURCE = pathlib.Path(stormcellar.__file__).parents[1]  # the tested package


@unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
@unittest.skipUnless(importlib.util.find_spec("matplotlib"), "matplotlib is not installed")
class Examples(unittest.TestCase):
    def run_example(self, name, *files):
        """Runs an example on files of the data. Returns the lines that it prints; it must write a picture."""
        with tempfile.TemporaryDirectory() as folder:
            picture = pathlib.Path(folder) / "picture.png"
            paths = [path for file in files for path in sorted(pathlib.Path(DATA).glob(file))]
            ran = subprocess.run(
                [sys.executable, "-W", "error:::__main__", EXAMPLES / name, *paths, picture], text=True,
                capture_output=True, env={**os.environ, "MPLBACKEND": "Agg", "PYTHONPATH": str(SOURCE)})
            self.assertEqual(ran.returncode, 0, ran.stderr)
            self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))
            self.assertGreater(picture.stat().st_size, 20_000)
        return ran.stdout.splitlines()

    @unittest.skipUnless(importlib.util.find_spec("xarray"), "xarray is not installed")
    def test_plot_sweep(self):
        self.assertEqual(self.run_example("plot_sweep.py", STORM)[-1], "3908 of 337640 gates of velocity are range folded")

    @unittest.skipUnless(importlib.util.find_spec("pyart"), "Py-ART is not installed")
    def test_compare_with_pyart(self):
        lines = self.run_example("compare_with_pyart.py", "volumes/KLBB20160601_150025_V06")
        compared = [line for line in lines if "gates in both" in line]
        self.assertEqual(len(compared), 6)
        for line in compared:
            self.assertTrue(line.endswith("the largest difference is 0.000"), line)

    def test_mosaic(self):
        self.assertIn("at 2010-09-11T01:26:41", self.run_example("mosaic.py", "mosaic-northeast/*")[-1])

    def test_climatology(self):
        self.assertTrue(self.run_example("climatology.py", "sequence-kbgm/*")[-1].startswith("5 volumes; "))

    def test_storm_3d(self):
        place, grid = self.run_example("storm_3d.py", STORM)[-2:]
        self.assertTrue(place.startswith("57.0 dBZ at 35.32, -97.66"), place)
        self.assertIn("160 x 160 x 71 cells", grid)


if __name__ == "__main__":
    unittest.main()
