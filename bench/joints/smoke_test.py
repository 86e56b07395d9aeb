"""The joints benchmark in its quick form: small cases run, rows are well formed, errors lie below generous bounds.

    smoke_test.py BENCH_JOINTS
"""

import csv
import re
import subprocess
import sys
import unittest

PROGRAM = sys.argv.pop(1)
HEADER = ["case", "program", "way", "step", "quantity", "value", "unit"]
LARGE = r".* chain of 10,000|net of (30|100) .*|100 ragdolls.*"   # without a quick form

# (case, way, quantity, coarsest step in s, bound, reason): at that step and all finer ones the value is at most the bound.
BOUNDS = [
    ("pendulum from .*", "default", "error", 0.01, 0.05, "second order: 5 periods at 512 steps a period"),
    ("pendulum that breaks", ".*", "error", 1 / 60, 1 / 60, "at the end of a step"),
    ("pendulum that breaks", ".*", "error", 1 / 960, 1 / 960, "at the end of a step"),
    ("pendulum that breaks", "exact", "error|angle|angular velocity", 1, 1e-12, "at its time within a step"),
    ("double pendulum, 2 s", "default", "error", 1 / 240, 2e-3, "second order"),
    ("double pendulum, 2 s", "splitting", "error", 1 / 240, 1e-6, "fourth order"),
    ("double pendulum, 2 s", "exact", "error", 1 / 240, 1e-10, "eighth order or more"),
    ("double pendulum, 5 s", "exact", "error", 1 / 240, 1e-9, "errors grow by two orders from 2 s to 5 s"),
    ("spherical pendulum|top with cusps", "exact", "error", 1e-3, 1e-10, "eighth order or more"),
    ("free chain of 8", ".*", "(angular )?momentum", 1, 1e-12, "kept to rounding"),
    ("free chain of 8", "splitting", "energy", 1 / 60, 1e-8, "fourth order"),
    ("four-bars.*", ".*", "gap", 1, 1e-9, "0.1 s, far from the singular position"),
    ("Andrews' squeezer", "default", "error", 1 / 48000, 3e-4, "second order"),
    ("Andrews' squeezer", "splitting", "error", 1 / 48000, 3e-9, "fourth order"),
    ("Andrews' squeezer", "exact", "error", 1 / 12000, 1e-11, "eighth order"),
    ("Bricard's mechanism", "default", "error", 1 / 240, 1e-4, "second order"),
    ("Bricard's mechanism", "exact", "error", 1 / 60, 1e-10, "eighth order or more"),
    ("door with motor and limit", ".*", "error", 1 / 60, 1 / 60, "first order"),
    ("door with motor and limit", ".*", "beyond the limit|off the limit at the end", 1, 1e-9, "a rigid row"),
    ("hanging chain|bridge, .*|leaning tower, .*", "default", "error", 1, 1e-8, "rigid rows"),
    ("hanging chain", "default", "force", 1, 1e-6, "rigid rows"),
    ("wrecking ball of .*", "default", "energy", 1, 1e-4, "substeps"),
    (r".* (chain|ball) of .*|hanging chain|bridge, .*|leaning tower, .*|humanoid .*|net .*", "default", "gap", 1, 1e-9, "rigid rows"),
    ("4 ragdolls", "default|two threads|sleep", "gap", 1, 1e-6, "rigid rows, in fall"),
    ("4 ragdolls", "sweeps", "gap", 1, 1e-3, "sweeps, in fall"),
]


class Smoke(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cases = subprocess.run([PROGRAM, "--list"], check=True, capture_output=True, text=True).stdout.splitlines()
        done = subprocess.run([PROGRAM, "--header", "--quick"], check=True, capture_output=True, text=True)
        cls.messages = done.stderr
        cls.header, *cls.rows = csv.reader(done.stdout.splitlines())

    def test_rows_are_well_formed(self):
        self.assertEqual(self.messages, "")
        self.assertEqual(self.header, HEADER)
        for row in self.rows:
            self.assertEqual(len(row), len(HEADER), row)
            self.assertEqual(row[1], "Tumble")
            self.assertTrue(0.0 < float(row[3]) < 0.1 and float(row[5]) < 1e9, row)
            self.assertNotEqual(row[4], "ended by an error", row)

    def test_every_case_runs(self):
        run = {row[0] for row in self.rows}
        self.assertEqual(run, {c for c in self.cases if not re.fullmatch(LARGE, c) or c in run})
        self.assertLessEqual(len(self.cases) - len(run), 6)

    def test_quantities_lie_below_their_bounds(self):
        for case, way, quantity, coarsest, bound, why in BOUNDS:
            rows = [r for r in self.rows if re.fullmatch(case, r[0]) and re.fullmatch(way, r[2]) and
                    re.fullmatch(quantity, r[4]) and float(r[3]) <= 1.001 * coarsest]
            self.assertTrue(rows, (case, way, quantity))
            for row in rows:
                self.assertLessEqual(float(row[5]), bound, (row, why))


if __name__ == "__main__":
    unittest.main()
