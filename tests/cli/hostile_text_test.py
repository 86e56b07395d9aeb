"""Foreign text (titles, names, keys, file names, output of another program) in messages: no control sequence of the
terminal, no line break, and a bounded length."""

import os

import program

# Escape sequences (ESC and C1), a bell, a line break, a reversed reading direction, a byte that is not UTF-8.
EVIL = "\x1b]0;owned\x07\x1b[2J\x9b31m\nerror: fake\u202eab"
EVIL_TOML = r"\u001b]0;owned\u0007\u001b[2J\u009b31m\nerror: fake\u202eab"
SHOWN = r"\x1b]0;owned\x07\x1b[2J\u009b31m\nerror: fake\u202eab"
BALL = 'shape = { type = "sphere", radius = 0.1 }\n'


class HostileText(program.ProgramTest):
    def assert_safe(self, run, most=20000):
        for text in (run.stdout, run.stderr):
            for c in text:
                self.assertTrue(c == "\n" or (ord(c) >= 0x20 and not 0x7f <= ord(c) <= 0x9f and not 0x202a <= ord(c) <= 0x202e),
                                f"{c!r} in {text[:2000]!r}")
            self.assertLess(len(text), most)
            self.assertNotIn("\nerror: fake", text)

    def error_of(self, scene):
        (self.folder / "evil.toml").write_text(scene)
        run = self.check(2, "info", "evil.toml")
        self.assert_safe(run)
        self.assertEqual(run.stderr.count("\n"), 1)
        return run.stderr

    def test_titles_and_names(self):
        (self.folder / "evil.toml").write_text(
            f'format = 1\ntitle = "{EVIL_TOML}"\n[camera]\nfollow = "{EVIL_TOML}"\n[[body]]\nname = "{EVIL_TOML}"\n' + BALL)
        run = self.check(0, "info", "evil.toml")
        self.assert_safe(run)
        self.assertEqual(run.stdout.count(SHOWN), 3)

    def test_values_and_keys(self):
        for scene in (f'format = "{EVIL_TOML}"', f'format = 1\n"{EVIL_TOML}" = 2', f'format = 1\n["{EVIL_TOML}"]',
                      f'format = 1\nmaterials."{EVIL_TOML}" = 3', f'format = 1\nmaterials."{EVIL_TOML}".x = 3',
                      f'format = 1\nmaterials."{EVIL_TOML}".color = 3', f'format = 1\n[simulation]\nintegrator = "{EVIL_TOML}"',
                      f'format = 1\n[[body]]\n{BALL}material = "{EVIL_TOML}"',
                      f'format = 1\n[[body]]\n{BALL}name = "{EVIL_TOML}"\n[[body]]\n{BALL}name = "{EVIL_TOML}"',
                      f'format = 1\n[camera]\nfollow = "{EVIL_TOML}"', f'format = 1\n[output]\nsize = ["{EVIL_TOML}", 2]',
                      f'format = 1\n[[body]]\nshape = {{ type = "mesh", file = "{EVIL_TOML}.obj" }}'):
            with self.subTest(scene=scene):
                self.error_of(scene)

    def test_raw_bytes_in_a_scene(self):
        for bad in (b"\x1b[2J", b"\x07", b"\xff\xfe", b"\xc2\x9b", "\u202e".encode(), b"\x00"):
            for scene in (b"format = 1\ntitle = \"" + bad + b"\"\nx = 1", b"format = 1\n" + bad + b" = 1", b"# " + bad, bad):
                with self.subTest(scene=scene):
                    (self.folder / "evil.toml").write_bytes(scene)
                    run = self.check(2, "info", "evil.toml")
                    self.assert_safe(run)
                    self.assertEqual(run.stderr.count("\n"), 1)

    def test_endless_texts(self):
        endless = "k" * 1_000_000
        for scene in (f"format = 1\n{endless} = 1", f'format = "{endless}"', f"format = 1\n[{endless}]",
                      f'format = 1\n[materials]\n{endless} = 1', f"format = 1\nmaterials.{endless}.x = 1",
                      f'format = 1\n[simulation]\nintegrator = "{endless}"',
                      f'format = 1\n[[body]]\n{BALL}material = "{endless}"', f"format = [{'1,' * 500_000}]",
                      f'format = 1\n[[body]]\n{BALL}name = "{endless}"\n[[body]]\n{BALL}name = "{endless}"'):
            with self.subTest(scene=scene[:60]):
                error = self.error_of(scene)
                self.assertLess(len(error), 1000)
                self.assertRegex(error, r"\.\.\. \(\d+ (bytes|items)\)")

    def test_an_endless_name_in_a_table(self):
        (self.folder / "evil.toml").write_text(f'format = 1\ntitle = "{"t" * 1000000}"\n[[body]]\nname = "{"n" * 1000000}"\n' + BALL)
        self.assert_safe(self.check(0, "info", "evil.toml"))

    def test_the_command_line(self):
        for arguments in ([EVIL], ["info"], ["info", EVIL], ["info", "scene.toml", EVIL], ["info", "--" + EVIL],
                          ["info", "scene.toml", "--fps", EVIL], ["info", "scene.toml", "--size", EVIL],
                          ["render", "scene.toml", "-o", EVIL], ["render", "scene.toml", "-o", "a." + EVIL],
                          ["render", "scene.toml", "--start", EVIL], ["render", "scene.toml", "--gl", EVIL],
                          ["render", "scene.toml", "--frames", "a", "--aov", EVIL], ["simulate", "scene.toml", "--integrator", EVIL],
                          ["simulate", "scene.toml", "--energy", EVIL, "--trajectory", EVIL],
                          ["encode", EVIL, "-o", "a.mp4"], ["compare", EVIL, EVIL], ["compare", "--tolerance", EVIL],
                          ["compare", "x" * 100000, "b"], ["info", "scene.toml", "--fps", "9" * 100000]):
            with self.subTest(arguments=arguments):
                run = self.check(2, *arguments)
                self.assert_safe(run)
                self.assertEqual(run.stderr.count("\n"), 1, run.stderr)

    def test_names_of_files(self):
        name = EVIL.replace("/", "")
        (self.folder / (name + ".toml")).write_text("format = 2")
        run = self.check(2, "info", name + ".toml")
        self.assert_safe(run)
        self.assertTrue(run.stderr.startswith(SHOWN + ".toml:1:10: error: "), run.stderr)
        (self.folder / (name + ".toml")).write_text(program.SCENE.replace('title = "Two bodies"', ""))
        run = self.check(0, "info", name + ".toml")
        self.assert_safe(run)
        self.assertTrue(run.stdout.startswith(SHOWN + ".toml\n"))
        run = self.check(0, "render", "scene.toml", "--frames", name, "-o", name + ".mp4")
        self.assert_safe(run)
        self.assertIn(f"wrote {SHOWN}.mp4: 6 frames", run.stderr)
        self.assertIn(f"wrote {SHOWN}/frame_000000.png to frame_000005.png", run.stderr)
        self.assert_safe(self.check(0, "encode", name, "-o", name + ".mkv"))
        self.assert_safe(self.check(0, "simulate", "scene.toml", "--energy", name + ".csv"))
        self.assert_safe(self.check(1, "simulate", "scene.toml", "--energy", name + "/no/e.csv"))
        self.assert_safe(self.check(1, "render", "scene.toml", "--frames", name + ".mp4"))

    def test_error_messages_of_another_program(self):
        (self.folder / "bin").mkdir()
        fake = self.folder / "bin/ffmpeg"
        fake.write_text(f"#!/bin/sh\nprintf 'Unknown \\033[31mencoder\\n\\302\\233' >&2; exit 4\n")
        fake.chmod(0o755)
        environment = {**os.environ, "PATH": str(self.folder / "bin")}
        run = self.check(1, "render", "scene.toml", "-o", "a.mp4", env=environment)
        self.assert_safe(run)
        self.assertIn("ffmpeg failed (exit code 4):\nUnknown \\x1b[31mencoder\n\\u009b", run.stderr)
        fake.write_text("#!/bin/sh\nprintf 'ffmpeg version \\033[31m9\\n'\n")
        self.assert_safe(self.check(1, "doctor", env=environment))


if __name__ == "__main__":
    program.main()
