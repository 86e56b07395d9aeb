"""`simulate --impacts`: eqs. 14 and 20 of the notes recomputed from outside, and the places and features of impacts.

Masses and inertia come from `info --bodies`, the state before an impact from the trajectory's row of the frame: a
parabola and torque-free rotation lead from there to the impact."""

import math
import pathlib

import mechanics
import program
from mechanics import add, cross, dot, norm, vector

MESHES = pathlib.Path(__file__).resolve().parents[2] / "assets" / "meshes"
GRAVITY = (0.0, -9.81, 0.0)


def scene(bodies, duration=1, gravity="[0, -9.81, 0]"):
    return f"format = 1\n[simulation]\nimpacts = \"exact\"\nduration = {duration}\ngravity = {gravity}\n" + bodies


def body(shape, position, **keys):
    keys = {"restitution": "0.6", "friction": "0", **keys}
    return (f"[[body]]\nshape = {shape}\nposition = {position}\n" +
            "".join(f"{key} = {value}\n" for key, value in keys.items()))


def fixed(shape, position="[0, 0, 0]", **keys):
    return body(shape, position, type='"fixed"', **keys)


FLOOR = '{ type = "plane" }'
BOX = '{ type = "box", size = [1.0, 0.6, 0.8] }'
CUBE = '{ type = "box", size = [1, 1, 1] }'
BALL = '{ type = "sphere", radius = 0.25 }'
COMPOUND = ('{ type = "compound", parts = [ { shape = { type = "box", size = [0.9, 0.2, 0.3] } }, '
            '{ shape = { type = "sphere", radius = 0.2 }, position = [0.5, 0.3, 0.1] } ] }')
TILT = "{ axis = [1, 2, 0.5], angle = 40 }"
TILT_Q = (math.cos(math.radians(20)), *(math.sin(math.radians(20)) / math.sqrt(5.25) * x for x in (1.0, 2.0, 0.5)))

SCENES = {
    "corner of a box at rest": scene(fixed(FLOOR) + body(BOX, "[0, 2, 0]", rotation=TILT, mass=3)),
    "corner of a tumbling box": scene(fixed(FLOOR) + body(BOX, "[0, 2, 0]", rotation=TILT, angular_velocity="[5, 2, -4]")),
    "box about its principal axis": scene(fixed(FLOOR) + body(
        BOX, "[0, 2, 0]", rotation=TILT, angular_velocity=str([3 * x for x in mechanics.turned(TILT_Q, (0.0, 0.0, 1.0))]))),
    "balls off center": scene(body(BALL, "[0, 0, 0]", velocity="[3, 0, 0]", angular_velocity="[1, 2, 3]") +
                              body(BALL, "[2, 0.2, 0.1]", mass=5), gravity="[0, 0, 0]"),
    "compound on a floor": scene(fixed(FLOOR) + body(COMPOUND, "[0, 2, 0]", rotation=TILT, angular_velocity="[1, -2, 3]")),
    "edge on edge": scene(body(CUBE, "[0, 0, 0]", rotation="{ axis = [1, 0.2, 0], angle = 45 }", angular_velocity="[0.1, 0.2, 0.3]") +
                          body(CUBE, "[0.1, 3, 0.05]", rotation="{ axis = [0, 0.1, 1], angle = 45 }",
                               velocity="[0, -4, 0]", mass=300), gravity="[0, 0, 0]"),
    "corner on a face": scene(body(CUBE, "[0, 0, 0]", angular_velocity="[0.2, 0.1, 0.1]") +
                              body(BOX, "[0.1, 3, 0.1]", rotation=TILT, velocity="[0, -4, 0]"), gravity="[0, 0, 0]"),
    "corner of a mesh": scene(fixed(FLOOR) + body('{ type = "mesh", file = "' + str(MESHES / "gem.obj") + '" }', "[0, 3, 0]",
                                                  rotation=TILT, angular_velocity="[1, 2, 1]")),
    "shot into a grid": scene(body(CUBE, "[0, 0, 0]") + "grid = { count = [3, 3, 3], spacing = [1.7, 1.7, 1.7], jitter = [0.1, 0.1, 0.1], "
                              "tilt = 30 }\n" + body(BALL, "[-6, 0.2, 0.1]", velocity="[12, 0, 0]", mass=4000),
                              duration=3, gravity="[0, 0, 0]"),
    "ball on a box": scene(body(BOX, "[0, 0, 0]") + body(BALL, "[0.3, 2, 0.2]", velocity="[0, -3, 0]"), gravity="[0, 0, 0]"),
}


class Flight:
    """A body's momenta and inertia at a time after a frame, without impacts between."""

    def __init__(self, run, name, frame, time, gravity):
        self.fixed = name not in run.mass
        if self.fixed:
            return
        self.mass, self.properties = run.mass[name], run.properties[name]
        row, t = run.states[frame][name], time - run.times[frame]
        self.place = tuple(x + t * (v + 0.5 * t * g)
                           for x, v, g in zip(vector(row, "x", "y", "z"), vector(row, "vx", "vy", "vz"), gravity))
        self.velocity = add(vector(row, "vx", "vy", "vz"), gravity, t)
        self.spin = mechanics.spin(self.properties, row)
        self.q = mechanics.orientation(row)
        for _ in range(64):   # Runge and Kutta's method of fourth order: its error is far below rounding
            self.q = self.turn(t / 64)
        self.omega = self.angular(self.spin)

    def turn(self, h):
        def rate(q):
            w = mechanics.inverse_times(self.properties, q, self.spin)
            return (-0.5 * dot(w, q[1:]), *add(tuple(0.5 * q[0] * x for x in w), cross(w, q[1:]), 0.5))

        def moved(k, scale):
            return tuple(x + scale * y for x, y in zip(self.q, k))

        k1 = rate(self.q)
        k2 = rate(moved(k1, 0.5 * h))
        k3 = rate(moved(k2, 0.5 * h))
        k4 = rate(moved(k3, h))
        q = tuple(x + h / 6 * (a + 2 * b + 2 * c + d) for x, a, b, c, d in zip(self.q, k1, k2, k3, k4))
        size = math.sqrt(sum(x * x for x in q))
        return tuple(x / size for x in q)

    def angular(self, moment):
        """I^-1 times a moment."""
        return mechanics.inverse_times(self.properties, self.q, moment)

    def speed(self, point, n):
        return 0.0 if self.fixed else dot(n, add(self.velocity, cross(self.omega, add(point, self.place, -1.0))))

    def response(self, point, n):
        """This body's part of the denominator of eq. 20."""
        if self.fixed:
            return 0.0
        r = add(point, self.place, -1.0)
        return 1.0 / self.mass + dot(n, cross(self.angular(cross(r, n)), r))

    def push(self, point, impulse):
        """Eqs. 9 and 10, and 2 to 4."""
        if self.fixed:
            return
        self.velocity = add(self.velocity, impulse, 1.0 / self.mass)
        self.omega = add(self.omega, self.angular(cross(add(point, self.place, -1.0), impulse)))


class ImpactEquations(program.ProgramTest):
    def run_of(self, text, *options):
        self.write("scene.toml", text)
        return mechanics.Run(self, "scene.toml", *options)

    def single_impacts(self, run, stepped=False):
        """(frame before, row): the first impacts of their bodies in a frame, of one contact. Steps resolve impacts
        before other contacts."""
        for frame in range(1, len(run.times)):
            rows, met = run.impacts[frame], set()
            held = {name for row in run.contacts[frame - 1] + run.contacts[frame] for name in (row["a"], row["b"])}
            for row in rows:
                pair = {row["a"], row["b"]} & set(run.mass)
                alone = sum(1 for other in rows if other["time"] == row["time"]) == 1
                if alone and not pair & met and (stepped or not pair & held):
                    yield frame - 1, row
                met |= pair

    def test_single_contacts_satisfy_eqs_14_and_20(self):
        for name, text in SCENES.items():
            run = self.run_of(text)
            gravity = (0.0, 0.0, 0.0) if "gravity = [0, 0, 0]" in text else GRAVITY
            found = 0
            for frame, row in self.single_impacts(run):
                self.check_impact(run, frame, row, float(row["time"]), gravity, name)
                found += 1
            self.assertGreater(found, 0, name)

    def test_single_contacts_of_steps_do_too(self):
        for name in ("corner of a box at rest", "corner of a tumbling box", "compound on a floor", "edge on edge", "ball on a box"):
            run = self.run_of(SCENES[name], "--impacts", "stepped", "--fps", 1000, "--steps-per-frame", 1)
            found = 0
            for frame, row in self.single_impacts(run, stepped=True):
                time = float(row["time"])
                if row["exact"] == "0":    # resolved at the state of the step's start
                    self.check_impact(run, frame, row, run.times[frame], GRAVITY, name)
                else:   # a hit within the step: Euler's path to it is off by g h^2 / 8, its velocity by g h / 2
                    self.check_impact(run, frame, row, time, GRAVITY, name, place=2e-6, speed=0.005)
                found += 1
            self.assertGreater(found, 0, name)

    def check_impact(self, run, frame, row, time, gravity, name, place=1e-12, speed=1e-12):
        """`place`, `speed`: allowed deviations, relative, for the place of the bodies and for v_before (m/s)."""
        point, n = vector(row, "px", "py", "pz"), vector(row, "nx", "ny", "nz")
        a, b = (Flight(run, row[key], frame, time, gravity) for key in ("a", "b"))
        found, e = float(row["v_before"]), float(row["restitution"])
        before = b.speed(point, n) - a.speed(point, n)
        self.assertAlmostEqual(found, before, delta=speed * max(1.0, abs(before)), msg=name)
        if speed > 1e-12:
            before = found
        j = -(1.0 + e) * before / (a.response(point, n) + b.response(point, n))
        a.push(point, tuple(-j * x for x in n))
        b.push(point, tuple(j * x for x in n))
        self.assertAlmostEqual(norm(n), 1.0, delta=1e-15)
        self.assertAlmostEqual(float(row["impulse"]) / j, 1.0, delta=place, msg=name)
        self.assertAlmostEqual(float(row["v_after"]) / before, -e, delta=1e-12, msg=name)
        self.assertAlmostEqual((b.speed(point, n) - a.speed(point, n)) / before, -e, delta=2.0 * speed, msg=name)

    # Features, normals and points of the first impact, from where the bodies must meet: without a spin a body keeps its
    # orientation as it falls.

    def first_impact(self, *bodies, gravity="[0, -9.81, 0]"):
        run = self.run_of(scene("".join(bodies), gravity=gravity))
        return next(rows[0] for rows in run.impacts if rows)

    def check_place(self, row, feature, normal, point):
        self.assertEqual(row["feature"], feature)
        for found, expected in zip(vector(row, "nx", "ny", "nz") + vector(row, "px", "py", "pz"), normal + point):
            self.assertAlmostEqual(found, expected, delta=1e-12, msg=str(row))

    def lowest_corner(self):
        """Of BOX with the rotation TILT, relative to its center."""
        corners = [mechanics.turned(TILT_Q, (x, y, z)) for x in (-0.5, 0.5) for y in (-0.3, 0.3) for z in (-0.4, 0.4)]
        return min(corners, key=lambda corner: corner[1])

    def test_a_corner_on_a_face(self):
        corner, falling = self.lowest_corner(), body(BOX, "[0.3, 2, -0.2]", rotation=TILT)
        point = (0.3 + corner[0], 0.0, -0.2 + corner[2])
        self.check_place(self.first_impact(fixed(FLOOR), falling), "face-vertex", (0, 1, 0), point)
        self.check_place(self.first_impact(falling, fixed(FLOOR)), "vertex-face", (0, -1, 0), point)
        table = fixed('{ type = "box", size = [4, 1, 4] }', "[0, -0.5, 0]")
        self.check_place(self.first_impact(table, falling), "face-vertex", (0, 1, 0), point)
        self.check_place(self.first_impact(falling, table), "vertex-face", (0, -1, 0), point)

    def test_an_edge_on_an_edge(self):
        lower = fixed(CUBE, "[0, 0, 0]", rotation="{ axis = [1, 0, 0], angle = 45 }")
        upper = body(CUBE, "[0.1, 3, 0.2]", rotation="{ axis = [0, 0, 1], angle = 45 }")
        self.check_place(self.first_impact(lower, upper), "edge-edge", (0, 1, 0), (0.1, math.sqrt(0.5), 0))

    def test_a_face_on_a_face(self):
        lower, upper = fixed(CUBE, "[0, 0, 0]"), body(CUBE, "[0.2, 3, 0.1]")
        self.write("scene.toml", scene(lower + upper))
        rows = next(rows for rows in mechanics.Run(self, "scene.toml").impacts if rows)
        self.assertEqual({row["feature"] for row in rows}, {"face-face"})
        corners = sorted(tuple(round(x, 9) for x in vector(row, "px", "py", "pz")) for row in rows)
        self.assertEqual(corners, [(-0.3, 0.5, -0.4), (-0.3, 0.5, 0.5), (0.5, 0.5, -0.4), (0.5, 0.5, 0.5)])

    def test_a_ball(self):
        ball = body(BALL, "[0.3, 2, 0.2]")
        for below in (fixed(FLOOR, "[0, 0, 0]"), fixed(BOX, "[0, -0.3, 0]"), fixed(BALL, "[0.3, -0.25, 0.2]")):
            self.check_place(self.first_impact(below, ball), "sphere", (0, 1, 0), (0.3, 0, 0.2))
            self.check_place(self.first_impact(ball, below), "sphere", (0, -1, 0), (0.3, 0, 0.2))
        # Two balls off center: the normal is along their centers where their distance is both radii.
        row = self.first_impact(body(BALL, "[0, 0, 0]"), body(BALL, "[0.3, 3, 0]", velocity="[0, -4, 0]"), gravity="[0, 0, 0]")
        self.check_place(row, "sphere", (0.6, 0.8, 0), (0.15, 0.2, 0))

    def test_a_mesh(self):
        # A wedge whose upper face has the normal (-0.6, 0.8, 0).
        corners = [(x, y, z) for z in (-2, 2) for x, y in ((-2, -1.5), (2, 1.5), (2, -1.5))]
        faces = ((1, 2, 5), (1, 5, 4), (1, 3, 2), (4, 5, 6), (2, 3, 6), (2, 6, 5), (1, 4, 6), (1, 6, 3))
        self.write("wedge.obj", "".join("v {} {} {}\n".format(*corner) for corner in corners) +
                   "".join("f {} {} {}\n".format(*face) for face in faces))
        wedge = fixed('{ type = "mesh", file = "wedge.obj" }')
        row = self.first_impact(wedge, body(BALL, "[0.4, 3, 0.1]"))
        # The center passes 0.25 / 0.8 above the face's point (0.4, 0.3, 0.1).
        self.check_place(row, "mesh", (-0.6, 0.8, 0), (0.4 + 0.6 * 0.25, 0.3 + 0.25 / 0.8 - 0.8 * 0.25, 0.1))
        row = self.first_impact(body(BALL, "[0.4, 3, 0.1]"), wedge)
        self.check_place(row, "mesh", (0.6, -0.8, 0), (0.4 + 0.6 * 0.25, 0.3 + 0.25 / 0.8 - 0.8 * 0.25, 0.1))


if __name__ == "__main__":
    program.main()
