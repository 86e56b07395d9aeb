"""The contact benchmark in its quick form: small cases run, rows are well formed, no body is lost and none diverges.

    smoke_test.py BENCH_CONTACT
"""

import csv
import subprocess
import sys
import unittest

PROGRAM = sys.argv.pop(1)
HEADER = ["case", "program", "way", "quantity", "value", "unit"]
CASES = ["a ball alone", "60 boxes in a pit: energy", "216 spheres at rest at 1/60", "SimBenchmark 666 at 1/100", "stack of 20", "1000 kg on 1 kg",
         "arch of 15 stones", "card house of 3 storeys", "incline: friction 0.1 % above tan",
         "incline: friction 10 % below tan", "SimBenchmark rolling, diagonal", "a box at rest"]
# (case, quantity, bound) of the quick form, by default settings.
BOUNDS = [
    ("216 spheres at rest at 1/60", "largest penetration", 100.0),                  # mm
    ("SimBenchmark 666 at 1/100", "penetration", 0.0153),         # the value of RaiSim
    ("stack of 20", "drift", 0.5), ("a box at rest", "penetration", 1e-4), ("a box at rest", "drift", 1e-6),
    ("incline: friction 0.1 % above tan", "error of the distance", 1e-3),
    ("incline: friction 10 % below tan", "error of the distance", 0.01),
    ("SimBenchmark rolling, diagonal", "velocity", 1e-3),
    ("60 boxes in a pit: energy", "largest gain of energy in a step", 1e-3),
]


class Smoke(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        chosen = [o for c in CASES for o in ("--case", c)]
        done = subprocess.run([PROGRAM, "--header", "--quick", *chosen], check=True, capture_output=True, text=True)
        cls.messages = done.stderr
        cls.header, *cls.rows = csv.reader(done.stdout.splitlines())

    def test_rows_are_well_formed(self):
        self.assertEqual(self.messages, "")
        self.assertEqual(self.header, HEADER)
        for row in self.rows:
            self.assertEqual(len(row), len(HEADER), row)
            self.assertLess(float(row[4]), 1e6, row)

    def test_every_case_runs(self):
        self.assertEqual(set(CASES), {row[0] for row in self.rows})

    def test_quantities_lie_below_their_bounds(self):
        for case, quantity, bound in BOUNDS:
            values = [float(r[4]) for r in self.rows if r[0] == case and r[2] == "default" and r[3] == quantity]
            self.assertTrue(values, (case, quantity))
            self.assertLessEqual(max(values), bound, (case, quantity))


if __name__ == "__main__":
    unittest.main()
