"""`tumble sweep`: the samples of a plan, their bytes and values, and sweeps that were killed and went on."""

import filecmp
import hashlib
import json
import os
import signal
import subprocess
import time
import unittest
import zlib

from program import TUMBLE, ProgramTest

SCENE = """\
format = 1
[simulation]
duration = 0.2
steps_per_frame = 4
[output]
size = [40, 32]
fps = 20
samples = 4
[[body]]
name = "ground"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "crate"
shape = { type = "box", size = [1.0, 1.0, 1.0] }
position = [0.0, 2.0, 0.0]
angular_velocity = [1.0, 2.0, 0.5]
friction = 0.5
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.3 }
position = [1.0, 0.3, 0.0]
scatter = { count = 3, size = [3.0, 2.0, 3.0] }
"""

OUTPUTS = """\
[outputs]
frames = true
clip = "clip.mp4"
aov = "all"
tables = ["trajectory", "energy", "impacts", "contacts", "loads"]
"""

RANDOM = """\
format = 1
scene = "boxes.toml"
samples = {samples}
seed = 5
[[axis]]
name = "friction"
path = "body.crate.friction"
distribution = "uniform"
min = 0.1
max = 0.9
[[axis]]
name = "seed"
path = "simulation.seed"
distribution = "integer"
min = 0
max = 1000
"""


def tree(folder):
    """The files below a folder, with the hash of their bytes."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
            for p in sorted(folder.rglob("*")) if p.is_file()}


class SweepTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("boxes.toml", SCENE)

    def manifest(self, folder="out"):
        with open(self.folder / folder / "manifest.jsonl") as file:
            return [json.loads(line) for line in file]

    def error(self, plan, expected, *arguments):
        self.write("bad.toml", plan)
        run = self.check(2, "sweep", "bad.toml", "-o", "bad", *arguments)
        self.assertIn(expected, run.stderr)
        self.assertFalse((self.folder / "bad").exists(), run.stderr)


class Bytes(SweepTest):
    """A sample is what `tumble render` and `tumble simulate` make of its scene."""

    def compare(self, plan, render, drawn=("frames", "aov", "clip")):
        self.write("plan.toml", plan)
        self.check(0, "sweep", "plan.toml", "-o", "out", "--quiet")
        lines = self.manifest()
        for line in lines:
            sample = self.folder / "out" / line["name"]
            alone = self.folder / "alone" / line["name"]
            alone.mkdir(parents=True)
            arguments = list(render)
            if "frames" in drawn:
                arguments += ["--frames", alone / "frames"]
            if "aov" in drawn:
                arguments += ["--aov", "depth,normal,segmentation,motion,albedo", "--aov-folder", alone / "aov"]
            clips = list(sample.glob("clip.*"))
            if clips:
                arguments += ["-o", alone / clips[0].name]
            self.check(0, "render", sample / "scene.toml", "--quiet", *arguments)
            self.check(0, "simulate", sample / "scene.toml", "--quiet", *[
                part for name in ("trajectory", "energy", "impacts", "contacts", "loads")
                for part in (f"--{name}", alone / f"{name}.csv")])
            mine = {n: h for n, h in tree(sample).items() if n not in ("scene.toml", "sample.json")}
            other = {n: h for n, h in tree(alone).items() if n in mine or not n.endswith(".json")}
            self.assertEqual(mine, other, line["name"])
        return lines

    def test_each_sample_has_the_bytes_of_a_render_of_its_scene(self):
        lines = self.compare(RANDOM.format(samples=3) + OUTPUTS, [])
        self.assertEqual([line["index"] for line in lines], [0, 1, 2])
        self.assertEqual(len({line["scene_hash"] for line in lines}), 3)

    def test_settings_of_the_drawing_are_those_of_render(self):
        plan = RANDOM.format(samples=2) + OUTPUTS.replace("mp4", "webm") + """\
[render]
speed = 0.5
shutter = 180
blur_samples = 4
start = 0.1
transparent = true
quality = "draft"
"""
        self.compare(plan, ["--speed", "0.5", "--shutter", "180", "--blur-samples", "4", "--start", "0.1",
                            "--transparent", "--quality", "draft"])

    def test_scenes_that_differ_in_all_that_is_drawn(self):
        # One process draws them in turn: left-overs of one scene in the OpenGL context would show in the next.
        self.write("boxes.toml", SCENE + """\
[[body]]
name = "wall"
type = "fixed"
shape = { type = "plane", normal = [1, 0, 0.2], offset = -3.0 }
pattern = "checker"
[[body]]
name = "gem"
shape = { type = "compound", parts = [{ shape = { type = "sphere", radius = 0.2 } },
                                      { shape = { type = "box", size = [0.1, 0.9, 0.1] }, color = "#10a040" }] }
position = [-1.0, 1.0, 0.0]
metallic = 1.0
[overlay]
show = ["velocity", "clock", "title"]
""")
        plan = """\
format = 1
scene = "boxes.toml"
combine = "zip"
[[axis]]
name = "size"
path = "output.size"
values = [[40, 32], [64, 24], [33, 47], [40, 32]]
[[axis]]
name = "samples"
path = "output.samples"
values = [4, 1, 4, 2]
[[axis]]
name = "shadows"
path = "light.shadows"
values = [true, false, true, true]
[[axis]]
name = "wall"
path = "body.wall.visible"
values = [true, true, false, true]
[[axis]]
name = "pattern"
path = "body.ground.pattern"
values = ["grid", "checker", "plain", "grid"]
[[axis]]
name = "overlay"
path = "overlay.show"
values = [["velocity", "title"], [], ["trails", "clock"], ["forces", "com"]]
""" + OUTPUTS
        self.write("plan.toml", plan)
        self.compare(plan, [])

    def test_meshes_are_found_from_the_resolved_scene(self):
        (self.folder / "meshes").mkdir()
        self.write("meshes/wedge.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        self.write("boxes.toml", SCENE + """\
[[body]]
name = "wedge"
shape = { type = "mesh", file = "meshes/wedge.obj", scale = 0.6 }
position = [0.0, 3.0, 0.0]
""")
        self.compare(RANDOM.format(samples=2).replace("samples = 2", 'samples = 2\nname = "a/b/{index}"') + OUTPUTS, [])

    def test_poses_are_found_from_the_resolved_scene(self):
        self.write("rows.csv", "x,y,z\n0,3,0\n2,3,0\n")
        self.write("boxes.toml", SCENE + '[[body]]\nname = "posed"\nshape = { type = "sphere", radius = 0.3 }\nposes = "rows.csv"\n')
        self.compare(RANDOM.format(samples=2).replace("samples = 2", 'samples = 2\nname = "a/b/{index}"') + OUTPUTS, [])

    def test_the_number_of_workers_changes_nothing(self):
        self.write("plan.toml", RANDOM.format(samples=4) + OUTPUTS)
        for workers in (1, 3):
            self.check(0, "sweep", "plan.toml", "-o", f"out{workers}", "--workers", workers)
        self.assertEqual(tree(self.folder / "out1"), tree(self.folder / "out3"))


class Values(SweepTest):
    FAST = "[outputs]\nscene = \"none\"\ntables = [\"energy\"]\n"

    def values(self, plan, *arguments):
        self.write("plan.toml", plan)
        self.check(0, "sweep", "plan.toml", "-o", "out", "--quiet", *arguments)
        return [line["values"] for line in self.manifest()]

    def lists(self, combine):
        return f"""\
format = 1
scene = "boxes.toml"
combine = "{combine}"
[[axis]]
name = "f"
path = "body.crate.friction"
values = [0.1, 0.2]
[[axis]]
name = "s"
path = "simulation.seed"
range = {{ from = 3, to = 4, step = 1 }}
""" + self.FAST

    def test_product_zip_and_random(self):
        self.assertEqual(self.values(self.lists("product")),
                         [{"f": f, "s": s} for f in (0.1, 0.2) for s in (3, 4)])
        self.assertEqual(self.values(self.lists("zip")), [{"f": 0.1, "s": 3}, {"f": 0.2, "s": 4}])
        drawn = self.values(self.lists("random").replace("combine", "samples = 30\ncombine", 1))
        self.assertEqual({(v["f"], v["s"]) for v in drawn}, {(f, s) for f in (0.1, 0.2) for s in (3, 4)})

    def test_ranges(self):
        plan = """\
format = 1
scene = "boxes.toml"
combine = "zip"
[[axis]]
name = "linear"
path = "body.crate.friction"
range = { from = 0, to = 1, count = 5 }
[[axis]]
name = "log"
path = "body.crate.density"
range = { from = 1.0, to = 10000.0, count = 5, scale = "log" }
[[axis]]
name = "step"
path = "body.crate.restitution"
range = { from = 0.0, to = 0.4, step = 0.1 }
""" + self.FAST
        values = self.values(plan)
        self.assertEqual([v["linear"] for v in values], [0, 0.25, 0.5, 0.75, 1])
        for v, expected in zip(values, (1, 10, 100, 1000, 10000)):
            self.assertAlmostEqual(v["log"] / expected, 1.0, places=14)
        self.assertEqual([v["step"] for v in values], [0, 0.1, 0.2, 0.3, 0.4])

    def test_further_samples_and_axes_leave_the_others_as_they_are(self):
        few = self.values(RANDOM.format(samples=3) + self.FAST)
        more = self.values("format = 1\nscene = \"boxes.toml\"\nsamples = 6\nseed = 5\n[[axis]]\nname = \"r\"\n"
                           "path = \"body.crate.restitution\"\ndistribution = \"uniform\"\nmin = 0\nmax = 1\n" +
                           RANDOM[RANDOM.index("[[axis]]"):] + self.FAST)
        self.assertEqual(few, [{k: v for k, v in one.items() if k != "r"} for one in more[:3]])
        other = self.values(RANDOM.format(samples=3).replace("seed = 5", "seed = 6") + self.FAST)
        self.assertNotEqual(few, other)

    def test_pairs_differ_in_one_value(self):
        plan = RANDOM.format(samples=8) + """\
[[axis]]
name = "density"
path = "body.crate.density"
values = [100.0, 200.0, 400.0]
[pair]
differ = ["friction", "density"]
""" + self.FAST
        self.write("plan.toml", plan)
        self.check(0, "sweep", "plan.toml", "-o", "out", "--quiet")
        lines = self.manifest()
        self.assertEqual([(line["pair"], line["side"]) for line in lines], [(i // 2, "AB"[i % 2]) for i in range(8)])
        for i, (a, b) in enumerate(zip(lines[::2], lines[1::2])):
            different = [name for name in a["values"] if a["values"][name] != b["values"][name]]
            self.assertEqual(different, [("friction", "density")[i % 2]])
            self.assertEqual(different, [a["differs"]])
            self.assertNotEqual(a["scene_hash"], b["scene_hash"])

    def test_the_other_value_of_a_pair_by_a_factor_or_of_its_own(self):
        for pair, expected in (("factor = 2.0", lambda a: 2.0 * a), ("offset = 0.05", lambda a: a + 0.05),
                               ("b = { values = [0.77] }", lambda a: 0.77)):
            values = self.values(RANDOM.format(samples=4) + f"[pair]\ndiffer = \"friction\"\n{pair}\n" + self.FAST)
            for a, b in zip(values[::2], values[1::2]):
                self.assertEqual(a["seed"], b["seed"])
                self.assertAlmostEqual(b["friction"], expected(a["friction"]), places=15)

    def test_names_of_samples(self):
        self.values(self.lists("product").replace("combine", 'name = "set/f{f}_{s:03}"\ncombine', 1)
                    .replace(":03}", "}"))
        self.assertEqual(sorted(os.listdir(self.folder / "out/set")), ["f0.1_3", "f0.1_4", "f0.2_3", "f0.2_4"])

    def test_fixed_values_and_the_form_of_the_scene(self):
        self.write("plan.toml", RANDOM.format(samples=1) + "[set]\noutput.fps = 10\n\"body.crate.name\" = \"box\"\n"
                   "[outputs]\nscene = \"json\"\n")
        self.check(2, "sweep", "plan.toml", "-o", "out")   # an axis sets the friction of the crate, which has a new name
        self.write("plan.toml", RANDOM.format(samples=1) + "[set]\noutput.fps = 10\nbody.ball.color = \"#102030\"\n"
                   "[outputs]\nscene = \"json\"\n")
        self.check(0, "sweep", "plan.toml", "-o", "out", "--set", "simulation.duration=0.3")
        with open(self.folder / "out/000000/scene.json") as file:
            scene = json.load(file)
        self.assertEqual(scene["output"]["fps"], 10)
        self.assertEqual(scene["simulation"]["duration"], 0.3)
        self.assertEqual(scene["body"][2]["color"], "#102030")
        self.assertEqual(scene["title"], "boxes")
        self.assertEqual(scene["body"][1]["friction"], self.manifest()[0]["values"]["friction"])

    def test_a_dry_run_writes_nothing(self):
        self.write("plan.toml", RANDOM.format(samples=1000))
        run = self.check(0, "sweep", "plan.toml", "--dry-run")
        self.assertIn("1000 samples of boxes.toml", run.stdout)
        self.assertIn("sample 5: friction = 0.", run.stdout)
        self.assertEqual(self.names(), ["boxes.toml", "plan.toml"])


class Manifest(SweepTest):
    def test_files_have_the_sizes_and_checksums_of_the_manifest(self):
        self.write("plan.toml", RANDOM.format(samples=2) + OUTPUTS)
        self.check(0, "sweep", "plan.toml", "-o", "out")
        for line in self.manifest():
            folder = self.folder / "out" / line["name"]
            self.assertEqual((folder / "sample.json").read_text(), json.dumps(line, separators=(",", ":")) + "\n")
            found = {"sample.json"}
            for entry in line["files"]:
                names = [entry["path"].format(i) for i in range(entry.get("first", 0),
                                                                entry.get("first", 0) + entry.get("count", 1))]
                content = b"".join((folder / name).read_bytes() for name in names)
                self.assertEqual(len(content), entry["bytes"])
                self.assertEqual(f"{zlib.crc32(content):08x}", entry["crc32"])
                found.update(names)
            self.assertEqual(found, set(tree(folder)))
            self.assertEqual((line["frames"], line["bodies"], line["width"], line["height"]), (5, 5, 40, 32))

    def test_a_failing_sample_is_named_and_the_others_are_made(self):
        plan = """\
format = 1
scene = "boxes.toml"
[[axis]]
name = "friction"
path = "body.crate.friction"
values = [0.5, -1.0, 0.7]
[outputs]
tables = ["energy"]
"""
        self.write("plan.toml", plan)
        run = self.check(1, "sweep", "plan.toml", "-o", "out")
        self.assertIn("sample 1: friction = -1.0: ", run.stderr)
        self.assertIn("body.crate.friction: must be from 0", run.stderr)
        self.assertIn("2 samples made, 1 failed", run.stderr)
        self.assertEqual([line["status"] for line in self.manifest()], ["done", "failed", "done"])
        self.assertIn("must be from 0", self.manifest()[1]["reason"])
        self.assertFalse((self.folder / "out/000001").exists())
        # Corrected, the others are kept.
        self.write("plan.toml", plan.replace("-1.0", "1.0"))
        run = self.check(0, "sweep", "plan.toml", "-o", "out")
        self.assertIn("1 samples made, 2 kept", run.stderr)
        self.assertEqual([line["status"] for line in self.manifest()], ["done"] * 3)

    def test_stop_at_the_first_failure(self):
        values = ", ".join(["0.5", "-1.0"] + ["0.5"] * 98)
        self.write("plan.toml", "format = 1\nscene = \"boxes.toml\"\n[[axis]]\nname = \"f\"\npath = "
                   f"\"body.crate.friction\"\nvalues = [{values}]\n[outputs]\ntables = [\"energy\"]\n")
        run = self.check(1, "sweep", "plan.toml", "-o", "out", "--stop", "--workers", 1)
        self.assertIn("sample 1: f = -1.0", run.stderr)
        self.assertEqual([line["index"] for line in self.manifest()], [0, 1])

    def test_one_sample_again(self):
        self.write("plan.toml", RANDOM.format(samples=3) + OUTPUTS)
        self.check(0, "sweep", "plan.toml", "-o", "out")
        whole = tree(self.folder / "out")
        (self.folder / "out/000001/clip.mp4").write_text("damaged")
        run = self.check(0, "sweep", "plan.toml", "-o", "out", "--only", "1")
        self.assertIn("1 samples made", run.stderr)
        self.assertEqual(tree(self.folder / "out"), whole)
        self.check(2, "sweep", "plan.toml", "-o", "out", "--only", "3")

    def test_no_folder_of_the_user_is_replaced(self):
        self.write("plan.toml", RANDOM.format(samples=2) + "[outputs]\ntables = [\"energy\"]\n")
        (self.folder / "out/000001").mkdir(parents=True)
        self.write("out/000001/thesis.txt", "not backed up")
        run = self.check(1, "sweep", "plan.toml", "-o", "out")
        self.assertIn("000001", run.stderr)
        self.assertEqual((self.folder / "out/000001/thesis.txt").read_text(), "not backed up")


class Resume(SweepTest):
    COUNT = int(os.environ.get("TUMBLE_SWEEP_SAMPLES", 24))   # 1000 by hand

    def plan(self, count=COUNT):
        self.write("plan.toml", RANDOM.format(samples=count) + "[outputs]\nframes = true\naov = [\"depth\"]\n")

    def killed(self, signal_number, made):
        """A sweep that is ended when it has made that many samples."""
        run = subprocess.Popen([TUMBLE, "sweep", "plan.toml", "-o", "out", "--workers", "2"], cwd=self.folder,
                               stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        deadline = time.monotonic() + 60
        while len(list((self.folder / "out").glob("0*"))) < made and time.monotonic() < deadline:
            time.sleep(0.002)
        run.send_signal(signal_number)
        run.wait()
        return run

    def test_a_killed_sweep_goes_on_to_the_same_bytes(self):
        self.plan()
        self.check(0, "sweep", "plan.toml", "-o", "whole", "--quiet")
        for kill in range(5):
            self.killed(signal.SIGKILL, self.COUNT * (2 * kill + 1) // 12)
        there = len(list((self.folder / "out").glob("0*")))
        self.assertGreater(there, 0)
        self.assertLess(there, self.COUNT)
        run = self.check(0, "sweep", "plan.toml", "-o", "out")
        self.assertIn(f"{self.COUNT - there} samples made, {there} kept", run.stderr)
        self.assertEqual([line["index"] for line in self.manifest()], list(range(self.COUNT)))
        self.assertEqual(tree(self.folder / "out"), tree(self.folder / "whole"))

    def test_an_interrupt_says_how_to_go_on(self):
        self.plan()
        run = self.killed(signal.SIGINT, 3)
        self.assertEqual(run.returncode, 1)
        self.assertIn("the same command goes on", run.stderr.read())
        indices = [line["index"] for line in self.manifest()]
        self.assertEqual(indices, sorted(set(indices)))
        self.assertFalse((self.folder / "out/.tumble-sweep").exists())

    def test_damaged_and_changed_samples_are_made_again(self):
        self.plan(4)
        self.check(0, "sweep", "plan.toml", "-o", "out")
        whole = tree(self.folder / "out")
        (self.folder / "out/000000/aov/aov_000002.npz").unlink()
        (self.folder / "out/000001/frames/frame_000001.png").write_bytes(b"")
        (self.folder / "out/000002/sample.json").write_text("{")
        run = self.check(0, "sweep", "plan.toml", "-o", "out")
        self.assertIn("3 samples made, 1 kept", run.stderr)
        self.assertEqual(tree(self.folder / "out"), whole)
        self.write("boxes.toml", SCENE.replace("2.0, 0.0]\nangular", "2.5, 0.0]\nangular"))
        run = self.check(0, "sweep", "plan.toml", "-o", "out")
        self.assertIn("4 samples made;", run.stderr)

    def test_a_longer_plan_keeps_the_samples(self):
        self.plan(3)
        self.check(0, "sweep", "plan.toml", "-o", "out")
        self.plan(5)
        run = self.check(0, "sweep", "plan.toml", "-o", "out")
        self.assertIn("2 samples made, 3 kept", run.stderr)


class Errors(SweepTest):
    def test_errors_name_the_place_in_the_plan(self):
        head = "format = 1\nscene = \"boxes.toml\"\n"
        axis = head + "[[axis]]\npath = \"body.crate.friction\"\n"
        for plan, expected in (
                ("scene = \"boxes.toml\"\n", "bad.toml:1:1: error: a plan starts with \"format = 1\""),
                ("format = 2\nscene = \"boxes.toml\"\n", "bad.toml:1:10: error: format must be 1"),
                ("format = 1\n", "a plan needs \"scene\""),
                (head + "sampels = 3\n", "bad.toml:3:1: error: unknown key \"sampels\" in a plan (did you mean "
                                         "\"samples\"?)"),
                (head + "samples = 0\n", "bad.toml:3:11: error: samples must be from 1"),
                (axis + "distribution = \"unifrom\"\nmin = 0\nmax = 1\n", "bad.toml:5:16: error: distribution must be"),
                (axis + "distribution = \"uniform\"\nmin = 2\nmax = 1\n", "bad.toml:7:7: error: max must be at least min"),
                (axis + "distribution = \"uniform\"\nmin = 0\nmax = 1\nmean = 3\n",
                 "bad.toml:8:8: error: mean does not belong"),
                (axis + "distribution = \"log-uniform\"\nmin = 0\nmax = 1\n", "bad.toml:6:7: error: min must be above 0"),
                (axis + "distribution = \"uniform\"\nmin = 0\nmax = 1\n", "needs \"samples\""),
                (axis + "values = []\n", "bad.toml:5:10: error: values must have a value"),
                (axis + "range = { from = 1, to = 0, step = 0.1 }\n", "must lead from"),
                (axis + "range = { from = 0, to = 1, count = 3, scale = \"log\" }\n", "must be above 0 in a logarithmic"),
                (axis + "value = [1]\n", "(did you mean \"values\"?)"),
                (axis + "values = [1]\n[pair]\ndiffer = \"fricton\"\n", "names no axis"),
                (axis + "values = [1]\n[pair]\ndiffer = \"body.crate.friction\"\n", "two values"),
                (axis + "values = [1, 1.5]\n[outputs]\ntables = [\"enrgy\"]\n", "(did you mean \"energy\"?)"),
                (axis + "values = [1, 1.5]\n[outputs]\naov = [\"deep\"]\n", "unknown name \"deep\""),
                (axis + "values = [1, 1.5]\n[outputs]\nclip = \"clip.avi\"\n", "clip.avi"),
                (head + "name = \"{f}\"\n[[axis]]\nname = \"f\"\npath = \"body.crate.friction\"\nvalues = [1, 1]\n",
                 "bad.toml:3:8: error: name gives two samples the name \"1\""),
                (head + "name = \"{g}\"\n", "has the unknown field \"g\""),
                (head + "name = \"../{index}\"\n", "bad.toml:3:8"),
                (head + "name = \"manifest.jsonl\"\n", "bad.toml:3:8: error: name must not be in the place of the manifest"),
                (head + "name = \"manifest.jsonl/{index}\"\n", "must not be in the place of the manifest"),
                (head + "name = \"{t}\"\n[[axis]]\nname = \"t\"\npath = \"title\"\nvalues = [\"a\", \"manifest.jsonl\"]\n",
                 "must not be in the place of the manifest"),
                (head + "name = \"a\\nb\"\n", "bad.toml:3:8: error: name must have no control characters"),
                (head + "name = \"a\\u0000b\"\n", "bad.toml:3:8: error: name must have no zero byte"),
                ("format = 1\nscene = \"boxes.toml\\u0000\"\n", "bad.toml:2:9: error: scene must have no zero byte"),
                (axis + "values = [1]\n[outputs]\nclip = \"\\u0000\"\n", "bad.toml:7:8: error: clip must have no zero byte"),
                (axis + "values = [1]\n[outputs]\nclip = \"a\\n.mp4\"\n", "clip must have no control characters"),
                (head + "[[axis]]\npath = \"body.crate.fricton\"\nvalues = [1, 2]\n", "did you mean \"friction\""),
                (head + "[[axis]]\npath = \"body.crat.friction\"\nvalues = [1, 2]\n", "no element \"crat\""),
                (head + "[set]\nsimulation.duratoin = 2\n", "did you mean \"duration\""),
        ):
            with self.subTest(plan=plan):
                self.error(plan, expected)

    def test_a_sweep_needs_a_folder(self):
        self.write("plan.toml", RANDOM.format(samples=1))
        self.assertIn("-o", self.check(2, "sweep", "plan.toml").stderr)
        self.check(2, "sweep", "none.toml", "-o", "out")
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    unittest.main()
