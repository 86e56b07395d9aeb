"""AOVs: files of `tumble render --aov`, read as a user would (np.load without NumPy), compared with closed forms."""

import ast
import io
import math
import resource
import struct
import zipfile

import program

ALL = ["depth", "normal", "segmentation", "motion", "albedo"]


class Array:
    """An .npy file's shape and values; [row, column] is a pixel's."""

    KINDS = {"<f4": "f", "<f8": "d", "<i4": "i", "|u1": "B"}

    def __init__(self, data):
        assert data[:8] == b"\x93NUMPY\x01\0", data[:8]
        end = 10 + struct.unpack("<H", data[8:10])[0]
        head = ast.literal_eval(data[10:end].decode())
        self.kind, self.shape = head["descr"], head["shape"]
        self.values = struct.unpack(f"<{(len(data) - end) // struct.calcsize(self.KINDS[self.kind])}{self.KINDS[self.kind]}",
                                    data[end:])

    def __getitem__(self, place):
        channels = self.shape[2] if len(self.shape) > 2 else 1
        at = (place[0] * self.shape[1] + place[1]) * channels
        return self.values[at] if channels == 1 else self.values[at:at + channels]


def load(path):
    with zipfile.ZipFile(io.BytesIO(path.read_bytes())) as archive:
        assert archive.testzip() is None
        return {name.removesuffix(".npy"): Array(archive.read(name)) for name in archive.namelist()}


def aov_names(count):
    return [f"aov_{n:06}.npz" for n in range(count)]


# The eye is 2 m over the ground and looks along -z; a box of 1 m falls, its front face 4 m from the eye.
SCENE = """\
format = 1
[simulation]
duration = 0.3
steps_per_frame = 64
integrator = "exact"
[output]
size = [64, 48]
fps = 10
[camera]
eye = [0, 2, 4.5]
target = [0, 2, 0]
vertical_fov = 60
[[body]]
name = "ground"
type = "fixed"
shape = { type = "plane" }
color = "#102030"
[[body]]
name = "crate, small"
shape = { type = "box", size = [1, 1, 1] }
position = [0, 2.2, 0]
color = "#c8853c"
"""


class Aovs(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)

    def loaded(self, folder, frame):
        return load(self.folder / folder / f"aov_{frame:06}.npz")

    def test_values_against_closed_form(self):
        run = self.check(0, "render", "scene.toml", "--frames", "out", "--aov", ",".join(ALL))
        self.assertEqual(sorted(p.name for p in (self.folder / "out").iterdir()),
                         sorted(program.frame_names(4) + aov_names(4) + ["aovs.json", "frames.json", "segmentation.csv"]))
        self.assertIn("wrote out/aov_000000.npz to aov_000003.npz: depth, normal, segmentation, motion, albedo\n", run.stderr)
        focal = 24 / math.tan(math.radians(30))
        for frame in range(4):
            a = self.loaded("out", frame)
            self.assertEqual(sorted(a), sorted(ALL + ["intrinsics", "camera_to_world"]))
            self.assertEqual([a[name].shape for name in ALL], [(48, 64), (48, 64, 3), (48, 64), (48, 64, 2), (48, 64, 3)])
            for value, expected in zip(a["intrinsics"].values, [focal, 0, 31.5, 0, focal, 23.5, 0, 0, 1]):
                self.assertAlmostEqual(value, expected, delta=1e-12 * focal)
            self.assertEqual(a["camera_to_world"].values, (1, 0, 0, 0, 0, -1, 0, 2, 0, 0, -1, 4.5, 0, 0, 0, 1))
            fallen = 9.81 / 2 * (frame / 10) ** 2
            bottom = 23.5 + focal * (2 - (1.7 - fallen)) / 4   # of the front face, rows
            for row in range(48):
                for column in (0, 31, 40):
                    place = (row, column)
                    slope = (row - 23.5) / focal
                    top = bottom - focal / 4
                    if column == 31 and top + 0.01 < row < bottom - 0.01:
                        next_fallen = 9.81 / 2 * ((frame + 1) / 10) ** 2
                        self.assertEqual((a["segmentation"][place], a["depth"][place]), (2, 4.0))
                        self.assertEqual((a["normal"][place], a["albedo"][place]), ((0, 0, 1), (0xc8, 0x85, 0x3c)))
                        self.assertAlmostEqual(a["motion"][place][0], 0, delta=1e-6)
                        self.assertAlmostEqual(a["motion"][place][1], focal * (next_fallen - fallen) / 4, delta=1e-5)
                    elif column == 0 and slope > 0:
                        self.assertAlmostEqual(a["depth"][place], 2 / slope, delta=1e-7 * 2 / slope)
                        self.assertEqual((a["segmentation"][place], a["normal"][place]), (1, (0, 1, 0)))
                        self.assertEqual((a["motion"][place], a["albedo"][place]), ((0, 0), (0x10, 0x20, 0x30)))
                    elif column == 0:
                        self.assertEqual((a["segmentation"][place], a["depth"][place]), (0, math.inf))
                        self.assertEqual((a["normal"][place], a["motion"][place], a["albedo"][place]),
                                         ((0, 0, 0), (0, 0), (0, 0, 0)))
        self.assertEqual(self.rows("out/segmentation.csv"),
                         [{"id": "0", "kind": "background", "index": "", "name": ""},
                          {"id": "1", "kind": "body", "index": "0", "name": "ground"},
                          {"id": "2", "kind": "body", "index": "1", "name": "crate, small"}])

    def test_pieces_name_their_whole(self):
        pane = """[[body]]
name = "pane, old"
shape = { type = "box", size = [1, 1, 0.1] }
position = [0, 4, 0]
density = 2500
strength = 1e4
stiffness = 1e9
fracture = { cells = 2, pattern = "slabs" }
"""
        self.write("pane.toml", SCENE.replace('"exact"', '"splitting"') + pane)
        self.check(0, "render", "pane.toml", "--aov", "segmentation", "--aov-folder", "out", "--duration", "0")
        rows = self.rows("out/segmentation.csv")
        self.assertEqual(list(rows[0]), ["id", "kind", "index", "name", "parent"])
        self.assertEqual([row["name"] for row in rows], ["", "ground", "crate, small", "pane, old", "pane, old/0", "pane, old/1"])
        self.assertEqual([row["parent"] for row in rows], ["", "", "", "", "pane, old", "pane, old"])

    def test_without_pictures(self):
        run = self.check(0, "render", "scene.toml", "--aov", "depth,motion", "--aov-folder", "values")
        self.assertEqual(self.names(), ["values"] + ["values/" + name for name in aov_names(4)])
        self.assertIn("0 drawn", run.stderr)
        self.assertEqual(sorted(self.loaded("values", 3)), ["camera_to_world", "depth", "intrinsics", "motion"])

    def test_older_files_are_noted(self):
        self.check(0, "render", "scene.toml", "--aov", "depth", "--aov-folder", "values")
        run = self.check(0, "render", "scene.toml", "--aov", "depth", "--aov-folder", "values", "--duration", "0.1")
        self.assertIn("2 older AOVs are still in the folder, from values/aov_000002.npz on", run.stderr)

    def test_beside_a_clip_and_in_a_folder_of_their_own(self):
        self.check(0, "render", "scene.toml", "-o", "a.mp4", "--frames", "frames", "--aov", "segmentation",
                   "--aov-folder", "values")
        self.assertEqual(self.names(), ["a.mp4", "frames"] + ["frames/" + name for name in program.frame_names(4)] +
                         ["values"] + ["values/" + name for name in aov_names(4)] + ["values/segmentation.csv"])

    def test_workers_and_pictures_change_no_byte(self):
        options = ("--aov", ",".join(ALL), "--duration", "1.5")
        self.check(0, "render", "scene.toml", "--frames", "plain", "-o", "plain.mp4", "--duration", "1.5", "--variable-rate")
        for workers in (1, 2, 3):
            name = f"w{workers}"
            self.check(0, "render", "scene.toml", "--frames", name, "-o", name + ".mp4", "--workers", workers,
                       "--variable-rate", *options)
            for frame in program.frame_names(16):
                self.assertEqual((self.folder / "plain" / frame).read_bytes(), (self.folder / name / frame).read_bytes())
            for frame in aov_names(16):
                self.assertEqual((self.folder / "w1" / frame).read_bytes(), (self.folder / name / frame).read_bytes())
            self.assertEqual((self.folder / "plain.mp4").read_bytes(), (self.folder / (name + ".mp4")).read_bytes())
        self.check(0, "render", "scene.toml", "--aov-folder", "alone", *options)
        for frame in aov_names(16):
            self.assertEqual((self.folder / "w1" / frame).read_bytes(), (self.folder / "alone" / frame).read_bytes())

    def test_blur_and_slow_motion(self):
        self.check(0, "render", "scene.toml", "--frames", "sharp", "--aov", "depth,motion")
        self.check(0, "render", "scene.toml", "--frames", "blurred", "--aov", "depth,motion", "--shutter", "180")
        for frame in range(4):   # values at the time when the shutter opens
            sharp, blurred = self.loaded("sharp", frame), self.loaded("blurred", frame)
            self.assertEqual(sharp["depth"].values, blurred["depth"].values)
            for a, b in zip(sharp["motion"].values, blurred["motion"].values):
                self.assertAlmostEqual(a, b, delta=1e-5)
        self.check(0, "render", "scene.toml", "--aov", "depth,motion", "--aov-folder", "slow", "--speed", "0.5")
        for frame in range(4):
            self.assertEqual(self.loaded("sharp", frame)["depth"].values, self.loaded("slow", 2 * frame)["depth"].values)
        fallen = [9.81 / 2 * (n / 20) ** 2 for n in (0, 1)]
        self.assertAlmostEqual(self.loaded("slow", 0)["motion"][24, 31][1],
                               24 / math.tan(math.radians(30)) * (fallen[1] - fallen[0]) / 4, delta=1e-5)

    def test_wrong_usage(self):
        listed = "(known: depth, normal, segmentation, motion, albedo)"
        for names, wrong in (("dept", "dept"), ("depth,Normal", "Normal"), ("depth,", ""), ("", ""),
                             ("depth normal", "depth normal")):
            run = self.check(2, "render", "scene.toml", "--frames", "out", "--aov", names)
            self.assertIn(f"error: --aov: unknown name '{wrong}' {listed}", run.stderr)
        run = self.check(2, "render", "scene.toml", "-o", "a.mp4", "--aov", "depth")
        self.assertIn("needs --frames or --aov-folder", run.stderr)
        run = self.check(2, "render", "scene.toml", "--frames", "out", "--aov-folder", "values")
        self.assertIn("--aov-folder: needs --aov", run.stderr)
        self.assertEqual(self.names(), [])

    def test_nowhere_to_write(self):
        self.write("file", "")
        run = self.check(1, "render", "scene.toml", "--aov", "depth", "--aov-folder", "file/out")
        self.assertIn("error: cannot make the folder 'file/out'", run.stderr)
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))
        run = self.check(1, "render", "scene.toml", "--aov", "depth,normal", "--aov-folder", "out", "--size", "640x400",
                         preexec_fn=limit)
        self.assertEqual(run.stderr, "error: cannot write 'out/aov_000000.npz': File too large\n")
        self.assertEqual(self.names(), ["file"])


if __name__ == "__main__":
    program.main()
