"""Help, versions, wrong usage, bad scenes; `info` and `doctor`."""

import os
import pathlib
import re

import program

COMMANDS = ["render", "simulate", "encode", "compare", "info", "doctor"]


class Help(program.ProgramTest):
    def test_version(self):
        self.assertRegex(self.check(0, "--version").stdout, r"^tumble \d+\.\d+\.\d+\n$")

    def test_help_names_every_command(self):
        text = self.check(0, "--help").stdout
        for command in COMMANDS:
            self.assertIn(command, text)
        self.assertIn("Exit codes: 0 done", text)

    def test_help_of_every_command(self):
        for command in COMMANDS:
            text = self.check(0, command, "--help").stdout
            self.assertIn("Usage: tumble " + command, text)
            if command != "doctor":
                self.assertIn("Example", text)

    def test_help_has_at_most_100_columns(self):
        def commands(*words):
            text = self.check(0, *words, "--help").stdout
            for line in text.splitlines():
                self.assertLessEqual(len(line), 100, line)
            listed = re.search(r"^Subcommands:\n((?:  .*\n)+)", text, re.M)
            names = re.findall(r"^  ([a-z]+) ", listed[1], re.M) if listed else []
            return 1 + sum(commands(*words, name) for name in names)
        self.assertGreater(commands(), 18)

    def test_help_has_the_documented_options(self):
        options = {"render": ["-o", "--frames", "--size", "--fps", "--duration", "--samples", "--threads", "--gl", "--quiet"],
                   "simulate": ["--trajectory", "--energy", "--step", "--steps-per-frame", "--integrator", "--impacts",
                                "--impact-law", "--duration", "--fps", "--threads"],
                   "encode": ["-o", "--fps"], "compare": ["--diff", "--tolerance", "--fraction"]}
        for command, names in options.items():
            text = self.check(0, command, "--help").stdout
            for name in names:
                self.assertIn(name, text)


class WrongUsage(program.ProgramTest):
    def test_misspelled_words_get_suggestions(self):
        for words, told in (
                (["rendr", "scene.toml"], 'unknown command "rendr" (did you mean "render"?)'),
                (["simulat"], 'unknown command "simulat" (did you mean "simulate"?)'),
                (["golden", "chek", "golden.toml"], 'unknown command "chek" (did you mean "check"?)'),
                (["farm", "slrum"], 'unknown command "slrum" (did you mean "slurm"?)'),
                (["zzz"], 'unknown command "zzz" (see'),
                (["render", "scene.toml", "--sped", "2"], 'unknown option "--sped" of tumble render (did you mean "--speed"?)'),
                (["render", "--sped=2"], 'unknown option "--sped" of tumble render (did you mean "--speed"?)'),
                (["render", "scene.toml", "-fps", "2"], 'unknown option "-fps" of tumble render (did you mean "--fps"?)'),
                (["render", "--set", "--sped", "--quite", "scene.toml"], 'unknown option "--quite" of tumble render (did you mean "--quiet"?)'),
                (["golden", "check", "a.toml", "--rport", "r"], 'unknown option "--rport" of tumble golden check (did you mean "--report"?)'),
                (["--verson"], 'unknown option "--verson" of tumble (did you mean "--version"?)'),
                (["render", "scene.toml", "--qqqqqq"], 'unknown option "--qqqqqq" of tumble render (see'),
                (["render", "scene.toml", "--quality", "darft"], "must be one of draft, normal, best (was 'darft') (did you mean \"draft\"?)"),
                (["render", "scene.toml", "--layout", "gird"], '(did you mean "grid"?)'),
                (["render", "scene.toml", "--aov", "dept"], '(did you mean "depth"?)'),
                (["render", "scene.toml", "--overlay", "velocty"], '(did you mean "velocity"?)'),
                (["render", "scene.toml", "--plot-place", "besid"], '(did you mean "beside"?)'),
                (["render", "scene.toml", "--method", "note"], '(did you mean "notes"?)'),
                (["simulate", "scene.toml", "--integrator", "exat"], '(did you mean "exact"?)'),
                (["simulate", "scene.toml", "--impacts", "steped"], '(did you mean "stepped"?)'),
                (["simulate", "scene.toml", "--impact-law", "simultanous"], '(did you mean "simultaneous"?)'),
                (["export", "scene.toml", "-o", "a.glb", "--keys", "cubc"], '(did you mean "cubic"?)'),
                (["completion", "bsh"], '(did you mean "bash"?)'),
                (["info", "scene.toml", "--set", 'body.crate.type="fixd"'], '(did you mean "fixed"?)')):
            with self.subTest(words=words):
                run = self.check(2, *words)
                self.assertIn("error: ", run.stderr)
                self.assertIn(told, run.stderr)
                self.assertEqual((run.stdout, self.names()), ("", []))

    def test_values_are_no_options(self):
        """The word after an option is its value, and a word after -- is an argument."""
        self.assertNotIn("unknown", self.check(2, "render", "scene.toml", "--start", "-1").stderr)
        self.assertNotIn("unknown option", self.check(2, "render", "--", "--sped").stderr)

    def test_exit_code_2_and_nothing_written(self):
        for arguments in ([], ["paint"], ["render"], ["render", "scene.toml", "--colour"], ["render", "scene.toml", "more"],
                          ["render", "none.toml"], ["simulate", "."], ["render", "scene.toml", "--size", "48"],
                          ["render", "scene.toml", "--size", "48x"], ["render", "scene.toml", "--size", ""],
                          ["render", "scene.toml", "--size", "48x32x2"],
                          ["render", "scene.toml", "--size=-48x32"], ["render", "scene.toml", "--size", "0x0"],
                          ["render", "scene.toml", "--size", "1000000x1000000"],
                          ["render", "scene.toml", "--fps", "0"], ["render", "scene.toml", "--fps", "nan"],
                          ["render", "scene.toml", "--fps", "fast"], ["render", "scene.toml", "--duration=-1"],
                          ["render", "scene.toml", "--duration", "inf"],
                          ["render", "scene.toml", "--threads", "0"], ["render", "scene.toml", "--threads", "two"],
                          ["render", "scene.toml", "--samples", "0"], ["render", "scene.toml", "--gl", "vulkan"],
                          ["render", "scene.toml", "-o", "clip.avi"], ["render", "scene.toml", "-o", "clip"],
                          ["render", "scene.toml", "-o", "clip.webm", "--fps", "1e6"],
                          ["simulate", "scene.toml", "--step", "0.025", "--steps-per-frame", "4"],
                          ["simulate", "scene.toml", "--step", "0.03"], ["simulate", "scene.toml", "--steps-per-frame", "0"],
                          ["simulate", "scene.toml", "--integrator", "magic"],
                          ["simulate", "scene.toml", "--impacts", "magic"], ["simulate", "scene.toml", "--fps", "1.1e6"],
                          ["simulate", "scene.toml", "--trajectory", "t.csv", "--energy", "t.csv"],
                          ["simulate", "scene.toml", "--trajectory", "t.csv", "--energy", "./t.csv"],
                          ["render", "scene.toml", "--frames", ""], ["render", "scene.toml", "-o", ""], ["render", ""],
                          ["render", "scene.toml", "--aov", "depth", "--aov-folder", ""],
                          ["simulate", "scene.toml", "--trajectory", ""], ["simulate", "scene.toml", "--energy", ""],
                          ["encode"], ["encode", "."], ["encode", ".", "-o", "clip.mp4"], ["encode", ".", "-o", "clip.txt"],
                          ["compare"], ["compare", "a.png"], ["compare", "a.png", "b.png"], ["info"], ["info", "none.toml"]):
            with self.subTest(arguments=arguments):
                run = self.check(2, *arguments)
                self.assertIn("error", run.stderr)
                self.assertEqual(run.stdout, "")
                self.assertEqual(self.names(), [])

    def test_no_input_is_replaced(self):
        self.write("clip.mp4", program.SCENE)   # a scene whose clip would have its own name
        (self.folder / "a.png").write_bytes(program.png(8, 8))
        for arguments in (["render", "clip.mp4"], ["render", "scene.toml", "-o", "scene.toml"],
                          ["simulate", "scene.toml", "--energy", "./scene.toml"],
                          ["simulate", "scene.toml", "--trajectory", self.folder / "scene.toml"],
                          ["compare", "a.png", "a.png", "--diff", "a.png"]):
            with self.subTest(arguments=arguments):
                self.check(2, *arguments)
        for scene in ("scene.toml", "clip.mp4"):
            self.assertEqual((self.folder / scene).read_text(), program.SCENE)
        self.assertEqual((self.folder / "a.png").read_bytes(), program.png(8, 8))

    def test_options_are_named(self):
        for option, value in (("--fps", "0"), ("--duration", "-1"), ("--size", "48by32"), ("--samples", "-3"),
                              ("--threads", "-1"), ("--start", "nan")):
            self.assertIn(option, self.check(2, "render", "scene.toml", f"{option}={value}").stderr)

    def test_an_error_in_the_scene_has_file_line_and_column(self):
        for old, new, line in (("duration = 0.5", "duration = nan", 4), ("fps = 10", "fsp = 10", 8),
                               ('type = "plane"', 'type = "plain"', 16), ("format = 1", "format = 9", 1),
                               ("density = 600.0", "density = 0.0", 12), ("[0.0, 3.0, 0.0]", "[0.0, 3.0]", 21),
                               ('title = "Two bodies"', "title = ", 2)):
            with self.subTest(new=new):
                self.write("bad.toml", program.SCENE.replace(old, new))
                for command in (["render", "bad.toml", "-o", "a.mp4", "--frames", "f"],
                                ["simulate", "bad.toml", "--trajectory", "t.csv"], ["info", "bad.toml"]):
                    run = self.check(2, *command)
                    self.assertTrue(program.located(run.stderr), run.stderr)
                    self.assertTrue(run.stderr.startswith(f"bad.toml:{line}:"), run.stderr)
                self.assertEqual(self.names(), ["bad.toml"])


class Info(program.ProgramTest):
    def test_describes_bodies_and_cost(self):
        text = self.check(0, "info", "scene.toml").stdout
        for part in ("Two bodies", "6 frames", "3 bodies", "1 dynamic box, 600 kg", "1 dynamic sphere", "1 fixed plane",
                     "crate", "100 100 100", "48 x 32"):
            self.assertIn(part, text)
        self.assertEqual(self.names(), [])

    def test_says_where_exact_impacts_need_steps(self):
        scene = program.SCENE.replace("[simulation]", "[simulation]\nimpacts = \"exact\"", 1)
        self.write("plain.toml", scene)
        self.assertNotIn("step by step", self.check(0, "info", "plain.toml").stdout)
        self.write("driven.toml", scene + '\n[wind]\nvelocity = [1, 0, 0]\n[[explosion]]\ncenter = [0, 0, 0]\nimpulse = 1\n')
        self.assertIn("bodies move step by step where these act: wind; explosions, in their steps\n",
                      self.check(0, "info", "driven.toml").stdout)

    def test_large_scenes_are_summarized(self):
        bodies = "".join(f'[[body]]\nshape = {{ type = "sphere", radius = 0.1 }}\nposition = [{n}.0, 1.0, 0.0]\n'
                         for n in range(300))
        self.write("many.toml", "format = 1\n" + bodies)
        text = self.check(0, "info", "many.toml").stdout
        self.assertIn("300 dynamic sphere", text)
        self.assertIn("more\n", text)
        self.assertLess(len(text.splitlines()), 60)

    def test_an_empty_scene(self):
        self.write("empty.toml", "format = 1\n")
        self.assertIn("0 bodies", self.check(0, "info", "empty.toml").stdout)


class Doctor(program.ProgramTest):
    def test_all_requirements_met(self):
        text = self.check(0, "doctor").stdout
        for part in ("tumble ", "llvmpipe", "osmesa", "egl", "ffmpeg version", "shaders", "All requirements are met"):
            self.assertIn(part, text)

    def test_font_and_player_are_no_requirements(self):
        """Their lines name a remedy; the verdict does not depend on them."""
        (self.folder / "page.html").touch()
        built = self.check(0, "doctor", env={**os.environ, "TUMBLE_WEB": str(self.folder)}).stdout
        self.assertRegex(built, rf"player of pages +ok +{self.folder}\n")
        self.write("fonts.conf", "<fontconfig></fontconfig>")
        bare = self.check(0, "doctor", env={**os.environ, "TUMBLE_WEB": str(self.folder / "none"),
                                            "FONTCONFIG_FILE": str(self.folder / "fonts.conf")}).stdout
        self.assertRegex(bare, r"player of pages +MISSING +not built\n +try: scripts/build-web")
        self.assertRegex(bare, r"font +MISSING .*\n +try: apt-get install fonts-inter")

    def test_no_ffmpeg(self):
        run = self.check(1, "doctor", env={**os.environ, "PATH": str(self.folder)})
        self.assertIn("apt-get install ffmpeg", run.stdout)

    def test_no_shaders(self):
        run = self.check(1, "doctor", env={**os.environ, "TUMBLE_SHADERS": str(self.folder / "none")})
        self.assertIn("MISSING", run.stdout)


if __name__ == "__main__":
    program.main()
