"""Planted faults of rendered frames, each of which `compare` finds by its defaults, and differences of processors, which it
lets pass."""

import os
import pathlib
import shutil
import tempfile

import program

# The camera looks along -z at 0.04 m a pixel in the plane z = 0 (180 pixels high, 2 atan(0.36) = 39.6 degrees at 10 m).
PIXEL = 0.04
SCENE = """\
format = 1
[simulation]
duration = 0.5
[output]
size = [320, 180]
fps = 10
[camera]
eye = [0.0, 1.5, 10.0]
target = [0.0, 1.5, 0.0]
vertical_fov = 39.5978
[materials.floor]
color = "#b0b0a8"
[materials.crate]
color = "#c8853c"
[materials.bead]
color = "#203060"
[[body]]
name = "ground"
type = "fixed"
shape = { type = "plane" }
material = "floor"
[[body]]
name = "crate"
shape = { type = "box", size = [1.0, 1.0, 1.0] }
material = "crate"
position = [1.5, 2.2, 0.0]
angular_velocity = [1.0, 2.0, 0.5]
[[body]]
name = "bead"
type = "fixed"
shape = { type = "sphere", radius = 0.08 }
material = "bead"
position = [-1.5, 0.8, 0.0]
"""
LAST = "frame_000005.png"


def rewrite(path, change):
    """Changes the pixels of a frame: change(pixels, width), with three bytes a pixel."""
    width, height, channels, pixels = program.png_pixels(path)
    assert channels == 3
    pixels = bytearray(pixels)
    change(pixels, width)
    rows = b"".join(b"\0" + bytes(pixels[3 * width * y:3 * width * (y + 1)]) for y in range(height))
    head = program.struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + program.chunk(b"IHDR", head) +
                     program.chunk(b"IDAT", program.zlib.compress(rows, 1)) + program.chunk(b"IEND", b""))


class Faults(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.golden = pathlib.Path(tempfile.mkdtemp(prefix="tumble-cli-"))
        cls.addClassCleanup(shutil.rmtree, cls.golden)
        (cls.golden / "scene.toml").write_text(SCENE)
        program.subprocess.run([program.TUMBLE, "render", "scene.toml", "--frames", "golden", "--workers", "1", "--quiet"],
                               cwd=cls.golden, check=True, timeout=300)

    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)
        for name in ("golden", "new"):
            shutil.copytree(self.golden / "golden", self.folder / name)

    def verdicts(self, code):
        """The pictures that are not alike, with their verdicts."""
        run = self.check(code, "compare", "golden", "new", "--quiet")
        return dict(reversed(line.split(": ")) for line in run.stdout.splitlines() if not line.startswith(" "))

    def render(self, *options, **environment):
        shutil.rmtree(self.folder / "new")
        self.check(0, "render", "scene.toml", "--frames", "new", "--quiet", *options,
                   env=dict(os.environ, **environment))

    def found_everywhere(self):
        self.assertEqual(self.verdicts(1), {f"frame_{i:06}.png": "different" for i in range(6)})

    def rewrite(self, change):
        rewrite(self.folder / "new" / LAST, change)
        self.assertEqual(self.verdicts(1), {LAST: "different"})

    def box(self, left, top, width, height, levels, channels=(0, 1, 2)):
        """Changes the colors of a rectangle by levels."""
        def change(pixels, row):
            for y in range(top, top + height):
                for x in range(left, left + width):
                    for c in channels:
                        pixels[3 * (row * y + x) + c] += levels
        self.rewrite(change)

    def test_nothing(self):
        self.assertEqual(self.verdicts(0), {})

    # Four pixels wide: the smallest body that a viewer takes for one.
    def test_a_small_body_moved_by_one_pixel(self):
        for offset in ((PIXEL, 0), (0, PIXEL), (-0.7 * PIXEL, 0.7 * PIXEL)):
            with self.subTest(offset=offset):
                self.render("--set", f"body.bead.position=[{-1.5 + offset[0]}, {0.8 + offset[1]}, 0]")
                self.found_everywhere()

    def test_a_pixel_of_a_small_body(self):
        def change(pixels, row):
            x, y = 160 - 37, 90 + 17  # of the bead
            self.assertLess(max(pixels[3 * (row * y + x):3 * (row * y + x) + 3]), 110, "no pixel of the bead")
            pixels[3 * (row * y + x):3 * (row * y + x) + 3] = pixels[3 * (row * y + x - 20):3 * (row * y + x - 20) + 3]
        self.rewrite(change)

    def test_a_lost_shadow(self):
        self.render("--set", "light.shadows=false")
        self.found_everywhere()

    def test_a_color_off_by_two_levels(self):
        for channels in ((0,), (1,), (2,), (0, 1, 2)):
            for levels in (2, -2):
                with self.subTest(channels=channels, levels=levels):
                    self.setUp()
                    self.box(20, 150, 3, 2, levels, channels)

    def test_a_color_of_the_scene_off_by_two_levels(self):
        for material, color in (("floor", "#b2b0a8"), ("crate", "#c8873c"), ("floor", "#b0b0a6")):
            with self.subTest(material=material, color=color):
                self.render("--set", f"materials.{material}.color=\"{color}\"")
                self.found_everywhere()

    def test_missing_and_added_frames(self):
        os.rename(self.folder / "new" / LAST, self.folder / "new/frame_000006.png")
        self.assertEqual(self.verdicts(3), {LAST: "missing", "frame_000006.png": "added"})
        shutil.copy(self.folder / "golden" / LAST, self.folder / "new" / LAST)
        self.assertEqual(self.verdicts(1), {"frame_000006.png": "added"})

    def test_one_frame_late(self):
        for i in range(5, 0, -1):
            shutil.copy(self.folder / f"new/frame_{i - 1:06}.png", self.folder / f"new/frame_{i:06}.png")
        self.assertEqual(self.verdicts(1), {f"frame_{i:06}.png": "different" for i in range(1, 6)})

    # The vector instructions that Mesa's code generator may use; the others of the program give the same bits.
    def test_workers_and_processors_are_no_difference(self):
        for workers in (2, 3):
            self.render("--workers", workers)
            self.assertEqual(self.verdicts(0), {})
        for instructions in ("sse2", "sse4.1", "avx"):
            self.render("--workers", "1", GALLIUM_OVERRIDE_CPU_CAPS=instructions)
            self.assertEqual(self.verdicts(0), {})


if __name__ == "__main__":
    program.main()
