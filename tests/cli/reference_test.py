"""docs/reference/cli.md: current with the help texts of the program."""

import os
import pathlib
import subprocess
import sys
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/make-cli-reference"


class Reference(unittest.TestCase):
    def test_is_current(self):
        run = subprocess.run([sys.executable, "-B", SCRIPT, os.environ["TUMBLE"], "--check"], capture_output=True, text=True, timeout=60)
        self.assertEqual(run.returncode, 0, run.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
