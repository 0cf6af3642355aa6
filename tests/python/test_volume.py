"""Reads real volumes in Python, and compares them with the golden values and with the command line."""

import gc
import io
import json
import pathlib
import threading
import unittest

import numpy as np

import stormcellar
from cellar import DATA

STORM = "volumes/KTLX19990503_235621.gz"
BUSY = "volumes/KLBB20160601_150025_V06"


def real(name):
    return pathlib.Path(DATA) / name


@unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
class Volumes(unittest.TestCase):
    def test_facts_are_those_of_the_file(self):
        volume = stormcellar.Volume(real(STORM))
        self.assertEqual(volume.station, "KTLX")
        self.assertEqual(volume.start, np.datetime64("1999-05-03T23:56:21"))
        self.assertEqual(volume.vcp, 11)
        self.assertTrue(volume.complete)
        self.assertEqual(set(volume.sweeps[0].moments), {"REF"})
        self.assertAlmostEqual(volume.latitude_deg, 35.333, 2)

    def test_values_follow_from_codes_and_states(self):
        for sweep in stormcellar.Volume(real(BUSY)).sweeps:
            for moment in sweep.kinds:
                codes, values, states = moment.codes(), moment.values(), moment.states()
                self.assertEqual(codes.shape, (len(sweep.radials), moment.shape[1]))
                valid = states == stormcellar.State.value
                np.testing.assert_array_equal(np.isnan(values), ~valid)
                right = (codes[valid].astype("f4") - np.float32(moment.offset)) / np.float32(moment.scale)
                np.testing.assert_array_equal(values[valid], right)
                self.assertTrue((codes[valid] >= moment.first_valid_code).all())

    def test_golden_sums(self):
        """Independent readers agree on the golden values (each file says which)."""
        compared = sum(compare_with_golden(self, golden) for golden in (pathlib.Path(DATA) / "golden").glob("*.json"))
        self.assertGreater(compared, 1000)

    def test_codes_are_a_view_that_keeps_the_volume(self):
        codes = stormcellar.Volume(real(STORM)).sweeps[0].moments["REF"].codes()
        gc.collect()
        self.assertGreater(int(codes.max()), 100)
        with self.assertRaises(ValueError):
            codes[0, 0] = 1

    def test_sources_are_paths_bytes_and_files(self):
        with open(real(STORM), "rb") as file:
            from_file = stormcellar.Volume(file, station="KTLX")
        in_memory = stormcellar.Volume(io.BytesIO(real(STORM).read_bytes()), station="KTLX")
        from_bytes = stormcellar.Volume(real(STORM).read_bytes(), station="KTLX")
        from_path = stormcellar.Volume(str(real(STORM)))
        for volume in (from_file, in_memory, from_bytes):
            self.assertEqual(repr(volume), repr(from_path))

    def test_errors_have_a_line_and_a_code(self):
        with self.assertRaisesRegex(stormcellar.Error, "/nothing/here") as caught:
            stormcellar.Volume("/nothing/here")
        self.assertEqual(caught.exception.code, "not_found")
        with self.assertRaises(stormcellar.Error) as caught:
            stormcellar.Volume(b"this is no radar data")
        self.assertEqual(caught.exception.code, "not_level2")
        with self.assertRaisesRegex(stormcellar.Error, "DBZH"):
            stormcellar.Volume(real(STORM), moments=["DBZH"])

    def test_derived_moments(self):
        volume = stormcellar.Volume(real(STORM))
        derived = volume.derive("VELD", dealias="region")
        plain, unfolded = (one.sweeps[1].moments for one in (volume, derived))
        difference = unfolded["VELD"].values() - plain["VEL"].values()
        nyquist = volume.sweeps[1].radials["nyquist_mps"][:, None]
        folds = difference / (2 * nyquist)
        np.testing.assert_allclose(folds[~np.isnan(folds)], np.rint(folds[~np.isnan(folds)]), atol=0.02)
        self.assertGreater(np.nanmax(np.abs(np.rint(folds))), 0)
        self.assertNotIn("VELD", plain)

    def test_a_moment_that_cannot_be_derived_is_an_error(self):
        with self.assertRaisesRegex(stormcellar.Error, "KDP cannot be derived") as raised:
            stormcellar.Volume(real(STORM)).derive("VELD KDP")
        self.assertEqual(raised.exception.code, "not_found")

    def test_unknown_options_are_refused(self):
        volume = stormcellar.Volume(real(STORM))
        for call in (stormcellar.grid, lambda source, **options: stormcellar.mosaic([source], **options),
                     stormcellar.accuracy):
            for source in (volume, real(STORM)):
                with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'spacing'"):
                    call(source, spacing=500)
            with self.assertRaisesRegex(TypeError, "takes 'station' only with a source that is not yet a Volume"):
                call(volume, station="KTLX")

    def test_threads_read_at_the_same_time(self):
        volume, failures = stormcellar.Volume(real(STORM)), []

        def read():
            try:
                for sweep in volume.sweeps:
                    for moment in sweep.kinds:
                        moment.values()
            except Exception as error:  # a thread must not lose an error
                failures.append(error)

        threads = [threading.Thread(target=read) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])


def compare_with_golden(case, golden):
    """Compares the moments of each sweep that a golden file describes. Returns how many it compared."""
    told = json.loads(golden.read_text())
    files = [path for folder in ("volumes", "sequence-kbgm", "mosaic-northeast")
             for path in (pathlib.Path(DATA) / folder).glob(told["file"] + "*")]
    if not files or told["corruption"]:  # other readers end at the damage
        return 0
    volumes = [stormcellar.Volume(files[0])]
    volumes += [stormcellar.Volume(files[0], volume=i) for i in range(2, volumes[0].volumes + 1)]
    sweeps = [sweep for volume in volumes for sweep in volume.sweeps]
    case.assertEqual(len(sweeps), told["n_sweeps"], golden.name)
    compared = 0
    for sweep, right in zip(sweeps, told["sweeps"]):
        case.assertEqual(len(sweep.radials), right["n_radials"], golden.name)
        for name, facts in right["moments"].items():
            if not facts["geometry_constant"] or not facts["scale_constant"] or not facts["valid"]:
                continue
            values = sweep.moments[name].values()
            case.assertEqual(np.count_nonzero(~np.isnan(values)), facts["valid"], (golden.name, sweep, name))
            case.assertAlmostEqual(float(np.nanmin(values)), facts["min"], 3, (golden.name, sweep, name))
            case.assertAlmostEqual(float(np.nanmax(values)), facts["max"], 3, (golden.name, sweep, name))
            case.assertAlmostEqual(float(np.nanmean(values.astype("f8"))), facts["mean"], 3, (golden.name, sweep, name))
            compared += 1
    return compared


if __name__ == "__main__":
    unittest.main()
