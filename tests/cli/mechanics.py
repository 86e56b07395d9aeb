"""Tables of a run by frame and body, and the mechanics that their tests need, in double precision."""

import csv
import math

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


def force(row, normal):
    """On b, with the size along the normal in that column."""
    return add(vector(row, "fx", "fy", "fz"), vector(row, "nx", "ny", "nz"), float(row[normal]))


def turned(q, v):
    """v, turned by the quaternion q = (w, x, y, z)."""
    t = cross(q[1:], v)
    return add(add(v, t, 2.0 * q[0]), cross(q[1:], t), 2.0)


def orientation(row):
    return tuple(float(row[key]) for key in ("qw", "qx", "qy", "qz"))


def inertia(properties):
    """The rows of the tensor in the body's frame."""
    i = {key: float(properties[key]) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")}
    return ((i["ixx"], i["ixy"], i["ixz"]), (i["ixy"], i["iyy"], i["iyz"]), (i["ixz"], i["iyz"], i["izz"]))


def spin(properties, row):
    """R I R^T omega."""
    q, rows = orientation(row), inertia(properties)
    w = turned((q[0], -q[1], -q[2], -q[3]), vector(row, "wx", "wy", "wz"))
    return turned(q, tuple(dot(i, w) for i in rows))


def inverse_times(properties, q, v):
    """R I^-1 R^T v, by the adjugate matrix."""
    x, y, z = inertia(properties)
    adjugate, determinant = (cross(y, z), cross(z, x), cross(x, y)), dot(x, cross(y, z))
    w = turned((q[0], -q[1], -q[2], -q[3]), v)
    return turned(q, tuple(dot(row, w) / determinant for row in adjugate))


class Run:
    """The tables of a run, by frame and body."""

    def __init__(self, test, name, *options):
        test.check(0, "simulate", name, "--trajectory", "t.csv", "--contacts", "c.csv", "--impacts", "i.csv",
                   "--loads", "l.csv", "--quiet", *options)
        table = test.check(0, "info", name, "--bodies", "-").stdout
        self.properties = {row["body"]: row for row in csv.DictReader(table.splitlines()) if row["type"] == "dynamic"}
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
                give(row["b"], force(row, normal), vector(row, "mx", "my", "mz"), scale)
                give(row["a"], force(row, normal), vector(row, "mx", "my", "mz"), -scale)

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
