"""`simulate`: the documented columns, rows and numbers."""

import ast
import math
import struct
import zipfile

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


PANE = """\
format = 1
[simulation]
duration = 0.2
gravity = [0, 0, 0]
[[body]]
name = "pane"
density = 2500
strength = 30e6
stiffness = 70e9
toughness = 8
shape = { type = "box", size = [0.6, 0.5, 0.01] }
fracture = { cells = 12 }
[[body]]
name = "ball"
density = 7800
shape = { type = "sphere", radius = 0.05 }
position = [0.03, 0.04, 0.3]
velocity = [0, 0, -9]
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

    BOUNCE = """format = 1
[simulation]
duration = 2
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.5 }
mass = 2
position = [0, 1.5, 0]
restitution = 0.5
"""

    def test_impacts_and_contacts(self):
        self.write("scene.toml", self.BOUNCE)
        self.check(0, "simulate", "scene.toml", "--impacts", "exact", "--impacts", "i.csv", "--contacts", "c.csv")
        impacts, contacts = self.rows("i.csv"), self.rows("c.csv")
        self.assertEqual(",".join(impacts[0]), "time,exact,frame,a,b,px,py,pz,nx,ny,nz,feature,v_before,v_after,restitution,impulse,fx,fy,fz,pass,mx,my,mz")
        self.assertEqual(",".join(contacts[0]), "frame,time,a,b,px,py,pz,nx,ny,nz,gap,normal_force,fx,fy,fz,torsion,sx,sy,sz,state,mx,my,mz")
        first = impacts[0]
        self.assertAlmostEqual(float(first["time"]), math.sqrt(2 / 9.81), delta=1e-12)
        self.assertEqual([first[key] for key in ("exact", "frame", "a", "b", "feature", "pass")], ["1", "27", "floor", "ball", "sphere", "0"])
        self.assertAlmostEqual(float(first["impulse"]), 3 * math.sqrt(2 * 9.81), delta=1e-11)
        rest = [row for row in contacts if row["a"]][-1]
        self.assertEqual([rest[key] for key in ("frame", "a", "b", "state")], ["120", "floor", "ball", "asleep"])
        self.assertAlmostEqual(float(rest["normal_force"]), 2 * 9.81, delta=1e-9)

    def test_contacts_of_every_nth_frame(self):
        self.write("scene.toml", self.BOUNCE)
        self.check(0, "simulate", "scene.toml", "--contacts", "all.csv", "--loads", "l.csv")
        rows = self.rows("all.csv")
        for every in (1, 7):
            self.check(0, "simulate", "scene.toml", "--contacts", "c.csv", "--contacts-every", every, "--loads", "m.csv")
            self.assertEqual(self.rows("c.csv"), [row for row in rows if int(row["frame"]) % every == 0])
            self.assertEqual(self.rows("m.csv"), self.rows("l.csv"))
        self.check(0, "simulate", "scene.toml", "--checkpoints", "states", "--contacts", "c.csv", "--contacts-every", 7)
        self.assertEqual({int(row["frame"]) % 7 for row in self.rows("c.csv")}, {0})
        self.check(0, "simulate", "scene.toml", "--from-checkpoints", "states", "--start", 1.1, "--contacts", "c.csv",
                   "--contacts-every", 7)
        late = [row for row in rows if int(row["frame"]) % 7 == 0 and int(row["frame"]) >= 66]
        self.assertEqual(self.rows("c.csv"), late)
        for wrong in ("0", "-1", "2.5", "nan", "many", ""):
            run = self.check(2, "simulate", "scene.toml", "--contacts", "x.csv", "--contacts-every", wrong)
            self.assertIn("--contacts-every", run.stderr)
        run = self.check(2, "simulate", "scene.toml", "--contacts-every", 2, "--loads", "x.csv")
        self.assertIn("--contacts-every requires --contacts", run.stderr)
        self.assertFalse((self.folder / "x.csv").exists())

    def test_impacts_of_steps(self):
        self.write("scene.toml", self.BOUNCE)
        self.check(0, "simulate", "scene.toml", "--impacts", "i.csv")
        first = self.rows("i.csv")[0]
        self.assertEqual(first["exact"], "0")
        self.assertAlmostEqual(float(first["time"]) * 960, round(float(first["time"]) * 960), delta=1e-9)
        self.assertAlmostEqual(float(first["v_after"]), -0.5 * float(first["v_before"]), delta=1e-12)

    def test_arrays(self):
        self.write("scene.toml", self.BOUNCE)
        self.check(0, "simulate", "scene.toml", "--impacts", "i.csv", "--contacts", "c.csv", "--loads", "l.csv")
        self.check(0, "simulate", "scene.toml", "--impacts", "i.npz", "--contacts", "c.npz", "--loads", "l.npz")
        for name in ("i", "c", "l"):
            rows = self.rows(name + ".csv")
            with zipfile.ZipFile(self.folder / (name + ".npz")) as archive:
                for key in rows[0]:
                    kind, values = npy(archive.read(key + ".npy"))
                    if key in ("a", "b", "body", "feature", "state"):
                        _, texts = npy(archive.read(key + "_names.npy"))
                        length = len(texts) // (max(values) + 1)
                        texts = [bytes(texts[i:i + length]).rstrip(b"\0").decode() for i in range(0, len(texts), length)]
                        self.assertEqual([texts[value] for value in values], [row[key] for row in rows])
                    else:
                        self.assertEqual(list(values), [float(row[key]) for row in rows], key)

    def test_loads(self):
        self.write("scene.toml", self.BOUNCE)
        self.check(0, "simulate", "scene.toml", "--loads", "l.csv")
        rows = self.rows("l.csv")
        self.assertEqual(",".join(rows[0]), "frame,time,body,fx,fy,fz,mx,my,mz")
        self.assertEqual([(row["frame"], row["body"]) for row in rows], [(str(n), "ball") for n in range(121)])
        self.assertEqual([float(rows[0][key]) for key in ("fx", "fy", "fz", "mx", "my", "mz")], [0] * 6)
        for row in rows[1:]:
            self.assertAlmostEqual(float(row["fy"]), -2 * 9.81, delta=1e-12)

    def test_bodies_of_info(self):
        text = self.check(0, "info", "scene.toml", "--bodies", "b.csv").stdout
        self.assertEqual(text.splitlines()[0], "Two bodies (scene.toml)")
        rows = self.rows("b.csv")
        self.assertEqual(",".join(rows[0]), "body,type,mass,cx,cy,cz,ixx,iyy,izz,ixy,ixz,iyz")
        self.assertEqual([(row["body"], row["type"]) for row in rows],
                         [("ground", "fixed"), ("crate", "dynamic"), ("2", "dynamic")])
        self.assertEqual([float(rows[0][key]) for key in rows[0] if key not in ("body", "type")], [0] * 10)
        ball = 1000 * 4 / 3 * math.pi * 0.5**3
        for row, mass, inertia in ((rows[1], 600, 100), (rows[2], ball, 0.4 * ball * 0.25)):
            self.assertAlmostEqual(float(row["mass"]), mass, delta=1e-12 * mass)
            for key, value in zip(("cx", "cy", "cz", "ixx", "iyy", "izz", "ixy", "ixz", "iyz"), [0] * 3 + [inertia] * 3 + [0] * 3):
                self.assertAlmostEqual(float(row[key]), value, delta=1e-12 * inertia, msg=key)
        table = self.check(0, "info", "scene.toml", "--bodies", "-").stdout
        self.assertEqual(table, (self.folder / "b.csv").read_text())
        self.check(2, "info", "scene.toml", "--bodies", "scene.toml")

    def test_tables_in_csv_only_are_not_written_as_npz(self):
        for command in (("info", "--bodies"), ("simulate", "--trajectory"), ("simulate", "--energy")):
            error = self.check(2, command[0], "scene.toml", command[1], "t.npz").stderr
            self.assertIn(f"{command[1]}: is written as CSV", error)
            self.assertFalse((self.folder / "t.npz").exists())

    def test_the_inertia_of_a_compound(self):
        # Two balls of 1 kg, and one of 2 kg, off the axes.
        parts = ((0, 0, 0, 1), (1, 0.5, 0, 1), (0, -1, 2, 2))
        density = 1 / (4 / 3 * math.pi * 0.1**3)
        self.write("c.toml", "format = 1\n[[body]]\nshape = { type = \"compound\", parts = [" + ", ".join(
            f'{{ shape = {{ type = "sphere", radius = 0.1 }}, position = [{x}, {y}, {z}], density = {m * density} }}'
            for x, y, z, m in parts) + "] }\n")
        row = self.check(0, "info", "c.toml", "--bodies", "b.csv") and self.rows("b.csv")[0]
        center = [sum(p[3] * p[k] for p in parts) / 4 for k in range(3)]
        r = [[p[k] - center[k] for k in range(3)] for p in parts]
        for name, i, j in (("ixx", 0, 0), ("iyy", 1, 1), ("izz", 2, 2), ("ixy", 0, 1), ("ixz", 0, 2), ("iyz", 1, 2)):
            expected = sum(p[3] * ((i == j) * (0.4 * 0.01 + sum(x * x for x in d)) - d[i] * d[j]) for p, d in zip(parts, r))
            self.assertAlmostEqual(float(row[name]), expected, delta=1e-12, msg=name)
        for name, value in zip(("cx", "cy", "cz"), center):
            self.assertAlmostEqual(float(row[name]), value, delta=1e-14)

    def test_a_wrong_mode_or_file_of_impacts(self):
        run = self.check(2, "simulate", "scene.toml", "--impacts", "exakt")
        self.assertIn("--impacts: must be stepped or exact, or a file that ends with .csv or .npz (was 'exakt')", run.stderr)
        self.check(2, "simulate", "scene.toml", "--impacts", "x.csv", "--contacts", "x.csv")


def npy(content):
    """Kind and values of an array file."""
    length = struct.unpack("<H", content[8:10])[0]
    header = ast.literal_eval(content[10:10 + length].decode())
    kind = {"<f8": "d", "<i4": "i", "|u1": "B"}[header["descr"]]
    body = content[10 + length:]
    return kind, struct.unpack(f"<{len(body) // struct.calcsize(kind)}{kind}", body)

    def test_a_body_that_breaks(self):
        self.write("pane.toml", PANE)
        self.check(0, "simulate", "pane.toml", "--trajectory", "t.csv", "--energy", "e.csv", "--breaks", "b.csv")
        breaks, energy = self.rows("b.csv"), self.rows("e.csv")
        self.assertEqual((self.folder / "b.csv").read_text().split("\n")[0],
                         "time,body,bond,area,tension,bending,shear,torsion,energy,pieces")
        self.assertGreater(len(breaks), 2)
        self.assertEqual({row["body"] for row in breaks}, {"pane"})
        paid = sum(float(row["energy"]) for row in breaks)
        self.assertAlmostEqual(float(energy[-1]["surface_energy"]), paid, delta=1e-12)
        self.assertAlmostEqual(paid, 8 * sum(float(row["area"]) for row in breaks if float(row["energy"]) > 0), delta=1e-12)
        # Rows of all bodies in all frames: empty where a body is not there.
        first = float(breaks[0]["time"])
        for row in self.rows("t.csv"):
            whole, later = row["body"] == "pane", float(row["time"]) >= first
            if row["body"] != "ball":
                self.assertEqual(row["x"] == "", whole == later, row)

    def test_breaks_as_arrays(self):
        self.write("pane.toml", PANE)
        self.check(0, "simulate", "pane.toml", "--breaks", "b.npz")
        with zipfile.ZipFile(self.folder / "b.npz") as arrays:
            self.assertIn("tension.npy", arrays.namelist())


if __name__ == "__main__":
    program.main()