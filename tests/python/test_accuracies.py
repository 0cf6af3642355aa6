"""Measures the accuracy of gridding in Python, and compares the results with those of the command line."""

import importlib.util
import json
import pathlib
import subprocess
import unittest

import stormcellar
from cellar import DATA, PROGRAM


@unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
class Accuracies(unittest.TestCase):
    file = pathlib.Path(DATA or "") / "volumes/KTLX19990503_235621.gz"

    def measure(self, moment="REF"):
        return stormcellar.accuracy(self.file, moment, columns=60, rows=60, spacing_m=4000, levels_m=[2000, 4000],
                                    sample=200, rounds=1)

    @unittest.skipUnless(PROGRAM, "no command line: set STORMCELLAR_PROGRAM")
    def test_errors_are_those_of_the_command_line(self):
        said = subprocess.run([PROGRAM, "accuracy", self.file, "--extent-km", "240,240", "--spacing-km", "4",
                               "--levels-km", "2,4", "--columns", "200", "--rounds", "1", "--json"], check=True,
                              capture_output=True)
        theirs = json.loads(said.stdout)["rows"]
        ours = self.measure()
        self.assertEqual([(row["step"], row["name"]) for row in ours], [(row["step"], row["name"]) for row in theirs])
        for our, their in zip(ours, theirs):
            self.assertEqual(our["value_unit"], "dB")
            for figure in ("rms", "p95", "p99", "max"):
                self.assertEqual(our[f"value_{figure}"], their[f"value_{figure}_db"])
            self.assertEqual(our["position_max_m"], their["position_max_m"])
            self.assertEqual(our["status_disagreement"], their["status_disagreement"])
        self.assertGreater(max(row["value_p99"] for row in ours), 3)

    def test_a_table_is_shown_and_becomes_a_data_frame(self):
        table = self.measure("VEL")
        self.assertEqual({row["value_unit"] for row in table}, {"m/s"})
        self.assertEqual(table._repr_html_().count("<tr>"), len(table) + 1)
        if importlib.util.find_spec("pandas") is None:
            self.skipTest("pandas is not installed")
        frame = table.to_pandas()
        self.assertEqual(list(frame.columns[:3]), ["step", "rung", "name"])
        self.assertTrue((frame["time_s"] > 0).all())


if __name__ == "__main__":
    unittest.main()
