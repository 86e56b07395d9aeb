"""The stability benchmark in its quick form: every case runs, rows are well formed, required cells pass.

    smoke_test.py BENCH_STABILITY
"""

import csv
import re
import subprocess
import sys
import unittest

PROGRAM = sys.argv.pop(1)
HEADER = ["case", "program", "way", "parameter", "pass line", "rate", "value", "worst", "verdict", "steps"]
EXACT = "exact|exact [+] exact impacts"

# (case, way, largest parameter): cells that must pass up to that parameter. The maps of docs/results/stability.md show the limits.
MUST_PASS = [
    ("stack", ".*", 5), ("heavy on light", ".*", 1), ("far from the origin", ".*", 1e5), ("600 s of rest", ".*", 3),
    ("spin", EXACT, 1e5), ("spin", ".*", 1), ("inertia ratio", EXACT, 1e6), ("inertia ratio", ".*", 1),
    ("a million steps of tumbling", ".*", 10), ("thin wall", ".*", 1e4), ("restitution", ".*", 1), ("friction", ".*", 10),
    ("deep overlap", ".*", 0.5), ("breaking plate", EXACT, 30), ("plate strength", EXACT, 1e8), ("box in water", "symplectic-euler|" + EXACT, 1e3),
    ("box on waves", ".*", 100), ("random: finite", ".*", 3), ("random: normals", ".*", 3),
]


class Smoke(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cases = subprocess.run([PROGRAM, "--list"], check=True, capture_output=True, text=True).stdout.splitlines()
        done = subprocess.run([PROGRAM, "--quick", "--header"], check=True, capture_output=True, text=True)
        cls.header, *cls.rows = csv.reader(done.stdout.splitlines())

    def test_rows_are_well_formed(self):
        self.assertEqual(self.header, HEADER)
        for row in self.rows:
            self.assertEqual(len(row), len(HEADER), row)
            self.assertEqual(row[1], "Tumble")
            self.assertIn(row[8], ("pass", "fail", "late"), row)  # late: its time was up, as on a busy machine
            self.assertGreaterEqual(float(row[7]), 0.0, row)

    def test_every_case_runs(self):
        for case in self.cases:
            start = "random: " if case == "random scenes" else case
            self.assertTrue(any(row[0].startswith(start) for row in self.rows), case)

    def test_required_cells_pass(self):
        for case, way, most in MUST_PASS:
            rows = [r for r in self.rows if r[0] == case and re.fullmatch(way, r[2]) and float(r[6]) <= most]
            self.assertTrue(rows, (case, way))
            for row in rows:
                self.assertEqual(row[8], "pass", row)


if __name__ == "__main__":
    unittest.main()
