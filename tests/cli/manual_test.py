"""Manual pages: all commands and options in them, no warning of groff, the same for each machine."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import unittest

import program

ROOT = pathlib.Path(__file__).resolve().parents[2]
SECTIONS = ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "ENVIRONMENT", "FILES", "SEE ALSO"]


def listed_commands(text):
    """The names in the list of subcommands of a help text."""
    listed = re.search(r"^Subcommands:\n((?:  .*\n)+)", text + "\n", re.M)
    return re.findall(r"^  ([a-z-]+) ", listed[1], re.M) if listed else []


def plain(text):
    """Letters and marks without white space: lines of the page break elsewhere."""
    return re.sub(r"\s+", "", text)


class ManPages(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.groff = shutil.which("groff")

    def setUp(self):
        super().setUp()
        self.check(0, "man-pages", "man1")
        self.pages = {path.stem: path.read_text() for path in (self.folder / "man1").iterdir()}

    def commands(self, *words):
        """Each command with its own commands, and its help."""
        text = self.check(0, *words, "--help").stdout
        yield words, text
        for name in listed_commands(text):
            yield from self.commands(*words, name)

    def rendered(self, name):
        run = subprocess.run([self.groff, "-ww", "-man", "-Tutf8", "-P-cbou", "-rLL=200n"], input=self.pages[name], text=True,
                             capture_output=True, timeout=60)
        self.assertEqual((run.returncode, run.stderr), (0, ""), name)
        return run.stdout

    def test_each_command_has_a_page_with_all_sections(self):
        names = listed_commands(self.check(0, "--help").stdout)
        self.assertIn("render", names)
        self.assertEqual(sorted(self.pages), sorted(["tumble", *("tumble-" + name for name in names)]))
        for name, text in self.pages.items():
            sections = re.findall(r"^\.SH (.*)", text, re.M)
            self.assertEqual([s for s in sections if s in SECTIONS], SECTIONS, name)
            self.assertTrue(name == "tumble-doctor" or "EXAMPLES" in sections, name)

    def test_pages_hold_the_text_of_the_help(self):
        if self.groff is None:
            self.skipTest("groff is not installed")
        for words, text in self.commands():
            page = plain(self.rendered("-".join(["tumble", *words[:1]])))
            options = re.split(r"\n(?:Options|Subcommands):\n", text)[1] if "\nOptions:" in text else ""
            entries = re.findall(r"^  (-\S+)(.*(?:\n {32}.*)*)", options, re.M)
            self.assertGreaterEqual(len(entries), 1, words)
            for names, rest in entries:
                for option in names.split(","):
                    self.assertIn(option, page, words)
                rest = re.sub(r"^.* REQUIRED\b", "", rest)
                help_text = re.split(r" {2,}", rest.replace("\n" + 32 * " ", "  ").strip(), maxsplit=1)[-1]
                self.assertIn(plain(help_text), page, (words, names))
            own = text.split("\nStart here:")[0] if words else text   # the footer of the program
            for example in re.findall(r"^  (tumble .*)", own, re.M):
                self.assertIn(plain(example), page)

    def test_groff_warns_of_nothing(self):
        if self.groff is None:
            self.skipTest("groff is not installed")
        for name in self.pages:
            self.assertNotIn("REQUIRED", self.rendered(name))   # the help's mark; pages have "Required." and the synopsis

    def test_man_shows_them(self):
        if shutil.which("man") is None:
            self.skipTest("man is not installed")
        run = subprocess.run(["man", "--warnings", "-l", self.folder / "man1/tumble-render.1"], text=True, capture_output=True,
                             timeout=60, env={**os.environ, "MANPAGER": "cat", "LC_ALL": "C.UTF-8", "MANROFFOPT": "", "MANWIDTH": "80"})
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertIn("--frames", run.stdout)

    def test_exit_codes_are_those_of_the_help(self):
        for words, text in self.commands():
            own = re.sub(r"^Subcommands:\n(?:  .*\n)+", "", text, flags=re.M)   # their codes are in their pages
            said = re.findall(r"[Ee]xit codes?:? ((?:\d [^,.(]*(?:\([^)]*\))?[^,.]*[,.]? ?)+)", re.sub(r"\s+", " ", own))
            status = self.pages["-".join(["tumble", *words[:1]])].split(".SH EXIT STATUS\n")[1].split(".SH")[0]
            if said and len(words) > 1:   # of a command in a command
                status = status.split(f"Of \\fBtumble {' '.join(words)}\\fR:")[1].split(".PP")[0]
            found = re.findall(r"^\\fB(\d)\\fR$", status, re.M)
            self.assertIn("0", found, words)
            for code in re.findall(r"(?:^|, )(\d) ", said[0]) if said else "02":
                self.assertIn(code, found, (words, said))

    def test_each_variable_of_the_sources_is_in_the_pages(self):
        names = {name for path in (ROOT / "src").rglob("*.cpp")
                 for name in re.findall(r'getenv\("(TUMBLE_\w+|PATH)"\)', path.read_text())}
        self.assertIn("TUMBLE_SHADERS", names)
        for name in names:
            self.assertIn(f"\\fB{name}\\fR", self.pages["tumble"], name)

    def test_the_same_on_another_machine(self):
        """No number of cores, no folder, no date."""
        one = subprocess.run(["taskset", "-c", str(min(os.sched_getaffinity(0))), program.TUMBLE, "man-pages", "other"],
                             cwd=self.folder, capture_output=True, env={"HOME": "/", "TZ": "Asia/Tokyo"}) \
            if shutil.which("taskset") else self.run_tumble("man-pages", "other")
        self.assertEqual(one.returncode, 0, one.stderr)
        for name, text in self.pages.items():
            self.assertEqual((self.folder / "other" / f"{name}.1").read_text(), text, name)
            self.assertNotIn(str(ROOT), text)
            self.assertNotRegex(text, r"\[\d+\]\n(Threads|Render processes)")

    def test_json_has_the_commands_and_options_of_the_help(self):
        description = json.loads(self.check(0, "manual", "--json").stdout)
        values = {"flag": False, "text": True, "number": True, "choice": True, "list": True, "file": True, "folder": True}
        for words, text in self.commands():
            command = description
            for word in words:
                command = next(part for part in command["commands"] if part["name"] == word)
            self.assertEqual([part["name"] for part in command["commands"]], listed_commands(text), words)
            shown = re.findall(r"^  (-[^ ]+)( [^ ]+)?", re.split(r"\n(?:Examples?|Start here):\n", text)[0], re.M)
            self.assertEqual(sorted(",".join(option["names"]) for option in command["options"]),
                             sorted(names for names, _ in shown), words)
            for option in command["options"] + command["arguments"]:
                self.assertEqual("value" in option, values[option["type"]], option)
                self.assertEqual(option["type"] in ("choice", "list"), "choices" in option and option["type"] != "file", option)
                if "endings" in option:
                    self.assertEqual(option["type"], "file", option)
        self.check(2, "manual")

    def test_a_folder_that_cannot_be_made(self):
        self.write("file", "")
        self.assertIn("error: cannot make the folder 'file'", self.check(1, "man-pages", "file").stderr)
        self.check(2, "man-pages")
        self.check(2, "man-pages", "")


if __name__ == "__main__":
    program.main()
