"""The first scene of the README and of the tutorial: the same text, a body that tumbles and comes to rest on a face."""

import math
import pathlib
import re

import program

ROOT = pathlib.Path(__file__).resolve().parents[2]


def scene_of(page):
    return re.search(r"```toml\n(format = 1\n.*?)```", (ROOT / page).read_text(), re.DOTALL).group(1)


def up_in_body(row):
    """The world's y axis in the frame of the body."""
    w, x, y, z = (float(row[key]) for key in ("qw", "qx", "qy", "qz"))
    return 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)


class FirstClip(program.ProgramTest):
    def test_the_pages_have_one_scene(self):
        self.assertEqual(scene_of("README.md"), scene_of("docs/tutorials/first-clip.md"))

    def test_the_body_tumbles_and_comes_to_rest_on_a_face(self):
        self.write("box.toml", scene_of("README.md"))
        self.check(0, "simulate", "box.toml", "--trajectory", "t.csv")
        rows = [row for row in self.rows("t.csv") if row["body"] == "1"]
        self.assertAlmostEqual(max(map(abs, up_in_body(rows[-1]))), 1.0, delta=1e-6)
        spins = [math.hypot(*(float(row[key]) for key in ("wx", "wy", "wz"))) for row in rows]
        self.assertLess(max(spins[-60:]), 1e-6, "at rest in the last second")
        self.assertGreater(sum(spins) / 60, math.pi / 2, "it turns over")

    def test_the_varied_value_of_the_readme_acts(self):
        vary = re.search(r"--vary (\S+)", (ROOT / "README.md").read_text()).group(1)
        self.write("box.toml", scene_of("README.md"))
        run = self.check(0, "plot", "box.toml", "--of", "total", "-o", "p.svg", "--vary", vary)
        self.assertNotIn("move alike", run.stderr)


if __name__ == "__main__":
    program.main()
