"""`export`: the structure of the glTF file, its meshes and materials, and its animation against the simulation."""

import bisect
import json
import math
import random
import resource
import struct

import program

SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
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
        values = {"CUBICSPLINE": 3, "LINEAR": 1}[sampler["interpolation"]]  # a key
        self.test.assertIn("min", self.json["accessors"][sampler["input"]])
        times = [t for t, in self.accessors[sampler["input"]]]
        output = self.accessors[sampler["output"]]
        self.test.assertEqual(len(output), values * len(times))
        self.test.assertTrue(all(a < b for a, b in zip(times, times[1:])))
        self.test.assertGreaterEqual(times[0], 0.0)
        return times, output

    def value(self, name, path, time):
        """A node's value at a time, as the specification defines it; of linear keys at a key or in rest."""
        node = self.nodes[name]
        if (node, path) not in self.tracks:
            return self.json["nodes"][node][path]
        times, output = self.tracks[node, path]
        if len(output) == len(times):
            return output[max(bisect.bisect_right(times, time + 1e-6) - 1, 0)]
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
        moments = random.Random(5)
        for _ in range(1000):
            time = moments.uniform(0.0, 2.0)
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

    def test_meshes_materials_and_children(self):
        self.write("tetrahedron.obj", TETRAHEDRON)
        glb = self.export(VARIED)
        nodes = glb.json["nodes"]
        self.assertNotIn("hidden", glb.nodes)
        self.assertEqual(glb.json["scenes"][0]["name"], "Shapes")

        rest = nodes[glb.nodes["rest"]]
        self.assertEqual(rest["scale"], [1.0, 0.5, 1.0])
        material = glb.json["materials"][glb.json["meshes"][rest["mesh"]]["primitives"][0]["material"]]
        look = material["pbrMetallicRoughness"]
        self.assertEqual((look["roughnessFactor"], look["metallicFactor"]), (0.25, 1.0))
        orange = 1.0, ((128 / 255 + 0.055) / 1.055)**2.4, 0.0, 1.0  # sRGB in linear light
        for value, expected in zip(look["baseColorFactor"], orange, strict=True):
            self.assertAlmostEqual(value, expected, places=12)

        # A mesh lies at its center of mass, and is in the file once.
        shapes = [nodes[child] for name in ("tetrahedron", "twin") for child in nodes[glb.nodes[name]]["children"]]
        self.assertEqual(shapes[0], shapes[1])
        for coordinate in shapes[0]["translation"]:
            self.assertAlmostEqual(coordinate, -0.25, places=12)

        parts = [nodes[child] for child in nodes[glb.nodes["hammer"]]["children"]]
        self.assertEqual([part["scale"] for part in parts], [[0.2, 1.0, 0.2], [0.3, 0.3, 0.3]])
        self.assertAlmostEqual(parts[1]["translation"][1] - parts[0]["translation"][1], 0.6, places=12)

    def test_camera_and_light(self):
        self.write("tetrahedron.obj", TETRAHEDRON)
        glb = self.export(VARIED)
        for time in (0.0, 0.4567, 1.5):
            turn = math.radians(40.0) * time
            eye = [9.0 * math.sin(turn), 3.0, 9.0 * math.cos(turn)]
            self.assertLess(math.dist(glb.value("camera", "translation", time), eye), 1e-5)
            x, y, z, w = glb.value("camera", "rotation", time)
            back = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
            side = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]
            for value, expected in zip(back, minus(eye, [0.0, 1.0, 0.0])):
                self.assertAlmostEqual(value, expected / math.hypot(9.0, 2.0), delta=1e-5)
            self.assertAlmostEqual(side[1], 0.0, delta=1e-5)
        x, y, z, w = glb.json["nodes"][glb.nodes["light"]]["rotation"]
        for value, expected in zip([-2 * (x * z + w * y), -2 * (y * z - w * x), 2 * (x * x + y * y) - 1], (0, -1, 0)):
            self.assertAlmostEqual(value, expected, places=12)

    def test_resting_bodies_have_no_keys_after_they_come_to_rest(self):
        glb = self.export(FLIGHT.replace("duration = 2.0", "duration = 8.0").replace("restitution = 0.9", "restitution = 0.2"),
                          "--set", "body.box.friction=1", "--set", "body.0.friction=1")
        self.check(0, "simulate", "scene.toml", "--trajectory", "t.csv", "--quiet",
                   "--set", "body.box.friction=1", "--set", "body.0.friction=1")
        rows = [row for row in self.rows("t.csv") if row["body"] == "box"]
        pose = [rows[-1][c] for c in ("x", "y", "z", "qw", "qx", "qy", "qz")]
        at_rest = min(float(row["time"]) for row in rows if [row[c] for c in ("x", "y", "z", "qw", "qx", "qy", "qz")] == pose)
        self.assertLess(at_rest, 7.0)
        for path in ("translation", "rotation"):
            self.assertLess(glb.tracks[glb.nodes["box"], path][0][-1], at_rest + 1e-6)

    def test_linear_keys_at_frames(self):
        text = FLIGHT.replace("duration = 2.0", "duration = 8.0").replace("restitution = 0.9", "restitution = 0.2\nfriction = 1.0")
        glb = self.export(text, "--keys", "frames", "--set", "body.box.friction=1")
        self.assertEqual({sampler["interpolation"] for sampler in glb.json["animations"][0]["samplers"]}, {"LINEAR"})
        self.assertEqual(glb.json["asset"]["extras"]["momentsPerSecond"], 60)
        self.check(0, "simulate", "scene.toml", "--trajectory", "t.csv", "--quiet", "--set", "body.box.friction=1")
        for row in self.rows("t.csv"):
            body, time = row["body"], float(row["time"])
            position = [float(row[c]) for c in ("x", "y", "z")]
            rotation = [float(row[c]) for c in ("qx", "qy", "qz", "qw")]
            self.assertLess(math.dist(glb.value(body, "translation", time), position), 1e-5, (body, time))
            self.assertLess(angle(glb.value(body, "rotation", time), rotation), 1e-5, (body, time))
        # One key a frame while the box moves, none in rest.
        times = glb.tracks[glb.nodes["box"], "translation"][0]
        for i, time in enumerate(times):
            self.assertAlmostEqual(time, i / 60, delta=1e-6)
        self.assertLess(times[-1], 7.0)

    def test_a_scene_without_motion(self):
        glb = self.export(FLIGHT, "--duration", 0)
        self.assertNotIn("animations", glb.json)
        self.assertEqual(glb.value("ball", "translation", 0.0), [-2.0, 1.5, 0.0])

    def test_water_is_a_translucent_square_at_its_level(self):
        glb = self.export(FLIGHT + "[water]\nlevel = -2.5\ncolor = \"#ff0000\"\n", "--duration", 0)
        node = next(node for node in glb.json["nodes"] if node.get("name") == "water")
        primitive = glb.json["meshes"][node["mesh"]]["primitives"][0]
        positions = glb.json["accessors"][primitive["attributes"]["POSITION"]]
        self.assertEqual((positions["min"][1], positions["max"][1]), (-2.5, -2.5))
        material = glb.json["materials"][primitive["material"]]
        self.assertEqual(material["pbrMetallicRoughness"]["baseColorFactor"], [1.0, 0.0, 0.0, 0.7])
        self.assertEqual(material["alphaMode"], "BLEND")

    def test_the_program_reads_its_own_meshes(self):
        self.write("box.toml", '''format = 1
[[body]]
type = "fixed"
shape = { type = "box", size = [1.0, 2.0, 3.0] }
rotation = { axis = [1.0, 2.0, 3.0], angle = 50.0 }
''')
        self.check(0, "export", "box.toml", "-o", "box.glb", "--duration", 0)
        self.write("scene.toml", 'format = 1\n[[body]]\nshape = { type = "mesh", file = "box.glb" }\n')
        self.check(0, "info", "scene.toml", "--bodies", "b.csv")
        self.assertAlmostEqual(float(self.rows("b.csv")[0]["mass"]), 6000.0, delta=1e-2)

    def test_a_texture_of_a_mesh_file(self):
        """The image differs by a level at most; the mesh that is read back has the same texture."""
        colors = [(255, 0, 0), (0, 255, 0), (20, 90, 200), (130, 131, 132)]
        (self.folder / "tile.png").write_bytes(program.png(2, 2, colors[0], [(1, 0, 1, 1, colors[1]), (0, 1, 1, 1, colors[2]),
                                                                            (1, 1, 1, 1, colors[3])]))
        self.write("tile.mtl", "newmtl tile\nKd 0.5 1 1\nmap_Kd tile.png\n")
        self.write("tile.obj", "mtllib tile.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\n"
                               "usemtl tile\nf 1/1 2/2 3/3 4/4\n")
        text = 'format = 1\n[[body]]\ntype = "fixed"\nshape = { type = "mesh", file = "%s" }\n'
        glb = self.export(text % "tile.obj")
        primitive, = glb.json["meshes"][0]["primitives"]
        self.assertEqual(sorted(glb.accessors[primitive["attributes"]["TEXCOORD_0"]]),
                         [(0.0, -1.0), (0.0, 1.0), (2.0, -1.0), (2.0, 1.0)])
        surface = glb.json["materials"][primitive["material"]]["pbrMetallicRoughness"]
        self.assertEqual(surface["baseColorTexture"], {"index": 0})
        self.assertEqual(glb.json["samplers"][0]["wrapS"], 10497)
        view = glb.json["bufferViews"][glb.json["images"][0]["bufferView"]]
        (self.folder / "back.png").write_bytes(glb.binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]])
        *size, back = program.png_pixels(self.folder / "back.png")
        self.assertEqual(size, [2, 2, 3])
        for old, new in zip([channel for color in colors for channel in color], back):
            self.assertLessEqual(abs(old - new), 1)
        (self.folder / "clip.glb").rename(self.folder / "first.glb")
        again = self.export(text % "first.glb")
        kept = again.json["materials"][0]["pbrMetallicRoughness"]
        for name in ("baseColorFactor", "baseColorTexture"):
            self.assertEqual(kept[name], surface[name])

    def test_colors_of_vertices(self):
        self.write("fan.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n")
        glb = self.export('format = 1\n[[body]]\ntype = "fixed"\nshape = { type = "mesh", file = "fan.obj" }\n')
        primitive, = glb.json["meshes"][0]["primitives"]
        self.assertEqual(sorted(glb.accessors[primitive["attributes"]["COLOR_0"]]), [(0, 0, 1), (0, 1, 0), (1, 0, 0)])
        self.assertNotIn("textures", glb.json)

    def test_textures_of_shapes_and_the_mean_of_a_pattern(self):
        (self.folder / "image.png").write_bytes(program.png(4, 2, (200, 40, 20)))
        glb = self.export('format = 1\n[materials.image]\ntexture = "image.png"\n'
                          '[[body]]\ntype = "fixed"\nshape = { type = "sphere", radius = 1 }\npattern = "stripes"\n'
                          'color = "#ffffff"\npattern_color = "#000000"\n'
                          '[[body]]\ntype = "fixed"\nshape = { type = "box", size = [1, 2, 3] }\nmaterial = "image"\n'
                          '[[body]]\ntype = "fixed"\nshape = { type = "box", size = [1, 2, 3] }\nmaterial = "image"\n'
                          'position = [9, 0, 0]\n'
                          '[[body]]\ntype = "fixed"\nshape = { type = "sphere", radius = 2 }\nmaterial = "image"\n'
                          'texture_scale = 1\nposition = [0, 9, 0]\n')
        self.assertEqual(len(glb.json["meshes"]), 3)  # both boxes share one
        self.assertEqual(len(glb.json["images"]), 1)
        factor = glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"]
        self.assertAlmostEqual(factor[0], 0.5, delta=0.01)
        box, ball = ([place for one in mesh["primitives"] for place in glb.accessors[one["attributes"]["TEXCOORD_0"]]]
                     for mesh in glb.json["meshes"][1:])
        self.assertEqual({place for place in box}, {(0, 0), (0, 1), (1, 0), (1, 1)})
        self.assertGreaterEqual(max(u for u, _ in ball) - min(u for u, _ in ball), 13)  # 4 pi m around, once each meter

    def test_the_same_bytes_for_any_number_of_threads(self):
        self.write("tetrahedron.obj", TETRAHEDRON)
        self.write("scene.toml", VARIED)
        for threads in (1, 2, 5):
            self.check(0, "export", "scene.toml", "-o", f"{threads}.glb", "--threads", threads)
        self.assertEqual(len({(self.folder / f"{threads}.glb").read_bytes() for threads in (1, 2, 5)}), 1)

    def test_overrides(self):
        glb = self.export(FLIGHT, "--fps", 30, "--set", "body.ball.position=[0,5,0]")
        self.assertEqual(glb.json["asset"]["extras"]["fps"], 30)
        self.assertEqual(glb.value("ball", "translation", 0.0), [0.0, 5.0, 0.0])

    def test_misuse(self):
        for message, *arguments in (("must end with .glb", "scene.toml", "-o", "clip.gltf"),
                                    ("--output", "scene.toml"),
                                    ("cubic, frames", "scene.toml", "-o", "clip.glb", "--keys", "some"),
                                    ('unknown key "masss"', "scene.toml", "-o", "clip.glb", "--set", "body.crate.masss=1"),
                                    ("missing.toml", "missing.toml", "-o", "clip.glb")):
            run = self.check(2, "export", *arguments)
            self.assertIn(message, run.stderr)
            self.assertEqual(self.names(), [])

    def test_failures_keep_the_existing_file(self):
        self.write("clip.glb", "old")
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))  # bytes of a file
        run = self.check(1, "export", "scene.toml", "-o", "clip.glb", "--quiet", preexec_fn=limit)
        self.assertIn("clip.glb", run.stderr)
        self.assertEqual((self.folder / "clip.glb").read_text(), "old")
        self.assertEqual(self.names(), ["clip.glb"])


if __name__ == "__main__":
    program.main()
