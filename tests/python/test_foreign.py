"""Opens volumes of other formats, and compares every gate with the Level II file of which they were made."""

import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

from cellar import DATA, PROGRAM

SOURCE = "volumes/KCRP20170826_044114.trimmed.ar2v"


@unittest.skipUnless(DATA and PROGRAM, "no real volumes, or no command line")
class Foreign(unittest.TestCase):
    def setUp(self):
        self.source = pathlib.Path(DATA) / SOURCE
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def converted(self, name, *options):
        file = self.folder / name
        subprocess.run([PROGRAM, "info", self.source, "--to", file, *options], check=True, capture_output=True)
        return file

    def test_volumes_have_the_gates_of_their_source(self):
        import stormcellar

        expected = stormcellar.open_volume(self.source)
        for name in ("x.h5", "x.nc"):
            with self.subTest(name):
                file = self.converted(name)
                for source in (file, file.read_bytes()):
                    volume = stormcellar.open_volume(source)
                    self.assertEqual(list(volume), list(expected))
                    for group in (group for group in expected if "sweep" in group):
                        sweep, same = volume[group], expected[group]
                        np.testing.assert_allclose(sweep.azimuth, same.azimuth, atol=1e-4)
                        np.testing.assert_allclose(sweep.DBZH, same.DBZH, rtol=1e-6)

    def test_grids_and_pictures_are_made(self):
        import stormcellar

        file = self.converted("x.h5")
        grid = stormcellar.grid(file, columns=115, rows=115, spacing_m=4000)
        expected = stormcellar.grid(self.source, columns=115, rows=115, spacing_m=4000)
        self.assertEqual(np.isfinite(grid.values()).sum(), np.isfinite(expected.values()).sum())
        self.assertGreater(stormcellar.draw(file, "ppi", pixels=True).shape[0], 0)

    def test_damage_is_an_error(self):
        import stormcellar

        file = self.converted("x.h5")
        with self.assertRaisesRegex(stormcellar.Error, "HDF5 file is cut off"):
            stormcellar.open_volume(file.read_bytes()[:20000])


if __name__ == "__main__":
    unittest.main()
