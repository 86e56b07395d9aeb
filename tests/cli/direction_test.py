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


if __name__ == "__main__":
    unittest.main()
