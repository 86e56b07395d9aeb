"""`compare`: 0 alike, 1 different, 2 cannot compare."""

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

    def test_a_colour_off_by_8(self):
        self.picture("b.png", 320, 180, (128, 120, 120), boxes=[(100, 60, 12, 12, RED)])
        self.check(1, "compare", "a.png", "b.png")
        self.check(0, "compare", "a.png", "b.png", "--tolerance", 16)
        self.check(0, "compare", "a.png", "b.png", "--fraction", 1)

    def test_the_difference_picture(self):
        self.picture("b.png", 320, 180, GREY, boxes=[(101, 60, 12, 12, RED)])
        self.check(1, "compare", "a.png", "b.png", "--diff", "d.png")
        self.assertEqual(program.png_size(self.folder / "d.png"), (320, 180))
        self.check(1, "compare", "d.png", "a.png")

    def test_what_cannot_be_compared(self):
        self.picture("wide.png", 321, 180, GREY)
        self.write("text.png", "no picture")
        for a, b in (("a.png", "wide.png"), ("a.png", "none.png"), ("none.png", "a.png"), ("a.png", "text.png"),
                     ("a.png", ".")):
            run = self.check(2, "compare", a, b, "--diff", "d.png")
            self.assertIn("error: ", run.stderr)
            self.assertFalse((self.folder / "d.png").exists())
        self.assertIn("321 x 180", self.check(2, "compare", "a.png", "wide.png").stderr)

    def test_a_difference_picture_that_cannot_be_written(self):
        run = self.check(2, "compare", "a.png", "a.png", "--diff", "no/d.png")
        self.assertIn("'no/d.png'", run.stderr)

    def test_options_out_of_range(self):
        for option in ("--tolerance=-1", "--tolerance=256", "--fraction=-0.1", "--fraction=1.1", "--fraction=nan"):
            self.check(2, "compare", "a.png", "a.png", option)


if __name__ == "__main__":
    program.main()
