"""Meshes in the colors of their files: textures, materials and colors of vertices, in frames and in the albedo AOV."""

import base64
import json
import math
import struct

import aov_test
import program

RED, BLUE, GRAY = (200, 40, 20), (30, 60, 210), (128, 128, 128)
SIZE, SIDE = 96, 80  # pixels of the frame, and of a square of 1 m in its middle

# The eye looks straight at the square.
HEAD = f"""\
format = 1
[simulation]
duration = 0.0
[output]
size = [{SIZE}, {SIZE}]
samples = 1
[light]
direction = [0.3, -0.4, -1]
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
vertical_fov = {2 * math.degrees(math.atan(0.5 * SIZE / SIDE / 5))}
"""


def body(file, keys="", shape=""):
    return f'[[body]]\ntype = "fixed"\nshape = {{ type = "mesh", file = "{file}"{shape} }}\n{keys}\n'


def checker(cells, a=RED, b=BLUE):
    """A PNG whose texels alternate."""
    boxes = [(x, y, 1, 1, b) for y in range(cells) for x in range(cells) if (x + y) % 2]
    return program.png(cells, cells, a, boxes)


def data_uri(data):
    return "data:application/octet-stream;base64," + base64.b64encode(data).decode()


def square(image=None, repeats=1, half=0.5, sampler=None, material=None, colors=None):
    """A glTF square that faces +z, with the texture `repeats` times along each side."""
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    places = [(0, repeats), (repeats, repeats), (repeats, 0), (0, 0)]
    data = b"".join(struct.pack("<3f", x, y, 0) for x, y in corners)
    data += b"".join(struct.pack("<2f", u, v) for u, v in places)
    data += struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    attributes = {"POSITION": 0, "TEXCOORD_0": 1}
    views = [(0, 48), (48, 32), (80, 12)]
    accessors = [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                 {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                 {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}]
    if colors:
        attributes["COLOR_0"] = 3
        views.append((92, 48))
        data += b"".join(struct.pack("<3f", *c) for c in colors)
        accessors.append({"bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC3"})
    primitive = {"attributes": attributes, "indices": 2}
    document = {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}],
                "accessors": accessors, "buffers": [{"byteLength": len(data), "uri": data_uri(data)}],
                "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in views]}
    if image is not None or material is not None:
        primitive["material"] = 0
        surface = {"metallicFactor": 0, "roughnessFactor": 0.6}
        if image is not None:
            surface["baseColorTexture"] = {"index": 0}
            document["textures"] = [{"source": 0} | ({"sampler": 0} if sampler else {})]
            document["images"] = [{"uri": image if isinstance(image, str) else data_uri(image)}]
            document["samplers"] = [sampler or {}]
        document["materials"] = [{"pbrMetallicRoughness": surface} | (material or {})]
    return json.dumps(document)


def linear(level):
    c = level / 255
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def srgb(c):
    return round(255 * (12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055))


def text_of(color):
    return "#%02x%02x%02x" % tuple(color)


NEAREST = {"magFilter": 9728}


class FileColorsTest(program.ProgramTest):
    number = 0  # of the output folders so far

    def frame(self, text, scene=HEAD):
        """The frame's pixels, [row][column] = (red, green, blue), and standard error."""
        self.write("scene.toml", scene + text)
        self.number += 1
        run = self.check(0, "render", "scene.toml", "--frames", f"out{self.number}")
        width, height, channels, data = program.png_pixels(self.folder / f"out{self.number}/frame_000000.png")
        rows = [[tuple(data[(y * width + x) * channels:][:3]) for x in range(width)] for y in range(height)]
        return rows, run.stderr

    def albedo(self, text):
        self.write("scene.toml", HEAD + text)
        self.number += 1
        self.check(0, "render", "scene.toml", "--aov", "albedo", "--aov-folder", f"aov{self.number}")
        return aov_test.load(self.folder / f"aov{self.number}/aov_000000.npz")["albedo"]

    def assert_near(self, one, other, levels, where=""):
        self.assertLessEqual(max(abs(a - b) for a, b in zip(one, other)), levels, f"{one} {other} {where}")

    def test_each_texel_is_as_bright_as_a_plain_square_of_its_color(self):
        cells = 8
        self.write("a.gltf", square(checker(cells), sampler=NEAREST))
        shown, _ = self.frame(body("a.gltf"))
        plain = [self.frame(body("a.gltf", f'color = "{text_of(c)}"'))[0] for c in (RED, BLUE)]
        albedo = self.albedo(body("a.gltf"))
        per_cell, first = SIDE // cells, (SIZE - SIDE) // 2
        for y in range(first + 1, first + SIDE - 1):
            for x in range(first + 1, first + SIDE - 1):
                if 0 in ((x - first) % per_cell, (y - first) % per_cell):
                    continue  # an edge between texels may be in this pixel
                which = ((x - first) // per_cell + (y - first) // per_cell) % 2
                self.assert_near(shown[y][x], plain[which][y][x], 1, (x, y))
                self.assert_near(albedo[y, x], (RED, BLUE)[which], 1, (x, y))

    def test_a_far_texture_has_its_mean_in_linear_light(self):
        mean = tuple(srgb(0.5 * (linear(a) + linear(b))) for a, b in zip(RED, BLUE))
        for cells in (2, 6):  # an edge that is no power of two has mip maps of odd sizes
            self.write("a.gltf", square(checker(cells), repeats=480 // cells))
            self.write("plain.gltf", square())
            shown, _ = self.frame(body("a.gltf"))
            plain, _ = self.frame(body("plain.gltf", f'color = "{text_of(mean)}"'))
            for y in range(20, 76, 5):
                for x in range(20, 76, 5):
                    self.assert_near(shown[y][x], plain[y][x], 2 if cells == 6 else 1, (cells, x, y))

    def test_materials_of_an_obj_and_their_image(self):
        self.write("two.obj", "mtllib two.mtl\nv -0.5 -0.5 0\nv 0 -0.5 0\nv 0.5 -0.5 0\nv 0.5 0.5 0\nv 0 0.5 0\n"
                   "v -0.5 0.5 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl left\nf 1/1 2/2 5/3 6/4\n"
                   "usemtl right one\nf 2/1 3/2 4/3 5/4\n")
        self.write("two.mtl", "newmtl left\nKd %f %f %f\nnewmtl right one\nKd 1 1 1\nmap_Kd -s 1 1 1 C:\\maps\\my map.png\n"
                   % tuple(c / 255 for c in RED))
        # The upper half of the image is gray.
        (self.folder / "my map.png").write_bytes(program.png(4, 4, BLUE, [(0, 0, 4, 2, GRAY)]))
        albedo = self.albedo(body("two.obj"))
        self.assert_near(albedo[48, 30], RED, 1)
        self.assert_near(albedo[60, 66], BLUE, 1)
        self.assert_near(albedo[30, 66], GRAY, 1)
        shown, said = self.frame(body("two.obj"))
        self.assertGreater(shown[48][30][0], shown[48][30][2])
        self.assertLess(shown[60][66][0], shown[60][66][2])
        self.assertNotIn("image", said)
        # A color or a material of the body wins, and one that only says how it slides does not.
        for keys in ('color = "#808080"', 'material = "gray"'):
            scene = HEAD + '[materials.gray]\ncolor = "#808080"\n[materials.ice]\nfriction = 0.01\n'
            rows, _ = self.frame(body("two.obj", keys), scene)
            self.assert_near(rows[48][30], rows[48][66], 3)
        for keys in ('material = "file"', 'material = "ice"'):
            self.assertEqual(self.frame(body("two.obj", keys), scene)[0], shown)

    def test_colors_of_vertices(self):
        faces = "3 0 1 2\n3 0 2 3\n"
        self.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                   "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                   "element face 2\nproperty list uchar int vertex_indices\nend_header\n" +
                   "".join(f"{x} {y} 0 200 40 20\n" for x, y in ((-.5, -.5), (.5, -.5), (.5, .5), (-.5, .5))) + faces)
        self.write("a.obj", "".join(f"v {x} {y} 0 {200 / 255} {40 / 255} {20 / 255}\n" for x, y in
                                    ((-.5, -.5), (.5, -.5), (.5, .5), (-.5, .5))) + "f 1 2 3 4\n")
        self.write("a.gltf", square(colors=[[linear(c) for c in RED]] * 4))
        for file in ("a.ply", "a.obj", "a.gltf"):
            self.assert_near(self.albedo(body(file))[48, 48], RED, 1, file)
        self.write("blend.gltf", square(colors=[(1, 0, 0), (0, 0, 1), (0, 0, 1), (1, 0, 0)]))
        albedo = self.albedo(body("blend.gltf"))
        self.assert_near(albedo[48, 48], (srgb(0.5), 0, srgb(0.5)), 2)  # interpolated in linear light

    def test_a_mask_cuts_holes(self):
        rows = b"".join(b"\0" + (bytes(RED) + (b"\xff" if y < 2 else b"\0")) * 4 for y in range(4))
        image = (b"\x89PNG\r\n\x1a\n" + program.chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 4, 8, 6, 0, 0, 0)) +
                 program.chunk(b"IDAT", program.zlib.compress(rows)) + program.chunk(b"IEND", b""))
        self.write("a.gltf", square(image, sampler=NEAREST, material={"alphaMode": "MASK"}))
        self.write("whole.gltf", square(image, sampler=NEAREST))
        empty, _ = self.frame("")
        holes, _ = self.frame(body("a.gltf"))
        whole, _ = self.frame(body("whole.gltf"))
        self.assertEqual(holes[66][48], empty[66][48])
        self.assertEqual(holes[30][48], whole[30][48])
        self.assertNotEqual(whole[66][48], empty[66][48])

    def test_a_missing_image_is_a_note_and_a_broken_one_an_error(self):
        self.write("a.gltf", square("none.png"))
        rows, said = self.frame(body("a.gltf"))
        self.assertIn('note: mesh "a.gltf": no PNG or JPEG file for its image "none.png"', said)
        self.assertGreater(min(rows[48][48]), 150)  # white, the color of the material
        (self.folder / "broken.png").write_bytes(checker(8)[:60])
        (self.folder / "broken.jpg").write_bytes(b"\xff\xd8\xff\xe0\0\x10JFIF\0")
        for name, kind in (("broken.png", "PNG"), ("broken.jpg", "JPEG")):
            self.write("a.gltf", square(name))
            self.write("scene.toml", HEAD + body("a.gltf"))
            run = self.check(2, "render", "scene.toml", "--frames", "none")
            self.assertRegex(run.stderr, rf'scene.toml:\d+:\d+: error: mesh "a.gltf" has the image "{name}", which is not a '
                             f"whole {kind} file")
        self.assertFalse((self.folder / "none").exists())
        head = struct.pack(">IIBBBBB", 20000, 4, 8, 2, 0, 0, 0)
        (self.folder / "broken.png").write_bytes(b"\x89PNG\r\n\x1a\n" + program.chunk(b"IHDR", head) +
                                                 program.chunk(b"IDAT", b"") + program.chunk(b"IEND", b""))
        self.write("a.gltf", square("broken.png"))
        run = self.check(2, "render", "scene.toml", "--frames", "none")
        self.assertIn('"broken.png", which is too large: 20000 x 4 pixels (at most 8192 a side)', run.stderr)

    def test_images_are_inputs_and_count_for_the_scene(self):
        (self.folder / "a.png").write_bytes(checker(8))
        self.write("a.gltf", square("a.png"))
        self.write("scene.toml", HEAD + body("a.gltf"))
        run = self.check(2, "simulate", "scene.toml", "--trajectory", "a.png")
        self.assertIn("a.png", run.stderr)
        self.assertEqual((self.folder / "a.png").read_bytes(), checker(8))

        def mark():
            self.frame("", (self.folder / "scene.toml").read_text())
            data = (self.folder / f"out{self.number}/frame_000000.png").read_bytes()
            at = data.index(b"Tumble-Scene")
            return data[at:at + 80]

        before = mark()
        (self.folder / "a.png").write_bytes(checker(8, RED, GRAY))
        self.assertNotEqual(mark(), before)

    def test_the_material_file_is_for_files_with_colors(self):
        self.write("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.write("scene.toml", HEAD + body("plain.obj", 'material = "file"'))
        self.assertIn('"file" is for meshes whose files have colors', self.check(2, "info", "scene.toml").stderr)
        self.write("a.gltf", square(checker(2)))
        self.write("scene.toml", HEAD + body("a.gltf", 'material = "file"\ncolor = "#ffffff"'))
        self.assertIn('color and material = "file" exclude each other', self.check(2, "info", "scene.toml").stderr)


if __name__ == "__main__":
    program.main()
