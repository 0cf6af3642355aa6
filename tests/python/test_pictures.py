"""Draws real volumes in Python, and compares the files with those of the command line."""

import gc
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import stormcellar
from cellar import DATA, PROGRAM


@unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
class Pictures(unittest.TestCase):
    file = pathlib.Path(DATA or "") / "volumes/KTLX19990503_235621.gz"

    @unittest.skipUnless(PROGRAM, "no command line: set STORMCELLAR_PROGRAM")
    def test_the_command_line_draws_the_same_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "frame.png"
            subprocess.run([PROGRAM, "frame", self.file, "-o", path, "--product", "section", "--section",
                            "35.2,-98.1,35.4,-97.3", "--theme", "light", "--no-labels"], check=True,
                           capture_output=True)
            theirs = path.read_bytes()
        picture = stormcellar.draw(self.file, "section", section=(35.2, -98.1, 35.4, -97.3), theme="light",
                                   no_labels=True)
        self.assertEqual(picture, theirs)
        self.assertEqual(picture._repr_png_(), theirs)

    def test_pixels_are_an_array(self):
        grid = stormcellar.grid(self.file)
        picture = stormcellar.draw(grid, "composite", width=500, height=400, pixels=True)
        gc.collect()
        self.assertEqual((picture.shape, picture.dtype), ((400, 500, 4), np.uint8))
        self.assertTrue((picture[..., 3] == 255).all())
        self.assertGreater(len(np.unique(picture.reshape(-1, 4), axis=0)), 50)

    def test_a_volume_may_have_derived_moments(self):
        volume = stormcellar.Volume(self.file)
        folded = stormcellar.draw(volume, "ppi", "VEL", elevation=0.5)
        dealiased = stormcellar.draw(volume, "ppi", "VELD", elevation=0.5)
        self.assertTrue(folded.startswith(b"\x89PNG"))
        self.assertNotEqual(folded, dealiased)

    def test_errors(self):
        for arguments, settings, message in ((["radar"], {}, "radar"), (["ppi", "DBZ"], {}, "DBZ"),
                                             (["ppi"], {"tint": "red"}, "tint"), (["ppi"], {"tilt": 40}, "tilt")):
            with self.assertRaisesRegex(stormcellar.Error, message) as caught:
                stormcellar.draw(self.file, *arguments, **settings)
            self.assertEqual(caught.exception.code, "bad_argument")
        with self.assertRaisesRegex(stormcellar.Error, "ppi"):
            stormcellar.draw(stormcellar.grid(self.file), "ppi")


if __name__ == "__main__":
    unittest.main()
