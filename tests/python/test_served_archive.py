"""Opens archives that the data server serves with xarray, and compares them with stormcellar.open_archive()."""

import contextlib
import importlib.util
import os
import pathlib
import subprocess
import tempfile
import unittest
import warnings

import numpy as np

from cellar import PROGRAM, make_catalog
from test_archives import DATA, HAS_XARRAY, HIGH, LOW, LOW_DOPPLER, MIDDLE, simulate

CLIENTS = ("zarr", "fsspec", "aiohttp")
CAN_READ = HAS_XARRAY and all(importlib.util.find_spec(name) for name in CLIENTS)
if CAN_READ:
    import xarray as xr
    import zarr

    CAN_READ = hasattr(xr, "DataTree") and int(zarr.__version__.split(".")[0]) >= 3
if HAS_XARRAY:
    import stormcellar


@contextlib.contextmanager
def served(catalog):
    """Yields the address of a server of the catalog."""
    with tempfile.TemporaryDirectory() as cache:
        command = [PROGRAM, "serve", "--catalog", catalog, "--cache", cache, "--listen", "127.0.0.1:0"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
            try:
                yield server.stdout.readline().split()[-1].rstrip("/")
            finally:
                server.terminate()


@unittest.skipUnless(CAN_READ and DATA and PROGRAM,
                     "needs xarray 2024.10, zarr 3, aiohttp, STORMCELLAR_DATA and STORMCELLAR_PROGRAM")
class ServedArchives(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def opened(self, address, station, **options):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # zarr says that consolidated metadata may change
            return xr.open_datatree(f"{address}/zarr3/volumes/{station}", engine="zarr", **options)

    def assert_same_variable(self, ours, theirs, name):
        self.assertEqual(ours.dims, theirs.dims, name)
        if theirs.dtype.kind not in "UT":  # texts
            self.assertEqual(ours.dtype, theirs.dtype, name)
        np.testing.assert_array_equal(ours.values, theirs.values, name)
        self.assertEqual(set(ours.attrs), set(theirs.attrs), name)
        for key, value in theirs.attrs.items():
            np.testing.assert_array_equal(ours.attrs[key], value, f"{name} {key}")

    def assert_same(self, ours, theirs, sweeps=None):
        """Compares groups, variables, coordinates and all values of two trees, or the values of these sweeps alone."""
        self.assertEqual(set(ours.groups), set(theirs.groups))
        for path in theirs.groups:
            mine, other = ours[path].to_dataset(inherit=False), theirs[path].to_dataset(inherit=False)
            self.assertEqual(set(mine.variables), set(other.variables), path)
            self.assertEqual(set(mine.coords), set(other.coords), path)
            self.assertEqual(mine.attrs, other.attrs, path)
            if sweeps is not None and path.split("_")[-1] not in map(str, sweeps):
                continue
            for name in other.variables:
                self.assert_same_variable(mine.variables[name], other.variables[name], f"{path} {name}")

    def test_a_sequence_is_the_tree_of_python(self):
        files = sorted((pathlib.Path(DATA) / "sequence-kbgm").iterdir())
        catalog = make_catalog(self.folder, files)
        archive = stormcellar.open_archive(catalog, "KBGM")
        with served(catalog) as address:
            for options in ({"consolidated": True}, {}):
                tree = self.opened(address, "KBGM", **options)
                self.assertEqual(tree["/VCP-21/sweep_0"].sizes["vcp_time"], len(files))
            self.assert_same(tree, archive)
            sweep = stormcellar.open_datatree(files[2])["sweep_4"]
            group = tree["/VCP-21/sweep_4"].isel(vcp_time=2)
            for ray in (0, 100, 359):
                angle = group["ray_azimuth"].values[ray]
                same = sweep.isel(azimuth=int(np.argmin(np.abs(sweep["azimuth"].values - angle))))
                gates = same.sizes["range"]
                np.testing.assert_array_equal(group["DBZH"].values[ray][:gates], same["DBZH"].values)
            group = xr.open_zarr(f"{address}/zarr3/volumes/KBGM/VCP-21/sweep_4")
            self.assertEqual(group["DBZH"].sizes["vcp_time"], len(files))

    def test_repeated_and_dropped_sweeps_keep_their_places(self):
        volumes = [[LOW, LOW_DOPPLER, MIDDLE, LOW, LOW_DOPPLER, HIGH, LOW], [LOW, LOW_DOPPLER, MIDDLE],
                   [LOW, LOW_DOPPLER, LOW, LOW_DOPPLER, MIDDLE, HIGH], [LOW, {**LOW, "azimuth_spacing_deg": 0.5}],
                   [LOW, LOW_DOPPLER, LOW, LOW, HIGH], [LOW, LOW_DOPPLER, MIDDLE, LOW, LOW_DOPPLER, HIGH]]
        catalog = make_catalog(self.folder, [simulate(self.folder, i, cuts) for i, cuts in enumerate(volumes)])
        with served(catalog) as address:
            self.assert_same(self.opened(address, "XSYN"), stormcellar.open_archive(catalog, "XSYN"))

    def test_real_repeated_sweeps_and_other_gates(self):
        """A volume of MRLE and a part of it; two volumes of one pattern with other gates and moments."""
        whole = b"".join(file.read_bytes() for file in sorted((pathlib.Path(DATA) / "chunks/L2D_230").iterdir()))
        part = whole[:16] + (int.from_bytes(whole[16:20], "big") + 600_000).to_bytes(4, "big") + whole[20:]
        files = [self.folder / "KLOT20210729_123848_V06", self.folder / "KLOT20210729_124848_V06"]
        files[0].write_bytes(whole)
        files[1].write_bytes(part[: len(part) * 5 // 6])
        files += [pathlib.Path(DATA) / "volumes" / name
                  for name in ("KTLX20140101_000624.trimmed.ar2v", "KTLX20170101_030027_V06")]
        catalog = make_catalog(self.folder, files)
        with served(catalog) as address:
            for station, sweeps in (("KLOT", (0, 11, 20)), ("KTLX", None)):
                archive = stormcellar.open_archive(catalog, station)
                self.assert_same(self.opened(address, station), archive, sweeps)

    def test_a_deleted_file_has_no_values(self):
        catalog = make_catalog(self.folder, [simulate(self.folder, minute, [LOW, HIGH]) for minute in range(3)])
        os.unlink(stormcellar.Catalog(catalog).volumes("XSYN")[1].path)
        with served(catalog) as address:
            group = self.opened(address, "XSYN")["/VCP-767/sweep_1"]
            self.assertEqual(np.isnan(group["DBZH"]).all(["azimuth", "range"]).values.tolist(), [False, True, False])
            self.assertTrue((group["DBZH_status"][1] == stormcellar.State.no_data).all())
            self.assertTrue(np.isnat(group["time"][1]).all())


if __name__ == "__main__":
    unittest.main()
