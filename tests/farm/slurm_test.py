"""`farm slurm` on a real Slurm of two nodes: the clip has the bytes of a local run, also where a part is killed, a whole job
dies, or a node is drained. Skipped where Slurm is missing."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import slurm_cluster
from farm_case import SCENE, TUMBLE, local_clips, run_tumble

if not slurm_cluster.available():
    print("skipped: no Slurm (scripts/install-dependencies --test)")
    sys.exit(77)

# A program that is tumble, except that it does harm to a part of the frames, as often as asked. Each harm leaves a file.
HARMFUL = """\
#!/bin/bash
if [[ " $* " == *"{words}"* ]] && (($(ls '{marks}' | wc -l) < {times})); then
    mktemp '{marks}/XXXXXX' >/dev/null
    {harm}
fi
exec '{tumble}' "$@"
"""
KILL_THE_PROGRAM = """\
'{tumble}' "$@" &
    until [[ -e '{first_frame}' ]]; do sleep 0.01; kill -0 $! || break; done
    kill -9 $!
    exit 137"""
KILL_THE_JOB = "kill -9 $PPID; exit 137"
FAIL = "exit 1"


class Farm:
    """A job that was submitted: its folder, clip, and the numbers of its three jobs."""

    def __init__(self, root, cluster, name, harm=None, times=0, options=(), words=" --frames-range 6-8 "):
        self.root, self.cluster = root, cluster
        self.clip = root / f"{name}.mp4"
        self.folder = root / f"{name}'s \"farm\" $HOME # 1"
        program = TUMBLE
        if harm:
            program = self.harmful_program(harm, times, words)
        self.submitted = run_tumble(root, "farm", "slurm", "the scene's.toml", "--parts", 4, "-o", self.clip, "--folder", self.folder,
                                    "--program", program, "--overlay", "trails,clock", "--size", "64x48", "--quality", "best",
                                    *options, env=cluster.environment)
        self.jobs = [int(number) for number in re.findall(r"^job (\d+): ", self.submitted.stdout, re.M)]

    def harmful_program(self, harm, times, words):
        marks = self.root / (self.clip.stem + "-harm")
        marks.mkdir()
        program = self.root / (self.clip.stem + "-tumble")
        values = {"tumble": TUMBLE, "marks": marks, "times": times, "words": words,
                  "first_frame": self.folder / "frames/frame_000006.png"}
        for key in ("first_frame",):
            values[key] = str(values[key]).replace("'", "'\\''")
        values["harm"] = harm.format(**values)
        program.write_text(HARMFUL.format(**values))
        program.chmod(0o755)
        self.marks = marks
        return program

    def log(self, name):
        path = self.folder / "log" / name
        return path.read_text() if path.exists() else f"({name} is not there)"

    def logs(self):
        return "".join(f"--- {p.name}\n{p.read_text()}" for p in sorted((self.folder / "log").iterdir()))

    def status(self, *options):
        return run_tumble(self.root, "farm", "status", self.folder, *options)


class SlurmFarm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = pathlib.Path(tempfile.mkdtemp(prefix="tumble-farm-"))
        cls.addClassCleanup(shutil.rmtree, cls.root)
        (cls.root / "the scene's.toml").write_text(SCENE)
        (cls.root / "slurm").mkdir()
        cls.cluster = cls.enterClassContext(slurm_cluster.Cluster(cls.root / "slurm"))
        # All at once, because the scheduler works in ticks of a second.
        cls.plain = Farm(cls.root, cls.cluster, "plain", options=["--sbatch=--comment=it's #1", "--time", "10:00", "--cpus-per-task", "2"])
        cls.killed = Farm(cls.root, cls.cluster, "killed", KILL_THE_PROGRAM, 1)
        cls.lost_job = Farm(cls.root, cls.cluster, "lost", KILL_THE_JOB, 1, ["--retries", "1"])
        cls.failing = Farm(cls.root, cls.cluster, "failing", FAIL, 1000, ["--retries", "0"])
        cls.no_simulation = Farm(cls.root, cls.cluster, "unsimulated", FAIL, 1000, ["--retries", "1"], " simulate ")
        cls.cluster.drain("n1")   # tasks that run there end; the others run on the other node
        cls.local = local_clips(cls.root, "the scene's.toml", "--overlay", "trails,clock", "--size", "64x48", "--quality", "best")
        cls.cluster.wait_for_end_of_jobs()

    def check_clip(self, farm):
        self.assertTrue(farm.clip.exists(), farm.logs())
        self.assertEqual(farm.clip.read_bytes(), self.local.encoded, "not the bytes of render --frames and encode")
        self.assertEqual(farm.clip.read_bytes(), self.local.rendered, "not the bytes of render -o")

    def test_clip_and_frames_equal_a_local_run(self):
        self.check_clip(self.plain)
        frames = self.plain.folder / "frames"
        for local in sorted(self.local.frames.glob("*.png")):
            self.assertEqual((frames / local.name).read_bytes(), local.read_bytes(), local.name)
        self.assertEqual(self.cluster.job(self.plain.jobs[2])["JobState"], "COMPLETED")
        job = self.cluster.job(self.plain.jobs[0])
        self.assertEqual((job["NumCPUs"], job["TimeLimit"]), ("2", "00:10:00"))
        self.assertIn("Comment=it's #1", self.cluster.run("scontrol", "show", "job", "-o", str(self.plain.jobs[0])))
        self.assertEqual(self.plain.status().returncode, 0)
        self.assertIn("4 of 4 parts are complete, 12 of 12 frames", self.plain.status().stdout)
        self.assertEqual(self.plain.status("--missing").stdout, "")

    def test_a_killed_part_is_run_again_and_named(self):
        self.check_clip(self.killed)
        self.assertRegex(self.killed.log("frames-3.log"), r"part 3 \(frames 6-8\) failed on \S+ with exit code 137")
        self.assertIn("part 3 (frames 6-8): trying again (1 of 2)", self.killed.log("frames-3.log"))
        for part in (1, 2, 4):
            self.assertEqual(self.killed.log(f"frames-{part}.log"), "")

    def test_a_job_that_dies_with_its_script_is_submitted_again(self):
        self.check_clip(self.lost_job)
        log = self.lost_job.log("stitch.log")
        self.assertIn("part 3 (frames 6-8): 3 of 3 frames are missing: 6-8", log)
        self.assertIn("submitting the missing parts again (1 of 1)", log)
        again = re.search(r"job (\d+): frames, parts 3\n", log)
        self.assertEqual(self.cluster.job(again[1] + "_3")["BatchHost"], "n2", "the drained node took a part")

    def test_a_part_that_fails_is_named_with_the_command_that_draws_it(self):
        farm = self.failing
        self.assertFalse(farm.clip.exists())
        self.assertEqual(self.cluster.job(farm.jobs[2])["JobState"], "FAILED")
        self.assertIn("part 3 (frames 6-8): 3 of 3 frames are missing: 6-8", farm.log("stitch.log"))
        self.assertEqual(farm.status().returncode, 3)
        self.assertEqual(farm.status("--missing").stdout, "3\n")
        command = re.search(r"on the cluster:  (bash .* 3)$", farm.log("stitch.log"), re.M)[1]
        farm.marks.joinpath("healed").touch()
        program = self.root / "failing-tumble"
        program.write_text(program.read_text().replace("< 1000", "< 0"))
        self.cluster.run("bash", "-c", command)
        self.cluster.wait_for_end_of_jobs()
        self.check_clip(farm)

    def test_without_the_simulation_no_part_is_drawn(self):
        farm = self.no_simulation
        states = self.cluster.jobs()
        self.assertEqual(states[str(farm.jobs[0])], "FAILED")
        for part in (1, 2, 3, 4):
            self.assertRegex(states[f"{farm.jobs[1]}_{part}"], "^CANCEL")
        self.assertEqual(states[str(farm.jobs[2])], "FAILED")
        self.assertIn("the simulation: trying again (1 of 1)", farm.log("simulate.log"))
        self.assertIn("the simulation has not finished", farm.log("stitch.log"))
        self.assertFalse(farm.clip.exists())

    def test_a_drained_node_is_left(self):
        self.assertEqual(self.cluster.state_of("n1"), "drained")   # its last task has ended
        self.assertEqual(self.cluster.state_of("n2"), "idle")

    def test_no_process_is_left_on_the_nodes(self):
        self.cluster.wait_for_end_of_jobs()
        for node in slurm_cluster.NODES:
            self.assertEqual(self.cluster.processes_of(node), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
