"""`farm openjd`: the template against the specification, and run step by step as it says."""

import copy
import json
import pathlib
import shutil
import tempfile
import unittest

import openjd
from farm_case import SCENE, TUMBLE, local_clips, run_tumble

OPTIONS = ("--overlay", "trails,clock", "--size", "64x48", "--set", "body.first.restitution=0.25")


class OpenJd(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="tumble openjd's "))
        self.addCleanup(shutil.rmtree, self.folder)
        (self.folder / "scene.toml").write_text(SCENE)

    def template(self, *words, scene="scene.toml", **options):
        run = run_tumble(self.folder, "farm", "openjd", scene, "-o", "job.json", *words, **options)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads((self.folder / "job.json").read_text())


class Form(OpenJd):
    def test_templates_keep_the_specification(self):
        made = [self.template(*words) for words in ((), OPTIONS, ("--transparent", "--clip", "a.webm"), ("--chunk", "1000"),
                                                    ("--program", "/opt/it's here/tumble", "--speed", "0.25", "--shutter", "180"))]
        for template in made:
            self.assertEqual(openjd.faults(template), [])
        found = openjd.schema_faults(made)
        if found is None:
            self.skipTest("the schema: python3-jsonschema is missing")
        self.assertEqual(found, [[]] * len(made))

    def test_damaged_templates_are_found(self):
        """Each in one place; without jsonschema those that the rules find."""
        def at(path, value):
            def damage(template):
                *keys, last = path
                for key in keys:
                    template = template[key]
                if value is None:
                    del template[last]
                else:
                    template[last] = value
            return damage
        frame = ("steps", 1, "parameterSpace", "taskParameterDefinitions", 0)
        run = ("steps", 2, "script", "actions", "onRun")
        by_schema = [at(("specificationVersion",), "jobtemplate-2024-01"), at(("unknown",), 1), at(("steps",), []), at(("name",), ""),
                     at(("parameterDefinitions", 0, "name"), "two words"), at(("parameterDefinitions", 0, "type"), "FILE"),
                     at((*frame, "chunks"), None), at((*frame, "chunks", "rangeConstraint"), "ANY"),
                     at((*frame, "chunks", "defaultTaskCount"), 0), at((*frame, "type"), "INT"), at((*run, "command"), None),
                     at((*run, "args", 0), "two\nlines"), at((*run, "cancelation", "notifyPeriodInSeconds"), 601),
                     at(("steps", 0, "name"), "x" * 65), at((*run, "timeout"), 0)]
        by_rules = [at(("extensions",), ["OTHER_THINGS"]), at(("steps", 1, "dependencies", 0, "dependsOn"), "Nothing"),
                    at(("steps", 0, "dependencies"), [{"dependsOn": "Stitch"}]), at(("steps", 1, "name"), "Stitch"),
                    at((*run, "args", 1), "{{Param.Nothing}}"), at((*run, "args", 1), "{{Task.Param.Frame}}"), at((*run, "args", 1), "{{ 1 + 1 }}"),
                    at((*frame, "range"), "{{Param.Scene}}"), at((*frame, "range"), "1-5,3"), at(("name",), "{{Param.OutputFolder}}"),
                    at(("parameterDefinitions", 4, "default"), 0), at(("parameterDefinitions", 0, "default"), "/etc/passwd"),
                    at(("parameterDefinitions", 1, "name"), "Scene"), at(("name",), "x" * 129)]
        whole = self.template()

        def damaged(damage):
            template = copy.deepcopy(whole)
            damage(template)
            return template
        for number, damage in enumerate(by_rules):
            self.assertNotEqual(openjd.faults(damaged(damage)), [], f"rule {number}")
        found = openjd.schema_faults([damaged(damage) for damage in by_schema])
        for number, one in enumerate(found or []):
            self.assertNotEqual(one, [], f"schema {number}")

    def test_inputs_are_named(self):
        """Defaults only inside the template's folder, where submitters take them."""
        (self.folder / "meshes").mkdir()
        (self.folder / "meshes/corner.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        body = '[[body]]\nshape = { type = "mesh", file = "meshes/corner.obj" }\nposition = [0.0, 4.0, 0.0]\n'
        (self.folder / "scene.toml").write_text(SCENE + body)
        parameters = {p["name"]: p for p in self.template()["parameterDefinitions"]}
        self.assertEqual(parameters["Scene"]["default"], "scene.toml")
        self.assertEqual((parameters["Mesh1"]["default"], parameters["Mesh1"]["dataFlow"]), ("meshes/corner.obj", "IN"))
        (self.folder / "jobs").mkdir()
        run = run_tumble(self.folder, "farm", "openjd", "scene.toml", "-o", "jobs/job.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        outside = json.loads((self.folder / "jobs/job.json").read_text())
        self.assertNotIn("default", outside["parameterDefinitions"][0])
        self.assertEqual(openjd.faults(outside), [])

    def test_wrong_use(self):
        for text, words in (("double braces", ("--set", 'title="{{Param.Scene}}"')), ("without a folder", ("--clip", "out/a.mp4")),
                            ("unknown kind of clip", ("--clip", "a.txt")), ("--chunk", ("--chunk", "0"))):
            run = run_tumble(self.folder, "farm", "openjd", "scene.toml", "-o", "job.json", *words)
            self.assertEqual(run.returncode, 2, words)
            self.assertIn(text, run.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["scene.toml"])


class Run(OpenJd):
    def test_both_kinds_of_chunks_give_the_local_clip(self):
        template = self.template(*OPTIONS, "--chunk", "5", "--quality", "best")
        local = local_clips(self.folder, "scene.toml", *OPTIONS, "--quality", "best")
        for constraint, expected in (("CONTIGUOUS", {"0-3", "4-7", "8-11"}), ("NONCONTIGUOUS", {"0,1,6,9", "3,4-10:3", "2-11:3"})):
            changed = copy.deepcopy(template)
            changed["steps"][1]["parameterSpace"]["taskParameterDefinitions"][0]["chunks"]["rangeConstraint"] = constraint
            self.assertEqual(openjd.faults(changed), [])
            output = self.folder / f"the {constraint}'s output"
            output.mkdir()
            commands = openjd.run(changed, self.folder, {"OutputFolder": output, "Tumble": TUMBLE, "Clip": "my clip.mp4"})
            ranges = {words[words.index("--frames-range") + 1] for words in commands["Render"]}
            self.assertEqual(ranges, expected)
            self.assertEqual((output / "my clip.mp4").read_bytes(), local.rendered)
            self.assertEqual((output / "my clip.mp4").read_bytes(), local.encoded)
            for frame in sorted(local.frames.glob("*.png")):
                self.assertEqual((output / "frames" / frame.name).read_bytes(), frame.read_bytes(), frame.name)

    def test_a_part_of_the_frames_makes_no_clip(self):
        output = self.folder / "out"
        with self.assertRaisesRegex(RuntimeError, "step Stitch"):
            openjd.run(self.template(), self.folder, {"OutputFolder": output, "Tumble": TUMBLE, "Frames": "0-3,5-11"})
        self.assertFalse((output / "scene.mp4").exists())


class Engine(unittest.TestCase):
    """The test's own engine."""

    def test_ranges(self):
        for text, values in (("1 - 5", [1, 2, 3, 4, 5]), ("-1 - 1", [-1, 0, 1]), ("1-5:2", [1, 3, 5]), ("10-15:2,1-5", [1, 2, 3, 4, 5, 10, 12, 14]),
                             ("1-10:4", [1, 5, 9]), ("7", [7]), ("9-1:-4", [1, 5, 9])):
            self.assertEqual(openjd.integers(text), values, text)
        for text in ("1-10:4,9-15", "", "1-2-3", "a", "1-5:0", "1,1"):
            with self.assertRaises(ValueError, msg=text):
                openjd.integers(text)
        for values in ([1], [1, 2], [1, 3], [1, 3, 5], [0, 1, 2, 5, 7, 9, 11, 20]):
            self.assertEqual(openjd.integers(openjd.expression(values)), values)

    def test_chunks(self):
        self.assertEqual(openjd.chunks(list(range(1, 13)), 5, "CONTIGUOUS"), ["1-4", "5-8", "9-12"])
        self.assertEqual(openjd.chunks([1, 2, 3, 7], 2, "CONTIGUOUS"), ["1-1", "2-3", "7-7"])
        for size in (1, 2, 3, 5, 20):
            dealt = openjd.chunks(list(range(12)), size, "NONCONTIGUOUS")
            self.assertEqual(sorted(n for chunk in dealt for n in openjd.integers(chunk)), list(range(12)))


if __name__ == "__main__":
    unittest.main(verbosity=2)
