"""Overlays from outside: pixels of arrows against the tables and the AOVs' intrinsics, equal bytes, and misuse."""

import math

import program
from aov_test import load

SCENE = """\
format = 1
[simulation]
duration = 0.4
impacts = "exact"
[output]
size = [320, 180]
fps = 20
[camera]
eye = [2.5, 1.6, 5.0]
target = [0.0, 0.8, 0.0]
[materials.m]
friction = 0.5
restitution = 0.6
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
position = [0, 0.4, 0]
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.3 }
material = "m"
mass = 2
position = [1.2, 0.9, 0.6]
velocity = [-1, 0, 0]
"""
EVERYTHING = ("contacts,normals,impulses,forces,loads,velocity,omega,momentum,angular-momentum,trails,ghosts,aabb,axes,com,"
              "islands,sleep,names,title,clock,mode")


class Overlays(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)

    def frames(self, folder):
        return {path.name: program.unmarked(path) for path in sorted((self.folder / folder).glob("*.png"))}

    def render(self, folder, *options):
        self.check(0, "render", "scene.toml", "--frames", folder, "--quiet", *options)
        return self.frames(folder)

    def changed_pixels(self, a, b):
        width, height, channels, left = program.png_pixels(self.folder / a)
        right = program.png_pixels(self.folder / b)[3]
        return [(i // channels % width, i // channels // width) for i in range(0, len(left), channels)
                if left[i:i + channels] != right[i:i + channels]]

    # The forces of the resting crate, 24.525 N at each corner, are drawn 0.02 m for 1 N from the logged points.
    def test_arrows_lie_on_the_projection_of_the_logged_forces(self):
        options = ("--set", "overlay.scale={force=0.02}", "--set", "overlay.legend=false", "--set", 'overlay.bodies=["crate"]')
        self.render("with", "--overlay", "forces", *options)
        self.render("without", "--aov", "depth")
        self.check(0, "simulate", "scene.toml", "--contacts", "c.csv", "--quiet")
        camera = load(self.folder / "without/aov_000001.npz")
        focal, center_x, center_y = (camera["intrinsics"].values[i] for i in (0, 2, 5))
        to_world = camera["camera_to_world"].values

        def pixel(point):  # integers at pixel centers
            away = [point[k] - to_world[4 * k + 3] for k in range(3)]
            x, y, z = (sum(to_world[4 * k + axis] * away[k] for k in range(3)) for axis in range(3))
            return focal * x / z + center_x, focal * y / z + center_y

        arrows = []
        for row in self.rows("c.csv"):
            if row["frame"] != "1" or row["b"] != "crate" or not row["a"]:
                continue
            foot = [float(row[name]) for name in ("px", "py", "pz")]
            force = [float(row["normal_force"]) * float(row["n" + c]) + float(row["f" + c]) for c in "xyz"]
            self.assertAlmostEqual(force[1], 10 * 9.81 / 4, delta=1e-6)
            arrows.append((pixel(foot), pixel([p + 0.02 * f for p, f in zip(foot, force)])))
        self.assertEqual(len(arrows), 4)

        def distance(x, y, foot, tip):
            along = (tip[0] - foot[0], tip[1] - foot[1])
            t = max(0.0, min(1.0, ((x - foot[0]) * along[0] + (y - foot[1]) * along[1]) / (along[0] ** 2 + along[1] ** 2)))
            return math.hypot(x - foot[0] - t * along[0], y - foot[1] - t * along[1])

        pixels = self.changed_pixels("with/frame_000001.png", "without/frame_000001.png")
        self.assertGreater(len(pixels), 100)
        half_of_head = 3.4 + 0.8  # pixels in a picture of this height, with the dark outline
        for x, y in pixels:
            self.assertLess(min(distance(x, y, *arrow) for arrow in arrows), half_of_head + 1.0, (x, y))
        for foot, tip in arrows:  # each arrow reaches its tip, to a pixel
            self.assertLess(min(math.hypot(x - tip[0], y - tip[1]) for x, y in pixels), 1.0)
            self.assertLess(min(math.hypot(x - foot[0], y - foot[1]) for x, y in pixels), 1.0)

    def test_bytes_do_not_depend_on_workers_threads_or_the_start(self):
        one = self.render("one", "--overlay", EVERYTHING, "--workers", "1", "--threads", "1")
        three = self.render("three", "--overlay", EVERYTHING, "--workers", "3", "--threads", "2")
        self.assertEqual(one, three)
        late = self.render("late", "--overlay", EVERYTHING, "--workers", "2", "--start", "0.2")
        self.assertEqual(late, {name: one[name] for name in late})
        self.assertEqual(len(late), 5)

    def test_motion_blur_and_dirty_regions_do_not_depend_on_workers(self):
        for options in (("--overlay", "forces,trails,ghosts", "--shutter", "180", "--blur-samples", "4"),
                        ("--overlay", "damage,velocity")):
            one = self.render("one", *options, "--workers", "1")
            self.assertEqual(one, self.render("three", *options, "--workers", "3"))
            self.assertGreater(len(set(one.values())), 5)

    def test_aovs_have_no_overlay(self):
        self.render("with", "--overlay", EVERYTHING, "--aov", "depth,normal,albedo,segmentation,motion")
        self.render("without", "--aov", "depth,normal,albedo,segmentation,motion")
        for n in range(9):
            name = f"aov_{n:06}.npz"
            self.assertEqual(program.unmarked(self.folder / "with" / name), program.unmarked(self.folder / "without" / name), name)
        self.assertNotEqual(self.frames("with"), self.frames("without"))

    def test_each_overlay_changes_the_picture(self):
        plain = self.render("plain")
        for name in EVERYTHING.split(",") + ["damage"]:
            with self.subTest(name=name):
                scene = SCENE.replace("duration = 0.4", "duration = 2.0") if name == "sleep" else SCENE
                self.write("scene.toml", 'title = "Crate and ball"\n' + scene)
                drawn = self.render(name, "--overlay", name)
                self.assertTrue(any(drawn[frame] != plain.get(frame) for frame in list(drawn)[1:]))

    def test_none_turns_the_scenes_overlays_off(self):
        plain = self.render("plain")
        caption = '[[caption]]\ntext = "A crate"\n'
        self.write("scene.toml", SCENE + '[overlay]\nshow = ["forces", "clock"]\n' + caption)
        self.assertNotEqual(self.render("own"), plain)
        self.assertEqual(self.render("none", "--overlay", "none"), plain)
        self.write("scene.toml", SCENE + '[overlay]\nshow = ["forces"]\nplot = ["energy"]\n' + caption)
        self.assertEqual(self.render("no_plot", "--overlay", "none"), plain)

    def test_the_trajectory_is_the_same(self):
        self.check(0, "simulate", "scene.toml", "--trajectory", "a.csv", "--quiet")
        self.write("scene.toml", SCENE + f'[overlay]\nshow = ["{EVERYTHING.replace(",", chr(34) + ", " + chr(34))}"]\n')
        self.check(0, "simulate", "scene.toml", "--trajectory", "b.csv", "--quiet")
        self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes())

    def test_misuse_is_told_and_writes_nothing(self):
        run = self.check(2, "render", "scene.toml", "--overlay", "force", "--frames", "out")
        self.assertIn('--overlay: "force" is not the name of an overlay (did you mean "forces"?)', run.stderr)
        run = self.check(2, "render", "scene.toml", "--overlay", "", "--frames", "out")
        for table, text in (('show = ["forces", "wheels"]', '"wheels" is not the name of an overlay'),
                            ('bodies = ["crat"]', 'did you mean "crate"?'),
                            ("scale = { force = 0.0 }", "must be above 0"),
                            ("scale = { fors = 1.0 }", 'unknown key "fors"'),
                            ('trail_points = [{ body = "crate", point = [1, 2] }]', "point"),
                            ("ghost_every = 0", "ghost_every"),
                            ("start = 2\nend = 1", "makes the time span end before it starts")):
            with self.subTest(table=table):
                self.write("scene.toml", SCENE + f"[overlay]\n{table}\n")
                run = self.check(2, "render", "scene.toml", "--frames", "out")
                self.assertTrue(program.located(run.stderr), run.stderr)
                self.assertIn(text, run.stderr)
        self.assertEqual(self.names(), [])


if __name__ == "__main__":
    program.main()
