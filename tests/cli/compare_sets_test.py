"""`compare` of folders, clips and scenes: verdicts, exit codes, tolerances, masks, platforms, result files."""

import json
import os
import xml.etree.ElementTree

import program

GREY = (120, 120, 120)
RED = (180, 100, 90)


class Sets(program.ProgramTest):
    def picture(self, name, *arguments, **options):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(program.png(*arguments, **options))

    def box(self, name, left=40, color=RED):
        self.picture(name, 96, 64, GREY, boxes=[(left, 20, 12, 12, color)])

    def pair(self, name, left=40, color=RED):
        self.box("a/" + name)
        self.box("b/" + name, left, color)

    def result(self, code, *arguments):
        """The JSON of a comparison of a/ and b/."""
        self.check(code, "compare", "a", "b", "--json", "r.json", *arguments)
        return json.loads((self.folder / "r.json").read_text())

    def verdicts(self, code, *arguments):
        return {image["name"]: image["verdict"] for image in self.result(code, *arguments)["images"]}


class Folders(Sets):
    def test_names_verdicts_and_exit_codes(self):
        self.pair("x.png")
        self.pair("deep/er/y.png")
        run = self.check(0, "compare", "a", "b")
        self.assertEqual(run.stdout, "2 pictures: 2 same\n")
        self.box("b/new.png")
        run = self.check(1, "compare", "a", "b")
        self.assertEqual(run.stdout, "added: new.png\n3 pictures: 2 same, 1 added\n")
        self.check(0, "compare", "a", "b", "--allow-added")
        self.box("b/deep/er/y.png", 41)
        run = self.check(1, "compare", "a", "b", "--allow-added")
        self.assertRegex(run.stdout, r"different: deep/er/y.png\n  rule pixels: .*\n  rule cluster: ")
        self.box("a/z.png")
        self.assertIn("missing: z.png\n", self.check(3, "compare", "a", "b").stdout)
        (self.folder / "b/x.png").write_text("no picture")
        run = self.check(2, "compare", "a", "b")
        self.assertIn("broken: x.png\n  b/x.png: ", run.stdout)
        self.assertTrue(run.stdout.endswith("4 pictures: 1 different, 1 missing, 1 added, 1 broken\n"))

    def test_the_same_for_any_number_of_workers(self):
        for i in range(12):
            self.pair(f"{i}.png", 40 + i % 3)
        one = self.check(1, "compare", "a", "b", "--workers", 1).stdout
        self.assertEqual(one, self.check(1, "compare", "a", "b", "--workers", 5).stdout)

    def test_nothing_to_compare_is_an_error(self):
        (self.folder / "a").mkdir()
        (self.folder / "b").mkdir()
        run = self.check(2, "compare", "a", "b")
        self.assertEqual(run.stderr, "error: there are no pictures (PNG, JPEG) in 'a' and 'b'\n")
        self.box("a/x.png")
        self.check(3, "compare", "a", "b")
        self.check(1, "compare", "b", "a")

    def test_operands_that_do_not_fit(self):
        self.pair("x.png")
        (self.folder / "c.mp4").write_text("no clip")
        for a, b in (("a", "a/x.png"), ("a/x.png", "scene.toml"), ("scene.toml", "scene.toml"), ("c.mp4", "scene.toml"),
                     ("a", "none"), ("none.mp4", "a"), ("a/x.png", "c.mp4")):
            run = self.check(2, "compare", a, b, "--json", "r.json")
            self.assertIn("error: ", run.stderr)
        self.assertFalse((self.folder / "r.json").exists())

    def test_outputs_replace_no_input(self):
        self.pair("x.png")
        self.write("t.toml", "levels = 4\n")
        for option in ("--json", "--junit"):
            self.check(2, "compare", "a", "b", "--tolerances", "t.toml", option, "t.toml")
            run = self.check(2, "compare", "a", "b", option, "no/r.json")
            self.assertIn("no/r.json", run.stderr)
        self.check(2, "compare", "a", "b", "--json", "r", "--junit", "r")
        self.assertEqual((self.folder / "t.toml").read_text(), "levels = 4\n")

    def test_two_pictures_as_a_set(self):
        self.pair("x.png", 41)
        self.write("t.toml", "[[rule]]\nfiles = \"x.png\"\nmasks = [{ pixels = [40, 20, 13, 12] }]\n")
        run = self.check(0, "compare", "a/x.png", "b/x.png", "--tolerances", "t.toml")
        self.assertEqual(run.stdout, "1 picture: 1 same\n")

    def test_names_that_are_no_text(self):
        hostile = self.folder / "a" / os.fsdecode(b"x\xff\x1b[2J.png")
        self.pair("x.png")
        hostile.write_bytes(program.png(8, 8))
        run = self.check(3, "compare", "a", "b", "--json", "r.json", "--junit", "r.xml")
        self.assertNotIn("\x1b", run.stdout)
        json.loads((self.folder / "r.json").read_text())
        xml.etree.ElementTree.parse(self.folder / "r.xml")


class Rules(Sets):
    def test_tolerances_by_pattern_and_figures(self):
        self.pair("hero/x.png", 41)
        self.pair("smoke/x.png", 41)
        self.write("t.toml", "[[rule]]\nfiles = \"smoke/**\"\nfraction = 1\n[[rule]]\nfiles = \"none*\"\nlevels = 9\n")
        result = self.result(1, "--tolerances", "t.toml")
        verdicts = {i["name"]: (i["verdict"], i["rule"]) for i in result["images"]}
        self.assertEqual(verdicts, {"hero/x.png": ("different", None), "smoke/x.png": ("alike", "smoke/**")})
        figures = {f["metric"]: f for f in result["images"][0]["figures"]}
        self.assertEqual(list(figures), ["pixels", "cluster", "window", "shade"])
        self.assertEqual((figures["pixels"]["value"], figures["pixels"]["limit"]), (24, 1))
        self.assertEqual([f["holds"] for f in figures.values()], [False, False, False, False])
        self.assertEqual(result["images"][0]["changed"], {"x": 40, "y": 20, "width": 13, "height": 12})
        run = self.check(1, "compare", "a", "b", "--tolerances", "t.toml")
        self.assertIn("note: the rule stands for no picture: t.toml:4: \"none*\"\n", run.stderr)

    def test_perceptual_metrics_have_figures_and_limits(self):
        self.pair("x.png", 44)
        self.write("t.toml", "fraction = 1\nssim = 0.999\nflip = 0.0001\n")
        images = self.result(1, "--tolerances", "t.toml")["images"]
        figures = {f["metric"]: f for f in images[0]["figures"]}
        self.assertLess(figures["ssim"]["value"], 0.999)
        self.assertGreater(figures["flip"]["value"], 0.0001)
        self.assertEqual([m for m, f in figures.items() if not f["holds"]], ["ssim", "flip"])
        self.write("t.toml", "fraction = 1\nssim = 0.5\nflip = 0.5\n")
        self.assertEqual(self.verdicts(0, "--tolerances", "t.toml"), {"x.png": "alike"})

    def test_a_mistake_has_its_place_and_nothing_is_written(self):
        self.pair("x.png")
        self.write("t.toml", "levels = 3\n[[rule]]\nfiles = \"*\"\nmasks = [{ file = \"none.png\" }]\n")
        run = self.check(2, "compare", "a", "b", "--tolerances", "t.toml", "--json", "r.json")
        self.assertTrue(run.stderr.startswith("t.toml:4:19: error: file cannot be used: none.png: "), run.stderr)
        self.assertFalse((self.folder / "r.json").exists())

    def test_masks(self):
        self.pair("x.png", 41)
        self.picture("mask.png", 96, 64, (0, 0, 0), boxes=[(40, 20, 13, 12, (255, 255, 255))])
        for mask in ("pixels = [40, 20, 13, 12]", "fractions = [0.4, 0.3, 0.2, 0.2]", "file = \"mask.png\""):
            self.write("t.toml", f"masks = [{{ {mask} }}]\n")
            self.assertEqual(self.verdicts(0, "--tolerances", "t.toml"), {"x.png": "same"}, mask)
        self.picture("mask.png", 95, 64, (255, 255, 255))
        self.assertEqual(self.verdicts(2, "--tolerances", "t.toml"), {"x.png": "broken"})

    def test_platforms_replace_references(self):
        self.pair("x.png", 41)
        self.pair("y.png")
        self.box("a/amd/x.png", 41)
        self.box("a/mine/y.png", 60)
        self.write("t.toml", "platforms = [\"mine\"]\n")
        result = self.result(0, "--platform", "amd", "--tolerances", "t.toml")
        self.assertEqual(result["platform"], "amd")
        self.assertEqual([i["reference"] for i in result["images"]], ["a/amd/x.png", "a/y.png"])
        self.assertEqual(self.verdicts(1, "--platform", "intel", "--tolerances", "t.toml"),
                         {"x.png": "different", "y.png": "same"})
        self.assertEqual(self.verdicts(1, "--platform", "mine"), {"x.png": "different", "y.png": "different"})
        # Without the declaration, a folder of another name is an ordinary one.
        self.assertEqual(self.verdicts(3, "--platform", "amd")["mine/y.png"], "missing")


class Results(Sets):
    def test_junit(self):
        self.pair("alike.png")
        self.pair("dif & \"ferent\".png", 41)
        self.box("a/missing.png")
        self.box("b/new.png")
        self.check(3, "compare", "a", "b", "--junit", "r.xml")
        suite = xml.etree.ElementTree.parse(self.folder / "r.xml").getroot()
        self.assertEqual((suite.tag, suite.get("tests"), suite.get("failures"), suite.get("errors")),
                         ("testsuite", "4", "2", "1"))
        kinds = {case.get("name"): [(child.tag, child.get("type")) for child in case] for case in suite}
        self.assertEqual(kinds, {"alike.png": [], "dif & \"ferent\".png": [("failure", "different")],
                                 "missing.png": [("error", "missing")], "new.png": [("failure", "added")]})
        self.assertIn("rule cluster", suite.findall(".//failure")[0].text)

    def test_pictures_of_the_differences(self):
        self.pair("x.png", 41)
        self.pair("deep/y.png", 41)
        self.pair("same.png")
        self.check(1, "compare", "a", "b", "--diff", "d")
        self.assertEqual(sorted(str(p.relative_to(self.folder / "d")) for p in (self.folder / "d").rglob("*.png")),
                         ["deep/y.png", "x.png"])
        self.assertEqual(program.png_size(self.folder / "d/x.png"), (96, 64))
        self.write("file", "")
        self.assertIn("--diff: must be a folder", self.check(2, "compare", "a", "b", "--diff", "file").stderr)

    def test_json(self):
        self.pair("x.png", 41)
        result = self.result(1)
        self.assertEqual({k: result[k] for k in ("format", "version", "reference", "image", "exit_code", "platform")},
                         {"format": "tumble-comparison", "version": 1, "reference": "a", "image": "b", "exit_code": 1,
                          "platform": None})
        self.assertEqual(result["counts"], {"same": 0, "alike": 0, "different": 1, "missing": 0, "added": 0, "broken": 0})
        self.assertEqual(set(result["images"][0]), {"name", "verdict", "reference", "image", "width", "height", "rule",
                                                    "reason", "figures", "differing_pixels", "max_difference", "changed",
                                                    "causes", "accepted"})


class Clips(Sets):
    def setUp(self):
        super().setUp()
        self.check(0, "render", "scene.toml", "--frames", "f", "-o", "a.mp4", "--quiet")

    def test_clip_and_clip(self):
        run = self.check(0, "compare", "a.mp4", "a.mp4")
        self.assertEqual(run.stdout, "6 pictures: 6 same\n")
        self.check(0, "encode", "f", "-o", "b.mp4", "--fps", "10", "--quiet")
        self.check(0, "compare", "a.mp4", "b.mp4")
        self.check(0, "render", "scene.toml", "-o", "short.mp4", "--set", "simulation.duration=0.4", "--quiet",
                   "--set", "camera.eye=[0,3,9]", "--set", "camera.target=[0,1,0]")
        run = self.check(3, "compare", "a.mp4", "short.mp4")
        self.assertIn("missing: frame_000005.png\n", run.stdout)

    def test_clip_and_folder(self):
        self.write("t.toml", "levels = 120\n")  # of a codec that loses detail
        self.check(0, "compare", "f", "a.mp4", "--tolerances", "t.toml")
        os.remove(self.folder / "f/frame_000003.png")
        self.assertIn("added: frame_000003.png\n", self.check(1, "compare", "f", "a.mp4", "--tolerances", "t.toml").stdout)
        self.check(3, "compare", "a.mp4", "f", "--tolerances", "t.toml")

    def test_clips_keep_pictures_that_are_shown_longer_and_alpha(self):
        self.write("still.toml", program.SCENE.replace("position = [0.0, 3.0, 0.0]", "type = \"fixed\"\nposition = [0.0, 3.0, 0.0]")
                   .replace("angular_velocity = [1.0, 2.0, 0.5]\n", ""))
        self.check(0, "render", "still.toml", "-o", "long.mp4", "--variable-rate", "--quiet")
        self.check(0, "render", "still.toml", "-o", "all.mp4", "--quiet")
        self.check(1, "compare", "long.mp4", "all.mp4", "--tolerance", "80")
        run = self.check(0, "compare", "long.mp4", "all.mp4", "--tolerance", "80", "--fps", "10")
        self.assertEqual(run.stdout.splitlines()[-1][:11], "6 pictures:")
        self.check(0, "render", "scene.toml", "-o", "alpha.mov", "--frames", "alpha", "--transparent", "--quiet")
        self.check(0, "compare", "alpha", "alpha.mov", "--tolerance", "4", "--cluster", "64")

    def test_broken_clips(self):
        data = (self.folder / "a.mp4").read_bytes()
        (self.folder / "cut.mp4").write_bytes(data[:len(data) // 2])
        (self.folder / "text.webm").write_text("no clip")
        for clip in ("cut.mp4", "text.webm"):
            run = self.check(2, "compare", "a.mp4", clip, "--json", "r.json")
            self.assertTrue(run.stderr.startswith(clip + ": error: "), run.stderr)
        self.assertFalse((self.folder / "r.json").exists())
        (self.folder / "empty").mkdir()
        self.assertIn("holds no frames", self.check(2, "compare", "empty", "a.mp4").stderr)


class Scenes(Sets):
    def setUp(self):
        super().setUp()
        self.check(0, "render", "scene.toml", "--frames", "all", "--quiet")
        (self.folder / "g").mkdir()
        for number in (1, 4):
            os.rename(self.folder / f"all/frame_{number:06}.png", self.folder / f"g/frame_{number:06}.png")

    def test_the_frames_of_the_references_are_drawn_at_their_size(self):
        for operands in (("g", "scene.toml"), ("scene.toml", "g")):
            run = self.check(0, "compare", *operands, "--json", "r.json", "--quiet")
            images = json.loads((self.folder / "r.json").read_text())["images"]
            self.assertEqual([(i["name"], i["verdict"], i["width"]) for i in images],
                             [("frame_000001.png", "same", 48), ("frame_000004.png", "same", 48)])
        self.assertEqual(self.names().count("all"), 1)
        self.check(0, "render", "scene.toml", "--frames", "g", "--size", "40x30", "--quiet")
        self.assertEqual(self.check(0, "compare", "g", "scene.toml", "--quiet").stdout, "")

    # A day of frames would take days.
    def test_frames_after_the_last_reference_are_not_drawn(self):
        self.check(0, "compare", "g", "scene.toml", "--set", "simulation.duration=86400", "--quiet", timeout=60)

    def test_a_changed_scene(self):
        run = self.check(1, "compare", "g", "scene.toml", "--set", "body.crate.position=[0.2, 3, 0]", "--quiet")
        self.assertIn("different: frame_000001.png\n", run.stdout)

    def test_frames_beyond_the_end_are_missing(self):
        self.picture("g/frame_000042.png", 48, 32)
        self.assertIn("missing: frame_000042.png\n", self.check(3, "compare", "g", "scene.toml", "--quiet").stdout)

    def test_references_that_are_no_frames_or_of_two_sizes(self):
        self.picture("g/frame_000002.png", 40, 32)
        (self.folder / "g/frame_000000.png").write_text("no picture")
        run = self.check(2, "compare", "g", "scene.toml", "--quiet")
        self.assertIn("broken: frame_000000.png\n  g/frame_000000.png: ", run.stdout)
        self.assertIn("broken: frame_000002.png\n  the picture has 48 x 32 pixels, and the reference 40 x 32\n", run.stdout)
        self.assertNotIn("frame_000001.png", run.stdout)
        os.remove(self.folder / "g/frame_000000.png")
        self.picture("other/x.png", 48, 32)
        self.assertIn("holds no frames of a scene", self.check(2, "compare", "other", "scene.toml").stderr)
        os.rename(self.folder / "other/x.png", self.folder / "g/x.png")
        os.remove(self.folder / "g/frame_000002.png")
        run = self.check(0, "compare", "g", "scene.toml", "--quiet")
        self.assertIn("note: 1 files of the folder are no frames of a scene", run.stderr)

    def test_drawn_frames_are_removed(self):
        self.assertEqual(len(os.listdir(self.folder / "g")), 2)
        temporary = self.folder / "tmp"
        temporary.mkdir()
        environment = dict(os.environ, TMPDIR=str(temporary))
        self.check(0, "compare", "g", "scene.toml", env=environment)
        self.check(2, "compare", "g", "scene.toml", "--set", "body.none.position=[0, 0, 0]", env=environment)
        self.assertEqual(list(temporary.iterdir()), [])


if __name__ == "__main__":
    program.main()
