"""scripts/check-format: all sources have their format and length, and planted files that have not are found.

Run it alone with: python3 tests/cli/format_test.py. Exit code 77: skipped, as clang-format 14 is missing.
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/check-format"
SKIPPED = 77
skipped = False


def check(*arguments):
    return subprocess.run([SCRIPT, *arguments], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


class Format(unittest.TestCase):
    def expect(self, run, code):
        """Expects an exit code, or that there is no clang-format for any but the length of files."""
        global skipped
        if run.returncode == SKIPPED:
            skipped = True
            self.skipTest(run.stderr.strip())
        self.assertEqual(run.returncode, code, run.stderr)

    def test_the_tree_is_formatted(self):
        self.expect(check(), 0)

    def test_a_planted_file_is_found_and_mended(self):
        with tempfile.TemporaryDirectory(prefix="tumble-format-") as folder:
            planted = pathlib.Path(folder, "planted.h")
            planted.write_text("int  sum( int a,int b ) { return a+b; }\n")
            run = check(folder)
            self.expect(run, 1)
            self.assertIn("planted.h", run.stderr)
            self.expect(check("--fix", folder), 0)
            self.assertEqual(planted.read_text(), "int sum(int a, int b) { return a + b; }\n")
            self.expect(check(folder), 0)

    def test_a_long_file_is_found(self):
        with tempfile.TemporaryDirectory(prefix="tumble-format-") as folder:
            long = pathlib.Path(folder, "long.cpp")
            long.write_text("int f();\n" * 601)
            run = check(folder)
            self.assertEqual(run.returncode, 1, run.stderr)
            self.assertIn("601 lines", run.stderr)
            long.write_text("int f();\n" * 600)
            self.expect(check(folder), 0)

    def test_a_long_comment_is_found(self):
        with tempfile.TemporaryDirectory(prefix="tumble-format-") as folder:
            long = pathlib.Path(folder, "long.cpp")
            long.write_text("// " + "word " * 24 + "\nint f();\n")
            run = check(folder)
            self.assertEqual(run.returncode, 1, run.stderr)
            self.assertIn("long.cpp:1: a comment of more than 120 columns", run.stderr)


if __name__ == "__main__":
    result = unittest.main(verbosity=2, exit=False).result
    sys.exit(1 if not result.wasSuccessful() else SKIPPED if skipped else 0)
