"""scripts/check-prose: the tree follows the mechanical writing rules, and planted sentences that break them are found.

Run it alone with: python3 tests/cli/prose_test.py
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts/check-prose"

# A sentence that breaks one rule, and the name of the finding.
# Sentences that break the rules on purpose, each with the name of the finding that it must give.
BAD = [("What rests, rests.", "free relative"), ("It tells what was read.", "free relative"),
       ("Here is what moved and what is drawn.", "free relative"), ("Whatever happens in a step takes time.", "free relative"),
       ("All who fly are moved.", "who"), ("Whom the blow has come to takes part.", "whom"), ("Then he stops.", "a body is 'it'"),
       ("The ball keeps his spin.", "a body is 'it'"), ("A process waits for ever.", "for ever"), ("Measured by turns.", "by turns"),
       ("With the engine of now it is faster.", "of now"), ("It lies .7 mm lower.", "number without 0"),
       ("The centre of the ball.", "British spelling"), ("Gives all bodies a colour.", "British spelling"),
       ("Textures are rasterised.", "British spelling"), ("A body behind its neighbours.", "British spelling"),
       ("Given by the scene, else 0.", "else for otherwise")]
GOOD = ["Resting bodies stay at rest.", "Users who need more open an issue.", "What does a force do?", "It takes 0.7 mm and 3.5 s.", "It does nothing else.",
        "See `centre` and `what rests`.", "The center of a gray body, in meters.", "A promise, a rise, an exercise, otherwise precise."]
PLACES = {
    "src/a.cpp": "// {}\nint main() {{}}\n",
    "src/b.h": "/** {} */\n",
    "src/c.cpp": 'auto text = "{}";\n',
    "tests/d.cpp": 'auto text = R"(\n{}\n)";\n',
    "shaders/e.frag": "float x;   // {}\n",
    "scripts/f": "#!/bin/bash\n# {}\n",
    "scripts/g.py": '"""{}"""\n',
    "scripts/h": "#!/usr/bin/env python3\nx = 1   # {}\n",
    "tests/CMakeLists.txt": "# {}\n",
    "docs/i.md": "# Title\n\n{}\n",
    "README.md": "{}\n",
}


def run(root, *arguments):
    done = subprocess.run([sys.executable, "-B", SCRIPT, "--root", root, *arguments], capture_output=True, text=True, encoding="utf-8")
    return done.returncode, done.stdout.splitlines(), done.stderr


def tree_of(folder, files):
    for name, text in files.items():
        path = pathlib.Path(folder) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    for name in ("docs", "src", "include", "examples", "tests", "bench", "scripts", "shaders"):
        (pathlib.Path(folder) / name).mkdir(exist_ok=True)


class Prose(unittest.TestCase):
    maxDiff = None

    def checked(self, files, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            tree_of(folder, files)
            code, lines, error = run(folder, *arguments)
        self.assertEqual(error, "")
        self.assertEqual(code, 1 if lines[:-1] else 0)
        return lines[:-1]

    def test_the_tree_follows_the_rules(self):
        code, lines, error = run(ROOT)
        self.assertEqual((code, lines[:-1], error), (0, [], ""))

    def test_each_planted_sentence_is_found_in_each_place(self):
        for sentence, finding in BAD:
            found = self.checked({name: text.format(sentence) for name, text in PLACES.items()})
            for name in PLACES:
                with self.subTest(sentence=sentence, name=name):
                    self.assertTrue(any(line.startswith(f"{name}:") and f": {finding}: " in line for line in found), found)

    def test_good_sentences_are_not_found(self):
        self.assertEqual(self.checked({name: "".join(text.format(sentence) for sentence in GOOD) for name, text in PLACES.items()}), [])

    def test_sentences_across_lines_and_names_of_tests_are_found(self):
        found = self.checked({"src/a.cpp": "int x;\n// It waits for\n// ever.\n", "tests/b.cpp": "TEST(World, WhatRestsStaysAtTheCentre) {}\n",
                              "tests/c.py": "def test_he_waits():\n    pass\n"})
        self.assertEqual([line.split(": ")[:2] for line in found], [
            ["src/a.cpp:3", "for ever"], ["tests/b.cpp:1", "British spelling"], ["tests/b.cpp:1", "free relative"],
            ["tests/c.py:1", "a body is 'it'"]])

    def test_comments_that_begin_without_a_subject_are_found(self):
        found = self.checked({"src/a.cpp": "int a;   // m\n// Of the body.\nint b;\nbool c;   // whether it moves\n/* Whether it rests. */\n",
                              "tests/b.h": "/// A paragraph.\n///\n/// Of another one.\n    // Whether it\n    // moves.\n",
                              "shaders/c.frag": "/** A paragraph.\n *\n * Whether it\n * moves. */\nfloat x;   //!< Of a body\n"})
        self.assertEqual([line.split(": ")[:2] for line in found], [
            [place, "comment without a subject"]
            for place in ("src/a.cpp:2", "src/a.cpp:4", "src/a.cpp:5", "tests/b.h:3", "tests/b.h:4", "shaders/c.frag:3", "shaders/c.frag:5")])

    def test_only_the_begin_of_a_comment_needs_a_subject(self):
        files = {"src/a.cpp": "// It tells\n// whether a body moves. Of two bodies one moves.\nint a;   // of a body\nint b;   // one\n"
                              "         // Of two\nauto c = \"Of a body\";\n/* Two\n   Of them. */\n// `Whether`: a word.\n",
                 "docs/b.md": "Whether a body sleeps is measured.\n", "scripts/c.py": "# Of all bodies one moves.\n"}
        self.assertEqual(self.checked(files), [])

    def test_history_is_found_in_documents_only(self):
        found = self.checked({"docs/a.md": "It is now faster.\n", "src/b.cpp": "// The time is now.\n"})
        self.assertEqual([line.split(": ")[:2] for line in found], [["docs/a.md:1", "history"]])

    def test_code_is_not_prose(self):
        files = {"src/a.cpp": '#include "centre.h"\ndouble centre = .5;   // position\n', "docs/b.md": "```\nwhat is\n```\n`colour`\n",
                 "scripts/c.py": "centre = .5\n"}
        self.assertEqual(self.checked(files), [])

    def test_exceptions_need_a_reason_and_a_use(self):
        text = {"src/a.cpp": "// the centre\n", "tests/prose-exceptions.txt": "# a comment\nsrc/a.cpp | centre | name of a program\n"}
        self.assertEqual(self.checked(text), [])
        text["src/a.cpp"] = "// the middle\n"
        self.assertIn("no text needs this exception", self.checked(text)[0])
        text["tests/prose-exceptions.txt"] = "src/b.cpp | centre | name of a program\n"
        self.assertIn("there is no such file", self.checked(text)[0])
        with tempfile.TemporaryDirectory() as folder:
            tree_of(folder, {"tests/prose-exceptions.txt": "src/a.cpp | centre\n"})
            code, _, error = run(folder)
        self.assertEqual((code, "FILE | TEXT | REASON" in error), (1, True))

    def test_pending_folders_are_counted(self):
        text = {"src/sim/a.cpp": "// the centre\n", "tests/prose-exceptions.txt": "src/sim/ | * | rewritten elsewhere\n"}
        self.assertEqual(self.checked(text), [])
        self.assertEqual(len(self.checked(text, "--pending")), 1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
