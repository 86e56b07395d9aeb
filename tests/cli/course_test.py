"""The course: every figure that it states is the one that the runs give, and a wrong one is found.

Skipped (77) where the compiler of lessons is not built (scripts/build-web) or Node is missing.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LESSONS = sorted((ROOT / "course").glob("[0-9]*.md"))
PROGRAM = pathlib.Path(os.environ.get("TUMBLE", ROOT / "build/release/tumble"))
PLAYER = pathlib.Path(os.environ.get("TUMBLE_WEB", PROGRAM.parent.parent / "web"))


def check(lessons):
    return subprocess.run([PROGRAM, "lesson", *lessons, "--check", "--no-pictures", "--quiet"], capture_output=True, text=True, check=False)


class Course(unittest.TestCase):
    def test_states_what_the_runs_give(self):
        result = check(LESSONS)
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_the_list_of_lessons_is_whole(self):
        text = (ROOT / "course/README.md").read_text(encoding="utf-8")
        self.assertGreaterEqual(len(LESSONS), 14)
        self.assertEqual([lesson.name for lesson in LESSONS if f"]({lesson.name})" not in text], [])

    def test_a_wrong_figure_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            course = pathlib.Path(folder) / "course"
            shutil.copytree(ROOT / "course", course)
            (pathlib.Path(folder) / "assets").symlink_to(ROOT / "assets")   # a scene of the course uses its meshes
            wrong = course / "05-two-euler-methods.md"
            text = wrong.read_text(encoding="utf-8")
            self.assertIn("expected = 0.824\n", text)
            wrong.write_text(text.replace("expected = 0.824\n", "expected = 0.825\n"), encoding="utf-8")
            result = check(sorted(course.glob("[0-9]*.md")))
        line = 1 + text[:text.index("expected = 0.824\n")].count("\n")
        self.assertEqual(result.returncode, 2)
        self.assertIn(f"05-two-euler-methods.md:{line}:", result.stderr)


if __name__ == "__main__":
    if not (PLAYER / "lesson.cjs").exists() or not shutil.which("node"):
        print(f"SKIPPED: needs node, and lesson.cjs in {PLAYER} (scripts/build-web)")
        sys.exit(77)
    unittest.main(verbosity=2)
