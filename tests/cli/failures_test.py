"""Failures of the environment: no ffmpeg, no space, no folder, Ctrl-C, a kill. No unfinished file may be left under its
final name, and the exit code is 1."""

import os
import pathlib
import resource
import shutil
import signal
import struct
import subprocess
import time

import program


FFMPEG = shutil.which("ffmpeg")


class Failures(program.ProgramTest):
    def without_ffmpeg(self):
        (self.folder / "bin").mkdir(exist_ok=True)
        return {**os.environ, "PATH": str(self.folder / "bin")}

    def with_ffmpeg(self, script):
        environment = self.without_ffmpeg()
        fake = self.folder / "bin/ffmpeg"
        fake.write_text("#!/bin/sh\n" + script + "\n")
        fake.chmod(0o755)
        return environment

    def left(self):
        return [name for name in self.names() if not name.startswith("bin")]

    def test_no_ffmpeg(self):
        for command in (["render", "scene.toml", "-o", "a.mp4", "--frames", "out"], ["render", "scene.toml"]):
            run = self.check(1, *command, env=self.without_ffmpeg())
            self.assertIn("apt-get install ffmpeg", run.stderr)
            self.assertEqual(self.left(), [])
        self.check(0, "render", "scene.toml", "--frames", "out", env=self.without_ffmpeg())

    def test_ffmpeg_dies(self):
        for script in ("echo 'Unknown encoder' >&2; exit 4", "exec <&-; echo 'Unknown encoder' >&2; exit 4",
                       "/bin/cat >/dev/null; echo 'Unknown encoder' >&2; exit 4",
                       "/usr/bin/head -c 9000 >/dev/null; echo 'Unknown encoder' >&2; exit 4"):
            run = self.check(1, "render", "scene.toml", "-o", "a.mp4", env=self.with_ffmpeg(script))
            self.assertIn(f"cannot write 'a.mp4': {self.folder}/bin/ffmpeg failed (exit code 4):\nUnknown encoder", run.stderr)
            self.assertEqual(self.left(), [])

    def test_impossible_folders(self):
        self.write("file", "")
        for arguments, named in ((["render", "scene.toml", "--frames", "file/out"], "file/out"),
                                 (["render", "scene.toml", "--frames", "file"], "file"),
                                 (["render", "scene.toml", "--frames", "/proc/out"], "/proc/out"),
                                 (["render", "scene.toml", "-o", "file/a.mp4"], "file/a.mp4"),
                                 (["render", "scene.toml", "-o", "no/a.mp4", "--frames", "out"], "no/a.mp4"),
                                 (["simulate", "scene.toml", "--trajectory", "file/t.csv"], "file/t.csv"),
                                 (["simulate", "scene.toml", "--energy", "no/e.csv", "--trajectory", "t.csv"], "no/e.csv")):
            run = self.check(1, *arguments)
            self.assertIn(f"'{named}'", run.stderr)
            self.assertTrue(run.stderr.startswith("error: cannot"), run.stderr)
            self.assertEqual(self.names(), ["file"])

    def test_the_old_clip_stays_when_the_new_one_fails(self):
        self.write("a.mp4", "old")
        self.check(1, "render", "scene.toml", "-o", "a.mp4", env=self.with_ffmpeg("exit 1"))
        self.assertEqual((self.folder / "a.mp4").read_text(), "old")
        self.assertEqual(self.left(), ["a.mp4"])

    def test_full_disk(self):
        run = self.check(1, "simulate", "scene.toml", "--energy", "/dev/full")
        self.assertIn("'/dev/full': No space left", run.stderr)

    def limited(self, size):
        """Limits the size of files, in bytes."""
        return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    def test_no_room_for_frames(self):
        run = self.check(1, "render", "scene.toml", "--frames", "out", "--size", "320x240", preexec_fn=self.limited(2000))
        self.assertRegex(run.stderr, r"^error: cannot write 'out/frame_\d{6}\.png': File too large\n$")
        self.assertEqual(self.names(), [])

    def test_no_room_for_the_table(self):
        run = self.check(1, "simulate", "scene.toml", "--trajectory", "t.csv", "--fps", "1000",
                         preexec_fn=self.limited(20000))
        self.assertEqual(run.stderr, "error: cannot write 't.csv': File too large\n")
        self.assertEqual(self.names(), [])

    def test_no_room_for_the_clip(self):
        for name in ("a.mp4", "a.mkv", "a.mov", "a.webm", "a.gif"):
            self.check(0, "render", "scene.toml", "-o", name, "--size", "64x48", "--duration", "1")
            whole = (self.folder / name).stat().st_size
            (self.folder / name).unlink()
            for size in (100, whole // 2, whole - 1):
                run = self.check(1, "render", "scene.toml", "-o", name, "--size", "64x48", "--duration", "1",
                                 preexec_fn=self.limited(size))
                self.assertIn(f"cannot write '{name}': {FFMPEG} failed", run.stderr)
                self.assertEqual(self.names(), [])

    def check_whole_frames(self):
        frames = sorted((self.folder / "out").glob("frame_*.png"))
        self.assertEqual([p.name for p in frames], program.frame_names(len(frames)))
        for path in frames:
            self.assertEqual(program.png_size(path), (160, 120))

    LONG = ("render", "scene.toml", "-o", "a.mp4", "--frames", "out", "--duration", "5000", "--size", "160x120")

    def test_interrupts(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            run = self.started(*self.LONG)
            run.send_signal(number)
            error = run.communicate(timeout=60)[1]
            self.assertEqual(run.returncode, 1)
            self.assertIn("error: interrupted", error)
            self.check_whole_frames()
            self.assertEqual([name for name in self.names() if "frame_0" not in name], ["out"])
            self.assertFalse([name for name in self.names() if ".part" in name])
            for path in (self.folder / "out").iterdir():
                path.unlink()

    def processes_of(self, run):
        """Its render processes: the children that run the same program."""
        children = pathlib.Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()
        return [int(c) for c in children if pathlib.Path(f"/proc/{c}/comm").read_text().strip() == "tumble"]

    def test_a_drawing_process_dies(self):
        run = self.started(*self.LONG, "--workers", "2")
        workers = self.processes_of(run)
        self.assertEqual(len(workers), 2)
        os.kill(workers[1], signal.SIGABRT)
        error = run.communicate(timeout=60)[1]
        self.assertEqual(run.returncode, 1)
        self.assertRegex(error, r"error: cannot draw frame \d+: its process ended by signal 6 \(Aborted\)")
        self.check_whole_frames()
        self.assertEqual([name for name in self.names() if "frame_0" not in name], ["out"])
        self.assertFalse(pathlib.Path(f"/proc/{workers[0]}").exists())

    def test_an_interrupted_table_is_not_there(self):
        run = subprocess.Popen([program.TUMBLE, "simulate", "scene.toml", "--trajectory", "t.csv", "--duration", "1e5"],
                               cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.kill)
        deadline = time.monotonic() + 60
        while not self.names() and time.monotonic() < deadline:
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        self.assertIn("interrupted", run.communicate(timeout=60)[1])
        self.assertEqual(run.returncode, 1)
        self.assertEqual(self.names(), [])

    def test_a_pipe_that_no_one_reads_can_be_left(self):
        os.mkfifo(self.folder / "a.mkv")
        for arguments in (["render", "scene.toml", "-o", "a.mkv", "--frames", "out"],
                          ["simulate", "scene.toml", "--trajectory", "a.mkv"]):
            for number in (signal.SIGINT, signal.SIGTERM):
                run = subprocess.Popen([program.TUMBLE, *arguments], cwd=self.folder, stderr=subprocess.PIPE, text=True)
                self.addCleanup(run.kill)
                time.sleep(1.0)
                self.assertIsNone(run.poll(), "it waits for a reader")
                run.send_signal(number)
                self.assertIn("interrupted", run.communicate(timeout=20)[1])
                self.assertEqual(run.returncode, 1)
                self.assertEqual(self.names(), ["a.mkv"])

    def test_a_pipe_whose_reader_stopped_reading_can_be_left(self):
        os.mkfifo(self.folder / "t.csv")
        for number in (signal.SIGINT, signal.SIGTERM):
            run = subprocess.Popen([program.TUMBLE, "simulate", "scene.toml", "--duration", "60", "--trajectory", "t.csv"],
                                   cwd=self.folder, stderr=subprocess.PIPE, text=True)
            self.addCleanup(run.kill)
            with open(self.folder / "t.csv", "rb") as reader:
                self.assertTrue(reader.read(1))   # and no more, so that the pipe fills up
                time.sleep(1.0)
                self.assertIsNone(run.poll(), "it waits for the reader")
                run.send_signal(number)
                self.assertIn("interrupted", run.communicate(timeout=20)[1])
            self.assertEqual(run.returncode, 1)

    def test_a_clip_into_a_pipe(self):
        for name in ("a.mkv", "a.webm", "a.gif"):
            pipe = self.folder / name
            os.mkfifo(pipe)
            with open(self.folder / ("got_" + name), "wb") as got:
                reader = subprocess.Popen(["cat", name], cwd=self.folder, stdout=got)
            self.addCleanup(reader.kill)
            self.check(0, "render", "scene.toml", "-o", name)
            self.assertEqual(reader.wait(timeout=20), 0)
            self.assertTrue(pipe.is_fifo(), "it is not replaced")
            self.assertEqual(program.probe(self.folder / ("got_" + name), "nb_read_frames"), ["6"])
        os.mkfifo(self.folder / "a.mp4")
        run = self.check(2, "render", "scene.toml", "-o", "a.mp4", "--frames", "out")
        self.assertIn("a.mp4: error: a .mp4 clip cannot be written into a pipe or device", run.stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_a_clip_through_a_link_to_a_name_of_another_kind(self):
        for name in ("a.mp4", "a.mov", "a.mkv", "a.webm", "a.gif"):
            self.check(0, "render", "scene.toml", "-o", name)
            expected = (self.folder / name).read_bytes()
            for target in ("plain", "a.txt", "other.mkv"):
                link = self.folder / ("link_" + name)
                link.unlink(missing_ok=True)
                link.symlink_to(target)
                self.check(0, "render", "scene.toml", "-o", link.name)
                self.assertTrue(link.is_symlink())
                self.assertEqual((self.folder / target).read_bytes(), expected, f"{name} to {target}")

    # The first stage of a GIF must not use the .mkv of that name.
    def test_a_gif_beside_a_folder_of_its_name(self):
        (self.folder / "a.mkv").mkdir()
        self.check(0, "render", "scene.toml", "-o", "a.gif")
        self.assertEqual(self.names(), ["a.gif", "a.mkv"])

    def test_a_kill_leaves_nothing_half_written(self):
        run = self.started(*self.LONG)
        run.kill()
        run.communicate(timeout=60)
        self.check_whole_frames()
        self.assertFalse((self.folder / "a.mp4").exists())
        # ffmpeg and the render processes see the end of their input and stop; they must not outlive the test's folder.
        deadline = time.monotonic() + 30
        while self.something_runs() and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertFalse((self.folder / "a.mp4").exists())

    def something_runs(self):
        for path in pathlib.Path("/proc").glob("[0-9]*/cwd"):
            try:
                if os.readlink(path) == str(self.folder):
                    return True
            except OSError:
                pass
        return False


@program.limits_memory
class Memory(program.ProgramTest):
    """Pictures that do not fit into memory are refused before any output is made."""

    @staticmethod
    def limited():
        return resource.setrlimit(resource.RLIMIT_DATA, (1 << 30, 1 << 30))

    def test_pictures_beyond_the_memory_are_refused(self):
        for outputs in (["-o", "a.mp4"], ["--frames", "out"], ["-o", "a.webm", "--frames", "out"]):
            run = self.check(1, "render", "scene.toml", *outputs, "--size", "16384x16384", preexec_fn=self.limited)
            self.assertRegex(run.stderr, r"^error: drawing pictures of 16384 x 16384 pixels takes [\d.]+ GiB of memory, and the limit "
                                         r"of the process's data \(ulimit -d\) has [\d.]+ [MG]iB left; a smaller --size takes less\n$")
            self.assertEqual(self.names(), [])

    def test_frames_too_large_to_encode_are_refused(self):
        (self.folder / "out").mkdir()
        head = struct.pack(">IIBBBBB", 16384, 16384, 1, 0, 0, 0, 0)
        (self.folder / "out/frame_000000.png").write_bytes(
            b"\x89PNG\r\n\x1a\n" + program.chunk(b"IHDR", head) + program.chunk(b"IDAT", b"") + program.chunk(b"IEND", b""))
        run = self.check(1, "encode", "out", "-o", "a.mp4", preexec_fn=self.limited)
        self.assertIn("error: encoding 16384 x 16384 pixels takes ", run.stderr)
        self.assertEqual(self.names(), ["out", "out/frame_000000.png"])

    def test_a_scene_whose_tree_does_not_fit_is_refused(self):
        self.write("many.toml", "format = 1\nx = [" + "1," * 2_000_000 + "]")
        run = self.check(1, "info", "many.toml",
                         preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (100 << 20, 100 << 20)))
        self.assertRegex(run.stderr, r"^error: a scene of 2 keys and 2000001 items takes 113 MiB of memory, and the limit of ")

    def test_info_gives_the_memory_of_pictures(self):
        text = self.check(0, "info", "scene.toml", "--size", "16384x16384").stdout
        self.assertRegex(text, r"memory +about 9\.38 GiB for the pictures of each render process and 6\.25 GiB for those of ffmpeg")


if __name__ == "__main__":
    program.main()
