"""Runs the programs of docs/python.md, which must print the lines that the document shows."""

import contextlib
import importlib.util
import io
import os
import pathlib
import re
import tempfile
import unittest
import unittest.mock

from cellar import DATA
from stormcellar import sources

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"```python\n(.*?)```\n(?:```text\n(.*?)```)?", re.S)


@unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
@unittest.skipUnless(all(importlib.util.find_spec(name) for name in ("xarray", "matplotlib")),
                     "xarray or matplotlib is not installed")
class Tutorial(unittest.TestCase):
    def test_every_program_prints_what_the_document_shows(self):
        import matplotlib

        matplotlib.use("Agg")
        storm = (pathlib.Path(DATA) / "volumes/KTLX19990503_235621.gz").read_bytes()
        blocks = BLOCK.findall((SOURCE / "docs/python.md").read_text())
        self.assertGreater(len(blocks), 6)
        before, names = os.getcwd(), {}
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(sources, "fetched", return_value=storm):
            os.chdir(folder)
            self.addCleanup(os.chdir, before)
            for program, shown in blocks:
                printed = io.StringIO()
                with contextlib.redirect_stdout(printed):
                    exec(program, names)  # the document is part of this project
                self.assertEqual(printed.getvalue(), shown, program)
            for picture in ("sweep.png", "storm.png"):
                self.assertGreater(pathlib.Path(picture).stat().st_size, 20_000)
            os.chdir(before)


if __name__ == "__main__":
    unittest.main()
