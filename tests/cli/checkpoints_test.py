"""Checkpoints from outside: parts of a clip have the bytes of the whole one, and nothing else is drawn from them."""

import re
import shutil

import program

SCENE = """\
format = 1
title = "A heap"
[simulation]
duration = 1.2
steps_per_frame = 4
[output]
size = [128, 72]
fps = 20
samples = 1
[camera]
eye = [2.5, 1.6, 5.0]
target = [0.0, 0.8, 0.0]
[materials.m]
friction = 0.5
restitution = 0.3
[[body]]
name = "ground"
type = "fixed"
shape = { type = "plane" }
material = "m"
[[body]]
name = "crate"
shape = { type = "box", size = [0.8, 0.8, 0.8] }
material = "m"
mass = 10
position = [0, 0.9, 0]
angular_velocity = [1, 2, 0.5]
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.3 }
material = "m"
mass = 2
position = [1.2, 1.9, 0.6]
velocity = [-2, 0, 0]
[[body]]
name = "second"
shape = { type = "box", size = [0.4, 0.5, 0.6] }
material = "m"
mass = 1
position = [0.1, 2.2, 0]
"""
EVERYTHING = ("contacts,normals,impulses,forces,loads,velocity,omega,momentum,angular-momentum,trails,ghosts,aabb,axes,com,"
              "islands,sleep,names,title,clock,mode")


class Checkpoints(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)

    def frames(self, folder):
        return {int(path.stem[6:]): path.read_bytes() for path in sorted((self.folder / folder).glob("*.png"))}

    def simulate(self, *options, scenes=("scene.toml",), every=0.25):
        return self.check(0, "simulate", *scenes, "--checkpoints", "states", "--every", every, *options)

    # The settings of the clip are given to both commands. The motion of the frames is in the folder, or simulated again.
    def goes_on(self, *options, scenes=("scene.toml",), starts=(0.0, 0.25, 0.6, 1.15), speed=1.0):
        self.check(0, "render", *scenes, "--frames", "whole", "--quiet", *options)
        whole = self.frames("whole")
        for motion in ((), ("--no-motion",)):
            self.simulate(*options, *motion, scenes=scenes)
            for start in starts:
                self.check(0, "render", *scenes, "--frames", "part", "--start", start, "--from-checkpoints", "states", "--quiet",
                           *options)
                part = self.frames("part")
                self.assertEqual(sorted(part), [n for n in whole if n >= round(start / speed * 20)])
                for number, picture in part.items():
                    self.assertEqual(picture, whole[number], f"frame {number} of a part from {start} s; {options} {motion}")
                shutil.rmtree(self.folder / "part")

    def test_parts_have_the_bytes_of_the_whole_clip(self):
        self.goes_on()
        states = [f"checkpoint_{n:06}.tumble" for n in (5, 10, 15, 20)]
        self.assertEqual(sorted(p.name for p in (self.folder / "states").iterdir()), [*states, "clip.tumble"])
        self.simulate()
        motion = [f"motion_{n:06}.tumble" for n in (0, 5, 10, 15, 20)]
        self.assertEqual(sorted(p.name for p in (self.folder / "states").iterdir()), [*states, "clip.tumble", *motion])

    def test_parts_with_all_overlays(self):
        self.goes_on("--overlay", EVERYTHING)

    def test_parts_with_exact_impacts_and_a_plot(self):
        self.goes_on("--set", 'simulation.impacts="exact"', "--plot", "body.crate.y,energy", "--plot-place", "below",
                     "--size", "320x300")

    def test_parts_with_motion_blur_in_slow_motion(self):
        self.goes_on("--shutter", "180", "--blur-samples", "3", "--speed", "0.5", "--overlay", "trails,impulses,forces",
                     starts=(0.3, 1.0), speed=0.5)

    def test_parts_with_a_camera_that_follows(self):
        self.goes_on("--set", 'camera.follow="ball"')

    # The second panel ends before the clip does, and shows its last frame from then on.
    def test_parts_of_panels_of_different_length(self):
        self.write("short.toml", SCENE.replace("duration = 1.2", "duration = 0.5"))
        self.goes_on("--overlay", "velocity,trails,clock", "--size", "256x160", scenes=("scene.toml", "short.toml"),
                     starts=(0.4, 0.6, 1.15))

    def test_parts_of_variants(self):
        self.goes_on("--vary", "simulation.integrator=explicit-euler,exact", "--size", "256x160", starts=(0.6,))

    def test_parts_fill_one_folder(self):
        self.check(0, "render", "scene.toml", "--frames", "whole", "--aov", "motion", "--quiet")
        for motion in ((), ("--no-motion",)):
            self.simulate(*motion)
            for frames in ("20-24", "0-6", "7-13:2,18-19", "8-14:2,15-17"):
                self.check(0, "render", "scene.toml", "--frames", "parts", "--aov", "motion", "--frames-range", frames,
                           "--from-checkpoints", "states", "--quiet")
            files = [path.name for path in (self.folder / "whole").iterdir() if path.suffix != ".json"]
            self.assertEqual(len(files), 50)
            for name in files:
                self.assertEqual((self.folder / "parts" / name).read_bytes(), (self.folder / "whole" / name).read_bytes(), name)
            shutil.rmtree(self.folder / "parts")

    def test_aovs_of_a_part(self):
        aovs = ("--aov", "depth,motion", "--quiet")
        self.check(0, "render", "scene.toml", "--aov-folder", "whole", *aovs)
        for motion in ((), ("--no-motion",)):
            self.simulate(*motion)
            self.check(0, "render", "scene.toml", "--aov-folder", "part", *aovs, "--start", 0.8, "--from-checkpoints", "states")
            part = sorted(path.name for path in (self.folder / "part").glob("*.npz"))
            self.assertEqual((part[0], len(part)), ("aov_000016.npz", 9))
            for name in part:
                self.assertEqual((self.folder / "part" / name).read_bytes(), (self.folder / "whole" / name).read_bytes())

    def test_tables_are_those_of_a_run_without_checkpoints(self):
        tables = ("--trajectory", "t.csv", "--energy", "e.csv", "--impacts", "i.csv", "--contacts", "c.csv", "--loads", "l.csv")
        read = lambda: [(self.folder / name).read_bytes() for name in tables[1::2]]
        self.check(0, "simulate", "scene.toml", *tables, "--quiet")
        alone = read()
        run = self.simulate(*tables)
        self.assertEqual(read(), alone)
        self.assertRegex(run.stderr, r"wrote states: 4 checkpoints, [0-9.]+ MB")

    def test_tables_go_on(self):
        tables = ("--trajectory", "t.csv", "--energy", "e.csv", "--impacts", "i.csv", "--contacts", "c.csv", "--loads", "l.csv")
        self.simulate(*tables)
        whole = {name: self.rows(name) for name in tables[1::2]}
        for start in (0.1, 0.8):
            self.check(0, "simulate", "scene.toml", "--from-checkpoints", "states", "--start", start, *tables, "--quiet")
            for name, rows in whole.items():
                self.assertEqual(self.rows(name), [row for row in rows if int(row["frame"]) >= round(20 * start)], name)
        self.simulate()
        run = self.check(2, "simulate", "scene.toml", "--from-checkpoints", "states", "--start", 0.8, "--energy", "e2.csv")
        self.assertIn("has no records of contacts: give the tables to simulate --checkpoints too", run.stderr)
        self.assertFalse((self.folder / "e2.csv").exists())

    def test_the_same_bytes_with_any_number_of_threads(self):
        folder = self.folder / "states"
        read = lambda: {path.name: path.read_bytes() for path in folder.iterdir()}
        self.simulate("--threads", 1)
        one = read()
        self.simulate("--threads", 3)
        self.assertEqual(read(), one)

    def refused(self, reason, *options, scene="scene.toml"):
        run = self.check(2, "render", scene, "--frames", "part", "--start", 0.6, "--from-checkpoints", "states", *options)
        self.assertRegex(run.stderr, reason)
        self.assertFalse((self.folder / "part").exists())

    def test_checkpoints_of_another_clip_are_refused(self):
        self.simulate()
        self.refused("the size: 128x72 there, 64x36 here", "--size", "64x36")
        self.refused("the number of frames: 25 there, 21 here", "--duration", 1.0)
        self.refused("the frames per second: 20 there, 30 here", "--fps", 30)
        self.refused("--speed: 1 there, 2 here", "--speed", 2)
        self.refused("--shutter and --blur-samples: 1 of 1 parts there, 8 of 16 parts here", "--shutter", 180)
        self.refused("the overlays: none there, trails here", "--overlay", "trails")
        self.refused("the number of panels: 1 there, 2 here", "--vary", "simulation.seed=1,2")
        self.refused("the values of the scene: [0-9a-f]{64} there, [0-9a-f]{64} here", "--set", "body.ball.mass=2.5")
        self.refused("the overlay 'damage'", "--overlay", "damage")
        self.write("other.toml", "# a comment\n" + SCENE)
        self.check(0, "render", "other.toml", "--frames", "other", "--start", 0.6, "--from-checkpoints", "states", "--quiet",
                   "--samples", 4, "--transparent")

    def test_damaged_and_missing_checkpoints_are_refused(self):
        self.refused("has no checkpoints of a whole clip")
        self.simulate()
        for name in ("checkpoint_000010.tumble", "motion_000010.tumble", "clip.tumble"):
            file = self.folder / "states" / name
            good = file.read_bytes()
            for place in (0, 9, 40, len(good) // 2, len(good) - 1):
                file.write_bytes(good[:place] + bytes([good[place] ^ 1]) + good[place + 1:])
                self.refused(name + r": error: (the checkpoint is damaged|is no checkpoint)")
            file.write_bytes(good[:-1])
            self.refused("damaged")
            file.unlink()
            self.refused("has no checkpoints of a whole clip" if name == "clip.tumble" else "the checkpoint cannot be read")
            file.write_bytes(good)
        shutil.copy(self.folder / "states/checkpoint_000005.tumble", self.folder / "states/checkpoint_000010.tumble")
        self.refused("holds the state of frame 5, not the state of frame 10: was the file renamed?")

    def test_a_report_is_of_a_whole_clip(self):
        self.simulate()
        self.refused("excludes", "--report", "r.html")

    def test_misuse_of_simulate(self):
        for reason, options in {
                "--every requires --checkpoints": ("--every", 1),
                "--start requires --from-checkpoints": ("--start", 1),
                "--size requires --checkpoints or --from-checkpoints": ("--size", "64x36"),
                "excludes": ("--checkpoints", "states", "--from-checkpoints", "states"),
                "several scenes are simulated together only with --checkpoints": ("scene.toml",),
                "tables are of the frames of one scene": ("--checkpoints", "states", "--speed", 2, "--energy", "e.csv"),
        }.items():
            run = self.check(2, "simulate", "scene.toml", *options)
            self.assertRegex(run.stderr, re.escape(reason))
            self.assertEqual(self.names(), [])


if __name__ == "__main__":
    program.main()
