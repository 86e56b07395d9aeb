"""The documents against the program: the command-line page is current, scenes in them load, commands in them exist."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TUMBLE = os.environ["TUMBLE"]
WITH_SUBCOMMANDS = ("farm", "golden")
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.M | re.S)


def blocks(language):
    """(page, text) of each fenced block of a language."""
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "bench").rglob("*.md")]
    return [(page.relative_to(ROOT).as_posix(), text) for page in sorted(pages)
            for found, text in BLOCK.findall(page.read_text(encoding="utf-8")) if found == language]


def run(*words):
    return subprocess.run(words, capture_output=True, text=True, timeout=60)


class Documents(unittest.TestCase):
    def test_the_command_line_page_is_current(self):
        made = run(sys.executable, "-B", ROOT / "scripts/make-cli-reference", TUMBLE, "--check")
        self.assertEqual(made.returncode, 0, made.stderr)

    def test_scenes_load(self):
        """Blocks with a table of a scene; those without the format number get it. Plans, suites and tolerances are other files."""
        scenes = [(page, text) for page, text in blocks("toml") if re.search(r"^\[", text, re.M)
                  and not re.search(r"^(scene|references|levels|sample|pattern) *=|^\[\[(case|axis|rule|draw)\]\]", text, re.M)]
        self.assertGreater(len(scenes), 5)
        with tempfile.TemporaryDirectory(prefix="tumble-documents-") as folder:
            (pathlib.Path(folder) / "meshes").symlink_to(ROOT / "assets/meshes")
            (pathlib.Path(folder) / "scenes").mkdir()
            scene = pathlib.Path(folder) / "scenes/scene.toml"
            for page, text in scenes:
                with self.subTest(page=page):
                    scene.write_text(text if "format = 1" in text else "format = 1\n" + text)
                    loaded = run(TUMBLE, "info", scene)
                    self.assertEqual(loaded.returncode, 0, loaded.stderr + text)

    def test_commands_and_options_exist(self):
        helps = {}
        commands = [(page, match) for page, text in blocks("sh")
                    for match in re.finditer(r"(?:^|/)tumble ([a-z]+)(.*?)(?:#.*)?$", text, re.M)]
        self.assertGreater(len(commands), 10)
        for page, match in commands:
            with self.subTest(page=page, command=match[0]):
                below = re.match(r" ([a-z]+) ", match[2])   # as in: tumble farm slurm
                words = (match[1], below[1]) if below and match[1] in WITH_SUBCOMMANDS else (match[1],)
                if words not in helps:
                    asked = run(TUMBLE, *words, "--help")
                    helps[words] = asked.stdout if asked.returncode == 0 else ""
                self.assertTrue(helps[words], words)
                for option in re.findall(r"--[a-z-]+", match[2]):
                    self.assertRegex(helps[words], rf"{option}\b")

    def test_scripts_exist(self):
        for page, text in blocks("sh"):
            for name in re.findall(r"^scripts/([a-z_-]+)", text, re.M):
                with self.subTest(page=page):
                    self.assertTrue((ROOT / "scripts" / name).is_file(), name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
