"""Runs the examples of the docstrings. FILE is a real volume."""

import doctest
import importlib
import importlib.util
import os
import pathlib
import pkgutil
import unittest

import numpy as np

import stormcellar

BESIDE = pathlib.Path(__file__).resolve().parents[2].parent / "shared" / "data"
DATA = os.environ.get("STORMCELLAR_DATA") or (BESIDE if BESIDE.is_dir() else None)
NEEDS = {"backend": "xarray", "trees": "xarray", "pyart_radar": "pyart"}  # what a module's examples need


@unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
class Doctests(unittest.TestCase):
    def test_examples_give_what_they_say(self):
        known = {"FILE": str(pathlib.Path(DATA) / "volumes/KTLX19990503_235621.gz"), "np": np,
                 "stormcellar": stormcellar}
        run = 0
        for name in ["", *(module.name for module in pkgutil.iter_modules(stormcellar.__path__))]:
            if name in NEEDS and importlib.util.find_spec(NEEDS[name]) is None:
                print(f"the examples of {name} are not run: no {NEEDS[name]}")
                continue
            module = importlib.import_module(f"stormcellar.{name}".rstrip("."))
            result = doctest.testmod(module, extraglobs=dict(known), optionflags=doctest.ELLIPSIS)
            self.assertEqual(result.failed, 0, name)
            run += result.attempted
        self.assertGreater(run, 3)


if __name__ == "__main__":
    unittest.main()
