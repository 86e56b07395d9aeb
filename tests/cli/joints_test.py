"""Joints from outside: the table, energies, the summary of breaking, `info`."""

import json
import math

import program

HEADER = "frame,time,joint,q1,q2,q3,v1,v2,v3,fx,fy,fz,tx,ty,tz,gap,limit,broken,active,broken_at,px,py,pz,mx,my,mz," \
         "move_x,move_y,move_z,turn_x,turn_y,turn_z,move_x_speed,move_y_speed,move_z_speed," \
         "turn_x_speed,turn_y_speed,turn_z_speed"

# A rod of 1 m and 1 kg, hinged to the world at one end, from the horizontal.
PENDULUM = """\
format = 1
[simulation]
duration = 1.0
steps_per_frame = 16
[output]
size = [64, 36]
fps = 60
[[body]]
name = "rod"
shape = { type = "box", size = [1.0, 0.1, 0.1] }
mass = 1.0
position = [0.5, 0.0, 0.0]
[[joint]]
name = "pin"
type = "hinge"
bodies = ["world", "rod"]
anchor = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
"""

# A box on a spring beside a ball on a rope, without names.
SPRING = """\
format = 1
[simulation]
duration = 2.0
gravity = [0.0, 0.0, 0.0]
[[body]]
name = "box"
shape = { type = "box", size = [0.2, 0.2, 0.2] }
mass = 1.0
position = [0.5, 0.0, 0.0]
[[body]]
shape = { type = "sphere", radius = 0.1 }
mass = 4.0
position = [0.5, -1.0, 0.0]
[[joint]]
type = "slider"
bodies = ["world", "box"]
anchor = [0.5, 0.0, 0.0]
axis = [1.0, 0.0, 0.0]
spring = { stiffness = 100.0, damping = 1.0, rest = 0.2 }
[[joint]]
type = "ball"
bodies = ["box", "1"]
anchor = [0.5, -0.5, 0.0]
"""


def norm(row, *keys):
    return math.hypot(*(float(row[key]) for key in keys))


class Joints(program.ProgramTest):
    def joints(self, text, *arguments):
        self.write("joints.toml", text)
        self.check(0, "simulate", "joints.toml", "--joints", "j.csv", *arguments)
        return self.rows("j.csv")

    def test_columns(self):
        rows = self.joints(PENDULUM)
        self.assertEqual((self.folder / "j.csv").read_text().split("\n")[0], HEADER)
        self.assertEqual([row["frame"] for row in rows], [str(n) for n in range(61)])
        first = rows[0]
        self.assertEqual([first[key] for key in ("joint", "q1", "q2", "q3", "v2", "limit", "broken", "active", "broken_at")],
                         ["pin", "0", "", "", "", "0", "0", "1", ""])
        self.assertEqual(norm(first, "fx", "fy", "fz"), 0.0)
        for row in rows:
            self.assertEqual(float(row["q1"]), float(row["turn_x"]))
            self.assertEqual(float(row["v1"]), float(row["turn_x_speed"]))
            self.assertEqual(float(row["q1"]), float(f"{float(row['q1']):.17g}"))

    # The closed form of the largest force, at the bottom.
    def test_force_of_a_pendulum(self):
        rows = self.joints(PENDULUM, "--fps", "960", "--steps-per-frame", "1")
        self.assertAlmostEqual(max(norm(row, "fx", "fy", "fz") for row in rows), 24.4883042394014963, delta=1e-2)
        self.assertLess(max(float(row["gap"]) for row in rows), 1e-12)

    # The moment of a rod about the hinge's point is the hinge's torque alone, so that m = p x f + t. By default the force and
    # the moment are balances of the momenta, and the torque is that of the middle of the step: of second order.
    def test_moment(self):
        text = PENDULUM.replace("[0.5, 0.0, 0.0]", "[2.5, 0.0, 0.0]").replace("anchor = [0.0, 0.0, 0.0]", "anchor = [2.0, 0.0, 0.0]")
        for integrator, error in (("symplectic-euler", 1e-4), ("exact", 1e-10)):
            for row in self.joints(text, "--integrator", integrator):
                self.assertAlmostEqual(float(row["px"]), 2.0, delta=1e-12)
                self.assertAlmostEqual(float(row["mz"]), 2.0 * float(row["fy"]) + float(row["tz"]), delta=error)

    def test_energies(self):
        self.write("spring.toml", SPRING)
        self.check(0, "simulate", "spring.toml", "--energy", "e.csv")
        rows = self.rows("e.csv")
        self.assertEqual(list(rows[0])[-3:], ["elastic", "motor_work", "joint_heat"])
        self.assertAlmostEqual(float(rows[0]["elastic"]), 0.5 * 100 * 0.2**2, delta=1e-12)
        self.assertGreater(float(rows[-1]["joint_heat"]), 0.1)
        for row in rows:
            e = {key: float(value) for key, value in row.items()}
            self.assertAlmostEqual(e["total"], e["kinetic"] + e["potential"] + e["elastic"], delta=1e-12)
            self.assertAlmostEqual(e["total"] + e["impact_loss"] + e["friction_loss"] - e["work"], 2.0, delta=0.02)

    # Without joints the table of energies has the columns of the contract.
    def test_scene_without_joints(self):
        self.check(0, "simulate", "scene.toml", "--energy", "e.csv", "--joints", "j.csv")
        self.assertTrue((self.folder / "e.csv").read_text().split("\n")[0].endswith(",elastic"))
        self.assertEqual((self.folder / "j.csv").read_text(), HEADER + "\n")

    def test_names_and_coordinates(self):
        rows = self.joints(SPRING)
        self.assertEqual([row["joint"] for row in rows[:2]], ["joint 0", "joint 1"])
        self.assertEqual([rows[0][key] == "" for key in ("q1", "q2", "q3")], [False, True, True])
        self.assertEqual([rows[1][key] == "" for key in ("q1", "q2", "q3")], [False, False, False])

    def test_arrays(self):
        self.write("joints.toml", PENDULUM)
        self.check(0, "simulate", "joints.toml", "--joints", "j.npz")
        self.assertIn(b"turn_z_speed.npy", (self.folder / "j.npz").read_bytes())

    # J1c: 15 N at 0.300354695438428074 s.
    def test_breaking(self):
        self.write("joints.toml", PENDULUM + "break_force = 15.0\n")
        run = self.check(0, "simulate", "joints.toml", "--joints", "j.csv")
        self.assertRegex(run.stderr, r"joint 'pin' broke at 0\.30\d+ s\n")
        rows = self.rows("j.csv")
        last = rows[-1]
        self.assertEqual((last["broken"], last["active"]), ("1", "0"))
        self.assertAlmostEqual(float(last["broken_at"]), 0.300354695438428074, delta=2 / 960)
        self.assertEqual(norm(last, "fx", "fy", "fz"), 0.0)
        self.assertEqual([row["broken"] for row in rows], ["0"] * 19 + ["1"] * 42)

    def test_breaking_in_the_log(self):
        self.write("joints.toml", PENDULUM + "break_force = 15.0\n")
        for command in (["simulate", "joints.toml"], ["render", "joints.toml", "--frames", "f"]):
            run = self.check(0, *command, "--log", "json")
            events = [json.loads(line) for line in run.stderr.splitlines()]
            broke = [event for event in events if event["event"] == "broke"]
            self.assertEqual([event["joint"] for event in broke], ["pin"])
            self.assertAlmostEqual(broke[0]["time"], 0.300354695438428074, delta=2 / 960)

    def test_info(self):
        self.write("joints.toml", PENDULUM)
        text = self.check(0, "info", "joints.toml").stdout
        for line in ("1 joint\n", "1 hinge\n", "1 degree of freedom of 1 joined body\n",
                     "1 group, 1 tree, 0 loops; 5 rows, 0 redundant\n", "in joint coordinates in flight; by rows beside contacts\n"):
            self.assertIn(line, text)
        text = self.check(0, "info", "joints.toml", "--set", "simulation.integrator=exact").stdout
        self.assertIn("in joint coordinates in flight", text)
        self.write("joints.toml", PENDULUM + PENDULUM[PENDULUM.index("[[joint]]"):].replace("pin", "second")
                   .replace("anchor = [0.0, 0.0, 0.0]", "anchor = [0.0, 0.0, 0.1]"))
        text = self.check(0, "info", "joints.toml").stdout
        self.assertIn("1 degree of freedom of 1 joined body\n", text)
        self.assertIn("1 group, 0 trees, 1 loop; 10 rows, 5 redundant\n", text)

    # The same bytes from a checkpoint as from the start.
    def test_checkpoints(self):
        self.write("joints.toml", PENDULUM.replace("[[joint]]", "[[joint]]\nfriction = 0.5"))
        tables = ("--joints", "j.csv", "--energy", "e.csv")
        self.check(0, "simulate", "joints.toml", "--checkpoints", "states", "--every", "0.25", *tables)
        whole = self.rows("j.csv"), self.rows("e.csv")
        self.check(0, "simulate", "joints.toml", "--from-checkpoints", "states", "--start", "0.5", *tables)
        self.assertEqual(self.rows("j.csv"), whole[0][30:])
        self.assertEqual(self.rows("e.csv"), whole[1][30:])


if __name__ == "__main__":
    program.main()
