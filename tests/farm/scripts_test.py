"""`farm slurm` without a cluster: its scripts run by hand, awkward names, and every wrong use."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from farm_case import SCENE, TUMBLE, local_clips, run_tumble

# Every character that a shell, printf or sbatch could take for its own.
AWKWARD = "it's a \"clip\" $HOME `id` ; & * # ~ (1) !"


class FarmTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="tumble-farm-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.scene = AWKWARD + ".toml"
        (self.folder / self.scene).write_text(SCENE)

    def farm(self, *words, code=0, **options):
        run = run_tumble(self.folder, "farm", *words, **options)
        self.assertEqual(run.returncode, code, f"{words}\n{run.stdout}{run.stderr}")
        return run

    def write(self, *words, clip=AWKWARD + ".mp4", parts=5):
        self.farm("slurm", self.scene, "--parts", parts, "-o", clip, "--program", TUMBLE, "--write-only", *words)
        return self.folder / (clip + ".farm")

    def bash(self, script, *words, code=0, **options):
        run = subprocess.run(["bash", script, *map(str, words)], cwd="/", capture_output=True, text=True, timeout=300, **options)
        self.assertEqual(run.returncode, code, f"{script} {words}\n{run.stdout}{run.stderr}")
        return run


class ByHand(FarmTest):
    def test_the_clip_equals_a_local_run(self):
        options = ["--overlay", "trails,clock", "--size", "64x48", "--set", "body.first.restitution=0.25"]
        folder = self.write(*options, "--quality", "best")
        self.bash(folder / "simulate.sh")
        self.assertEqual(self.farm("status", folder, "--missing", code=3).stdout, "1-4\n")
        for part in (4, 2, 1):   # in any order
            self.bash(folder / "frames.sh", part)
        self.assertEqual(self.farm("status", folder, "--missing", code=3).stdout, "3\n")
        refused = self.bash(folder / "stitch.sh", code=1)
        self.assertIn("part 3 (frames 6-8): 3 of 3 frames are missing: 6-8", refused.stderr)
        self.assertFalse((self.folder / (AWKWARD + ".mp4")).exists())
        # The printed command draws the part and makes the clip.
        command = re.search(r"or here:  (.*)$", refused.stderr, re.M)[1]
        done = subprocess.run(["bash", "-c", command], cwd="/", capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, command + done.stderr)
        local = local_clips(self.folder, self.scene, *options, "--quality", "best")
        self.assertEqual((self.folder / (AWKWARD + ".mp4")).read_bytes(), local.rendered)
        self.assertEqual((self.folder / (AWKWARD + ".mp4")).read_bytes(), local.encoded)
        self.assertIn("4 of 4 parts are complete, 12 of 12 frames", self.farm("status", folder).stdout)

    def test_other_clips(self):
        """Panels, motion blur, slow motion, plots, alpha, frames per second: each option reaches the commands that need it."""
        (self.folder / "other.toml").write_text(SCENE.replace("restitution", "friction").replace("0.6, 0.0]", "0.9, 0.0]"))
        for clip, scenes, options in (("a.mp4", (self.scene, "other.toml"), ("--plot", "energy", "--size", "240x320", "--duration", "0.5")),
                                      ("b.webm", (self.scene,), ("--transparent", "--shutter", "180", "--blur-samples", "3", "--duration", "0.5")),
                                      ("c.gif", (self.scene,), ("--vary", "body.first.restitution=0,0.9", "--size", "120x60", "--duration", "0.5", "--speed", "0.5", "--fps", "5", "--samples", "4"))):
            self.farm("slurm", *scenes, "--parts", 3, "-o", clip, "--program", TUMBLE, "--write-only", *options)
            folder = self.folder / (clip + ".farm")
            self.bash(folder / "simulate.sh")
            for part in (3, 1, 2):
                self.bash(folder / "frames.sh", part)
            self.bash(folder / "stitch.sh")
            local = run_tumble(self.folder, "render", *scenes, *options, "-o", "local-" + clip, "--quiet")
            self.assertEqual(local.returncode, 0, local.stderr)
            self.assertEqual((self.folder / clip).read_bytes(), (self.folder / ("local-" + clip)).read_bytes(), clip)

    def test_a_damaged_frame_is_missing(self):
        folder = self.write()
        self.bash(folder / "simulate.sh")
        for part in (1, 2, 3, 4):
            self.bash(folder / "frames.sh", part)
        frame = folder / "frames/frame_000004.png"
        whole = frame.read_bytes()
        for damaged in (b"", whole[:-1], whole[:40], b"x" + whole[1:]):
            frame.write_bytes(damaged)
            self.assertEqual(self.farm("status", folder, "--missing", code=3).stdout, "2\n")
        run_tumble(self.folder, "render", self.scene, "--set", "light.direction=[0.4,-1,0.3]", "--frames", "other", "--quiet")
        self.assertNotEqual((self.folder / "other/frame_000004.png").read_bytes(), whole)
        frame.write_bytes((self.folder / "other/frame_000004.png").read_bytes())   # of another clip
        self.assertEqual(self.farm("status", folder, "--missing", code=3).stdout, "2\n")
        frame.unlink()
        self.bash(folder / "frames.sh", 2)
        self.assertEqual(frame.read_bytes(), whole)
        # The same clip in other parts keeps the frames; another clip is refused before anything is submitted.
        self.write(parts=3)
        self.assertIn("3 of 3 parts are complete", self.farm("status", folder).stdout)
        refused = self.farm("slurm", self.scene, "--parts", 3, "-o", AWKWARD + ".mp4", "--write-only", "--size", "64x64", code=2)
        self.assertRegex(refused.stderr, "frames of another clip, which differs in .*size")

    def test_parts(self):
        """As many as asked, but of one length; each frame in one of them."""
        for parts, lengths in ((1, [12]), (2, [6, 6]), (5, [3, 3, 3, 3]), (7, [2] * 6), (8, [2] * 6), (12, [1] * 12), (500, [1] * 12)):
            settings = (self.write(parts=parts) / "settings.sh").read_text()
            ranges = [tuple(map(int, word.split("-"))) for word in re.search(r"^parts=\( (.*) \)", settings, re.M)[1].split()]
            self.assertEqual([last - first + 1 for first, last in ranges], lengths, parts)
            self.assertEqual([n for first, last in ranges for n in range(first, last + 1)], list(range(12)))

    def test_a_wrong_part(self):
        folder = self.write()
        for part in ("0", "5", "x", "1x", "-1", "1 2"):
            self.assertIn("a number from 1 to 4", self.bash(folder / "frames.sh", part, code=2).stderr)
        self.assertIn("a number from 1 to 4", self.bash(folder / "frames.sh", code=2, env={"PATH": os.environ["PATH"]}).stderr)

    def test_wrong_input_is_not_tried_again(self):
        folder = self.write()
        (self.folder / self.scene).write_text("format = 2\n")
        log = self.bash(folder / "simulate.sh", code=2).stderr
        self.assertRegex(log, r"the simulation failed on \S+ with exit code 2\n$")
        self.assertNotIn("again", log)

    def test_bash_finds_no_mistake_in_the_scripts(self):
        folder = self.write()
        names = sorted(path.name for path in folder.glob("*.sh"))
        self.assertEqual(names, ["frames.sh", "settings.sh", "simulate.sh", "stitch.sh", "submit.sh"])
        for name in names:
            checked = subprocess.run(["bash", "-n", folder / name], capture_output=True, text=True, timeout=60)
            self.assertEqual((checked.returncode, checked.stderr), (0, ""))


class Submission(FarmTest):
    """With a program in place of sbatch that writes down its arguments and answers with a number."""

    def with_sbatch(self, script="echo $(($(wc -l < calls)));"):
        (self.folder / "bin").mkdir(exist_ok=True)
        fake = self.folder / "bin/sbatch"
        fake.write_text(f"#!/bin/sh\ncd '{self.folder}'\necho \"$@\" >> calls\n{script}\n")
        fake.chmod(0o755)
        cancel = self.folder / "bin/scancel"
        cancel.write_text(f"#!/bin/sh\necho \"scancel $@\" >> '{self.folder}/calls'\n")
        cancel.chmod(0o755)
        return {**os.environ, "PATH": f"{self.folder}/bin:{os.environ['PATH']}"}

    def calls(self):
        return (self.folder / "calls").read_text().splitlines()

    def test_jobs_and_their_dependencies(self):
        run = self.farm("slurm", self.scene, "--parts", 4, "-o", "a.mp4", env=self.with_sbatch())
        folder = self.folder / "a.mp4.farm"
        self.assertEqual(self.calls(), [
            f"--parsable {folder}/simulate.sh",
            f"--parsable --dependency=afterok:1 --kill-on-invalid-dep=yes --array=1-4 {folder}/frames.sh",
            f"--parsable --dependency=afterany:2 {folder}/stitch.sh 0"])
        self.assertEqual(run.stdout, "job 1: simulation\njob 2: frames, parts 1-4\njob 3: clip\n")

    def test_the_name_of_a_cluster_in_the_answer(self):
        self.farm("slurm", self.scene, "--parts", 4, "-o", "a.mp4", env=self.with_sbatch("echo '7;alps'"))
        self.assertIn("--dependency=afterok:7 ", self.calls()[1])

    def test_a_refused_array_leaves_no_job_behind(self):
        environment = self.with_sbatch('case "$*" in *array*) echo "no such partition" >&2; exit 1 ;; esac; echo 5')
        run = self.farm("slurm", self.scene, "--parts", 4, "-o", "a.mp4", code=1, env=environment)
        self.assertIn("the job could not be submitted:\nno such partition", run.stderr)
        self.assertEqual(self.calls()[2:], ["scancel 5"])

    def test_without_sbatch(self):
        run = self.farm("slurm", self.scene, "--parts", 4, "-o", "a.mp4", code=1, env={**os.environ, "PATH": "/nowhere"})
        self.assertIn("no program 'sbatch'", run.stderr)
        self.assertIn("a.mp4.farm/submit.sh", run.stderr)


class WrongUse(FarmTest):
    def refused(self, text, *words, code=2):
        run = self.farm("slurm", *words, code=code)
        self.assertIn(text, run.stderr)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), [self.scene], "something was written")

    def test_nothing_is_written(self):
        usual = (self.scene, "--write-only", "--parts", "4", "-o", "a.mp4")
        self.refused("--parts", self.scene, "-o", "a.mp4")
        self.refused("--parts", self.scene, "-o", "a.mp4", "--parts", "0")
        self.refused("--output", self.scene, "--parts", "4")
        self.refused("no-such.toml", "no-such.toml", "--parts", "4", "-o", "a.mp4")
        self.refused("unknown kind of clip", self.scene, "--parts", "4", "-o", "a.txt")
        self.refused("--size", *usual, "--size", "64")
        self.refused("--overlay", *usual, "--overlay", "nothing-known")
        self.refused("--overlay: damage", *usual, "--overlay", "damage")
        self.refused("--set", *usual, "--set", "simulation.nothing=1")
        self.refused("--plot", *usual, "--plot", "body.nobody.y")
        self.refused("control character", *usual, "--folder", "a\nb")
        self.refused("Slurm cannot write its logs", *usual, "--folder", "100%a")
        self.refused("Slurm cannot write its logs", *usual, "--folder", "a\\b")
        self.refused("--sbatch", *usual, "--sbatch", "account")
        for option in ("--array=1-3", "-a1-3", "-a 1-3", "-o/tmp/log", "-o", "-o x", "--output=x", "--out=x", "--outp x", "-Qox",
                       "-dafterok:1", "--dep=afterok:1", "--parsable", "--open-mode=truncate", "-J name", "--job-name=x",
                       "--no-requeue", "--wrap=true", "-pcpu", "--partition=cpu", "-t10", "--time=10", "-c4", "--cpus-per-task=4",
                       "--test-only", "-W"):
            self.refused("--sbatch: -", *usual, "--sbatch=" + option)
        for text in ("account", "-", "--", "-A film -o x", "--comment a b", "--account=a\nb", "-A -ox", "--a'b=1"):
            self.refused("--sbatch: must be one option of sbatch", *usual, "--sbatch=" + text)
        self.refused("--cpus-per-task", *usual, "--cpus-per-task", "0")
        self.refused("--frames", *usual, "--frames", "out")
        self.refused("--workers", *usual, "--workers", "2")

    def test_other_options_of_sbatch(self):
        given = ("--account=film", "-A film", "-Afilm", "--mem=2G", "--time-min=5", "--exclusive", "-vHk", "--comment=it's #1 -o x")
        folder = self.write(*("--sbatch=" + option for option in given))
        lines = [line[8:] for line in (folder / "frames.sh").read_text().splitlines() if line.startswith("#SBATCH ")]
        self.assertEqual(lines[-len(given):], [*given[:-1], "--comment=\"it's #1 -o x\""])

    def test_the_folder_is_not_the_clip(self):
        self.refused("must be two files", self.scene, "--write-only", "--parts", "4", "-o", "a.mp4", "--folder", "a.mp4")

    def test_folders(self):
        self.refused("there is no folder", self.scene, "--write-only", "--parts", "4", "-o", "missing/a.mp4")
        (self.folder / "mine").mkdir()
        (self.folder / "mine/settings.sh").write_text("mine")
        run = self.farm("slurm", self.scene, "--write-only", "--parts", "4", "-o", "a.mp4", "--folder", "mine", code=2)
        self.assertIn("holds other files than those of a farm job", run.stderr)
        self.assertEqual((self.folder / "mine/settings.sh").read_text(), "mine")
        (self.folder / "mine/settings.sh").unlink()
        self.farm("slurm", self.scene, "--write-only", "--parts", "4", "-o", "a.mp4", "--folder", "mine")
        self.farm("slurm", self.scene, "--write-only", "--parts", "2", "-o", "a.mp4", "--folder", "mine")   # its own

    def test_status_of_another_folder(self):
        self.assertIn("holds no farm job", self.farm("status", ".", code=2).stderr)
        for text in ("", "[]", "{}", '{"format": 2}', '{"format": 1, "scene": "a", "clip": "b", "frames": 4, "parts": [[0, 1], [3, 3]]}'):
            (self.folder / "farm.json").write_text(text)
            self.assertIn("farm.json: error: is ", self.farm("status", ".", code=2).stderr)

    def test_status_of_absurdly_many_frames(self):
        for frames, code in ((10**15, 2), (10**18, 2), (10**7 + 1, 2), (10**7, 3)):
            (self.folder / "farm.json").write_text(
                f'{{"format": 1, "clip": "b", "frames": {frames}, "parts": [[0, {frames - 1}]]}}')
            run = self.farm("status", ".", code=code)
            if code == 2:
                self.assertIn("farm.json: error: is broken: its parts are not the frames of a clip", run.stderr)
            else:
                self.assertIn(f"0 of 1 parts are complete, 0 of {frames} frames", run.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
