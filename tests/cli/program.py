"""The program under test, run in a folder of its own, and small helpers to make its inputs and read its outputs."""

import csv
import os
import pathlib
import re
import shutil
import struct
import subprocess
import tempfile
import time
import unittest
import zlib

TUMBLE = os.environ["TUMBLE"]

# For tests that limit the memory of the program: a sanitizer reserves far more for itself.
limits_memory = unittest.skipIf(os.environ.get("TUMBLE_SANITIZE"), "the program is built with a sanitizer")

SCENE = """\
format = 1
title = "Two bodies"
[simulation]
duration = 0.5
steps_per_frame = 4
[output]
size = [48, 32]
fps = 10
samples = 1
[materials.crate]
color = "#c8853c"
density = 600.0
[[body]]
name = "ground"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "crate"
shape = { type = "box", size = [1.0, 1.0, 1.0] }
material = "crate"
position = [0.0, 3.0, 0.0]
angular_velocity = [1.0, 2.0, 0.5]
[[body]]
shape = { type = "sphere", radius = 0.5 }
position = [2.0, 0.5, 0.0]
"""


class ProgramTest(unittest.TestCase):
    """Each test has an empty folder, self.folder, in which the program runs; scene.toml is in it."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="tumble-cli-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.write("scene.toml", SCENE)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def started(self, *arguments):
        """A run that would take minutes and writes its frames to out/, once the first of them are there."""
        run = subprocess.Popen([TUMBLE, *arguments], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        deadline = time.monotonic() + 60
        while not (self.folder / "out/frame_000003.png").exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertIsNone(run.poll(), "it ended early")
        return run

    def run_tumble(self, *arguments, **options):
        """The finished run: returncode, stdout, stderr."""
        options.setdefault("timeout", 300)
        return subprocess.run([TUMBLE, *map(str, arguments)], cwd=self.folder, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)

    def check(self, code, *arguments, **options):
        """Runs, and expects that exit code."""
        run = self.run_tumble(*arguments, **options)
        self.assertEqual(run.returncode, code, f"{arguments}\n{run.stdout}\n{run.stderr}")
        return run

    def names(self):
        """All files and folders except the scene and the manifests beside frames."""
        return sorted(str(p.relative_to(self.folder)) for p in self.folder.rglob("*")
                      if p.name not in ("scene.toml", "frames.json", "aovs.json"))

    def rows(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))


def probe(path, entries):
    """ffprobe's values of the first video stream, as a list of texts in ffprobe's order of entries."""
    out = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-select_streams", "v", "-show_entries",
                          "stream=" + entries, "-of", "default=nw=1:nk=1", path],
                         stdout=subprocess.PIPE, text=True, check=True)
    return out.stdout.split()


def unmarked(path):
    """The bytes of a frame or of its AOVs without the mark of scene and settings, to compare those of different ones."""
    data = pathlib.Path(path).read_bytes()
    if data.startswith(b"PK"):
        return data[:data.index(b"Tumble-Scene ")]
    at = data.index(b"tEXtTumble-Scene") - 4
    return data[:at] + data[at + 12 + int.from_bytes(data[at:at + 4], "big"):]


def chunk(kind, data):
    """Width and height of a PNG."""
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, color=(120, 120, 120), boxes=()):
    """The bytes of a PNG: plain, with boxes (left, top, width, height, color)."""
    rows = []
    for y in range(height):
        row = bytearray(bytes(color) * width)
        for left, top, w, h, c in boxes:
            if top <= y < top + h:
                row[3 * left:3 * (left + w)] = bytes(c) * w
        rows.append(b"\0" + bytes(row))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(b"".join(rows), 1)) +
            chunk(b"IEND", b""))


def png_size(path):
    data = pathlib.Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and data[-8:-4] == b"IEND", f"{path} is no whole PNG"
    return struct.unpack(">II", data[16:24])


def png_pixels(path):
    """Width, height, channels and the bytes of the pixels of a PNG as the program writes it: rows without filter or by Sub."""
    data = pathlib.Path(path).read_bytes()
    width, height = png_size(path)
    channels = {b"\x08\x02": 3, b"\x08\x06": 4}[data[24:26]]
    packed, place = b"", 8
    while place < len(data):
        size = int.from_bytes(data[place:place + 4], "big")
        if data[place + 4:place + 8] == b"IDAT":
            packed += data[place + 8:place + 8 + size]
        place += 12 + size
    rows, pixels = zlib.decompress(packed), bytearray()
    for y in range(height):
        start = y * (channels * width + 1)
        row = bytearray(rows[start + 1:start + 1 + channels * width])
        assert rows[start] in (0, 1), rows[start]
        if rows[start] == 1:
            for i in range(channels, len(row)):
                row[i] = (row[i] + row[i - channels]) & 255
        pixels += row
    return width, height, channels, bytes(pixels)


def frame_names(count):
    return [f"frame_{n:06}.png" for n in range(count)]


def located(message):
    """Whether a message begins FILE:LINE:COLUMN: error:"""
    return re.match(r"[^:\n]+:\d+:\d+: error: .", message) is not None


def main():
    unittest.main(verbosity=2)
