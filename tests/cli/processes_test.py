"""Programs and processes that hang, die or are missing, and closed descriptors: each run ends by itself or by the first
signal, and leaves no process behind."""

import itertools
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import time

import program

# A guard against a hang, in s: far more than a run takes on a busy machine.
GUARD = 120


class Processes(program.ProgramTest):
    def with_ffmpeg(self, script):
        """An environment in which ffmpeg is this script. $real is the real one, $left a file for the numbers of processes."""
        (self.folder / "bin").mkdir(exist_ok=True)
        fake = self.folder / "bin/ffmpeg"
        fake.write_text(f"#!/bin/sh\nleft={self.folder}/bin/left\nreal=$(PATH=/usr/local/bin:/usr/bin command -v ffmpeg)\n{script}\n")
        fake.chmod(0o755)
        return {**os.environ, "PATH": f"{self.folder}/bin:{os.environ['PATH']}"}

    def left(self):
        return [name for name in self.names() if not name.startswith("bin")]

    def left_processes(self):
        """The numbers that scripts wrote into $left; each is killed when the test ends."""
        try:
            numbers = [int(word) for word in (self.folder / "bin/left").read_text().split()]
        except FileNotFoundError:
            return []
        for number in numbers:
            self.addCleanup(end, number)
        return numbers

    def started(self, *arguments, **options):
        run = subprocess.Popen([program.TUMBLE, *arguments], cwd=self.folder, stderr=subprocess.PIPE, stdout=subprocess.PIPE,
                               text=True, **options)
        self.addCleanup(run.communicate)
        self.addCleanup(run.kill)
        return run

    def until(self, condition):
        deadline = time.monotonic() + GUARD
        while not condition() and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertTrue(condition())

    def check_nothing_runs(self):
        """True if no process has the test's folder as its working folder."""
        self.until(lambda: not in_folder(self.folder))


class ClosedDescriptors(Processes):
    def setUp(self):
        super().setUp()
        self.check(0, "render", "scene.toml", "--frames", "in")

    def commands(self):
        first = "in/frame_000000.png"
        return {("render", "scene.toml", "-o", "a.gif", "--frames", "out", "--aov", "depth", "--workers", "2"): "a.gif",
                ("encode", "in", "-o", "b.mp4"): "b.mp4",
                ("simulate", "scene.toml", "--energy", "e.csv", "--trajectory", "t.csv"): "e.csv",
                ("compare", first, first): None,
                ("info", "scene.toml"): None,
                ("doctor",): None}

    def test_every_combination(self):
        for command, output in self.commands().items():
            whole = None
            for closed in itertools.chain.from_iterable(itertools.combinations(range(3), n) for n in range(4)):
                with self.subTest(command=command, closed=closed):
                    def close(descriptors=closed):
                        for descriptor in descriptors:
                            os.close(descriptor)
                    run = subprocess.run([program.TUMBLE, *command], cwd=self.folder, stdin=subprocess.DEVNULL,
                                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=close, timeout=GUARD)
                    if output:
                        self.assertEqual(run.returncode, 0, run.stderr)
                        data = (self.folder / output).read_bytes()
                        whole = whole or data
                        self.assertEqual(data, whole, "messages went into the output")
                        (self.folder / output).unlink()
                    elif 1 not in closed:
                        self.assertEqual(run.returncode, 0, run.stderr)
                    else:   # the requested output was not printed
                        self.assertIn(run.returncode, (0, 1, 2), run.stderr)
        self.check_nothing_runs()


class OddFfmpeg(Processes):
    def test_one_that_leaves_a_process_behind(self):
        environment = self.with_ffmpeg('sleep 1000 & echo $! >> "$left"; exec "$real" "$@"')
        for name in ("a.mp4", "a.gif"):
            self.check(0, "render", "scene.toml", "-o", name, env=environment, timeout=GUARD)
        self.assertEqual(len(self.left_processes()), 3)
        self.assertEqual(program.probe(self.folder / "a.mp4", "nb_read_frames"), ["6"])

    def test_one_that_dies_and_leaves_a_process_that_holds_its_input(self):
        self.write("scene.toml", program.SCENE.replace("[48, 32]", "[1280, 720]"))
        for script in ('sleep 1000 & echo $! >> "$left"; echo gone >&2; exit 3',
                       'sleep 1000 <&0 & echo $! >> "$left"; echo gone >&2; exit 3'):
            run = self.check(1, "render", "scene.toml", "-o", "a.mp4", env=self.with_ffmpeg(script), timeout=GUARD)
            self.assertIn("bin/ffmpeg failed (exit code 3):\ngone", run.stderr)
        self.assertEqual(len(self.left_processes()), 2)
        self.assertEqual(self.left(), [])

    def test_one_that_reads_all_and_writes_nothing(self):
        environment = self.with_ffmpeg("cat > /dev/null; echo 'all is well' >&2")
        self.check(0, "render", "scene.toml", "--frames", "in")
        for name in ("a.mp4", "a.mov", "a.mkv", "a.webm", "a.gif"):
            self.write(name, "old")
            for command in (["render", "scene.toml"], ["encode", "in"]):
                run = self.check(1, *command, "-o", name, env=environment, timeout=GUARD)
                self.assertIn(f"cannot write '{name}': {self.folder}/bin/ffmpeg ended with exit code 0, but", run.stderr)
                self.assertIn("the file is empty:\nall is well", run.stderr)
                self.assertEqual((self.folder / name).read_text(), "old")
        self.assertEqual([n for n in self.left() if not n.startswith("in")], ["a.gif", "a.mkv", "a.mov", "a.mp4", "a.webm"])

    def test_one_that_closes_its_pipes_and_hangs(self):
        run = self.check(1, "render", "scene.toml", "-o", "a.mp4", env=self.with_ffmpeg("exec <&- 2>&-; exec sleep 1000"), timeout=GUARD)
        self.assertIn("bin/ffmpeg failed (ended by signal 9 (Killed))", run.stderr)
        self.assertEqual(self.left(), [])
        self.check_nothing_runs()

    # Each hangs at another place: before it reads, in the middle, after the last frame.
    HANGS = ('exec sleep 1000', 'sleep 1000 & echo $! >> "$left"; wait', 'head -c 2000 > /dev/null; exec sleep 1000',
             'cat > /dev/null; sleep 1000', 'trap "" TERM INT HUP; cat > /dev/null; sleep 1000',
             'kill -STOP $$', 'setsid sleep 1000 & echo $! >> "$left"; sleep 1000',
             'case "$*" in *palette*) echo second >> "$left.gif"; sleep 1000 ;; esac; exec "$real" "$@"')

    def test_one_that_hangs_can_be_left(self):
        for number, script in enumerate(self.HANGS):
            with self.subTest(script=script):
                name = "a.gif" if "palette" in script else "a.mp4"
                run = self.started("render", "scene.toml", "-o", name, env=self.with_ffmpeg("touch \"$left.started\"\n" + script))
                self.until((self.folder / "bin/left.started").exists)
                if "palette" in script:
                    self.until((self.folder / "bin/left.gif").exists)
                time.sleep(0.3)
                self.assertIsNone(run.poll(), "it waits for ffmpeg")
                run.send_signal((signal.SIGTERM, signal.SIGINT, signal.SIGHUP)[number % 3])
                error = run.communicate(timeout=GUARD)[1]
                self.assertEqual(run.returncode, 1, error)
                self.assertIn("error: interrupted", error)
                self.assertEqual(self.left(), [])
                (self.folder / "bin/left.started").unlink()
                if "setsid" in script:   # a process with its own session cannot be killed with the group
                    for process in self.left_processes():
                        end(process)
                self.check_nothing_runs()


class Doctor(Processes):
    def test_an_ffmpeg_that_hangs(self):
        for script in ("exec sleep 1000", "sleep 1000; echo ffmpeg version 5", "trap '' TERM; sleep 1000",
                       "case $* in *encoders*) exec sleep 1000 ;; esac; echo ffmpeg version 5"):
            run = self.check(1, "doctor", "--time-limit", "0.5", env=self.with_ffmpeg(script), timeout=GUARD)
            self.assertIn(f"{self.folder}/bin/ffmpeg does not answer (ended after 0.5 s)", run.stdout)
            self.assertNotIn("apt-get install ffmpeg", run.stdout)
            self.check_nothing_runs()

    def test_an_ffmpeg_that_leaves_a_process_behind(self):
        run = self.check(0, "doctor", env=self.with_ffmpeg('sleep 1000 & echo $! >> "$left"; exec "$real" "$@"'), timeout=GUARD)
        self.assertIn("ffmpeg version", run.stdout)
        self.assertEqual(len(self.left_processes()), 2)

    def test_one_that_hangs_can_be_left(self):
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            run = self.started("doctor", env=self.with_ffmpeg('touch "$left.started"; exec sleep 1000'))
            self.until((self.folder / "bin/left.started").exists)
            run.send_signal(number)
            self.assertIn("error: interrupted", run.communicate(timeout=GUARD)[1])
            self.assertEqual(run.returncode, 1)
            self.check_nothing_runs()
            (self.folder / "bin/left.started").unlink()


@program.limits_memory
class LittleMemory(Processes):
    def test_it_does_not_ask_for_an_installation(self):
        def limit(mebibytes):
            return lambda: resource.setrlimit(resource.RLIMIT_AS, (mebibytes << 20, mebibytes << 20))
        kinds = set()
        for size in range(80, 400, 20):
            run = self.run_tumble("render", "scene.toml", "--frames", "out", "--threads", "1", "--workers", "1",
                                  preexec_fn=limit(size), timeout=GUARD)
            self.assertNotIn("apt-get", run.stderr)
            self.assertIn(run.returncode, (0, 1), run.stderr)
            if run.returncode == 0:
                break
            kinds.add("not enough memory to open libOSMesa.so.8" in run.stderr)
            self.assertRegex(run.stderr, r"(?m)^error: ")
            self.assertRegex(run.stderr, rf"memory|ulimit -v\) is {size} MiB")
            if self.names():  # memory that was too little in the middle of the clip: finished frames are kept
                self.assertRegex("\n".join(self.names()), r"\Aout(\nout/frame_[0-9]+\.png)*\Z")
                shutil.rmtree(self.folder / "out")
        self.assertIn(True, kinds)

    def test_doctor_distinguishes_it_from_a_missing_library(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (150 << 20, 150 << 20))
        run = self.check(1, "doctor", preexec_fn=limit, timeout=GUARD)
        self.assertIn("not enough memory to open libOSMesa.so.8", run.stdout)
        self.assertIn("the limit of address space (ulimit -v) is 150 MiB", run.stdout)
        self.assertNotIn("apt-get install libosmesa6", run.stdout)

    # Threads that were started before the failure must end.
    def test_no_room_for_threads(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (200 << 20, 200 << 20))   # 64 stacks take 512 MiB
        run = self.check(1, "simulate", "scene.toml", "--energy", "e.csv", "--threads", "64", preexec_fn=limit, timeout=GUARD)
        self.assertIn("error: cannot start a thread: ", run.stderr)
        self.assertEqual(self.names(), [])


class StoppedWorkers(Processes):
    LONG = ("render", "scene.toml", "--frames", "out", "--duration", "5000", "--workers", "2")

    def workers(self, run):
        children = pathlib.Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()
        return [int(c) for c in children]

    def stopped_workers(self):
        run = self.started(*self.LONG)
        self.until((self.folder / "out/frame_000003.png").exists)
        workers = self.workers(run)
        self.assertEqual(len(workers), 2)
        for worker in workers:
            os.kill(worker, signal.SIGSTOP)
        return run, workers

    def test_they_can_be_left(self):
        run, workers = self.stopped_workers()
        run.send_signal(signal.SIGTERM)
        self.assertIn("error: interrupted", run.communicate(timeout=GUARD)[1])
        self.assertEqual(run.returncode, 1)
        for worker in workers:
            self.assertFalse(pathlib.Path(f"/proc/{worker}").exists())

    def test_they_do_not_outlive_the_program(self):
        run, _ = self.stopped_workers()
        run.kill()
        run.communicate(timeout=GUARD)
        self.check_nothing_runs()


def end(number):
    try:
        os.kill(number, signal.SIGKILL)
    except ProcessLookupError:
        pass


def in_folder(folder):
    """The processes whose working folder is this one; without zombies."""
    found = []
    for path in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if os.readlink(path / "cwd") == str(folder) and ") Z " not in (path / "stat").read_text():
                found.append(int(path.name))
        except OSError:
            pass
    return found


if __name__ == "__main__":
    program.main()
