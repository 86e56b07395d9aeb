"""The accuracy benchmark in its quick form: every case runs, rows are well formed, errors lie below generous bounds.

    smoke_test.py BENCH_ACCURACY
"""

import csv
import re
import subprocess
import sys
import unittest

PROGRAM = sys.argv.pop(1)
HEADER = ["case", "program", "variant", "step", "error", "unit", "cpu_seconds_per_simulated_second"]

EXACT, EITHER = "exact [+] exact impacts", "exact|exact [+] exact impacts"   # patterns of variants

# (case, variant, coarsest step in s, bound, reason): at that step and all finer ones the error is at most the bound.
BOUNDS = [
    # First order: 1 s of the quick form at omega = 5 rad/s errs by about 0.1 omega^2 h.
    ("torque-free box: orientation", "explicit-euler|symplectic-euler", 1 / 30, 0.1, "first order"),
    ("torque-free box: orientation", "splitting", 1 / 30, 1e-3, "second order"),
    ("torque-free box: orientation", "rk4", 1 / 30, 1e-4, "fourth order"),
    ("torque-free box: energy", "explicit-euler|symplectic-euler|splitting|rk4", 1 / 30, 1e-4, "stays near its axis for 1 s"),
    ("torque-free box: angular momentum", ".*", 1 / 30, 1e-13, "kept to rounding"),
    ("box in the wind, pushed: .*", "explicit-euler|symplectic-euler", 1 / 240, 0.1, "first order: a h t, dominated by the spin"),
    ("box in the wind, pushed: .*", "splitting", 1 / 240, 1e-4, "second order"),
    ("box in the wind, pushed: .*", "rk4", 1 / 240, 1e-7, "fourth order"),
    # Symplectic Euler retraces its fall: the error stays that of one step, g h v / (g 1 m) = 4.4 h, with a factor of two.
    ("elastic (sphere|box, flat|box, tilted): energy", "symplectic-euler", 1 / 30, 0.3, "error of one step"),
    ("elastic (sphere|box, flat|box, tilted): energy", "symplectic-euler", 1 / 240, 0.04, "error of one step"),
    ("elastic box, flat: spin", ".*", 1 / 30, 1e-4, "rotation only by rounding and the solver's tolerance"),
    ("ball coming to rest: height", "symplectic-euler", 1 / 240, 0.2, "a fraction of a step per bounce"),
    ("ball coming to rest: path", "symplectic-euler", 1 / 240, 0.2, "as the height"),
    ("elastic spheres in a pit: energy", "symplectic-euler", 1 / 60, 0.02, "error of one step"),
    ("cradle of .*", "symplectic-euler.*", 1 / 60, 1e-12, "no force acts: the law alone decides"),
    # The impact is at the poses of the step, up to v h past the touch: the normals are rotated by about as much.
    ("Bernoulli's three balls.*", "symplectic-euler.*", 1 / 60, 0.05, "v h"),
    # Impacts at their own times: no error of the step remains, at any step.
    ("torque-free box: (energy|angular momentum)", EITHER, 1 / 30, 1e-13, "a closed form, evaluated from the start"),
    ("torque-free box: orientation.*", EITHER, 1 / 30, 1e-12, "a closed form, evaluated from the start"),
    ("box in the wind, pushed: .*", EITHER, 1 / 30, 1e-11, "an error-controlled scheme of order 10"),
    ("elastic (sphere|box, flat|box, tilted): energy", EXACT, 1 / 30, 1e-10, "rounding"),
    ("elastic (sphere|box, flat): height", EXACT, 1 / 30, 1e-9, "the time of impact to 1e-12 s, at 4.4 m/s, ten times"),
    ("elastic box, flat: spin", EXACT, 1 / 30, 1e-10, "four corners at once; the tolerance of the time of impact"),
    ("ball coming to rest: height", EXACT, 1 / 30, 1e-9, "as the elastic sphere"),
    ("ball coming to rest: time of rest", EXACT, 1 / 30, 1e-6, "the last hops are taken together"),
    ("ball coming to rest: path", EXACT, 1 / 30, 1e-5, "the last hops are taken together"),
    ("500 m/s at .*", ".*", 1 / 30, 1e-10, "nothing passes"),
    ("SimBenchmark bouncing: energy", EXACT, 0.1, 1e-14, "rounding of 24 kJ, squared"),
    ("SimBenchmark elastic 666: energy", EXACT, 1 / 60, 1e-10, "rounding of 35 kJ, squared"),
    ("elastic spheres in a pit: energy", EXACT, 1 / 60, 1e-12, "rounding"),
    ("(cradle of|Bernoulli).*", EXACT + ".*", 1 / 60, 1e-12, "closed forms"),
]
# Many bodies: run by few variants, because sanitizers are slow.
CROWDS = {"SimBenchmark bouncing": ["symplectic-euler", "exact + exact impacts"],
          "SimBenchmark elastic 666": ["exact + exact impacts"],
          "elastic spheres in a pit": ["symplectic-euler", "exact + exact impacts"]}
# ODE's published column of SimBenchmark's "bouncing" at 0.1 and 0.01 s: its spheres sink into the ground by more than a radius,
# Tumble's stop at the ground and have a smaller error.
PUBLISHED = {"0.1": "2.03326e+06", "0.01": "18808.3"}


class Smoke(unittest.TestCase):
    messages = ""

    @classmethod
    def setUpClass(cls):
        cls.cases = subprocess.run([PROGRAM, "--list"], check=True, capture_output=True, text=True).stdout.splitlines()
        cls.header, *cls.rows = cls.run_cases("--header", *[c for c in cls.cases if c not in CROWDS])
        for case, variants in CROWDS.items():
            for variant in variants:
                cls.rows += cls.run_cases("--variant", variant, case)

    @classmethod
    def run_cases(cls, *arguments):
        options = [a for a in arguments if a not in cls.cases]
        cases = [o for a in arguments if a in cls.cases for o in ("--case", a)]
        done = subprocess.run([PROGRAM, "--quick", *options, *cases], check=True, capture_output=True, text=True)
        cls.messages += done.stderr
        return list(csv.reader(done.stdout.splitlines()))

    def test_rows_are_well_formed(self):
        self.assertEqual(self.header, HEADER)
        for row in self.rows:
            self.assertEqual(len(row), len(HEADER), row)
            self.assertEqual(row[1], "Tumble")
            step, error, cpu = float(row[3]), float(row[4]), float(row[6])
            self.assertTrue(0.0 < step <= 0.1 and error >= 0.0 and cpu >= 0.0, row)

    def test_every_case_runs(self):
        self.assertEqual(self.messages, "")
        for case in self.cases:
            self.assertTrue(any(row[0].startswith(case + ":") for row in self.rows), case)

    def test_errors_lie_below_their_bounds(self):
        for case, variant, coarsest, bound, why in BOUNDS:
            rows = [r for r in self.rows
                    if re.fullmatch(case, r[0]) and re.fullmatch(variant, r[2]) and float(r[3]) <= 1.001 * coarsest]
            self.assertTrue(rows, (case, variant))
            for row in rows:
                self.assertLessEqual(float(row[4]), bound, (row, why))

    def test_bouncing_errs_by_less_than_the_published_column(self):
        found = {r[3]: r[4] for r in self.rows if r[0] == "SimBenchmark bouncing: energy" and r[2] == "symplectic-euler"}
        self.assertEqual(found.keys(), PUBLISHED.keys())
        for step, error in PUBLISHED.items():
            self.assertLess(float(found[step]), float(error))
            self.assertGreater(float(found[step]), 0.5 * float(error))


if __name__ == "__main__":
    unittest.main()
