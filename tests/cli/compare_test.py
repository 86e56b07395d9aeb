"""`compare`: 0 alike, 1 different, 2 cannot compare."""

import resource
import struct
import subprocess
import zlib

import program

GREY = (120, 120, 120)
RED = (180, 100, 90)


class Compare(program.ProgramTest):
    def picture(self, name, *arguments, **options):
        (self.folder / name).write_bytes(program.png(*arguments, **options))

    def setUp(self):
        super().setUp()
        self.picture("a.png", 320, 180, GREY, boxes=[(100, 60, 12, 12, RED)])

    def test_alike(self):
        self.picture("b.png", 320, 180, GREY, boxes=[(100, 60, 12, 12, RED)])
        self.assertEqual(self.check(0, "compare", "a.png", "b.png").stdout, "alike: every pixel is the same\n")

    def test_noise_is_alike(self):
        self.picture("b.png", 320, 180, GREY, boxes=[(100, 60, 12, 12, RED), (7, 9, 1, 1, (121, 120, 119)),
                                                     (200, 100, 1, 1, (150, 140, 130))])
        self.assertEqual(self.check(0, "compare", "a.png", "b.png").stdout, "alike: 2 pixels differ, by 30 levels at most\n")

    def test_a_box_moved_by_one_pixel(self):
        self.picture("b.png", 320, 180, GREY, boxes=[(101, 60, 12, 12, RED)])
        self.assertTrue(self.check(1, "compare", "a.png", "b.png").stdout.startswith("different: "))

    def test_a_single_pixel_is_reported_with_rule_value_and_place(self):
        self.picture("b.png", 320, 180, GREY, boxes=[(100, 60, 12, 12, RED), (203, 101, 1, 1, (255, 255, 255))])
        self.assertEqual(self.check(1, "compare", "a.png", "b.png").stdout,
                         "different: rule window: the 8 x 8 pixels from x 196, y 96 on differ by 2.109 levels on average "
                         "(at most 1.526 may; see --window)\n1 pixels differ, by 135 levels at most, at x 203, y 101\n")
        self.check(0, "compare", "a.png", "b.png", "--window", "2.11")
        self.check(0, "compare", "a.png", "b.png", "--window", "255")
        self.assertIn("rule cluster", self.check(1, "compare", "a.png", "b.png", "--window", "255", "--cluster", "0").stdout)
        self.assertIn("rule pixels", self.check(1, "compare", "a.png", "b.png", "--window", "255", "--fraction", "0").stdout)

    def test_the_help_names_every_rule(self):
        text = self.check(0, "compare", "--help").stdout
        for word in ("--tolerance", "--fraction", "--cluster", "--window", "--shade", "Rule pixels", "Rule cluster", "Rule window",
                     "Rule shade"):
            self.assertIn(word, text)

    def test_a_color_off_by_8(self):
        self.picture("b.png", 320, 180, (128, 120, 120), boxes=[(100, 60, 12, 12, RED)])
        self.check(1, "compare", "a.png", "b.png")
        self.check(0, "compare", "a.png", "b.png", "--tolerance", 16)
        self.check(0, "compare", "a.png", "b.png", "--fraction", 1)

    def test_the_difference_picture(self):
        self.picture("b.png", 320, 180, GREY, boxes=[(101, 60, 12, 12, RED)])
        self.check(1, "compare", "a.png", "b.png", "--diff", "d.png")
        self.assertEqual(program.png_size(self.folder / "d.png"), (320, 180))
        self.check(1, "compare", "d.png", "a.png")

    def test_files_that_cannot_be_compared(self):
        self.picture("wide.png", 321, 180, GREY)
        self.write("text.png", "no picture")
        for a, b in (("a.png", "wide.png"), ("a.png", "none.png"), ("none.png", "a.png"), ("a.png", "text.png"),
                     ("a.png", ".")):
            run = self.check(2, "compare", a, b, "--diff", "d.png")
            self.assertIn("error: ", run.stderr)
            # Two sizes have a picture of their difference.
            self.assertEqual((self.folder / "d.png").exists(), b == "wide.png")
            (self.folder / "d.png").unlink(missing_ok=True)
        self.assertIn("321 x 180", self.check(2, "compare", "a.png", "wide.png").stderr)

    def test_a_difference_picture_that_cannot_be_written(self):
        run = self.check(2, "compare", "a.png", "a.png", "--diff", "no/d.png")
        self.assertIn("'no/d.png'", run.stderr)

    def bomb(self, name, width, height, interlaced=False):
        """A few kilobytes that claim to be a black picture of one bit per pixel."""
        row = b"\0" * (1 + (width + 7) // 8)
        pixels = b"" if interlaced else zlib.compress(row * height, 9)
        head = struct.pack(">IIBBBBB", width, height, 1, 0, 0, 0, int(interlaced))
        (self.folder / name).write_bytes(b"\x89PNG\r\n\x1a\n" + program.chunk(b"IHDR", head) + program.chunk(b"IDAT", pixels) +
                                         program.chunk(b"IEND", b""))

    @staticmethod
    def limited(what, size):
        return lambda: resource.setrlimit(what, (size, size))

    # One picture alone takes 128 MiB if it is unpacked as a whole.
    @program.limits_memory
    def test_large_pictures_are_compared_row_by_row(self):
        self.bomb("large.png", 16384, 2048)
        run = self.check(0, "compare", "large.png", "large.png", "--diff", "d.png",
                         preexec_fn=self.limited(resource.RLIMIT_DATA, 64 << 20))
        self.assertEqual(run.stdout, "alike: every pixel is the same\n")
        self.assertEqual(program.png_size(self.folder / "d.png"), (16384, 2048))

    @program.limits_memory
    def test_interlaced_pictures_beyond_the_memory_are_refused(self):
        self.bomb("large.png", 16384, 16384, interlaced=True)
        run = self.check(2, "compare", "large.png", "large.png", preexec_fn=self.limited(resource.RLIMIT_DATA, 512 << 20))
        self.assertRegex(run.stderr, r"^error: an interlaced picture of 16384 x 16384 pixels takes 1 GiB of memory, and the limit "
                                     r"of the process's data \(ulimit -d\) has [\d.]+ [MG]iB left; ")

    # Exit code 1 is "different", so a failure of the comparison must be 2.
    @program.limits_memory
    def test_out_of_memory_is_not_different(self):
        self.bomb("wide.png", 1000000, 4)
        run = self.check(2, "compare", "wide.png", "wide.png", preexec_fn=self.limited(resource.RLIMIT_DATA, 12 << 20))
        self.assertEqual(run.stderr, "error: out of memory\n")

    def test_a_result_that_cannot_be_written_is_not_different(self):
        for name, arguments in (("alike", ["a.png", "a.png"]), ("different", ["a.png", "b.png"])):
            self.picture("b.png", 320, 180, GREY)
            with self.subTest(name), open("/dev/full", "w") as full:
                run = subprocess.run([program.TUMBLE, "compare", *arguments], cwd=self.folder, text=True, stdout=full,
                                     stderr=subprocess.PIPE, timeout=60)
                self.assertEqual(run.returncode, 2)
                self.assertIn("standard output", run.stderr)

    def test_options_out_of_range(self):
        for option in ("--tolerance=-1", "--tolerance=256", "--fraction=-0.1", "--fraction=1.1", "--fraction=nan",
                       "--cluster=-1", "--cluster=65", "--window=-1", "--window=256", "--window=nan", "--shade=-1",
                       "--shade=65"):
            self.check(2, "compare", "a.png", "a.png", option)


if __name__ == "__main__":
    program.main()
