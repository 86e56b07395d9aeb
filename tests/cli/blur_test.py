"""Motion blur: where the streak of a moving ball is."""

import program

# The ball crosses the picture at 6 m/s in front of the empty sky: 0.6 m a frame, 19 pixels.
SCENE = """\
format = 1
[simulation]
duration = 0.3
gravity = [0, 0, 0]
[output]
size = [160, 48]
fps = 10
samples = 4
[camera]
eye = [0, 0, 40]
target = [0, 0, 0]
vertical_fov = 2.2
[light]
shadows = false
[[body]]
shape = { type = "sphere", radius = 0.3 }
position = [-1.5, 0, 0]
velocity = [6, 0, 0]
color = "#000000"
"""


def linear(level):
    value = level / 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


LINEAR = [linear(level) for level in range(256)]


class Streak(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", SCENE)

    def center(self, folder, number):
        """The column of the centroid of the light that the ball takes from the sky."""
        width, height, channels, image = program.png_pixels(self.folder / folder / f"frame_{number:06}.png")
        sky = program.png_pixels(self.folder / "sky/frame_000000.png")[3]
        weights = [0.0] * width
        for at in range(0, channels * width * height, channels):
            dark = sum(LINEAR[sky[at + k]] - LINEAR[image[at + k]] for k in range(3))
            weights[at // channels % width] += dark
        return sum((x + 0.5) * weight for x, weight in enumerate(weights)) / sum(weights)

    def test_it_is_where_the_ball_is_in_the_middle_of_the_shutter(self):
        self.check(0, "render", "ball.toml", "--frames", "sky", "--set", "body.0.position=[99, 0, 0]", "--duration", "0")
        # Four frames in each of the clip: the middle of a whole and of a half frame.
        self.check(0, "render", "ball.toml", "--frames", "sharp", "--fps", "40")
        for degrees, after in (("360", 2), ("180", 1)):
            for samples in (2, 3, 4, 8):
                with self.subTest(degrees=degrees, samples=samples):
                    out = f"blurred-{degrees}-{samples}"
                    self.check(0, "render", "ball.toml", "--frames", out, "--shutter", degrees, "--blur-samples", samples)
                    self.assertAlmostEqual(self.center(out, 1), self.center("sharp", 4 + after), delta=0.25)

    def test_an_overlay_is_drawn_at_the_time_of_the_frame(self):
        # The camera moves with the ball: the arrow is where it is in a frame without blur.
        self.write("followed.toml", SCENE.replace("vertical_fov = 2.2", 'vertical_fov = 2.2\nfollow = "0"'))
        usual = ("render", "followed.toml", "--overlay", "velocity", "--set", "overlay.legend=false")
        self.check(0, *usual, "--frames", "sharp")
        self.check(0, *usual, "--frames", "blurred", "--shutter", "360", "--blur-samples", "4")
        self.check(0, "compare", "sharp", "blurred")


if __name__ == "__main__":
    program.main()
