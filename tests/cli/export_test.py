"""`export`: the structure of the glTF file, its meshes and materials, and its animation against the simulation."""

import bisect
import json
import math
import random
import struct

import program

SIZES = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
FORMATS = {5123: "H", 5125: "I", 5126: "f"}

FLIGHT = """\
format = 1
[simulation]
duration = 2.0
impacts = "exact"
[output]
size = [320, 180]
fps = 60
[[body]]
type = "fixed"
shape = { type = "plane" }
restitution = 0.9
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.5 }
position = [-2.0, 1.5, 0.0]
velocity = [0.25, 0.0, 0.0]
angular_velocity = [0.0, 0.0, 6.0]
[[body]]
name = "box"
shape = { type = "box", size = [0.6, 0.3, 0.9] }
position = [3.0, 1.2, 0.0]
velocity = [0.0, 1.0, 0.5]
angular_velocity = [5.0, 4.0, -3.0]
"""

VARIED = """\
format = 1
title = "Shapes"
[simulation]
duration = 1.5
[output]
size = [320, 180]
fps = 60
[camera]
eye = [0.0, 3.0, 9.0]
target = [0.0, 1.0, 0.0]
orbit = 40.0
[light]
direction = [0.0, -2.0, 0.0]
[[body]]
name = "ground"
type = "fixed"
shape = { type = "plane" }
friction = 0.5
[[body]]
name = "rest"
shape = { type = "box", size = [1.0, 0.5, 1.0] }
position = [0.0, 0.25, 0.0]
color = "#ff8000"
roughness = 0.25
metallic = 1.0
[[body]]
name = "tetrahedron"
shape = { type = "mesh", file = "tetrahedron.obj" }
position = [2.0, 1.0, 0.0]
angular_velocity = [1.0, 2.0, 3.0]
[[body]]
name = "twin"
shape = { type = "mesh", file = "tetrahedron.obj" }
position = [2.0, 3.0, 0.0]
[[body]]
name = "hammer"
shape = { type = "compound", parts = [
  { shape = { type = "box", size = [0.2, 1.0, 0.2] } },
  { shape = { type = "sphere", radius = 0.3 }, position = [0.0, 0.6, 0.0], color = "#0000ff" } ] }
position = [-2.0, 2.0, 0.0]
angular_velocity = [0.0, 0.0, 3.0]
[[body]]
name = "paddle"
type = "kinematic"
shape = { type = "box", size = [0.5, 0.1, 0.5] }
interpolation = "linear"
keyframes = [ { time = 0.0, position = [5.0, 1.0, 0.0] }, { time = 0.7131, position = [5.0, 2.0, 0.0] },
              { time = 1.2, position = [5.0, 1.0, 0.0], rotation = { axis = [0.0, 0.0, 1.0], angle = 90.0 } } ]
[[body]]
name = "hidden"
type = "fixed"
shape = { type = "sphere", radius = 1.0 }
position = [0.0, 0.0, -20.0]
visible = false
"""

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


class Glb:
    """A parsed file; its parts are checked against the rules of glTF 2.0."""

    def __init__(self, data, test):
        self.test = test
        magic, version, size, json_size, kind = struct.unpack_from("<4sIII4s", data)
        test.assertEqual((magic, version, size, kind), (b"glTF", 2, len(data), b"JSON"))
        test.assertEqual(json_size % 4, 0)
        self.json = json.loads(data[20:20 + json_size])
        binary_size, kind = struct.unpack_from("<I4s", data, 20 + json_size)
        test.assertEqual(kind, b"BIN\0")
        self.binary = data[28 + json_size:]
        test.assertEqual(len(self.binary), binary_size)
        test.assertEqual(binary_size % 4, 0)
        test.assertEqual(self.json["buffers"], [{"byteLength": binary_size}])
        self.accessors = [self.read_accessor(a) for a in self.json["accessors"]]
        self.nodes = {node.get("name"): i for i, node in enumerate(self.json["nodes"])}
        self.check_meshes()
        self.tracks = {}
        for animation in self.json.get("animations", []):
            for channel in animation["channels"]:
                sampler = animation["samplers"][channel["sampler"]]
                key = channel["target"]["node"], channel["target"]["path"]
                test.assertNotIn(key, self.tracks)
                self.tracks[key] = self.read_track(sampler)

    def read_accessor(self, accessor):
        view = self.json["bufferViews"][accessor["bufferView"]]
        n, form = SIZES[accessor["type"]], FORMATS[accessor["componentType"]]
        self.test.assertEqual(view["byteOffset"] % 4, 0)
        self.test.assertEqual(view["byteLength"], accessor["count"] * n * struct.calcsize(form))
        self.test.assertLessEqual(view["byteOffset"] + view["byteLength"], len(self.binary))
        flat = struct.unpack_from(f"<{accessor['count'] * n}{form}", self.binary, view["byteOffset"])
        values = [flat[i:i + n] for i in range(0, len(flat), n)]
        if "min" in accessor:
            self.test.assertEqual(accessor["min"], [min(column) for column in zip(*values)])
            self.test.assertEqual(accessor["max"], [max(column) for column in zip(*values)])
        return values

    def check_meshes(self):
        for mesh in self.json["meshes"]:
            for primitive in mesh["primitives"]:
                positions = self.accessors[primitive["attributes"]["POSITION"]]
                normals = self.accessors[primitive["attributes"]["NORMAL"]]
                self.test.assertIn("min", self.json["accessors"][primitive["attributes"]["POSITION"]])
                self.test.assertEqual(len(positions), len(normals))
                corners = [i for i, in self.accessors[primitive["indices"]]]
                self.test.assertLess(max(corners), len(positions))
                for normal in normals:
                    self.test.assertAlmostEqual(math.hypot(*normal), 1.0, places=5)
                for a, b, c in zip(corners[::3], corners[1::3], corners[2::3]):
                    side = cross(minus(positions[b], positions[a]), minus(positions[c], positions[a]))
                    self.test.assertGreater(dot(side, normals[a]), 0.0)  # counter-clockwise from outside

    def read_track(self, sampler):
        self.test.assertEqual(sampler["interpolation"], "CUBICSPLINE")
        self.test.assertIn("min", self.json["accessors"][sampler["input"]])
        times = [t for t, in self.accessors[sampler["input"]]]
        output = self.accessors[sampler["output"]]
        self.test.assertEqual(len(output), 3 * len(times))
        self.test.assertTrue(all(a < b for a, b in zip(times, times[1:])))
        self.test.assertGreaterEqual(times[0], 0.0)
        return times, output

    def value(self, name, path, time):
        """A node's value at a time, as the specification defines it."""
        node = self.nodes[name]
        if (node, path) not in self.tracks:
            return self.json["nodes"][node][path]
        times, output = self.tracks[node, path]
        k = bisect.bisect_right(times, time) - 1
        if k < 0 or k == len(times) - 1:
            return output[3 * max(k, 0) + 1]
        span = times[k + 1] - times[k]
        t = (time - times[k]) / span
        weights = 2 * t**3 - 3 * t**2 + 1, span * (t**3 - 2 * t**2 + t), -2 * t**3 + 3 * t**2, span * (t**3 - t**2)
        parts = output[3 * k + 1], output[3 * k + 2], output[3 * k + 4], output[3 * k + 3]
        value = [dot(weights, column) for column in zip(*parts)]
        return [v / math.hypot(*value) for v in value] if path == "rotation" else value


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def angle(p, q):
    return 4 * math.asin(0.5 * min(math.dist(p, q), math.dist(p, [-x for x in q])))


class Export(program.ProgramTest):
    def export(self, text, *options):
        self.write("scene.toml", text)
        self.check(0, "export", "scene.toml", "-o", "clip.glb", "--quiet", *options)
        return Glb((self.folder / "clip.glb").read_bytes(), self)

    def compare_with_simulation(self, glb, rate):
        """At 1,000 random moments of each body."""
        self.check(0, "simulate", "scene.toml", "--trajectory", "t.csv", "--fps", rate, "--steps-per-frame", 1, "--quiet")
        rows = {}
        for row in self.rows("t.csv"):
            rows.setdefault(row["body"], []).append(row)
        for body, all_rows in rows.items():
            for row in random.Random(7).sample(all_rows, min(1000, len(all_rows))):
                time = float(row["time"])
                position = [float(row[c]) for c in ("x", "y", "z")]
                rotation = [float(row[c]) for c in ("qx", "qy", "qz", "qw")]
                self.assertLess(math.dist(glb.value(body, "translation", time), position), 1e-5, (body, time))
                self.assertLess(angle(glb.value(body, "rotation", time), rotation), 1e-5, (body, time))
        return rows

    def test_a_bouncing_ball_in_closed_form(self):
        glb = self.export(FLIGHT)
        g, fall = 9.81, math.sqrt(2 * 1.0 / 9.81)
        for _ in range(1000):
            time = random.uniform(0.0, 2.0)
            x, y, _ = glb.value("ball", "translation", time)
            t, speed = time - fall, g * fall
            height = 1.0 - 0.5 * g * time**2
            while t > 0:
                speed *= 0.9
                height = speed * t - 0.5 * g * t**2
                t -= 2 * speed / g
            self.assertAlmostEqual(y, 0.5 + height, delta=1e-5)
            self.assertAlmostEqual(x, -2.0 + 0.25 * time, delta=1e-5)
        # The start, the three impacts, the end.
        times = glb.tracks[glb.nodes["ball"], "translation"][0]
        for time, expected in zip(times, (0, fall, 2.8 * fall, 4.42 * fall, 2), strict=True):
            self.assertAlmostEqual(time, expected, delta=1e-6)

    def test_exact_motion_between_the_moments_that_make_the_keys(self):
        glb = self.export(FLIGHT)
        self.compare_with_simulation(glb, 7680)

    def test_stepped_motion(self):
        self.write("tetrahedron.obj", TETRAHEDRON)
        glb = self.export(VARIED)
        self.compare_with_simulation(glb, 960)

    def test_stated_errors(self):
        extras = self.export(FLIGHT).json["asset"]["extras"]
        self.assertLess(extras["largestPositionError"], 1e-5)
        self.assertLess(extras["largestRotationError"], 1e-5)
        self.assertEqual((extras["fps"], extras["momentsPerSecond"], extras["duration"]), (60, 960, 2))


if __name__ == "__main__":
    program.main()
