"""Files that are read: no output replaces one, by any name and in any command; a pipe in their place is an error. Outputs of
suites, sweeps and lessons stay below their folder."""

import os
import pathlib
import shutil
import unittest

import program

PLAN = """\
format = 1
scene = "scene.toml"
name = "{index}"
[[axis]]
path = "simulation.duration"
values = [0.1, 0.2]
[outputs]
frames = false
scene = "toml"
tables = ["trajectory"]
"""
LESSON = '+++\ntitle = "One"\nsummary = "One."\n+++\n\nText.\n'


class Inputs(program.ProgramTest):
    def contents(self):
        return {str(path.relative_to(self.folder)): os.readlink(path) if path.is_symlink() else path.read_bytes()
                for path in self.folder.rglob("*") if path.is_symlink() or path.is_file()}

    def refused(self, *arguments, said="", **options):
        before = self.contents()
        with self.subTest(arguments=arguments):
            run = self.check(2, *arguments, timeout=60, **options)
            self.assertIn(said, run.stderr + run.stdout)
            self.assertEqual(self.contents(), before)

    def pair(self, name, color=(90, 90, 90)):
        for folder, c in (("a", (120, 120, 120)), ("b", color)):
            (self.folder / folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / folder / name).write_bytes(program.png(16, 12, c))


class Compare(Inputs):
    def setUp(self):
        super().setUp()
        self.pair("x.png")
        self.pair("in/y.png")
        (self.folder / "a/frames.motion.json").write_text("{}")
        (self.folder / "mask.png").write_bytes(program.png(16, 12, (255, 255, 255)))
        self.write("t.toml", 'masks = [{ file = "mask.png" }]\n')
        os.link(self.folder / "a/x.png", self.folder / "hard")
        (self.folder / "link").symlink_to("a/in")
        (self.folder / "soft").symlink_to("b/x.png")

    def test_files_in_compared_folders(self):
        names = ("a/x.png", "b/in/y.png", "link/y.png", "soft", "hard", "a/../a/x.png", "a/frames.motion.json",
                 "b/frames.motion.json", "a/new.png", "a/new.JPG", "b/new/new.png", "link/z.png")
        for option in ("--json", "--junit", "--report"):
            for name in names:
                self.refused("compare", "a", "b", option, name, said=option)

    def test_masks_and_tolerances(self):
        for option in ("--json", "--junit", "--report"):
            for name in ("mask.png", "t.toml"):
                self.refused("compare", "a", "b", "--tolerances", "t.toml", option, name, said="which is read")

    def test_differences(self):
        (self.folder / "d/in").mkdir(parents=True)
        for name in ("a", "b", "a/in", "a/new", "link", "link/../../a", os.fspath(self.folder / "b")):
            self.refused("compare", "a", "b", "--diff", name, said="--diff")
        (self.folder / "d/x.png").symlink_to("../a/x.png")
        self.refused("compare", "a", "b", "--diff", "d", said="--diff")
        (self.folder / "d/x.png").unlink()
        os.rmdir(self.folder / "d/in")
        (self.folder / "d/in").symlink_to("../a/in")
        self.refused("compare", "a", "b", "--diff", "d", said="--diff")
        for name in ("a/x.png", "b/x.png", "soft", "hard"):
            self.refused("compare", "a/x.png", "b/x.png", "--diff", name, said="which is read")

    def test_a_folder_above_the_compared_ones(self):
        # a/x.png of the difference is a reference here.
        shutil.copytree(self.folder / "a", self.folder / "b/a")
        self.refused("compare", "a", "b", "--diff", ".", said="--diff")

    def test_other_files_may_stand_there(self):
        self.check(1, "compare", "a", "b", "--report", "a/r.html", "--json", "a/r.json", "--diff", "a/.d")
        self.check(1, "compare", "a", "b", "--report", "a/r.html", "--json", "a/r.json", "--diff", "a/.d")
        self.assertTrue((self.folder / "a/.d/x.png").exists())

    def test_clips(self):
        self.check(0, "render", "scene.toml", "--frames", "f", "-o", "c.mp4", "--quiet")
        for option in ("--json", "--junit", "--report"):
            self.refused("compare", "f", "c.mp4", option, "c.mp4", said="which is read")
            self.refused("compare", "f", "c.mp4", option, "f/frame_000001.png", said=option)
        self.refused("compare", "f", "c.mp4", "--diff", "f", said="--diff")

    def test_a_scene_and_its_meshes(self):
        self.write("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        self.write("mesh.toml", program.SCENE + '[[body]]\nshape = { type = "mesh", file = "part.obj" }\n'
                                                'position = [0.0, 9.0, 0.0]\n')
        self.check(0, "render", "mesh.toml", "--frames", "f", "--quiet", "--duration", "0")
        for name in ("part.obj", "mesh.toml", "f/frame_000000.png"):
            self.refused("compare", "f", "mesh.toml", "--json", name, said="--json")


class Suites(Inputs):
    def setUp(self):
        super().setUp()
        self.write("golden.toml", 'format = 1\n[[case]]\nname = "c"\nscene = "scene.toml"\n'
                                  '[case.tolerances]\nmasks = [{ file = "mask.png" }]\n')
        (self.folder / "mask.png").write_bytes(program.png(48, 32, (255, 255, 255)))
        self.secret = self.write("secret.txt", "secret")

    def golden(self, code, action, *arguments):
        more = ["--cache", "cache"] if action == "check" else []
        return self.check(code, "golden", action, "golden.toml", *arguments, *more)

    def test_a_check_replaces_nothing_that_it_reads(self):
        self.golden(0, "accept", "--all")
        self.golden(0, "check")
        cached = next((self.folder / "cache").rglob("c_000000.png")).relative_to(self.folder)
        names = ("references/c_000000.png", "references/c.motion.json", "references/new.png", "mask.png", "scene.toml",
                 "golden.toml", "references/amd/c_000000.png", str(cached))
        for option in ("--json", "--junit", "--report"):
            for name in names:
                self.refused("golden", "check", "golden.toml", "--cache", "cache", option, name, said=option)
        for name in ("references", "references/in"):
            self.refused("golden", "check", "golden.toml", "--cache", "cache", "--failures", name, said="--failures")
        (self.folder / "failures").mkdir()
        (self.folder / "failures/new_c_000000.png").symlink_to("../secret.txt")
        self.refused("golden", "check", "golden.toml", "--cache", "cache", "--failures", "failures", said="--failures")

    def test_references_stay_below_their_folder(self):
        (self.folder / "out").mkdir()
        (self.folder / "references").mkdir()
        for name, to in (("c_000000.png", "../secret.txt"), ("c.motion.json", "../secret.txt"),
                         ("c_000000.png", "/dev/null"), ("c_000000.png", "../none"), ("amd", "../out"),
                         ("amd", "../none")):
            link = self.folder / "references" / name
            link.symlink_to(to)
            more = ["--platform", "amd"] if name == "amd" else []
            self.refused("golden", "accept", "golden.toml", "--all", *more, said="leads out")
            link.unlink()
        os.mkfifo(self.folder / "references/c.motion.json")
        self.refused("golden", "accept", "golden.toml", "--all", said="no regular file")
        (self.folder / "references/c.motion.json").unlink()
        os.rmdir(self.folder / "references")
        (self.folder / "references").symlink_to(self.folder / "out")
        self.golden(0, "accept", "--all")   # a link that stays in the suite's folder
        (self.folder / "references").unlink()
        (self.folder / "references").symlink_to("/dev/shm")
        self.refused("golden", "accept", "golden.toml", "--all", said="leads out")

    def test_platforms_are_names(self):
        for name in ("../../x", "..", ".", "a/b", "/x", ".hidden"):
            self.refused("golden", "accept", "golden.toml", "--all", "--platform", name, said="--platform")
            self.refused("golden", "check", "golden.toml", "--platform", name, said="--platform")
            self.refused("compare", "references", "references", "--platform", name, said="--platform")

    def test_a_reference_replaces_no_input(self):
        self.write("golden.toml", 'format = 1\nreferences = "."\n[[case]]\nname = "mask"\nscene = "scene.toml"\n'
                                  'tolerances = { masks = [{ file = "mask_000000.png" }] }\n')
        os.rename(self.folder / "mask.png", self.folder / "mask_000000.png")
        self.refused("golden", "accept", "golden.toml", "--all", said="which is read")


class Sweeps(Inputs):
    def setUp(self):
        super().setUp()
        self.write("plan.toml", PLAN)
        self.write("secret.txt", "secret")

    def test_samples_replace_nothing_that_is_read(self):
        self.check(0, "sweep", "plan.toml", "-o", "out", "--quiet")
        self.write("out/0/plan.toml", PLAN.replace("scene.toml", "../../scene.toml"))
        self.refused("sweep", "out/0/plan.toml", "-o", "out", said="it is read")
        os.remove(self.folder / "out/0/plan.toml")
        self.write("other.toml", PLAN.replace("scene.toml", "out/1/scene.toml", 1))
        self.refused("sweep", "other.toml", "-o", "out", said="it is read")
        self.check(0, "sweep", "other.toml", "-o", "elsewhere", "--quiet")

    def test_the_manifest_and_the_samples_stay_below_the_folder(self):
        (self.folder / "out").mkdir()
        (self.folder / "out/manifest.jsonl").symlink_to("../secret.txt")
        self.refused("sweep", "plan.toml", "-o", "out", said="leads out")
        (self.folder / "out/manifest.jsonl").unlink()
        os.mkfifo(self.folder / "out/manifest.jsonl")
        self.refused("sweep", "plan.toml", "-o", "out", said="no regular file")
        (self.folder / "out/manifest.jsonl").unlink()
        self.write("deep.toml", PLAN.replace('"{index}"', '"in/{index}"'))
        (self.folder / "elsewhere").mkdir()
        (self.folder / "out/in").symlink_to("../elsewhere")
        self.refused("sweep", "deep.toml", "-o", "out", said="leads out")
        self.check(0, "sweep", "plan.toml", "-o", "out", "--quiet")


class Lessons(Inputs):
    def test_pages_stay_below_the_site(self):
        if shutil.which("node") is None or self.run_tumble("lesson", "scene.toml", "--check").returncode == 1:
            self.skipTest("the compiler of lessons is missing")
        self.write("one.md", LESSON)
        self.write("secret.txt", "secret")
        (self.folder / "site").mkdir()
        for name in ("one.html", "index.html"):
            (self.folder / "site" / name).symlink_to("../secret.txt")
            self.refused("lesson", "one.md", "-o", "site", said="leads out")
            (self.folder / "site" / name).unlink()
        self.check(0, "lesson", "one.md", "-o", "site", "--quiet")


class OtherCommands(Inputs):
    def test_checkpoints(self):
        self.check(0, "simulate", "scene.toml", "--checkpoints", "d", "--quiet")
        for name in ("d/clip.tumble", "d/checkpoint_000000.tumble", "d/checkpoint_000099.tumble"):
            self.refused("simulate", "scene.toml", "--checkpoints", "d", "--energy", name, said="--energy")
            self.refused("simulate", "scene.toml", "--from-checkpoints", "d", "--energy", name, said="--energy")
            self.refused("render", "scene.toml", "--from-checkpoints", "d", "--frames", "f", "--report", name,
                         said="--report")
        os.rename(self.folder / "scene.toml", self.folder / "d/motion_x.tumble")
        self.refused("simulate", "d/motion_x.tumble", "--checkpoints", "d", said="which is read")

    def test_frames_json_of_encoded_frames(self):
        self.check(0, "render", "scene.toml", "--frames", "f", "--quiet")
        (self.folder / "a.mp4").symlink_to("f/frames.json")
        self.refused("encode", "f", "-o", "a.mp4", said="which is read")

    def test_scripts_of_a_farm(self):
        (self.folder / "job").mkdir()
        self.write("secret.txt", "secret")
        self.write("job/farm.json", "{}")
        os.rename(self.folder / "scene.toml", self.folder / "job/settings.sh")
        self.refused("farm", "slurm", "job/settings.sh", "-o", "c.mp4", "--parts", "2", "--folder", "job",
                     "--write-only", said="which is read")
        os.rename(self.folder / "job/settings.sh", self.folder / "scene.toml")
        (self.folder / "job/submit.sh").symlink_to("../secret.txt")
        self.refused("farm", "slurm", "scene.toml", "-o", "c.mp4", "--parts", "2", "--folder", "job", "--write-only",
                     said="leads out")


class NoFiles(Inputs):
    """A pipe, a socket, a device or a folder in the place of an input. Nobody writes to the pipe."""

    def setUp(self):
        super().setUp()
        os.mkfifo(self.folder / "pipe.toml")
        os.mkfifo(self.folder / "pipe.png")
        os.mkfifo(self.folder / "pipe.mp4")
        (self.folder / "device.toml").symlink_to("/dev/zero")
        (self.folder / "folder.toml").mkdir()

    def refused(self, *arguments, said="", **options):
        with self.subTest(arguments=arguments):
            run = self.check(2, *arguments, timeout=60, **options)
            self.assertIn(said, run.stderr + run.stdout)

    def test_scenes(self):
        for name, said in (("pipe.toml", "not a regular file"), ("device.toml", "not a regular file"),
                           ("folder.toml", "is a folder, not a file")):
            for arguments in (("render", name), ("simulate", name), ("info", name), ("plot", name, "--of", "energy", "-o", "p.svg"),
                              ("export", name, "-o", "p.glb"), ("page", name), ("sweep", name, "--dry-run"),
                              ("golden", "check", name), ("golden", "accept", name, "--all"),
                              ("farm", "openjd", name, "-o", "j.json")):
                self.refused(*arguments, said=said)

    def test_files_that_a_file_names(self):
        self.write("suite.toml", 'format = 1\n[[case]]\nscene = "pipe.toml"\n')
        self.refused("golden", "check", "suite.toml", "--cache", "none", said="not a regular file")
        self.refused("golden", "accept", "suite.toml", "--all", said="not a regular file")
        self.write("plan.toml", PLAN.replace("scene.toml", "pipe.toml"))
        self.refused("sweep", "plan.toml", "-o", "out", said="not a regular file")
        self.write("template.toml", program.SCENE + '[templates]\nt = { file = "pipe.toml" }\n[[template]]\nname = "t"\n'
                                                    'file = "pipe.toml"\n')
        self.refused("simulate", "template.toml")
        self.write("masks.toml", 'masks = [{ file = "pipe.png" }]\n')
        (self.folder / "x.png").write_bytes(program.png(8, 8))
        self.refused("compare", "x.png", "x.png", "--tolerances", "masks.toml", said="not a regular file")
        self.refused("compare", "x.png", "x.png", "--tolerances", "pipe.toml", said="not a regular file")

    def test_pictures_and_clips(self):
        (self.folder / "x.png").write_bytes(program.png(8, 8))
        for a, b in (("pipe.png", "x.png"), ("x.png", "pipe.png"), ("pipe.mp4", "pipe.mp4")):
            self.refused("compare", a, b, said="not a regular file")
        (self.folder / "a").mkdir()
        (self.folder / "b").mkdir()
        os.mkfifo(self.folder / "a/x.png")
        (self.folder / "b/x.png").write_bytes(program.png(8, 8))
        self.refused("compare", "a", "b", "--report", "r.html", said="not a regular file")
        self.write("suite.toml", 'format = 1\n[[case]]\nname = "c"\nscene = "scene.toml"\n')
        (self.folder / "references").mkdir()
        os.mkfifo(self.folder / "references/c_000000.png")
        self.refused("golden", "check", "suite.toml", "--cache", "none", said="not a regular file")

    def test_records_and_checkpoints(self):
        self.check(0, "simulate", "scene.toml", "--checkpoints", "d", "--quiet")
        os.remove(self.folder / "d/clip.tumble")
        os.mkfifo(self.folder / "d/clip.tumble")
        self.refused("render", "scene.toml", "--from-checkpoints", "d", "--frames", "f", said="not a regular file")
        for folder in ("a", "b"):
            self.check(0, "render", "scene.toml", "--frames", folder, "--quiet", "--duration", "0")
            os.mkfifo(self.folder / folder / "frames.motion.json")
        (self.folder / "b/frame_000000.png").write_bytes(program.png(48, 32))
        self.check(1, "compare", "a", "b", timeout=60)


if __name__ == "__main__":
    program.main()
