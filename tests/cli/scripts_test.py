"""The scripts: --help shows the usage of each, and an unknown option ends a script before it has any effect."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "scripts"
SCRIPTS = sorted(p.name for p in FOLDER.iterdir() if p.is_file() and os.access(p, os.X_OK))
# Replaced programs that would install, build or run something; each leaves a file as evidence.
OTHER_PROGRAMS = ("apt-get", "cmake", "ctest", "dpkg-query", "ffmpeg", "ninja", "sudo")


class Scripts(unittest.TestCase):
    """Each script runs as a copy in a temporary tree, which must stay unchanged."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="tumble-scripts-"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copytree(FOLDER, self.folder / "scripts", ignore=shutil.ignore_patterns("__pycache__"))
        (self.folder / "programs").mkdir()
        for name in OTHER_PROGRAMS:
            program = self.folder / "programs" / name
            program.write_text(f'#!/bin/sh\ntouch "{self.folder}/{name} was called"\nexit 1\n')
            program.chmod(0o755)
        (self.folder / "here").mkdir()

    def run_script(self, name, *arguments):
        before = self.names()
        run = subprocess.run([self.folder / "scripts" / name, *arguments], cwd=self.folder / "here", text=True, timeout=60,
                             stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             env={**os.environ, "PATH": f"{self.folder}/programs:{os.environ['PATH']}"})
        self.assertEqual(self.names(), before, f"{name} {arguments}\n{run.stdout}\n{run.stderr}")
        return run

    def names(self):
        return sorted(str(p.relative_to(self.folder)) for p in self.folder.rglob("*"))

    def test_there_are_scripts(self):
        self.assertIn("make-crowd-scenes", SCRIPTS)

    def test_help(self):
        for name in SCRIPTS:
            for option in ("--help", "-h"):
                with self.subTest(name=name, option=option):
                    run = self.run_script(name, option)
                    self.assertEqual(run.returncode, 0, run.stderr)
                    self.assertIn(name, run.stdout)
                    self.assertEqual(run.stderr, "")

    def test_unknown_options(self):
        for name in SCRIPTS:
            for arguments in (("--no-such-option",), ("--no-such-option", "value"), ("-x",)):
                with self.subTest(name=name, arguments=arguments):
                    run = self.run_script(name, *arguments)
                    self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
                    self.assertNotEqual(run.stderr, "")

    def test_unknown_words(self):
        for arguments in (("bench", "no-such-benchmark"), ("bench", "accuracy", "--rounds", "2"), ("bench", "contact", "--case"),
                          ("demo", "more"), ("install-dependencies", "more"), ("accept-golden", "no-such-scene"),
                          ("test", "more"), ("test", "-R"), ("make-crowd-scenes",), ("make-scenes-picture",), ("make-readme-clip",),
                          ("make-meshes", "a", "b"), ("plot-contact", "a"), ("plot-joints", "a"), ("make-cli-reference",), ("check-prose", "no-such-file"),
                          ("lecture", "a", "b"), ("lecture", "--size"), ("lecture", "--only")):
            with self.subTest(arguments=arguments):
                run = self.run_script(*arguments)
                self.assertEqual(run.returncode, 2, run.stdout + run.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
