"""`simulate`: the documented columns, rows and numbers."""

import math
import struct

import program

TRAJECTORY = "frame,time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz"
ENERGY = "frame,time,kinetic,potential,total,px,py,pz,lx,ly,lz,contacts,max_penetration," \
         "kinetic_linear,kinetic_angular,work,impact_loss,friction_loss,elastic"

FALL = """\
format = 1
[simulation]
duration = {duration}
steps_per_frame = {steps}
gravity = [0.0, -10.0, 0.0]
[output]
fps = {fps}
[[body]]
shape = {{ type = "sphere", radius = 0.5 }}
mass = 2.0
position = [0.0, 100.0, 0.0]
velocity = [3.0, 0.0, 0.0]
"""


class Tables(program.ProgramTest):
    def simulate(self, *arguments):
        self.check(0, "simulate", "scene.toml", "--trajectory", "t.csv", "--energy", "e.csv", *arguments)
        return self.rows("t.csv"), self.rows("e.csv")

    def test_headers(self):
        self.simulate()
        self.assertEqual((self.folder / "t.csv").read_text().split("\n")[0], TRAJECTORY)
        self.assertEqual((self.folder / "e.csv").read_text().split("\n")[0], ENERGY)
        self.assertEqual(self.names(), ["e.csv", "t.csv"])

    def test_rows(self):
        trajectory, energy = self.simulate()
        self.assertEqual([row["frame"] for row in energy], [str(n) for n in range(6)])
        # One row per frame and body that may move, in scene order; a body without a name is its index.
        self.assertEqual([(row["frame"], row["body"]) for row in trajectory],
                         [(str(n), body) for n in range(6) for body in ("crate", "2")])
        for row in trajectory + energy:
            self.assertEqual(float(row["time"]), int(row["frame"]) / 10)

    def test_every_number_has_17_digits(self):
        trajectory, energy = self.simulate()
        for row in trajectory + energy:
            for key, text in row.items():
                if key in ("frame", "body", "contacts"):
                    continue
                self.assertEqual(text, f"{float(text):.17g}", f"{key} of {row}")

    def test_totals(self):
        for row in self.simulate()[1]:
            self.assertEqual(float(row["total"]), float(row["kinetic"]) + float(row["potential"]))

    def test_first_row_is_the_scene(self):
        trajectory, energy = self.simulate()
        crate = trajectory[0]
        self.assertEqual([float(crate[key]) for key in ("x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz")],
                         [0, 3, 0, 1, 0, 0, 0, 0, 0, 0])
        for key, expected in (("wx", 1), ("wy", 2), ("wz", 0.5)):
            self.assertAlmostEqual(float(crate[key]), expected, delta=1e-12)
        # The crate at 3 m, the sphere (1000 kg/m^3) at 0.5 m; only the crate moves: I = m/6.
        sphere = 1000 * 4 / 3 * math.pi * 0.5**3
        self.assertAlmostEqual(float(energy[0]["potential"]), 9.81 * (600 * 3 + sphere * 0.5), delta=1e-8)
        self.assertAlmostEqual(float(energy[0]["kinetic"]), 0.5 * 100 * (1 + 4 + 0.25), delta=1e-8)

    def test_free_fall_is_symplectic_euler(self):
        self.write("fall.toml", FALL.format(duration=1.0, steps=8, fps=25))
        self.check(0, "simulate", "fall.toml", "--trajectory", "t.csv", "--energy", "e.csv")
        h = 1 / 200
        for row, energy in zip(self.rows("t.csv"), self.rows("e.csv")):
            n = 8 * int(row["frame"])   # y = y0 - g h^2 n (n + 1) / 2
            self.assertAlmostEqual(float(row["y"]), 100 - 10 * h * h * n * (n + 1) / 2, delta=1e-10)
            self.assertAlmostEqual(float(row["vy"]), -10 * n * h, delta=1e-11)
            self.assertAlmostEqual(float(row["x"]), 3 * n * h, delta=1e-11)
            self.assertAlmostEqual(float(energy["px"]), 6.0, delta=1e-11)
            self.assertAlmostEqual(float(energy["py"]), -20 * n * h, delta=1e-10)

    def test_explicit_euler_by_option(self):
        self.write("fall.toml", FALL.format(duration=1.0, steps=8, fps=25))
        self.check(0, "simulate", "fall.toml", "--trajectory", "t.csv", "--integrator", "explicit-euler")
        h = 1 / 200
        for row in self.rows("t.csv"):
            n = 8 * int(row["frame"])   # y = y0 - g h^2 n (n - 1) / 2
            self.assertAlmostEqual(float(row["y"]), 100 - 10 * h * h * n * (n - 1) / 2, delta=1e-10)

    def test_step_and_steps_per_frame_are_one(self):
        self.check(0, "simulate", "scene.toml", "--trajectory", "a.csv", "--steps-per-frame", 8)
        self.check(0, "simulate", "scene.toml", "--trajectory", "b.csv", "--step", 0.0125)
        self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes())
        self.check(0, "simulate", "scene.toml", "--trajectory", "c.csv")
        self.assertNotEqual((self.folder / "a.csv").read_bytes(), (self.folder / "c.csv").read_bytes())

    def test_frame_counts(self):
        # floor(D * fps) + 1, and 4.35 * 100 (434.99999999999994) is 435.
        for duration, fps, count in ((0, 60, 1), (0.5, 10, 6), (0.55, 10, 6), (0.05, 10, 1), (4.35, 100, 436),
                                     (0.3, 29.97, 9), (3, 0.5, 2), (0.0002, 1e6, 201), (0.1, 30, 4)):
            self.write("fall.toml", FALL.format(duration=duration, steps=1, fps=fps))
            self.check(0, "simulate", "fall.toml", "--energy", "e.csv")
            rows = self.rows("e.csv")
            self.assertEqual(len(rows), count, f"{duration} s at {fps}")
            for n, row in enumerate(rows):
                self.assertEqual(float(row["time"]), n / fps)

    def test_options_replace_the_scene(self):
        self.write("fall.toml", FALL.format(duration=7.0, steps=8, fps=25))
        self.check(0, "simulate", "fall.toml", "--energy", "e.csv", "--fps", "1e3", "--duration", "0.01",
                   "--steps-per-frame", 1)
        rows = self.rows("e.csv")
        self.assertEqual(len(rows), 11)
        self.assertAlmostEqual(float(rows[-1]["py"]), -0.2, delta=1e-12)

    def test_kinematic_bodies_are_in_the_trajectory_but_not_in_the_energy(self):
        self.write("k.toml", 'format = 1\n[simulation]\nduration = 0.1\n[[body]]\nname = "a, \\"b\\""\ntype = "kinematic"\n'
                             'shape = { type = "box", size = [1.0, 1.0, 1.0] }\n')
        self.check(0, "simulate", "k.toml", "--trajectory", "t.csv", "--energy", "e.csv")
        self.assertEqual({row["body"] for row in self.rows("t.csv")}, {'a, "b"'})
        for row in self.rows("e.csv"):
            self.assertEqual([float(row[k]) for k in ("kinetic", "potential", "px", "contacts")], [0, 0, 0, 0])

    def test_contacts_are_reported(self):
        energy = self.simulate("--duration", 3)[1]
        self.assertGreater(int(energy[-1]["contacts"]), 0)   # crate and sphere have come to rest on the ground
        self.assertLess(float(energy[-1]["max_penetration"]), 0.05)

    def test_no_tables_at_all(self):
        run = self.check(0, "simulate", "scene.toml")
        self.assertIn("6 frames, 20 steps", run.stderr)
        self.assertEqual(self.names(), [])

    def test_quiet_is_silent(self):
        run = self.check(0, "simulate", "scene.toml", "--energy", "e.csv", "--quiet")
        self.assertEqual(run.stdout + run.stderr, "")

    def test_to_standard_output(self):
        for name in ("/dev/stdout", "-"):
            run = self.check(0, "simulate", "scene.toml", "--energy", name, "--quiet")
            self.assertTrue(run.stdout.startswith(ENERGY + "\n0,0,"))
        self.assertEqual(self.names(), [])
        run = self.check(2, "simulate", "scene.toml", "--energy", "-", "--trajectory", "-")
        self.assertIn("must be two files", run.stderr)

    def test_doubles_are_restored_to_the_bit(self):
        for row in self.simulate()[0]:
            value = float(row["qx"])
            self.assertEqual(struct.pack("d", value), struct.pack("d", float(f"{value:.17g}")))


if __name__ == "__main__":
    program.main()
