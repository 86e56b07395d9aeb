"""Targets of outputs: standard output and other descriptors, links, names of inputs, long names, folders in use, and
left-overs of killed runs."""

import fcntl
import json
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import time

import program

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
MESH_SCENE = program.SCENE + '[[body]]\nshape = { type = "mesh", file = "models/part.obj" }\nposition = [0.0, 9.0, 0.0]\n'


class Descriptors(program.ProgramTest):
    def run_into(self, stream, *arguments, code=0):
        """Runs with a file that holds "old" as that descriptor, open for appending; returns what it holds then."""
        path = self.folder / "log"
        path.write_bytes(b"old\n")
        script = 'exec "$@" ' + f"{stream}>> log"
        run = subprocess.run(["/bin/bash", "-c", script, "sh", program.TUMBLE, *map(str, arguments)], cwd=self.folder,
                             text=True, stderr=subprocess.PIPE, timeout=300)
        self.assertEqual(run.returncode, code, f"{arguments}\n{run.stderr}")
        return path.read_bytes()

    def test_tables_are_appended(self):
        self.check(0, "simulate", "scene.toml", "--energy", "e.csv")
        expected = b"old\n" + (self.folder / "e.csv").read_bytes()
        (self.folder / "link").symlink_to("/dev/stdout")
        (self.folder / "other").symlink_to("link")
        (self.folder / "third").symlink_to("/dev/fd/3")
        for stream, names in (("1", ("-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", "/proc/thread-self/fd/1", "link",
                                     "other")),
                              ("3", ("/dev/fd/3", "third"))):
            for name in names:
                with self.subTest(name=name):
                    self.assertEqual(self.run_into(stream, "simulate", "scene.toml", "--quiet", "--energy", name), expected)
        self.assertTrue((self.folder / "link").is_symlink())
        self.assertEqual(self.names(), ["e.csv", "link", "log", "other", "third"])

    def test_clips_are_appended(self):
        for name in ("a.mkv", "a.webm", "a.gif"):
            (self.folder / name).symlink_to("/dev/stdout")
            found = self.run_into("1", "render", "scene.toml", "-o", name)
            self.assertEqual(found[:4], b"old\n")
            (self.folder / ("cut_" + name)).write_bytes(found[4:])
            self.assertEqual(program.probe(self.folder / ("cut_" + name), "nb_read_frames"), ["6"])
        for name in ("a.mp4", "a.mov"):
            (self.folder / name).symlink_to("/dev/stdout")
            self.assertEqual(self.run_into("1", "render", "scene.toml", "-o", name, code=2), b"old\n")

    def test_pictures_are_appended(self):
        (self.folder / "a.png").write_bytes(program.png(8, 8))
        (self.folder / "d.png").symlink_to("/dev/fd/5")
        found = self.run_into("5", "compare", "a.png", "a.png", "--diff", "d.png")
        self.assertTrue(found.startswith(b"old\n\x89PNG"))

    def test_a_descriptor_that_is_not_open(self):
        for name in ("/dev/fd/7", "/proc/self/fd/7"):   # nor one that the program has opened meanwhile
            run = self.check(1, "simulate", "scene.toml", "--trajectory", "t.csv", "--energy", name)
            self.assertIn(f"cannot write '{name}': Bad file descriptor", run.stderr)
            self.assertEqual(self.names(), [])

    def test_a_descriptor_that_is_open_for_reading(self):
        with open("/dev/null", "rb") as nothing:
            run = self.check(1, "simulate", "scene.toml", "--energy", "/dev/fd/0", stdin=nothing)
        self.assertIn("cannot write '/dev/fd/0': Bad file descriptor", run.stderr)

    # The link of a descriptor of another process names a file, which must not be replaced either.
    def test_a_descriptor_of_another_process(self):
        log = self.folder / "log"
        log.write_text("old\n")
        with open(log, "a") as file:
            name = f"/proc/{os.getpid()}/fd/{file.fileno()}"
            self.check(0, "simulate", "scene.toml", "--energy", name)
        self.assertTrue(log.read_text().startswith("old\nframe,time,"))

    def test_a_reader_that_stops_can_be_left(self):
        run = subprocess.Popen([program.TUMBLE, "simulate", "scene.toml", "--duration", "60", "--trajectory", "-"],
                               cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(run.kill)
        self.assertTrue(run.stdout.read(1))   # and no more, so that the pipe fills up
        time.sleep(0.5)
        self.assertIsNone(run.poll(), "it waits for the reader")
        run.send_signal(signal.SIGINT)
        self.assertIn(b"interrupted", run.stderr.read())
        self.assertEqual(run.wait(timeout=20), 1)
        run.stdout.close()
        run.stderr.close()


class OneFile(program.ProgramTest):
    def contents(self):
        return {str(path.relative_to(self.folder)): os.readlink(path) if path.is_symlink() else path.read_bytes()
                for path in self.folder.rglob("*") if path.is_symlink() or path.is_file()}

    def refused(self, *arguments, said=""):
        before = self.contents()
        with self.subTest(arguments=arguments):
            run = self.check(2, *arguments)
            self.assertIn(said, run.stderr)
            self.assertEqual(self.contents(), before)

    def test_two_tables(self):
        (self.folder / "in").mkdir()
        (self.folder / "again").symlink_to("in")
        (self.folder / "link.csv").symlink_to("e.csv")
        (self.folder / "deep.csv").symlink_to("again/../in/x.csv")
        (self.folder / "tty.csv").symlink_to("/dev/stdout")
        for energy, trajectory in (("e.csv", "link.csv"), ("link.csv", "e.csv"), ("in/e.csv", "again/e.csv"),
                                   ("deep.csv", "in/x.csv"), ("-", "tty.csv"), ("-", "/dev/fd/1"), ("-", "-")):
            self.refused("simulate", "scene.toml", "--energy", energy, "--trajectory", trajectory, said="must be two files")
        self.write("e.csv", "old")
        self.refused("simulate", "scene.toml", "--energy", "e.csv", "--trajectory", "link.csv", said="must be two files")
        os.link(self.folder / "e.csv", self.folder / "hard.csv")
        self.refused("simulate", "scene.toml", "--energy", "e.csv", "--trajectory", "hard.csv", said="must be two files")

    def test_a_table_among_checkpoints(self):
        for table in ("states/clip.tumble", "states/checkpoint_000002.tumble", "./states/motion_000000.tumble", "states"):
            for option in ("--energy", "--trajectory", "--contacts"):
                self.refused("simulate", "scene.toml", "--checkpoints", "states", option, table, said="must be two files")
        self.check(0, "simulate", "scene.toml", "--checkpoints", "states")
        self.check(0, "simulate", "scene.toml", "--checkpoints", "states", "--energy", "states/energy.csv")
        self.refused("simulate", "scene.toml", "--checkpoints", "states", "--energy", "states/clip.tumble", said="must be two files")

    def test_standard_output_may_be_a_file_that_is_named_too(self):
        with open(self.folder / "t.csv", "wb") as file:
            run = subprocess.run([program.TUMBLE, "simulate", "scene.toml", "--energy", "-", "--trajectory", "t.csv"],
                                 cwd=self.folder, stdout=file, stderr=subprocess.PIPE, timeout=300)
        self.assertEqual(run.returncode, 2)
        self.assertIn(b"must be two files", run.stderr)

    def test_the_null_device_may_be_several_outputs(self):
        self.check(0, "simulate", "scene.toml", "--energy", "/dev/null", "--trajectory", "/dev/null")

    def test_outputs_that_are_read(self):
        (self.folder / "models").mkdir()
        self.write("models/part.obj", TRIANGLE)
        self.write("mesh.toml", MESH_SCENE)
        (self.folder / "a.mp4").symlink_to("models/part.obj")
        (self.folder / "b.mkv").symlink_to("mesh.toml")
        (self.folder / "out").mkdir()
        (self.folder / "out/frame_000002.png").symlink_to("../models/part.obj")
        (self.folder / "out/aov_000002.npz").symlink_to("../mesh.toml")
        (self.folder / "out/segmentation.csv").symlink_to("../mesh.toml")
        said = "is read"
        self.refused("simulate", "mesh.toml", "--energy", "models/part.obj", said=said)
        self.refused("simulate", "mesh.toml", "--trajectory", "./models/../mesh.toml", said=said)
        self.refused("render", "mesh.toml", "-o", "a.mp4", said=said)
        self.refused("render", "mesh.toml", "-o", "b.mkv", said=said)
        self.refused("render", "mesh.toml", "--frames", "out", said=said)
        self.refused("render", "mesh.toml", "--aov", "depth", "--aov-folder", "out", said=said)
        self.refused("render", "mesh.toml", "--aov", "segmentation", "--aov-folder", "out", said=said)
        self.check(0, "render", "mesh.toml", "--frames", "out", "--duration", "0.1")   # frame 2 is not written
        with open(self.folder / "scene.toml", "rb") as scene:   # as standard input
            run = self.check(2, "simulate", "/dev/stdin", "--energy", "scene.toml", stdin=scene)
            self.assertIn(said, run.stderr)

    def test_a_scene_among_the_frames(self):
        (self.folder / "out").mkdir()
        self.write("out/frame_000003.png", program.SCENE)
        self.refused("render", "out/frame_000003.png", "--frames", "out", said="is read")

    def test_a_file_of_poses(self):
        self.write("rows.csv", "x,y,z\n0,9,0\n")
        self.write("posed.toml", program.SCENE + '[[body]]\nshape = { type = "sphere", radius = 0.2 }\nposes = "rows.csv"\n')
        (self.folder / "link.csv").symlink_to("rows.csv")
        for option, file in (("--energy", "rows.csv"), ("--trajectory", "link.csv"), ("--contacts", "./rows.csv")):
            self.refused("simulate", "posed.toml", option, file, said="rows.csv")
        self.check(0, "simulate", "posed.toml", "--energy", "e.csv")

    def test_buffers_of_a_mesh(self):
        positions = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)
        indices = struct.pack("<12H", 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3)
        (self.folder / "part.bin").write_bytes(positions + indices)
        document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "buffers": [{"uri": "part.bin", "byteLength": 72}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0],
                           "max": [1, 1, 1]},
                          {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}]}
        self.write("part.gltf", json.dumps(document))
        self.write("gltf.toml", program.SCENE + '[[body]]\nshape = { type = "mesh", file = "part.gltf" }\n'
                                                'position = [0.0, 9.0, 0.0]\n')
        self.refused("simulate", "gltf.toml", "--energy", "part.bin", said="is read")

    def test_outputs_among_the_frames(self):
        (self.folder / "out").mkdir()
        (self.folder / "a.mp4").symlink_to("out/frame_000002.png")   # does not exist yet
        self.refused("render", "scene.toml", "-o", "a.mp4", "--frames", "out", said="must be two files")
        (self.folder / "b.mp4").symlink_to("new/frame_000002.png")
        self.refused("render", "scene.toml", "-o", "b.mp4", "--frames", "new", said="must be two files")
        self.refused("render", "scene.toml", "-o", "c.mp4", "--frames", "c.mp4", said="must be two files")
        (self.folder / "out/frame_000001.png").symlink_to("frame_000004.png")
        self.refused("render", "scene.toml", "--frames", "out", said="must be two files")
        (self.folder / "out/frame_000004.png").write_text("old")
        self.refused("render", "scene.toml", "--frames", "out", said="must be two files")
        (self.folder / "out/aov_000000.npz").symlink_to("frame_000005.png")
        (self.folder / "out/frame_000001.png").unlink()
        self.refused("render", "scene.toml", "--frames", "out", "--aov", "depth", said="must be two files")
        self.check(0, "render", "scene.toml", "--frames", "out")
        os.link(self.folder / "out/frame_000001.png", self.folder / "hard")   # two names of one frame: no harm
        (self.folder / "out/frame_000003.png").unlink()
        os.rename(self.folder / "hard", self.folder / "out/frame_000003.png")
        self.check(0, "render", "scene.toml", "--frames", "out")

    def test_frames_that_are_encoded(self):
        (self.folder / "in").mkdir()
        for name in program.frame_names(2):
            (self.folder / "in" / name).write_bytes(program.png(8, 8))
        (self.folder / "a.mp4").symlink_to("in/frame_000001.png")
        self.refused("encode", "in", "-o", "a.mp4", said="is read")

    def test_pictures_that_are_compared(self):
        (self.folder / "a.png").write_bytes(program.png(8, 8))
        (self.folder / "b.png").write_bytes(program.png(8, 8))
        (self.folder / "d.png").symlink_to("b.png")
        self.refused("compare", "a.png", "b.png", "--diff", "d.png", said="is read")

    def test_link_loops(self):
        (self.folder / "in").mkdir()
        (self.folder / "in/frame_000000.png").write_bytes(program.png(8, 8))
        (self.folder / "out").mkdir()
        for name in ("a.csv", "a.mp4", "a.gif", "a.png", "out/frame_000000.png"):
            (self.folder / name).symlink_to(pathlib.Path(name).name)
        said = "its links form a loop"
        self.refused("simulate", "scene.toml", "--energy", "a.csv", said=said)
        self.refused("render", "scene.toml", "-o", "a.mp4", said=said)
        self.refused("render", "scene.toml", "-o", "a.gif", said=said)
        self.refused("render", "scene.toml", "--frames", "out", said=said)
        self.refused("encode", "in", "-o", "a.mp4", said=said)
        self.refused("compare", "in/frame_000000.png", "in/frame_000000.png", "--diff", "a.png", said=said)


class Names(program.ProgramTest):
    def test_the_longest(self):
        (self.folder / "a.png").write_bytes(program.png(8, 8))
        limit = os.pathconf(self.folder, "PC_NAME_MAX")
        for size in (231, 240, limit - 1, limit):
            for letter in ("n", "ö"):
                def name(ending):
                    stem = letter * ((size - len(ending)) // len(letter.encode()))
                    return "x" * (size - len(ending) - len(stem.encode())) + stem + ending
                with self.subTest(size=size, letter=letter):
                    self.check(0, "simulate", "scene.toml", "--energy", name(".csv"))
                    self.check(0, "compare", "a.png", "a.png", "--diff", name(".png"))
                    self.check(0, "render", "scene.toml", "-o", name(".mp4"), "--duration", "0")
                    self.check(0, "render", "scene.toml", "-o", name(".gif"), "--duration", "0")
                    self.check(0, "render", "scene.toml", "--frames", name(""), "--duration", "0")
                    self.assertEqual(self.names(), sorted(["a.png", name(".csv"), name(".png"), name(".mp4"), name(".gif"),
                                                           name(""), name("") + "/frame_000000.png"]))
                    for path in self.folder.iterdir():
                        if path.name not in ("a.png", "scene.toml"):
                            shutil.rmtree(path) if path.is_dir() else path.unlink()

    def unprivileged(self, *arguments, code):
        """Runs as a user without root's permissions."""
        drop = ["setpriv", "--bounding-set=-dac_override,-dac_read_search"] if os.geteuid() == 0 else []
        run = subprocess.run([*drop, program.TUMBLE, *arguments], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, timeout=300)
        self.assertEqual(run.returncode, code, f"{arguments}\n{run.stderr}")
        return run.stderr

    def test_permission_denied(self):
        locked = self.folder / "locked"
        (locked / "in").mkdir(parents=True)
        (locked / "in/frame_000000.png").write_bytes(program.png(8, 8))
        (self.folder / "in").mkdir()
        for name in ("scene.toml", "part.obj", "part.ply"):
            shutil.copy(self.folder / "scene.toml", locked / name)
            shutil.copy(self.folder / "scene.toml", self.folder / ("closed." + name))
            (self.folder / ("closed." + name)).chmod(0)
        for ending in ("obj", "ply"):
            for place in ("locked/part.", "closed.part."):
                self.write(f"{place[:6]}.{ending}.toml", f'format = 1\n[[body]]\nshape = {{ type = "mesh", file = "{place}{ending}" }}\n')
        (self.folder / "in/frame_000000.png").write_bytes(program.png(8, 8))
        (self.folder / "in/frame_000000.png").chmod(0)
        (self.folder / "unwritable").mkdir(mode=0o555)
        (self.folder / "unreadable").mkdir(mode=0o333)
        locked.chmod(0)
        self.addCleanup(locked.chmod, 0o755)
        for code, *arguments in ((2, "info", "locked/scene.toml"), (2, "info", "closed.scene.toml"),
                                 (2, "info", "locked.obj.toml"), (2, "info", "closed.obj.toml"),
                                 (2, "info", "locked.ply.toml"), (2, "info", "closed.ply.toml"),
                                 (2, "encode", "locked/in", "-o", "a.mp4"), (2, "encode", "in", "-o", "a.mp4"),
                                 (2, "compare", "in/frame_000000.png", "in/frame_000000.png"),
                                 (1, "simulate", "scene.toml", "--energy", "locked/e.csv"),
                                 (1, "simulate", "scene.toml", "--energy", "unwritable/e.csv"),
                                 (1, "render", "scene.toml", "-o", "locked/a.mp4"),
                                 (1, "render", "scene.toml", "-o", "unwritable/a.gif"),
                                 (1, "render", "scene.toml", "--frames", "unwritable"),
                                 (1, "render", "scene.toml", "--frames", "unwritable/out"),
                                 (1, "render", "scene.toml", "--frames", "locked/out"),
                                 (1, "render", "scene.toml", "--frames", "locked/out/deep"),
                                 (1, "render", "scene.toml", "--aov", "depth", "--aov-folder", "unwritable/out/deep"),
                                 (2, "render", "scene.toml", "--frames", "unreadable")):
            with self.subTest(arguments=arguments):
                self.assertIn("Permission denied", self.unprivileged(*arguments, code=code))


class Runs(program.ProgramTest):
    def started(self, *arguments):
        return super().started("render", "scene.toml", "--duration", "5000", "--size", "160x120", *arguments)

    def hidden(self):
        return [name for name in self.names() if pathlib.Path(name).name.startswith(".")]

    def until_unlocked(self, names):
        """Waits for ffmpeg: it holds the lock of its output until it has ended, a moment after its input has."""
        for name in names:
            with open(self.folder / name, "rb") as part:
                deadline = time.monotonic() + 60
                while time.monotonic() < deadline:
                    try:
                        fcntl.flock(part, fcntl.LOCK_EX | fcntl.LOCK_NB)
                        break
                    except BlockingIOError:
                        time.sleep(0.01)

    def test_left_overs_of_a_killed_run_are_removed(self):
        for clip, parts in (("a.gif", 2), ("a.mkv", 1)):
            run = self.started("-o", clip, "--frames", "out", "--aov", "depth")
            self.write(".unlike." + clip + ".tumble.part-00000000", "")   # of another name
            run.kill()
            run.wait()
            left = self.hidden()
            self.until_unlocked(left)
            self.assertGreaterEqual(len([name for name in left if name.startswith("." + clip)]), parts, left)
            self.check(0, "render", "scene.toml", "-o", clip, "--frames", "out", "--aov", "depth", "--duration", "0")
            self.assertEqual(self.hidden(), [".unlike." + clip + ".tumble.part-00000000"])
            (self.folder / (".unlike." + clip + ".tumble.part-00000000")).unlink()
            shutil.rmtree(self.folder / "out")

    def test_left_overs_of_a_killed_simulation_are_removed(self):
        run = subprocess.Popen([program.TUMBLE, "simulate", "scene.toml", "--trajectory", "t.csv", "--duration", "1e5"],
                               cwd=self.folder, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while not self.hidden() and time.monotonic() < deadline:
            time.sleep(0.01)
        run.kill()
        run.wait()
        self.assertEqual(len(self.hidden()), 1)
        self.check(0, "simulate", "scene.toml", "--energy", "t.csv")
        self.assertEqual(self.names(), ["t.csv"])

    def test_files_of_a_living_run_stay(self):
        run = self.started("-o", "a.mkv", "--frames", "out")
        parts = [name for name in self.hidden() if name.startswith(".a.mkv")]
        self.assertEqual(len(parts), 1)
        self.check(0, "render", "scene.toml", "-o", "a.mkv")
        self.assertIn(parts[0], self.hidden())
        run.kill()
        run.wait()
        self.check(0, "render", "scene.toml", "-o", "a.mkv")
        self.assertNotIn(parts[0], self.hidden())

    def test_a_folder_in_use(self):
        (self.folder / "again").symlink_to("out")
        run = self.started("--frames", "out")
        for arguments in (["--frames", "out"], ["--frames", "again/"], ["--aov", "depth", "--aov-folder", "out"],
                          ["-o", "b.mp4", "--frames", "./out"]):
            second = self.check(1, "render", "scene.toml", "--duration", "0", *arguments)
            self.assertIn("another run is writing frames there", second.stderr)
            self.assertIn(f"'{arguments[-1]}'", second.stderr)
        self.assertIsNone(run.poll(), "the first goes on")
        self.assertFalse((self.folder / "b.mp4").exists())
        self.check(0, "render", "scene.toml", "--frames", "other", "--duration", "0")
        run.kill()
        run.wait()
        self.check(0, "render", "scene.toml", "--frames", "out", "--duration", "0")   # it is free at once
        self.assertEqual(self.hidden(), [])

    def test_one_folder_for_frames_and_aovs(self):
        self.check(0, "render", "scene.toml", "--frames", "out", "--aov", "depth", "--aov-folder", "./out", "--duration", "0")
        self.assertEqual(self.names(), ["out", "out/aov_000000.npz", "out/frame_000000.png"])


if __name__ == "__main__":
    program.main()
