"""`simulate`: momentum and angular momentum of every body and frame, from the tables alone.

The change of P is the sum of the logged impulses, and of the contact forces and external load times the frame's
duration; that of L about the world origin is the sum of their moments. Rows without a body A correct the method; the
tests count them where the method needs none."""

import math
import pathlib
import re

import program

DEMOS = pathlib.Path(__file__).resolve().parents[2] / "assets" / "scenes"
MESHES = DEMOS.parent / "meshes"

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
    "mesh": scene(MESH),
    "row of balls": scene(ROW, gravity="[0, 0, 0]"),
    "far from the origin": scene(re.sub(r"\nposition = \[", "\nposition = [1000", HEAP.replace("position = [-", "position = ["))),
    "grid": scene(FLOOR + body(CUBE, "[0, 1, 0]", rotation=TILT) + "grid = { count = [2, 3, 2], spacing = [0.6, 0.6, 0.6], jitter = [0.1, 0.1, 0.1], tilt = 20 }\n"),
}


def vector(row, x, y, z):
    return (float(row[x]), float(row[y]), float(row[z]))


def add(a, b, scale=1.0):
    return (a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def norm(a):
    return math.sqrt(dot(a, a))


def turned(q, v):
    """v, turned by the quaternion q = (w, x, y, z)."""
    t = cross(q[1:], v)
    return add(add(v, t, 2.0 * q[0]), cross(q[1:], t), 2.0)


def spin(properties, row):
    """R I R^T omega."""
    q = tuple(float(row[key]) for key in ("qw", "qx", "qy", "qz"))
    w = turned((q[0], -q[1], -q[2], -q[3]), vector(row, "wx", "wy", "wz"))
    i = {key: float(properties[key]) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")}
    return turned(q, (dot((i["ixx"], i["ixy"], i["ixz"]), w), dot((i["ixy"], i["iyy"], i["iyz"]), w),
                      dot((i["ixz"], i["iyz"], i["izz"]), w)))


class Run:
    """The tables of a run, by frame and body."""

    def __init__(self, test, name, *options):
        test.check(0, "simulate", name, "--trajectory", "t.csv", "--contacts", "c.csv", "--impacts", "i.csv",
                   "--loads", "l.csv", "--quiet", *options)
        test.check(0, "info", name, "--bodies", "b.csv")
        self.properties = {row["body"]: row for row in test.rows("b.csv") if row["type"] == "dynamic"}
        self.mass = {name: float(row["mass"]) for name, row in self.properties.items()}
        self.states, self.times = [], []
        for row in test.rows("t.csv"):
            frame = int(row["frame"])
            if frame == len(self.states):
                self.states.append({})
                self.times.append(float(row["time"]))
            if row["body"] in self.mass:
                self.states[frame][row["body"]] = row
        frames = len(self.times)
        self.contacts = [[] for _ in range(frames)]
        self.impacts = [[] for _ in range(frames)]
        self.loads = [{} for _ in range(frames)]
        for row in test.rows("c.csv"):
            self.contacts[int(row["frame"])].append(row)
        for row in test.rows("l.csv"):
            self.loads[int(row["frame"])][row["body"]] = row
        for row in test.rows("i.csv"):   # of the frame that ends at or after it
            frame = int(row["frame"]) if float(row["time"]) == self.times[int(row["frame"])] else int(row["frame"]) + 1
            self.impacts[frame].append(row)

    def momenta(self, frame, name):
        """P and L about the world origin."""
        row = self.states[frame][name]
        p = tuple(self.mass[name] * x for x in vector(row, "vx", "vy", "vz"))
        return p, add(cross(vector(row, "x", "y", "z"), p), spin(self.properties[name], row))

    def load(self, frame):
        """By body: the impulse and moment of gravity, wind and forces in a frame."""
        duration = self.times[frame] - self.times[frame - 1]
        zero = (0.0, 0.0, 0.0)
        return {name: (add(zero, vector(row, "fx", "fy", "fz"), duration),
                       add(zero, vector(row, "mx", "my", "mz"), duration)) for name, row in self.loads[frame].items()}

    def sums(self, frame):
        """By body: the impulses and moments of a frame."""
        duration = self.times[frame] - self.times[frame - 1]
        zero = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        sums = {name: zero for name in self.mass}

        def give(name, force, moment, scale):
            if name in sums:
                sums[name] = (add(sums[name][0], force, scale), add(sums[name][1], moment, scale))

        def forces(rows, normal, scale):
            for row in rows:
                force = add(vector(row, "fx", "fy", "fz"), vector(row, "nx", "ny", "nz"), float(row[normal]))
                moment = vector(row, "mx", "my", "mz")
                give(row["b"], force, moment, scale)
                give(row["a"], force, moment, -scale)

        forces(self.impacts[frame], "impulse", 1.0)
        forces(self.contacts[frame], "normal_force", duration)
        for name, (linear, angular) in self.load(frame).items():
            give(name, linear, angular, 1.0)
        return sums

    def errors(self):
        """The largest errors of both balances, as fractions of the largest P and L, or of the largest load's impulse."""
        errors, largest = [0.0, 0.0], [1e-300, 1e-300]
        before = {name: self.momenta(0, name) for name in self.mass}
        for frame in range(1, len(self.times)):
            sums, loads = self.sums(frame), self.load(frame)
            for name in self.mass:
                after = self.momenta(frame, name)
                for k in range(2):
                    change = add(add(after[k], before[name][k], -1.0), sums[name][k], -1.0)
                    errors[k] = max(errors[k], norm(change))
                    largest[k] = max(largest[k], norm(after[k]), norm(loads[name][k]))
                before[name] = after
        return errors[0] / largest[0], errors[1] / largest[1]

    def corrections(self):
        """By frame: the number of rows without a body A."""
        return [sum(1 for row in rows if not row["a"]) for rows in self.contacts]


class Balance(program.ProgramTest):
    def balance(self, name, *options):
        run = Run(self, name, *options)
        return run, run.errors()

    def test_scenes_of_all_kinds(self):
        for name, text in SCENES.items():
            self.write("scene.toml", text)
            for mode in ("stepped", "exact"):
                with self.subTest(name, mode=mode):
                    run, errors = self.balance("scene.toml", "--impacts", mode)
                    print(name, mode, errors, sum(run.corrections()), sum(map(len, run.contacts)), sum(map(len, run.impacts)))


if __name__ == "__main__":
    program.main()
