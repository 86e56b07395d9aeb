"""The teaching scenes: each can be drawn, and its captions tell the truth."""

import math
import os
import pathlib
import subprocess
import tomllib

import program

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = sorted((ROOT / "assets/scenes/teaching").glob("*.toml"))
COMPARED = {"05", "06", "07", "08", "12", "17", "18"}   # scripts/lecture shows their variants as panels
EARTH, MOON = 9.81, 1.62                                # m/s^2


def vector(row, keys):
    return [float(row[key]) for key in keys]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def turn(q, v):
    """v in the world, of a vector in the frame of a body with the unit quaternion q."""
    w, u = q[0], q[1:]
    t = [2.0 * x for x in cross(u, v)]
    return [x + w * y + z for x, y, z in zip(v, t, cross(u, t))]


def turn_back(q, v):
    return turn([q[0], -q[1], -q[2], -q[3]], v)


def box_inertia(mass, size):
    x, y, z = (s * s for s in size)
    return [mass * (y + z) / 12.0, mass * (x + z) / 12.0, mass * (x + y) / 12.0]


def respond(q, inertia, l):
    """I^-1(t) l: eqs. 3 and 4."""
    return turn(q, [c / i for c, i in zip(turn_back(q, l), inertia)])


def length(v):
    return math.sqrt(dot(v, v))


class Teaching(program.ProgramTest):
    def simulate(self, number, *arguments, tables=("trajectory",)):
        """The tables of a scene, as lists of rows."""
        scene = next(path for path in SCENES if path.name.startswith(number))
        outputs = [text for table in tables for text in (f"--{table}", f"{table}.csv")]
        self.check(0, "simulate", scene, "--quiet", *outputs, *arguments)
        found = [self.rows(f"{table}.csv") for table in tables]
        return found if len(found) > 1 else found[0]

    def near(self, value, expected, delta):
        self.assertAlmostEqual(value, expected, delta=delta)

    def body(self, rows, name):
        return [row for row in rows if row["body"] == name]

    def test_there_is_a_scene_for_each_section(self):
        self.assertEqual([path.name[:2] for path in SCENES], [f"{n:02}" for n in range(1, 22)])

    def test_captions_fill_the_clip(self):
        for path in SCENES:
            with self.subTest(scene=path.name):
                scene = tomllib.loads(path.read_text())
                times = [0.0]
                for caption in scene["caption"]:
                    self.assertEqual(caption.get("start", 0.0), times[-1])
                    times.append(caption.get("end", scene["simulation"]["duration"]))
                self.assertEqual(times[-1], scene["simulation"]["duration"])
                self.assertGreater(min(b - a for a, b in zip(times, times[1:])), 0.75)
                self.assertLessEqual(times[-1], 8.0)

    def test_all_can_be_drawn(self):
        subprocess.run([ROOT / "scripts/lecture", "--size", "720x405", "--duration", "0", self.folder], check=True,
                       stdout=subprocess.DEVNULL)
        self.assertEqual(self.names(), [f"{path.stem}.mp4" for path in SCENES])

    def test_scenes_of_comparisons_can_be_drawn_alone(self):
        for path in SCENES:
            if path.name[:2] in COMPARED:
                with self.subTest(scene=path.name):
                    self.check(0, "render", path, "--size", "480x270", "--duration", "0", "--frames", "out", "--quiet")

    def test_state(self):
        trajectory, energy = self.simulate("01", tables=("trajectory", "energy"))
        for key, value in (("px", 6 * 0.35), ("py", 0.0), ("pz", 0.0)):
            for row in energy:
                self.near(float(row[key]), value, 1e-12)
        for key in ("lx", "ly", "lz"):
            self.near(max(float(row[key]) for row in energy), min(float(row[key]) for row in energy), 1e-12)
        self.near(float(trajectory[-1]["x"]), -1.05 + 0.35 * 6, 1e-12)
        self.assertLess(abs(float(trajectory[240]["qw"])), 0.9)

    def test_derived_quantities(self):
        rows = self.simulate("02")
        inertia = box_inertia(6.0, (0.3, 0.9, 0.5))
        q, w = (vector(rows[0], keys) for keys in (("qw", "qx", "qy", "qz"), ("wx", "wy", "wz")))
        l = turn(q, [i * c for i, c in zip(inertia, turn_back(q, w))])
        for row in rows:
            self.near(float(row["vx"]), 0.08, 1e-12)
            for value, expected in zip(vector(row, ("wx", "wy", "wz")),
                                       respond(vector(row, ("qw", "qx", "qy", "qz")), inertia, l)):
                self.near(value, expected, 1e-12)
        self.assertGreater(max(float(row["wx"]) for row in rows), 2.0)

    def test_center_of_mass_of_the_hammer(self):
        for row in self.simulate("03"):
            t = float(row["time"])
            self.near(float(row["x"]), -2.2 + 1.1 * t, 1e-12)
            self.near(float(row["y"]), 0.7 + 3.24 * t - 0.5 * MOON * t * t, 1e-12)

    def test_forces_at_points(self):
        rows = self.simulate("04")
        center, end = self.body(rows, "center"), self.body(rows, "end")
        for a, b in zip(center, end):
            self.near(float(a["z"]), float(b["z"]), 1e-4)       # the red blocks weigh next to nothing
            self.assertEqual(float(a["wy"]), 0.0)
        self.near(float(center[-1]["vz"]), -0.5, 1e-12)
        self.near(float(end[-1]["vz"]), -0.5, 1e-12)
        self.assertGreater(float(end[-1]["wy"]), 1.0)

    def test_rotation_forms(self):
        step, steps = 1.0 / 3.0, 90
        for form, turned in (("matrix", math.atan(step)), ("quaternion", 2.0 * math.atan(0.5 * step))):
            rows = self.simulate("05", "--set", f"simulation.rotation={form}")
            hand, exact = (vector(self.body(rows, name)[-1], ("qw", "qx", "qy", "qz")) for name in ("hand", "exact"))
            lag = 2.0 * math.acos(min(1.0, abs(dot(hand, exact))))
            self.near(lag, steps * (step - turned), 1e-9)
            self.assertEqual(round(math.degrees(lag)), {"matrix": 60, "quaternion": 16}[form])

    def test_throw(self):
        for integrator, sign in (("explicit-euler", 1.0), ("symplectic-euler", -1.0)):
            rows = self.simulate("06", "--set", f"simulation.integrator={integrator}")
            for exact, ball in zip(self.body(rows, "exact"), self.body(rows, "ball")):
                self.near(float(ball["y"]) - float(exact["y"]), sign * 0.1 * MOON * float(ball["time"]) / 2.0, 1e-9)

    def test_energy_of_both_euler_methods(self):
        for integrator, sign in (("explicit-euler", 1.0), ("symplectic-euler", -1.0)):
            rows = self.simulate("07", "--set", f"simulation.integrator={integrator}", tables=("energy",))
            for row in rows:
                gain = float(row["total"]) - float(rows[0]["total"])
                self.near(gain, sign * EARTH ** 2 / 60.0 * float(row["time"]) / 2.0, 1e-9)
            self.assertEqual(f"{abs(gain):.1f}", "4.8")

    def test_step_size(self):
        for step, percent in ((0.01, 26), (0.005, 10), (0.0025, 4)):
            for integrator in ("explicit-euler", "symplectic-euler"):
                rows = self.simulate("08", "--set", f"simulation.step={step}", "--integrator", integrator, tables=("energy",))
                self.assertEqual(round(100.0 * (float(rows[-1]["kinetic"]) / float(rows[0]["kinetic"]) - 1.0)), percent)

    def test_detection(self):
        impacts = self.simulate("09", "--impacts", "exact", tables=("impacts",))
        contacts = self.simulate("09", tables=("contacts",))
        features = {row["b"]: row["feature"] for row in impacts}
        self.assertEqual(features, {"vertex": "face-vertex", "upper": "edge-edge"})
        last = [row for row in contacts if float(row["time"]) == 5.0 and row["a"]]
        self.assertEqual({row["b"] for row in last}, {"vertex", "upper"})
        for row in last:
            self.near(float(row["ny"]), 1.0, 1e-3)

    def test_corner_hit(self):
        trajectory, impacts = self.simulate("10", tables=("trajectory", "impacts"))
        self.assertEqual(len(impacts), 1)
        hit, start, end = impacts[0], trajectory[0], trajectory[-1]
        mass, e, n, v = 3.0, 0.8, [0.0, 1.0, 0.0], -0.5
        inertia, q = box_inertia(mass, (0.8, 0.5, 0.4)), vector(start, ("qw", "qx", "qy", "qz"))
        corners = [turn(q, [0.4 * x, 0.25 * y, 0.2 * z]) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        r = min(corners, key=lambda corner: corner[1])
        self.near(float(hit["time"]), (1.5 + r[1]) / 0.5, 1e-12)
        k = 1.0 / mass + dot(n, cross(respond(q, inertia, cross(r, n)), r))
        j = -(1.0 + e) * v / k
        self.near(float(hit["impulse"]), j, 1e-12)                            # eq. 20
        self.near(float(hit["v_after"]), -e * v, 1e-12)                       # eq. 14
        self.near(float(end["vy"]), v + j / mass, 1e-12)                      # eq. 15
        spin = respond(q, inertia, cross(r, [j * c for c in n]))              # eq. 16
        after = next(row for row in trajectory if float(row["time"]) > float(hit["time"]))
        self.near(length(vector(after, ("wx", "wy", "wz"))), length(spin), 1e-3)
        self.assertEqual([f"{k:.3f}", f"{j:.2f}", f"{j / mass:.2f}", f"{length(spin):.2f}"], ["0.442", "2.04", "0.68", "1.56"])

    def test_restitution(self):
        trajectory, impacts = self.simulate("11", tables=("trajectory", "impacts"))
        for e in (0.5, 0.7, 0.9, 1):
            hits = [row for row in impacts if row["b"] == f"e = {e}"]
            self.near(float(hits[0]["time"]), math.sqrt(2.0 / MOON), 1e-12)
            self.near(float(hits[0]["v_after"]), e * math.sqrt(2.0 * MOON), 1e-12)
            for bounce in (1, 2):
                start, end = (float(hits[k]["time"]) if k < len(hits) else 6.0 for k in (bounce - 1, bounce))
                top = max(float(row["y"]) for row in self.body(trajectory, f"e = {e}") if start <= float(row["time"]) <= end)
                self.near(top - 0.12, e ** (2 * bounce), 1e-4)
        self.near(float(self.body(trajectory, "e = 0")[-1]["y"]), 0.12, 1e-9)

    def test_row_of_balls(self):
        for law, expected in (("propagating", [0, 0, 0, 0, 1]), ("simultaneous", [-0.6, 0.4, 0.4, 0.4, 0.4])):
            rows = self.simulate("12", "--impact-law", law)
            for row, speed in zip(rows[-5:], expected):
                self.near(float(row["vx"]), speed, 1e-9)

    def test_cradle(self):
        trajectory, energy = self.simulate("13", tables=("trajectory", "energy"))
        for time, moving in ((1.5, "ball 5"), (3.0, "ball 1")):
            rows = {row["body"]: row for row in trajectory if float(row["time"]) == time}
            for name, row in rows.items():
                if name != moving:
                    self.assertLess(length(vector(row, ("vx", "vy", "vz"))), 0.2, f"{name} at {time} s")
            self.assertGreater(float(rows[moving]["y"]), 0.3)
        self.near(float(energy[-1]["total"]), float(energy[0]["total"]), 1e-3 * float(energy[0]["total"]))

    def test_fixed_and_kinematic(self):
        trajectory, impacts = self.simulate("14", tables=("trajectory", "impacts"))
        last = {row["body"]: row for row in trajectory[-3:]}
        self.near(float(last["ball A"]["vx"]), -1.0, 1e-9)
        self.near(float(last["ball B"]["vx"]), -2.0, 1e-9)
        self.assertEqual(len(impacts), 2)
        for row in impacts:
            self.near(float(row["impulse"]), {"wall": 2.0, "plate": 3.0}[row["b"]], 1e-9)
        for row in self.body(trajectory, "plate"):
            self.near(float(row["x"]), 1.975 - 0.5 * float(row["time"]), 1e-9)

    def test_friction(self):
        trajectory, contacts = self.simulate("15", tables=("trajectory", "contacts"))
        angle = math.radians(25)
        weight, up = 4.0 * EARTH, (-math.cos(angle), math.sin(angle), 0.0)
        for name, friction in (("μ = 0.6", weight * math.sin(angle)), ("μ = 0.4", 0.4 * weight * math.cos(angle))):
            rows = [row for row in contacts if row["b"] == name and float(row["time"]) == 2.0]
            self.near(sum(dot(vector(row, ("fx", "fy", "fz")), up) for row in rows), friction, 1e-6)
            self.near(sum(float(row["normal_force"]) for row in rows), weight * math.cos(angle), 1e-6)
        self.assertEqual([f"{weight * math.sin(angle):.1f}", f"{0.4 * weight * math.cos(angle):.1f}"], ["16.6", "14.2"])
        last = {row["body"]: row for row in trajectory[-2:]}
        self.near(length(vector(last["μ = 0.6"], ("vx", "vy", "vz"))), 0.0, 1e-9)
        self.near(length(vector(last["μ = 0.4"], ("vx", "vy", "vz"))),
                  3.5 * EARTH * (math.sin(angle) - 0.4 * math.cos(angle)), 1e-3)

    def test_stack(self):
        contacts = self.simulate("16", tables=("contacts",))
        for time, press in ((1.0, 0.0), (2.5, 196.2), (5.0, 0.0)):
            for below in range(5):
                rows = [row for row in contacts if float(row["time"]) == time and row["b"] == str(below + 1) and row["a"]]
                self.assertEqual(len(rows), 4)
                self.near(sum(float(row["normal_force"]) for row in rows), (5 - below) * 98.1 + press, 1e-4)
        self.assertEqual({row["state"] for row in contacts if float(row["time"]) == 5.0}, {"asleep"})

    def test_notes_at_rest(self):
        rows = self.body(self.simulate("17"), "box")
        for row in rows[60:]:
            self.near(float(row["vy"]), -EARTH / 120.0 / 1.5, 3e-3)
        self.assertLess(float(rows[-1]["y"]), 0.0)
        for row in self.simulate("17", "--method", "tumble")[-3:]:
            self.assertLess(length(vector(row, ("vx", "vy", "vz", "wx", "wy", "wz"))), 1e-12)
            self.near(float(row["y"]), 0.75 if row["body"] == "upper" else 0.25, 1e-9)

    def test_jitters(self):
        rows = self.simulate("18")
        for second in range(5):
            part = rows[60 * second + 1:60 * second + 60]
            self.assertGreater(max(length(vector(row, ("wx", "wy", "wz"))) for row in part), 0.2)
            self.assertGreater(min(float(row["y"]) for row in part), 0.23)

    def test_struck_bar(self):
        rows = {row["body"]: row for row in self.simulate("20", tables=("breaks",))}
        self.assertEqual({name: int(row["bond"]) for name, row in rows.items()}, {"end": 9, "quarter": 7})
        self.assertEqual({int(row["pieces"]) for row in rows.values()}, {2})

    def test_explosion(self):
        trajectory = self.simulate("19")
        for name, distance in (("near", 0.5), ("middle", 1.0), ("far", 2.0)):
            rows = self.body(trajectory, name)
            self.near(length(vector(rows[29], ("vx", "vy", "vz"))), 0.0, 1e-12)
            self.near(length(vector(rows[-1], ("vx", "vy", "vz"))), 200.0 / 4.0 * 0.1**2 / distance**2, 1e-9)
        self.assertGreater(length(vector(self.body(trajectory, "box")[-1], ("wx", "wy", "wz"))), 0.1)

    def test_floating_bodies(self):
        trajectory, energy = self.simulate("21", tables=("trajectory", "energy"))
        last = {row["body"]: row for row in trajectory[-3:]}
        for name, expected in (("flat box", [0.0, 0.0, 1.0]), ("bar", [0.0, 0.5**0.5, 0.5**0.5]),
                               ("cube", [3.0**-0.5] * 3)):
            up = turn_back(vector(last[name], ("qw", "qx", "qy", "qz")), [0.0, 1.0, 0.0])
            for value, wanted in zip(sorted(map(abs, up)), expected):
                self.near(value, wanted, 0.02)
        self.assertEqual(list(energy[0])[-1], "water_loss")
        books = [float(row["total"]) + float(row["water_loss"]) - float(row["work"]) for row in energy]
        self.near(max(books) - min(books), 0.0, 1e-3 * float(energy[-1]["water_loss"]))


if __name__ == "__main__":
    program.main()
