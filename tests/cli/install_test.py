"""scripts/install-dependencies: its packages, with replaced dpkg-query and apt-get.

Run it alone with: python3 tests/cli/install_test.py.
"""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/install-dependencies"


class Install(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="tumble-install-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("bash", "env", "sed"):
            (self.folder / name).symlink_to(shutil.which(name))
        self.program("id", "echo 0")
        self.program("apt-get", f'echo "$@" >> {self.folder}/calls')
        self.program("dpkg-query", f'for last; do :; done; while read -r name; do [ "$name" != "$last" ] || exit 1; done '
                                   f'< {self.folder}/missing; echo installed')
        self.missing()

    def program(self, name, text):
        (self.folder / name).write_text(f"#!/bin/sh\n{text}\n")
        (self.folder / name).chmod(0o755)

    def missing(self, *packages):
        """The packages that the system lacks."""
        (self.folder / "missing").write_text("".join(f"{p}\n" for p in packages))

    def installed(self, *arguments):
        """The packages that the script installs, None if it leaves apt-get alone."""
        calls = self.folder / "calls"
        calls.unlink(missing_ok=True)
        run = subprocess.run(["bash", SCRIPT, *arguments], text=True, timeout=60, env={"PATH": str(self.folder)},
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        if not calls.exists():
            return None
        update, install = calls.read_text().splitlines()
        self.assertTrue(update.endswith(" update"))
        return install.split(" --no-install-recommends ")[1].split()

    def test_nothing_is_missing(self):
        for options in ((), ("--web",), ("--test",), ("--bench",), ("--fuzz",)):
            self.assertIsNone(self.installed(*options))

    def test_a_bare_system(self):
        self.missing("g++", "ffmpeg", "nodejs", "npm", "chromium", "clang-format-14")
        self.assertEqual(self.installed(), ["g++", "ffmpeg"])
        self.assertEqual(self.installed("--web"), ["g++", "ffmpeg", "nodejs", "npm"])
        self.assertEqual(self.installed("--test"), ["g++", "ffmpeg", "clang-format-14", "chromium", "nodejs", "npm"])

    def test_node_from_another_source(self):
        self.missing("npm")  # its package of nodejs has the command
        for name in ("node", "npm"):
            self.program(name, "")
        for option in ("--web", "--test"):
            self.assertIsNone(self.installed(option))

    def test_node_without_a_package(self):
        self.missing("nodejs", "npm")
        self.program("node", "")
        self.assertEqual(self.installed("--web"), ["npm"])
        self.program("npm", "")
        self.assertIsNone(self.installed("--web"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
