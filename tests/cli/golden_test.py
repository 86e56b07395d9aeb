"""`golden`: check, accept and add; exit codes, causes, the cache, outputs, platforms."""

import json
import pathlib
import resource
import shutil
import xml.etree.ElementTree

import program

# A ball falls by 1 m onto the ground beside a crate: it lands after 0.45 s, between frames 13 and 14.
SCENE = """\
format = 1
[simulation]
duration = 1.0
steps_per_frame = 4
[output]
size = [96, 64]
fps = 30
samples = 1
[camera]
eye = [0, 2, 6]
target = [0, 0.5, 0]
[light]
direction = [-0.4, -1.0, -0.3]
shadows = true
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
color = "#808080"
[[body]]
name = "crate"
type = "fixed"
shape = { type = "box", size = [0.8, 0.8, 0.8] }
position = [-0.9, 0.4, 0.0]
color = "#c8853c"
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.3 }
position = [0.6, 1.3, 0.0]
restitution = 0.5
"""
SUITE = """\
format = 1
[[case]]
name = "fall"
scene = "scene.toml"
frames = [0, 24]
"""


class Golden(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)
        self.write("golden.toml", SUITE)

    def golden(self, code, action, *arguments, cache="cache"):
        more = ["--cache", cache] if action == "check" else []
        return self.check(code, "golden", action, "golden.toml", *arguments, *more)

    def change(self, old, new):
        self.assertIn(old, SCENE)
        self.write("scene.toml", SCENE.replace(old, new))

    def references(self):
        return {p.name: p.read_bytes() for p in (self.folder / "references").iterdir()}

    def causes(self):
        """Of each image that is not alike, from --json."""
        self.golden(1, "check", "--json", "r.json")
        images = json.loads((self.folder / "r.json").read_text())["images"]
        return {image["name"]: image["causes"] for image in images if image["verdict"] == "different"}


class Verdicts(Golden):
    def test_missing_then_accepted_then_alike(self):
        run = self.golden(3, "check")
        self.assertIn("missing: fall_000000.png", run.stdout)
        self.assertIn("tumble golden accept golden.toml fall", run.stderr)
        self.assertIn("2 new", self.golden(0, "accept", "fall").stderr)
        self.assertEqual(sorted(self.references()), ["fall.motion.json", "fall_000000.png", "fall_000024.png"])
        self.assertIn("2 pictures: 2 same", self.golden(0, "check").stdout)

    def test_a_scene_that_is_missing_or_wrong_is_broken(self):
        self.golden(0, "accept", "--all")
        self.write("golden.toml", SUITE + '[[case]]\nname = "gone"\nscene = "gone.toml"\n')
        run = self.golden(2, "check")
        self.assertIn("gone.toml: error: the scene cannot be read", run.stdout)
        self.assertIn("1 broken", run.stdout)
        self.assertIn("2 same", run.stdout)
        self.change('type = "sphere"', 'type = "ball"')
        self.assertIn("scene.toml:", self.golden(2, "check", "fall").stdout)

    def test_a_reference_that_is_no_picture_or_has_another_size_is_broken(self):
        self.golden(0, "accept", "--all")
        (self.folder / "references/fall_000000.png").write_bytes(program.png(97, 64))
        (self.folder / "references/fall_000024.png").write_text("no picture")
        self.assertIn("2 broken", self.golden(2, "check").stdout)

    def test_mistakes_of_the_suite_and_of_the_command(self):
        self.write("golden.toml", SUITE + "frame = 3\n")
        run = self.golden(2, "check")
        self.assertEqual(run.stderr, 'golden.toml:6:1: error: unknown key "frame" in a case (did you mean "frames"?)\n')
        self.write("golden.toml", SUITE)
        self.assertIn('did you mean "fall"?', self.golden(2, "check", "fal").stderr)
        self.assertIn("--all", self.golden(2, "accept").stderr)
        self.golden(2, "accept", "--all", "fall")
        self.write("golden.toml", SUITE.replace("24]", "240]"))
        run = self.golden(2, "check")
        self.assertIn("golden.toml:5:10: error: frames: ", run.stdout)
        self.assertIn("240", run.stdout)
        self.write("golden.toml", SUITE + 'overlay = "clok"\n')
        self.assertIn("golden.toml:6:11: error: overlay: ", self.golden(2, "check").stdout)
        self.assertEqual(self.check(2, "golden", "check", "none.toml").stderr.splitlines()[0],
                         "none.toml: error: the suite cannot be read: No such file or directory")
        self.assertFalse((self.folder / "references").exists())


class Causes(Golden):
    """A planted change is found, and the named cause is the right one."""

    def setUp(self):
        super().setUp()
        self.golden(0, "accept", "--all")

    def test_a_moved_body(self):
        # A pixel is 0.07 m at the crate: 6 m away, 64 rows over 40 degrees.
        for x, pixels in ((-0.83, "1"), (-0.75, "[23]")):
            self.change("[-0.9, 0.4, 0.0]", f"[{x}, 0.4, 0.0]")
            causes = self.causes()
            self.assertEqual(list(causes), ["fall_000000.png", "fall_000024.png"])
            for sentences in causes.values():
                self.assertEqual(len(sentences), 1)
                self.assertRegex(sentences[0], rf"^crate moved by {pixels} px \(first differing frame 0\)$")

    def test_a_color(self):
        self.change("#808080", "#888888")
        self.assertEqual(self.causes(), {f"fall_{n}.png": ["color of floor (#808080 to #888888)"]
                                         for n in ("000000", "000024")})

    def test_the_light(self):
        self.change("[-0.4, -1.0, -0.3]", "[-0.8, -1.0, -0.3]")
        for causes in self.causes().values():
            self.assertEqual(causes, ["light (direction [-0.3578, -0.8944, -0.2683] to [-0.6082, -0.7603, -0.2281])"])

    def test_a_lost_shadow(self):
        self.change("shadows = true", "shadows = false")
        for causes in self.causes().values():
            self.assertEqual(causes, ["shadow only (shadows are off, they were on)"])

    def test_the_camera(self):
        self.change("eye = [0, 2, 6]", "eye = [0, 2.3, 6]")
        for causes in self.causes().values():
            self.assertEqual(causes, ["camera (eye moved by 0.3 m)"])

    def test_a_restitution(self):
        self.change("restitution = 0.5", "restitution = 0.8")
        causes = self.causes()
        self.assertEqual(list(causes), ["fall_000024.png"])
        self.assertEqual(causes["fall_000024.png"][0], "restitution of ball (0.5 to 0.8)")
        self.assertRegex(causes["fall_000024.png"][1],
                         r"^ball moved by \d+ px \(first differing frame 14, first differing contact at 0.4[56] s\)$")

    def test_text(self):
        self.write("golden.toml", SUITE + 'overlay = "clock"\n')
        for causes in self.causes().values():
            self.assertEqual(causes, ["text (clock: false to true)"])

    def test_a_record_that_is_damaged_takes_no_verdict(self):
        self.change("#808080", "#888888")
        (self.folder / "references/fall.motion.json").write_text("{")
        self.assertEqual(list(self.causes().values()), [[], []])


class Cache(Golden):
    def test_only_changed_cases_are_drawn(self):
        self.write("golden.toml", SUITE + '[[case]]\nname = "other"\nscene = "scene.toml"\nset = ["simulation.seed=2"]\n')
        self.golden(0, "accept", "--all")
        self.assertIn("2 cases: 2 drawn, 0 unchanged", self.golden(0, "check").stderr)
        self.assertIn("2 cases: 0 drawn, 2 unchanged", self.golden(0, "check").stderr)
        self.write("scene.toml", "# a comment\n" + SCENE)
        self.assertIn("2 cases: 0 drawn, 2 unchanged", self.golden(0, "check").stderr)
        self.assertIn("1 cases: 1 drawn, 0 unchanged", self.golden(0, "check", "fall", "--force").stderr)
        self.assertIn("2 cases: 2 drawn", self.golden(0, "check", cache="none").stderr)
        text = (self.folder / "golden.toml").read_text()
        self.write("golden.toml", text.replace("seed=2", "seed=3"))
        self.assertIn("2 cases: 1 drawn, 1 unchanged", self.golden(0, "check").stderr)
        self.write("golden.toml", text.replace("[0, 24]", "[0, 12, 24]").replace("seed=2", "seed=3"))
        self.assertIn("2 cases: 1 drawn, 1 unchanged", self.golden(3, "check").stderr)
        # One entry for each case is left, without parts.
        self.assertEqual(len(list((self.folder / "cache").glob("golden-*/*"))), 2)

    def test_a_verdict_from_the_cache_is_that_of_a_drawing(self):
        self.golden(0, "accept", "--all")
        self.golden(0, "check")
        shutil.copy(self.folder / "references/fall_000000.png", self.folder / "references/fall_000024.png")
        self.golden(1, "check")
        self.golden(0, "accept", "--all")
        self.golden(0, "check")
        self.change("#808080", "#888888")
        self.golden(1, "check")

    def test_the_default_folder(self):
        self.golden(0, "accept", "--all")
        home = self.folder / "home"
        run = self.check(0, "golden", "check", "golden.toml", env={"XDG_CACHE_HOME": str(home), "PATH": "/usr/bin:/bin"})
        self.assertIn("1 drawn", run.stderr)
        self.assertEqual(len(list((home / "tumble/golden").iterdir())), 1)


class Accept(Golden):
    def test_same_images_stay(self):
        self.golden(0, "accept", "--all")
        before = self.references()
        times = {p: p.stat().st_mtime_ns for p in (self.folder / "references").iterdir()}
        self.assertIn("2 images: 0 new, 0 replaced, 2 the same", self.golden(0, "accept", "--all").stderr)
        self.assertEqual(self.references(), before)
        self.assertEqual({p: p.stat().st_mtime_ns for p in (self.folder / "references").iterdir()}, times)

    def test_only_images_that_differ_are_replaced(self):
        self.golden(0, "accept", "--all")
        before = self.references()
        self.change("restitution = 0.5", "restitution = 0.8")
        self.assertIn("1 replaced, 1 the same", self.golden(0, "accept", "fall").stderr)
        after = self.references()
        self.assertEqual(after["fall_000000.png"], before["fall_000000.png"])
        self.assertNotEqual(after["fall_000024.png"], before["fall_000024.png"])
        self.assertNotEqual(after["fall.motion.json"], before["fall.motion.json"])
        self.golden(0, "check")

    def test_images_within_the_tolerances_stay_unless_asked_for(self):
        self.golden(0, "accept", "--all")
        before = self.references()
        self.change("#808080", "#818181")
        run = self.golden(0, "accept", "--all")
        self.assertIn("2 alike and kept", run.stderr)
        self.assertEqual(self.references(), before)
        self.assertIn("2 replaced", self.golden(0, "accept", "--all", "--even-alike").stderr)
        self.assertNotEqual(self.references()["fall_000000.png"], before["fall_000000.png"])

    def test_references_that_cannot_be_written(self):
        (self.folder / "references").write_text("a file")
        self.assertIn("references", self.golden(2, "accept", "--all").stderr)

    def test_a_platform_has_references_of_its_own(self):
        self.golden(0, "accept", "--all")
        self.change("#808080", "#888888")
        self.golden(0, "accept", "--all", "--platform", "amd")
        self.golden(0, "check", "--platform", "amd")
        self.golden(1, "check", "--platform", "none")
        self.write("scene.toml", SCENE)
        self.golden(1, "check", "--platform", "amd")
        self.golden(0, "check", "--platform", "none")


class Outputs(Golden):
    def test_json_junit_and_failures(self):
        self.golden(0, "accept", "--all")
        self.change("restitution = 0.5", "restitution = 0.8")
        self.golden(1, "check", "--json", "r.json", "--junit", "r.xml", "--failures", "failures", "--quiet")
        images = json.loads((self.folder / "r.json").read_text())["images"]
        self.assertEqual([(i["name"], i["verdict"]) for i in images],
                         [("fall_000000.png", "same"), ("fall_000024.png", "different")])
        tree = xml.etree.ElementTree.parse(self.folder / "r.xml").getroot()
        self.assertEqual([len(case.findall("failure")) for case in tree.iter("testcase")], [0, 1])
        self.assertEqual(sorted(p.name for p in (self.folder / "failures").iterdir()),
                         ["difference_fall_000024.png", "new_fall_000024.png"])

    def test_a_full_disk_leaves_no_cut_failures(self):
        self.golden(0, "accept", "--all")
        self.change("restitution = 0.5", "restitution = 0.8")
        self.golden(1, "check")   # the images are in the cache
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        run = self.check(2, "golden", "check", "golden.toml", "--cache", "cache", "--failures", "failures", preexec_fn=limit)
        self.assertRegex(run.stderr, r"^error: cannot write 'failures/new_fall_000024\.png': File too large\n$")
        self.assertEqual(list((self.folder / "failures").iterdir()), [])

    def test_outputs_are_not_failures(self):
        for name in ("new_fall_000024.png", "difference_fall_000000.png"):
            run = self.golden(2, "check", "--failures", "failures", "--report", "failures/" + name)
            self.assertIn("must be two files", run.stderr)
        self.assertFalse((self.folder / "failures").exists())

    def test_differences_show_the_tolerances_of_the_case(self):
        self.write("golden.toml", SUITE + "tolerances = { exact = true }\n")
        self.golden(0, "accept", "--all")
        self.change('color = "#808080"', 'color = "#828282"')
        self.golden(1, "check", "--failures", "failures")
        _, _, channels, pixels = program.png_pixels(self.folder / "failures/difference_fall_000000.png")
        red, green, blue = (pixels[i::channels] for i in range(3))
        self.assertTrue(any(r > g for r, g in zip(red, green)))
        self.assertFalse(any(b > g for b, g in zip(blue, green)))  # no difference is within the tolerance

    def test_plots_and_panels(self):
        self.write("golden.toml", """\
format = 1
[defaults]
size = [640, 480]
[[case]]
name = "curve"
scene = "scene.toml"
of = ["energy", "body.ball.y"]
[[case]]
name = "two"
scene = "scene.toml"
frames = [24]
vary = ["body.ball.restitution=0.2,0.9"]
overlay = ["velocity", "clock"]
plot = "body.ball.y"
plot_place = "below"
""")
        self.golden(0, "accept", "--all")
        self.golden(0, "check")
        # The frame of a case is that of a render with the same options.
        self.check(0, "render", "scene.toml", "--vary", "body.ball.restitution=0.2,0.9", "--overlay", "velocity,clock",
                   "--plot", "body.ball.y", "--plot-place", "below", "--size", "640x480", "--frames", "out", "--quiet")
        self.assertEqual(program.png_pixels(self.folder / "out/frame_000024.png"),
                         program.png_pixels(self.folder / "references/two_000024.png"))
        self.check(0, "plot", "scene.toml", "--of", "energy,body.ball.y", "--size", "640x480", "-o", "p.png")
        self.assertEqual((self.folder / "p.png").read_bytes(),
                         (self.folder / "references/curve_000000.png").read_bytes())
        self.change("restitution = 0.5", "restitution = 0.6")
        run = self.golden(1, "check")
        self.assertIn("restitution of ball (0.5 to 0.6)", run.stdout)

    def test_references_of_no_case_are_named(self):
        self.golden(0, "accept", "--all")
        shutil.copy(self.folder / "references/fall_000000.png", self.folder / "references/old_000000.png")
        self.assertIn("belong to no case: old_000000.png", self.golden(0, "check").stderr)


class Add(Golden):
    def test_a_new_suite(self):
        (self.folder / "golden.toml").unlink()
        self.golden(0, "add", "scene.toml", "--frames", "0,24", "--size", "48x32")
        self.golden(0, "check")
        self.golden(0, "add", "scene.toml", "--name", "b", "--set", "simulation.sleep=false")
        self.assertEqual((self.folder / "golden.toml").read_text(), """\
format = 1
references = "references"   # folder of the accepted images

[[case]]
scene = "scene.toml"
frames = [0, 24]
size = [48, 32]

[[case]]
name = "b"
scene = "scene.toml"
set = ["simulation.sleep=false"]
""")
        self.assertIn("3 same", self.golden(0, "check").stdout)

    def test_a_case_that_cannot_be_drawn_is_not_added(self):
        self.assertIn("cannot be drawn", self.golden(2, "add", "none.toml").stderr)
        self.assertIn("another case", self.golden(2, "add", "scene.toml", "--name", "Fall").stderr)
        self.assertEqual((self.folder / "golden.toml").read_text(), SUITE)
        self.assertFalse((self.folder / "references").exists())


class Compare(Golden):
    """Causes of `tumble compare`, by records that `tumble render` wrote."""

    def render(self, folder):
        self.check(0, "render", "scene.toml", "--frames", folder, "--motion-record", f"{folder}/frames.motion.json", "--quiet")

    def test_folders_and_a_scene(self):
        self.render("a")
        self.change("restitution = 0.5", "restitution = 0.8")
        self.render("b")
        for other in ("b", "scene.toml"):
            self.check(1, "compare", "a", other, "--json", "r.json")
            images = json.loads((self.folder / "r.json").read_text())["images"]
            causes = {i["name"]: i["causes"] for i in images if i["verdict"] == "different"}
            self.assertIn("frame_000024.png", causes)
            self.assertNotIn("frame_000013.png", causes)
            for sentences in causes.values():
                self.assertEqual(sentences[0], "restitution of ball (0.5 to 0.8)")
                self.assertIn("(first differing frame 14, first differing contact at 0.4", sentences[1])

    def test_late_frames_without_records(self):
        self.check(0, "render", "scene.toml", "--frames", "a", "--quiet")
        late = self.folder / "late"
        late.mkdir()
        for n in range(12):
            shutil.copy(self.folder / f"a/frame_{max(n - 1, 0):06}.png", late / f"frame_{n:06}.png")
        run = self.check(3, "compare", "a", "late", "--json", "r.json")
        images = json.loads((self.folder / "r.json").read_text())["images"]
        self.assertEqual([i["causes"] for i in images if i["name"] == "frame_000008.png"],
                         [["one frame late (it is frame_000007.png of the reference)"]], run.stdout)

    def test_images_that_only_the_drawing_changed(self):
        """The same records: the pixels tell a lost shadow from another difference."""
        self.render("a")
        record = (self.folder / "a/frames.motion.json").read_bytes()
        for old, new, cause in (("shadows = true", "shadows = false", "shadow only (brightness alone differs; "),
                                ("#c8853c", "#3c85c8", "drawing at crate (")):
            self.change(old, new)
            self.render("b")
            (self.folder / "b/frames.motion.json").write_bytes(record)
            self.check(1, "compare", "a", "b", "--json", "r.json")
            images = json.loads((self.folder / "r.json").read_text())["images"]
            for image in images:
                self.assertTrue(image["causes"][0].startswith(cause), image["causes"])

    def test_a_record_is_of_a_whole_run(self):
        run = self.check(2, "render", "scene.toml", "--frames", "a", "--motion-record", "r.json", "--resume")
        self.assertIn("--motion-record", run.stderr)
        self.check(2, "render", "scene.toml", "--frames", "a", "--motion-record", "scene.toml")


if __name__ == "__main__":
    program.main()
