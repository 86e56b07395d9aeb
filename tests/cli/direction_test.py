"""Direction of clips: the default camera by the motion, [[speed]], [cameras], [[shot]] and --camera."""

import unittest

import program

HEAD = """\
format = 1
[simulation]
duration = 1
[output]
size = [64, 36]
fps = 20
samples = 1
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.2 }
position = [0, 1, 0]
"""
SLOW = """\
[[speed]]
time = "impact:ball,floor"
factor = 0.25
easing = "step"
hold = 0.5
[[speed]]
time = "impact:ball,floor"
after = 0.25
factor = 1
"""
CAMERAS = """\
[cameras.side]
eye = [3, 1, 0]
target = [0, 0.5, 0]
[[shot]]
camera = "side"
from = 0.5
"""
TOGETHER = """\
[cameras.top]
eye = [0, 4, 0.01]
target = [0, 0, 0]
[[inset]]
camera = "top"
to = 0.52
border = 0
[[label]]
body = "ball"
text = "{y:.1f} m"
size = 6
"""
CHASE = """\
[camera]
follow = "ball"
follow_time = 0.3
eye = [0, 1, 4]
"""


def difference(a, b):
    """Mean, in levels."""
    return sum(abs(x - y) for x, y in zip(a, b)) / len(a)


class Direction(program.ProgramTest):
    def frames(self, text, *options):
        """The pixels of each frame."""
        self.write("scene.toml", text)
        folder = self.folder / f"frames{len(list(self.folder.iterdir()))}"
        self.check(0, "render", "scene.toml", "--frames", str(folder), "--quiet", *options)
        return [program.png_pixels(file)[3] for file in sorted(folder.glob("*.png"))]

    def test_slow_motion_at_an_impact_has_more_frames_and_holds_one(self):
        plain, slow = self.frames(HEAD), self.frames(HEAD + SLOW)
        self.assertEqual(len(plain), 21)
        # 0.25 s at a quarter of the speed are 20 frames instead of 5, and 0.5 s stand still.
        self.assertAlmostEqual(len(slow), 21 + 15 + 10, delta=2)
        same = [a == b for a, b in zip(slow, slow[1:])]
        self.assertGreaterEqual(max(len(run) for run in "".join("=" if s else " " for s in same).split()), 10)

    def test_an_impact_that_does_not_happen_is_a_note(self):
        self.write("scene.toml", HEAD.replace("duration = 1", "duration = 0.1") + SLOW)
        run = self.check(0, "render", "scene.toml", "--frames", "frames")
        self.assertIn("ball and floor have no impact", run.stdout + run.stderr)

    def test_bad_keyframes_name_their_place(self):
        for keys, message in [
            ('time = "impact:ball,flor"', 'not the name of a body.*did you mean "floor"'),
            ('time = "impact:ball"', 'must be a number of seconds, or "impact:A,B"'),
            ("time = 1\nafter = 1", "after is for a time of an impact"),
            ("time = 1\nfactor = 0", "factor must be from 0.001"),
        ]:
            self.write("scene.toml", HEAD + "[[speed]]\n" + keys + "\n")
            error = self.check(2, "render", "scene.toml", "--frames", "f").stderr
            self.assertRegex(error, f"scene.toml:1[0-9]:[0-9]+: error: (.|\\n)*{message}")
            self.assertFalse((self.folder / "f").exists())

    def test_any_number_of_workers_draws_the_same_bytes(self):
        text = HEAD + SLOW + CAMERAS
        self.assertEqual(self.frames(text, "--workers", "1"), self.frames(text, "--workers", "3"))

    def test_the_camera_does_not_depend_on_the_duration_of_the_clip(self):
        whole, part = self.frames(HEAD), self.frames(HEAD, "--duration", "0.25")
        self.assertEqual(part, whole[: len(part)])

    def test_a_shot_is_the_clip_of_its_camera(self):
        # The haze is that of the farthest camera: colors may differ by a level or two.
        cut, side = self.frames(HEAD + CAMERAS), self.frames(HEAD + CAMERAS, "--camera", "side")
        plain = self.frames(HEAD)
        for n, frame in enumerate(cut):
            self.assertLess(difference(frame, plain[n] if n < 10 else side[n]), 2.0, n)
        self.assertGreater(difference(plain[15], side[15]), 2.0)

    def test_an_unknown_camera_is_an_error(self):
        self.write("scene.toml", HEAD + CAMERAS)
        error = self.check(2, "render", "scene.toml", "--frames", "f", "--camera", "sde").stderr
        self.assertRegex(error, r'--camera: the scene has no \[cameras.sde\].*"side"')
        self.write("scene.toml", HEAD + '[[shot]]\ncamera = "top"\n')
        error = self.check(2, "render", "scene.toml", "--frames", "f").stderr
        self.assertIn('"top" is not the name of one of [cameras]', error)

    def test_insets_and_labels_are_the_same_for_any_workers_and_parts(self):
        text = HEAD + TOGETHER
        whole = self.frames(text, "--workers", "1")
        self.assertEqual(whole, self.frames(text, "--workers", "3"))
        part = self.frames(text, "--frames-range", "7-12", "--workers", "2")
        self.assertEqual(part, whole[7:13])
        plain = self.frames(text, "--overlay", "none", "--set", "inset.0.to=0.1")
        inside = [self.corner(frame) != self.corner(other) for frame, other in zip(whole, plain)]
        self.assertEqual(inside, [False, False] + [True] * 9 + [False] * 10)

    @staticmethod
    def corner(pixels, width=64, channels=3):
        """The inset's place, without its lowest rows, in which labels may be."""
        return [pixels[channels * (y * width + 46) : channels * (y * width + 61)] for y in range(2, 10)]

    def test_a_camera_behind_a_body_is_the_same_after_a_resume_and_from_checkpoints(self):
        text = HEAD + CHASE
        whole = self.frames(text)
        self.assertEqual(self.frames(text, "--frames-range", "11-20"), whole[11:])
        self.check(0, "render", "scene.toml", "--frames", "kept", "--quiet")
        for n in (3, 4, 12):
            (self.folder / "kept" / f"frame_{n:06}.png").unlink()
        self.check(0, "render", "scene.toml", "--frames", "kept", "--quiet", "--resume")
        kept = [program.png_pixels(file)[3] for file in sorted((self.folder / "kept").glob("*.png"))]
        self.assertEqual(kept, whole)
        self.check(0, "simulate", "scene.toml", "--checkpoints", "points", "--every", "0.2", "--quiet")
        late = self.frames(text, "--frames-range", "11-20", "--from-checkpoints", "points")
        self.assertEqual(late, whole[11:])
        self.assertNotEqual(whole, self.frames(text.replace("follow_time = 0.3", "")))

    def test_all_cameras_have_their_folders(self):
        self.write("scene.toml", HEAD + CAMERAS)
        self.check(0, "render", "scene.toml", "--duration", "0.1", "--camera", "all", "--frames", "out",
                   "--aov", "depth", "--quiet")
        for camera in ("camera", "side"):
            files = sorted(path.name for path in (self.folder / "out" / camera).iterdir())
            for name in ("frame_000002.png", "aov_000002.npz"):
                self.assertIn(name, files)
        self.check(0, "render", "scene.toml", "--duration", "0.1", "--camera", "side", "--frames", "one",
                   "--aov", "depth", "--quiet")
        for name in ("frame_000002.png", "aov_000002.npz"):
            self.assertEqual((self.folder / "one" / name).read_bytes(),
                             (self.folder / "out" / "side" / name).read_bytes())
        error = self.check(2, "render", "scene.toml", "--camera", "all", "-o", "clip.mp4").stderr
        self.assertIn("needs --frames or --aov-folder", error)

    def test_mistakes_of_labels_insets_and_logos_name_their_place(self):
        for keys, message in [
            ('[[label]]\nbody = "ball"\ntext = "{spede}"', "text has an unknown placeholder"),
            ('[[label]]\nbody = "floor"\ntext = "a"', "body must have a center"),
            ('[[label]]\nbody = "ball"\ntext = "a"\nfrom = 2\nto = 1', "to makes the time span end"),
            ('[[inset]]\ncamera = "top"', '"top" is not the name of one of'),
            ("[cameras.a]\n[[inset]]\ncamera = \"a\"\nsize = 0.5\nrectangle = [0, 0, 1, 1]", "exclude each other"),
            ("[cameras.a]\n[[inset]]\ncamera = \"a\"\nrectangle = [0.5, 0, 0.6, 1]", "must lie in the frame"),
            ('[logo]\nimage = "logo.png"', 'image "logo.png" does not exist'),
            ('[logo]\nimage = "scene.toml"', "neither a PNG nor a JPEG"),
            ("[logo]\nwidth = 0.2", "image"),
        ]:
            self.write("scene.toml", HEAD + keys + "\n")
            error = self.check(2, "render", "scene.toml", "--frames", "f").stderr
            self.assertRegex(error, f"scene.toml:[12][0-9]:[0-9]+: error: (.|\\n)*{message}")
            self.assertFalse((self.folder / "f").exists())


if __name__ == "__main__":
    unittest.main()
