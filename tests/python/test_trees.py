"""Reads real volumes as xarray datasets, and compares them with xradar if it is installed."""

import importlib.util
import pathlib
import unittest

import numpy as np

from cellar import DATA

HAS_XARRAY = importlib.util.find_spec("xarray") is not None
STORM = "volumes/KTLX19990503_235621.gz"
BUSY = "volumes/KLBB20160601_150025_V06"

if HAS_XARRAY:
    import xarray as xr

    import stormcellar


def real(name):
    return pathlib.Path(DATA) / name


@unittest.skipUnless(DATA and HAS_XARRAY, "no real volumes, or no xarray")
class Trees(unittest.TestCase):
    def test_sweeps_have_values_and_states(self):
        datasets = stormcellar.open_volume(real(BUSY))
        self.assertEqual(list(datasets)[:3], ["/", "/sweep_0", "/sweep_1"])
        sweep = datasets["/sweep_0"]
        self.assertEqual(sweep["DBZH"].dims, ("azimuth", "range"))
        self.assertTrue((np.diff(sweep["azimuth"]) >= 0).all())
        self.assertEqual(sweep["DBZH"].dtype, np.float32)
        np.testing.assert_array_equal(np.isnan(sweep["DBZH"]), sweep["DBZH_status"] != 0)
        self.assertEqual(sweep["DBZH_status"].attrs["flag_meanings"].split()[2], "range_folded")
        self.assertEqual(str(datasets["/"]["time_coverage_start"].values), "2016-06-01T15:00:25Z")

    def test_rays_can_stay_in_their_order(self):
        sweep = stormcellar.open_volume(real(BUSY), sort=False)["/sweep_0"]
        self.assertTrue((np.diff(sweep["time"].values) >= np.timedelta64(0, "ns")).all())
        self.assertFalse((np.diff(sweep["azimuth"]) >= 0).all())

    def test_packed_codes_decode_to_the_values(self):
        for name in (STORM, BUSY):
            packed = stormcellar.open_volume(real(name), packed=True)
            values = stormcellar.open_volume(real(name))
            for group in list(values)[1:4]:
                decoded = xr.decode_cf(packed[group])
                for moment in [name for name in values[group] if f"{name}_status" in values[group]]:
                    is_value = values[group][f"{moment}_status"] == 0
                    self.assertTrue(np.isnan(decoded[moment].values[~is_value.values]).all(), moment)
                    np.testing.assert_allclose(decoded[moment].where(is_value), values[group][moment], rtol=1e-5,
                                               atol=1e-4)

    def test_long_gates_are_repeated_on_the_finer_axis(self):
        """In 1999 a gate of reflectivity was as long as four of velocity."""
        datasets = stormcellar.open_volume(real(STORM), sort=False)
        volume = stormcellar.Volume(real(STORM))
        shared = [sweep for sweep in volume.sweeps if {"REF", "VEL"} <= set(sweep.moments)]
        self.assertTrue(shared)
        for sweep in shared:
            dataset, long = datasets[f"/sweep_{sweep.number}"], sweep.moments["REF"].values()
            self.assertEqual(dataset["range"].attrs["meters_between_gates"], 250)
            for part in range(4):
                np.testing.assert_array_equal(dataset["DBZH"].values[:, part::4][:, : long.shape[1]], long)
            self.assertNotIn("range_DBZH", dataset.dims)

    def test_derived_moments_join(self):
        sweep = stormcellar.open_volume(real(STORM), derive="VELD")["/sweep_1"]
        self.assertIn("VRADDH", sweep)
        self.assertTrue((sweep["VRADDH_status"] == 4).any() or (sweep["VRADDH_status"] == 0).any())

    @unittest.skipUnless(HAS_XARRAY and hasattr(xr, "DataTree"), "this xarray has no trees")
    def test_a_tree_has_the_datasets(self):
        tree = stormcellar.open_datatree(real(BUSY))
        self.assertEqual(list(tree.children)[0], "sweep_0")
        self.assertAlmostEqual(float(tree.latitude), 33.654, 3)
        self.assertEqual(tree["sweep_0/DBZH"].dims, ("azimuth", "range"))

    @unittest.skipUnless(importlib.util.find_spec("xradar"), "xradar is not installed")
    def test_xradar_reads_the_same(self):
        import xradar

        theirs = xradar.io.open_nexradlevel2_datatree(real(BUSY))
        ours = stormcellar.open_volume(real(BUSY))
        compared = 0
        for name in theirs.children:
            right, mine = theirs[name].to_dataset(), ours[f"/{name}"]
            self.assertEqual({key for key in mine if f"{key}_status" in mine},
                             {key for key in right if right[key].ndim == 2})
            np.testing.assert_allclose(mine["azimuth"], right["azimuth"], atol=1e-4)
            np.testing.assert_allclose(mine["range"][: right.sizes["range"]], right["range"][: mine.sizes["range"]])
            for moment in [key for key in right if right[key].ndim == 2]:
                width = min(mine.sizes["range"], right.sizes["range"])
                a, b = mine[moment].values[:, :width], right[moment].values[:, :width]
                is_value = mine[f"{moment}_status"].values[:, :width] == 0
                np.testing.assert_allclose(a[is_value], b[is_value], atol=2e-3)
                compared += int(is_value.sum())
        self.assertGreater(compared, 1_000_000)


if __name__ == "__main__":
    unittest.main()
