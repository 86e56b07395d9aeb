"""`simulate`: momentum and angular momentum of every body and frame, from the tables alone.

The change of P is the sum of the logged impulses, and of the contact forces and external load times the frame's
duration; that of L about the world origin is the sum of their moments. Rows without a body A correct the method; the
tests count them where the method needs none."""

import math
import pathlib
import re

import mechanics
import program

ASSETS = pathlib.Path(__file__).resolve().parents[2] / "assets"
MESHES = ASSETS / "meshes"
# With their durations in s.
DEMOS = {"bouncing_balls": 1, "dominoes": 0.3, "falling_boxes": 0.3, "furniture": 0.3, "newtons_cradle": 0.5,
         "paddle": 0.8, "tennis_racket": 0.5, "tower_hit": 0.3, "turntable": 0.3}

FLOOR = """
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
restitution = 0.4
friction = 0.5
"""


def scene(bodies, **settings):
    """A scene of 0.6 s at 50 frames/s and 8 steps a frame; settings are lines of [simulation]."""
    settings = {"duration": "0.6", "steps_per_frame": "8", **settings}
    return ("format = 1\n[simulation]\n" + "".join(f"{key} = {value}\n" for key, value in settings.items()) +
            "[output]\nfps = 50\n" + bodies)


def body(shape, position, **keys):
    keys = {"restitution": "0.4", "friction": "0.5", **keys}
    return (f"[[body]]\nshape = {shape}\nposition = {position}\n" +
            "".join(f"{key} = {value}\n" for key, value in keys.items()))


BOX = '{ type = "box", size = [0.6, 0.4, 0.5] }'
CUBE = '{ type = "box", size = [0.5, 0.5, 0.5] }'
BALL = '{ type = "sphere", radius = 0.3 }'
L_SHAPE = ('{ type = "compound", parts = [ { shape = { type = "box", size = [0.8, 0.2, 0.3] } }, '
           '{ shape = { type = "sphere", radius = 0.2 }, position = [0.4, 0.3, 0] } ] }')
TILT = "{ axis = [1, 2, 0.5], angle = 40 }"
SPIN = "[2, -1, 3]"
WIND = "[wind]\nvelocity = [8, 1, 2]\n"
HEAP = (FLOOR + body(BOX, "[0, 0.6, 0]", rotation=TILT, angular_velocity=SPIN) +
        body(BALL, "[0.2, 1.2, 0.1]", velocity="[0, -2, 0]") +
        body(L_SHAPE, "[-0.2, 1.7, 0]", rotation=TILT, velocity="[0.5, -3, 0]") +
        body(BOX, "[0.1, 2.3, 0.1]", velocity="[0, -4, 0]"))
THROWN = (body(BOX, "[1, 2, 3]", velocity="[2, 3, 1]", angular_velocity=SPIN) +
          body(L_SHAPE, "[-4, 2, 0]", velocity="[-1, 0, 2]", angular_velocity=SPIN))
STACK = FLOOR + "".join(body(CUBE, f"[3, {0.25 + 0.5 * k}, 1]", restitution=0) for k in range(4))
PUSHED = (body(BOX, "[0, 1, 0]", name='"rocket"', angular_velocity=SPIN) + body(BALL, "[0.1, 2, 0.1]") +
          '[[force]]\nbody = "rocket"\npoint = [0.2, 0.1, 0]\nforce = [0, 900, 50]\nframe = "body"\nend = 0.303\n'
          '[[force]]\nbody = "rocket"\npoint = [0, 0.1, 0.2]\nforce = [-3000, 0, 0]\nstart = 0.201\nend = 0.2012\n')
SLIDING = ('[[body]]\ntype = "fixed"\nname = "slope"\nshape = { type = "plane", normal = [0.3, 1, 0] }\nfriction = 0.2\n' +
           body(CUBE, "[5, -1.18, 0]", rotation="{ axis = [0, 0, 1], angle = -16.7 }", friction=0.2, restitution=0) +
           body(BALL, "[8, -2, 2]", velocity="[3, 0, 2]", angular_velocity="[0, 20, 0]"))
KINEMATIC = (FLOOR + '[[body]]\ntype = "kinematic"\nname = "bat"\nshape = { type = "box", size = [0.2, 1, 1] }\nfriction = 0.4\n'
             'position = [-1, 0.6, 0]\nkeyframes = [ { time = 0, position = [-1, 0.6, 0] }, { time = 0.5, '
             'position = [1, 0.7, 0], rotation = { axis = [0, 0, 1], angle = -50 } } ]\n' +
             body(BOX, "[-0.3, 0.2, 0]") + body(BALL, "[0.4, 0.8, 0.1]"))
MESH = ('[[body]]\ntype = "fixed"\nname = "bowl"\nshape = { type = "mesh", file = "' + str(MESHES / "bowl.obj") + '" }\n' +
        body('{ type = "mesh", file = "' + str(MESHES / "egg.gltf") + '", scale = 0.3 }', "[0.1, 1.6, 0.2]", rotation=TILT) +
        body(BALL, "[-0.3, 2, 0]", velocity="[1, -3, 0]") + body(BOX, "[0.3, 2.5, 0.2]", rotation=TILT))
ROW = "".join(body('{ type = "sphere", radius = 0.25 }', f"[{0.5 * k}, 0, 0]", restitution=1, friction=0,
                   velocity="[4, 0, 0]" if k == 0 else "[0, 0, 0]") for k in range(5))

# Each in both modes of impacts.
SCENES = {
    "thrown": scene(THROWN),
    "thrown in wind": scene(WIND + THROWN),
    "thrown by fourth order": scene(WIND + THROWN, integrator='"rk4"'),
    "thrown by splitting": scene(WIND + THROWN, integrator='"splitting"'),
    "thrown exactly": scene(WIND + THROWN, integrator='"exact"'),
    "thrown by explicit Euler": scene(THROWN, integrator='"explicit-euler"'),
    "heap": scene(HEAP),
    "heap of matrices": scene(HEAP, rotation='"matrix"'),
    "heap by explicit Euler": scene(HEAP, integrator='"explicit-euler"'),
    "heap by fourth order": scene(HEAP, integrator='"rk4"'),
    "heap by the soft solver": scene(HEAP, contact_solver='"soft"'),
    "heap with simultaneous impacts": scene(HEAP, impact_law='"simultaneous"'),
    "heap in wind": scene(WIND + HEAP),
    "stack": scene(STACK),
    "sleep": scene(STACK + body(BALL, "[3, 12, 1]", velocity="[0, -6, 0]"), duration=1.4),
    "pushed": scene(FLOOR + PUSHED),
    "sliding": scene(SLIDING),
    "kinematic": scene(KINEMATIC),
    "mesh": scene(MESH, duration=0.5),
    "row of balls": scene(ROW, gravity="[0, 0, 0]"),
    "far from the origin": scene(re.sub(r"\nposition = \[", "\nposition = [1000", HEAP.replace("position = [-", "position = ["))),
    "grid": scene(FLOOR + body(CUBE, "[0, 1, 0]", rotation=TILT) + "grid = { count = [2, 3, 2], spacing = [0.6, 0.6, 0.6], jitter = [0.1, 0.1, 0.1], tilt = 20 }\n"),
}


class Balance(program.ProgramTest):
    def run_of(self, text, *options):
        self.write("scene.toml", text)
        return mechanics.Run(self, "scene.toml", *options)

    def check_balance(self, run):
        for error in run.errors():
            self.assertLess(error, 1e-12)
        for rows in run.impacts:
            for row in rows:
                self.assertGreaterEqual(float(row["impulse"]), 0.0)

    def test_scenes_of_all_kinds(self):
        for name, text in SCENES.items():
            for mode in ("stepped", "exact"):
                with self.subTest(name, mode=mode):
                    run = self.run_of(text, "--impacts", mode)
                    self.check_balance(run)
                    if "[wind]" not in text and "[[force]]" not in text:
                        self.check_weights(run, 0.0 if "gravity = [0, 0, 0]" in text else 9.81)

    def check_weights(self, run, gravity):
        for loads in run.loads[1:]:
            for name, load in loads.items():
                weight = (0.0, -gravity * run.mass[name], 0.0)
                error = mechanics.norm(mechanics.add(mechanics.vector(load, "fx", "fy", "fz"), weight, -1.0))
                self.assertLessEqual(error, 1e-11 * mechanics.norm(weight), load)

    def test_demo_scenes(self):
        for name, duration in DEMOS.items():
            for mode in ("stepped", "exact"):
                with self.subTest(name, mode=mode):
                    self.check_balance(mechanics.Run(self, ASSETS / "scenes" / (name + ".toml"), "--impacts", mode,
                                                     "--duration", duration))

    def test_method_of_the_notes(self):
        for push_out in ("true", "false"):
            run = self.run_of(scene(HEAP, method='"notes"', push_out=push_out))
            self.check_balance(run)
            if push_out == "false":
                self.assertEqual(sum(run.corrections()), 0)

    def test_flights_need_no_corrections(self):
        for name, options in (("thrown", ()), ("thrown in wind", ()), ("thrown by explicit Euler", ()), ("row of balls", ()),
                              ("thrown by fourth order", ()), ("pushed", ("--impacts", "exact")), ("mesh", ("--impacts", "exact"))):
            self.assertEqual(sum(self.run_of(SCENES[name], *options).corrections()), 0, name)

    # The rows of contact alone close the sums of these, friction of their areas included.

    def test_a_flat_landing_needs_no_corrections(self):
        run = self.run_of(scene(FLOOR + body(BOX, "[0, 0.7, 0]", velocity="[2, 0, 1]", angular_velocity="[0, 4, 0]"),
                                duration="0.4"), "--impacts", "exact")
        rows = [row for rows in run.impacts for row in rows]
        self.assertGreaterEqual(len(rows), 4)
        self.assertEqual(sum(run.corrections()), 0)
        beside = [mechanics.norm(mechanics.add(mechanics.cross(mechanics.vector(row, "px", "py", "pz"), mechanics.force(row, "impulse")),
                                               mechanics.vector(row, "mx", "my", "mz"), -1.0)) for row in rows]
        self.assertGreater(max(beside), 0.1)   # friction beside the points

    def test_a_flat_slide_needs_no_corrections(self):
        text = scene(FLOOR.replace("restitution = 0.4", "restitution = 0") +
                     body(BOX, "[0, 0.2, 0]", velocity="[2, 0, 1]", angular_velocity="[0, 4, 0]", restitution=0), duration="0.4")
        for mode in ("stepped", "exact"):
            run = self.run_of(text, "--impacts", mode)
            self.check_balance(run)
            self.assertEqual(sum(run.corrections()), 0, mode)
            self.assertGreater(max(abs(float(row["torsion"])) for rows in run.contacts for row in rows), 1.0)

    def test_gravity_acts_where_the_integrator_puts_it(self):
        # In free flight: sum of x_n x m g, with x_n at the start, end or middle of the step.
        for integrator, share in (("symplectic-euler", 0.5), ("explicit-euler", -0.5), ("splitting", 0), ("rk4", 0),
                                  ("exact", 0)):
            run = self.run_of(scene(THROWN, integrator=f'"{integrator}"'))
            self.check_flights(run, share / 400)
        self.check_flights(self.run_of(scene(THROWN), "--impacts", "exact"), 0)

    def check_flights(self, run, delay):
        for frame in range(1, len(run.times)):
            for name, load in run.loads[frame].items():
                before, after = run.states[frame - 1][name], run.states[frame][name]
                force = (0.0, -9.81 * run.mass[name], 0.0)
                place = tuple(0.5 * (float(before[k]) + float(after[k])) - delay * float(before["v" + k]) for k in "xyz")
                self.assert_near(mechanics.vector(load, "fx", "fy", "fz"), force, 1e-12)
                self.assert_near(mechanics.vector(load, "mx", "my", "mz"), mechanics.cross(place, force), 1e-11)

    def assert_near(self, found, expected, tolerance):
        scale = max(mechanics.norm(expected), 1e-300)
        self.assertLess(mechanics.norm(mechanics.add(found, expected, -1.0)), tolerance * scale, f"{found}, {expected}")

    def test_gravity_acts_at_the_start_of_a_step_with_contact(self):
        run = self.run_of(scene(HEAP, steps_per_frame="1").replace("fps = 50", "fps = 400"))
        for frame in range(1, len(run.times)):
            for name, load in run.loads[frame].items():
                force = (0.0, -9.81 * run.mass[name], 0.0)
                place = mechanics.vector(run.states[frame - 1][name], "x", "y", "z")
                self.assert_near(mechanics.vector(load, "mx", "my", "mz"), mechanics.cross(place, force), 1e-12)

    def test_wind_of_a_step(self):
        text = scene("[wind]\nvelocity = [8, 1, 2]\ndensity = 1.2\ndrag = 0.5\n" +
                     body(BALL, "[1, 2, 3]", velocity="[2, 3, 1]", mass=2), steps_per_frame="1")
        run = self.run_of(text)
        for frame in range(1, len(run.times)):
            state, load = run.states[frame - 1]["0"], run.loads[frame]["0"]
            u = mechanics.add((8.0, 1.0, 2.0), mechanics.vector(state, "vx", "vy", "vz"), -1.0)
            drag = 0.5 * 1.2 * 0.5 * math.pi * 0.09 * mechanics.norm(u)
            force = mechanics.add((0.0, -2 * 9.81, 0.0), u, drag)
            self.assert_near(mechanics.vector(load, "fx", "fy", "fz"), force, 1e-12)
            place = mechanics.vector(state, "x", "y", "z")
            self.assert_near(mechanics.vector(load, "mx", "my", "mz"), mechanics.cross(place, force), 1e-12)

    def test_a_brief_force_gives_its_whole_impulse(self):
        text = scene(body(BALL, "[0, 1, 0]", name='"ball"', mass=2) +
                     '[[force]]\nbody = "ball"\nforce = [3000, 0, 500]\nstart = 0.2011\nend = 0.2013\n')
        for mode in ("stepped", "exact"):
            run = self.run_of(text, "--impacts", mode)
            total = (0.0, 0.0, 0.0)
            for frame in range(1, len(run.times)):
                total = mechanics.add(total, run.load(frame)["ball"][0])
            self.assert_near(total, (0.6, -2 * 9.81 * run.times[-1], 0.1), 1e-12)

    def test_work_of_wind_in_exact_flight(self):
        self.write("scene.toml", SCENES["thrown in wind"])
        self.check(0, "simulate", "scene.toml", "--impacts", "exact", "--energy", "e.csv")
        rows = self.rows("e.csv")
        sums = [float(row["total"]) + float(row["impact_loss"]) + float(row["friction_loss"]) - float(row["work"])
                for row in rows]
        self.assertGreater(abs(float(rows[-1]["work"])), 1.0)
        for value in sums:
            self.assertAlmostEqual(value, sums[0], delta=1e-10 * abs(sums[0]))


if __name__ == "__main__":
    program.main()
