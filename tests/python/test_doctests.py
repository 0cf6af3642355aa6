"""Runs the examples of the docstrings, and requires examples and types. FILE is a real volume; CATALOG and CACHE are
directories with its facts and its grid."""

import doctest
import importlib
import importlib.util
import inspect
import pathlib
import pkgutil
import tempfile
import unittest

import numpy as np

import stormcellar
from cellar import DATA, PROGRAM, make_cache, make_catalog


def has(name):
    return importlib.util.find_spec(name) is not None


def missing(name):
    """Returns what an example needs and this machine lacks, or None."""
    needs = {"stormcellar.backend": "xarray", "stormcellar.trees": "xarray", "stormcellar.volume.Volume.to_pyart": "pyart",
             "stormcellar.archives": "xarray", "stormcellar.grids.Grid.to_dataset": "xarray", "stormcellar.lazy": "xarray",
             "stormcellar.caches.Cache.open": "xarray", "stormcellar.accuracies.Table": "pandas"}
    if name.startswith(("stormcellar.archives.open", "stormcellar.caches.", "stormcellar.catalogs.Cat")) and not PROGRAM:
        return "command line that makes a catalog and a cache"
    found = next((needed for start, needed in needs.items() if name.startswith(start) and not has(needed)), None)
    if found is None and name == "stormcellar.trees.open_datatree":
        import xarray

        found = None if hasattr(xarray, "DataTree") else "xarray with trees"
    return found


def public():
    """Yields name and object of every public class, function and method."""
    names = [name for name in stormcellar.__all__ if has("xarray") or not name.startswith("open_")]
    for name in names:
        one = getattr(stormcellar, name)
        yield name, one
        if inspect.isclass(one):
            for method, value in vars(one).items():
                value = value.fget if isinstance(value, property) else value
                if not method.startswith("_") and inspect.isfunction(value):
                    yield f"{name}.{method}", value


class Documentation(unittest.TestCase):
    @unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
    def test_examples_give_what_they_say(self):
        file = pathlib.Path(DATA) / "volumes/KTLX19990503_235621.gz"
        known = {"FILE": str(file), "np": np, "stormcellar": stormcellar}
        if PROGRAM:
            folder = tempfile.TemporaryDirectory()
            self.addCleanup(folder.cleanup)
            known |= {"CATALOG": make_catalog(folder.name, [file]),
                      "CACHE": make_cache(folder.name, [file], "1999-05-03", "1999-05-05")}
        runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
        for name in ["stormcellar", *(f"stormcellar.{one.name}" for one in pkgutil.iter_modules(stormcellar.__path__))]:
            if missing(name):
                print(f"the examples of {name} are not run: no {missing(name)}")
                continue
            for example in doctest.DocTestFinder().find(importlib.import_module(name), extraglobs=dict(known)):
                if missing(example.name):
                    print(f"the example of {example.name} is not run: no {missing(example.name)}")
                else:
                    self.assertEqual(runner.run(example).failed, 0, example.name)
        self.assertGreater(runner.summarize(verbose=False).attempted, 20)

    def test_everything_public_has_an_example_and_types(self):
        for name, one in public():
            self.assertIn(">>>", one.__doc__ or "", name)
            function = one.__init__ if inspect.isclass(one) else one
            if not inspect.isfunction(function) or issubclass(one if inspect.isclass(one) else object, int):
                continue
            signature = inspect.signature(function)
            for parameter in signature.parameters.values():
                self.assertTrue(parameter.name == "self" or parameter.annotation is not parameter.empty, (name, parameter))
            if not inspect.isclass(one):
                self.assertIsNot(signature.return_annotation, signature.empty, name)


if __name__ == "__main__":
    unittest.main()
