"""Long renders: parts of a clip (--frames-range), and runs that go on after kill -9 at any moment (--resume).

TUMBLE_KILLS is the number of kills in the tests that kill at random moments; a few without it."""

import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import time
import unittest
import zipfile

import program
from program import ProgramTest

KILLS = int(os.environ.get("TUMBLE_KILLS", "3"))
CLIP = ("--size", "96x64", "--fps", "30", "--duration", "4")


def contents(folder, pattern="*"):
    return {p.name: p.read_bytes() for p in sorted(pathlib.Path(folder).glob(pattern)) if not p.name.startswith(".")}


class FramesRange(ProgramTest):
    def whole(self, *options):
        self.check(0, "render", "scene.toml", "--frames", "whole", "--quiet", *options)
        return contents(self.folder / "whole")

    def test_parts_are_the_bytes_of_the_whole(self):
        whole = self.whole(*CLIP)
        self.assertEqual(len(whole), 121 + 1)
        for part in ("0-59", "60-80,100-120:5,90", "81-89,91-99", "101-104, 106-109,111-114,116-119"):
            self.check(0, "render", "scene.toml", "--frames", "parts", "--quiet", "--frames-range", part, *CLIP)
        self.assertEqual(contents(self.folder / "parts"), whole)

    def test_frames_after_a_gap(self):
        # The paddle stands still from 1 to 2 s: frame 15 equals the one before it, and not the last one that was drawn.
        self.write("scene.toml", """format = 1
            [simulation]
            duration = 3
            [output]
            size = [48, 32]
            fps = 10
            [camera]
            eye = [0, 1, 6]
            target = [0, 1, 0]
            [[body]]
            type = "kinematic"
            shape = { type = "box", size = [1, 1, 1] }
            keyframes = [{ time = 0 }, { time = 1, position = [1, 1, 0] }, { time = 2, position = [1, 1, 0] },
                         { time = 3, position = [0, 2, 0] }]
            """)
        whole = self.whole()
        self.assertEqual(whole["frame_000014.png"], whole["frame_000015.png"])
        self.assertNotEqual(whole["frame_000005.png"], whole["frame_000015.png"])
        self.check(0, "render", "scene.toml", "--frames", "parts", "--frames-range", "5,15,17-18,24", "--workers", "1")
        parts = contents(self.folder / "parts")
        self.assertEqual(len(parts), 6)
        self.assertEqual(parts, {name: whole[name] for name in parts})

    def test_overlays_plots_and_aovs(self):
        options = ("--size", "640x400", "--fps", "10", "--duration", "1.5", "--aov", "depth,segmentation,motion", "--overlay",
                   "trails,ghosts,velocity,contacts,clock,sleep", "--plot", "energy")
        whole = self.whole(*options)
        for part in ("9-12", "3,5-7,15"):
            self.check(0, "render", "scene.toml", "--frames", "parts", "--frames-range", part, *options)
        parts = contents(self.folder / "parts")
        self.assertEqual(len(parts), 4 + 5 + 4 + 5 + 3)
        self.assertEqual(parts, {name: whole[name] for name in parts})

    def test_the_overlay_of_damage(self):
        options = ("--fps", "20", "--overlay", "damage")
        whole = self.whole(*options)
        self.check(0, "render", "scene.toml", "--frames", "parts", "--frames-range", "4,7-8", *options)
        parts = contents(self.folder / "parts")
        self.assertEqual(sorted(parts), ["frame_000004.png", "frame_000007.png", "frame_000008.png", "frames.json"])
        self.assertEqual(parts, {name: whole[name] for name in parts})

    def test_a_clip_of_a_part(self):
        self.check(0, "render", "scene.toml", "-o", "a.mkv", "--frames-range", "10-39", *CLIP)
        self.assertEqual(program.probe(self.folder / "a.mkv", "nb_read_frames"), ["30"])
        error = self.check(2, "render", "scene.toml", "-o", "b.mkv", "--frames-range", "1,3", *CLIP).stderr
        self.assertIn("a clip needs frames without gaps", error)
        self.assertEqual(self.names(), ["a.mkv"])

    def test_mistakes(self):
        for text, message in (("", "FRAMES missing"), ("x", "given 'x'"), ("3-", "given '3-'"), ("-3", "given '-3'"),
                              ("1,,2", "given ''"), ("5-2", "must ascend: 2-5"), ("1-4:0", "a step must be at least 1"),
                              ("1-4:-1", "given '1-4:-1'"), ("4:2", "a step needs a range"),
                              ("1-4,3", "must not overlap ('1-4' and '3' do)"), ("1-5:2,3", "must not overlap"),
                              ("0-6", "the clip's last frame is 5 (given '0-6')"), ("1.5", "given '1.5'"),
                              ("99999999999999999999", "is too large")):
            with self.subTest(text):
                error = self.check(2, "render", "scene.toml", "--frames", "out", "--frames-range=" + text).stderr
                self.assertIn("--frames-range: ", error)
                self.assertIn(message, error)
        error = self.check(2, "render", "scene.toml", "--frames", "out", "--frames-range", "1", "--start", "0.1").stderr
        self.assertIn("not together with --start", error)
        self.assertEqual(self.names(), [])


class Resume(ProgramTest):
    def test_whole_frames_are_kept_and_the_rest_drawn(self):
        self.check(0, "render", "scene.toml", "--frames", "whole", "--aov", "depth,segmentation", "--quiet", *CLIP)
        whole = contents(self.folder / "whole")
        out = self.folder / "out"
        render = ("render", "scene.toml", "--frames", "out", "--aov", "depth,segmentation", "--resume", *CLIP)
        self.check(0, *render, "--frames-range", "0-99")
        kept = {p.name: p.stat().st_mtime_ns for p in out.iterdir()}

        def damage(name, change):
            path = out / name
            path.write_bytes(change(path.read_bytes()))
            kept.pop(name)
        damage("frame_000003.png", lambda b: b[:len(b) // 2])
        damage("frame_000004.png", lambda b: b"")
        damage("frame_000005.png", lambda b: b[:700] + bytes([b[700] ^ 1]) + b[701:])
        damage("frame_000006.png", lambda b: b + b"\0")
        damage("aov_000003.npz", lambda b: b[:-1])
        damage("aov_000004.npz", lambda b: b[:500] + bytes([b[500] ^ 128]) + b[501:])
        damage("aov_000005.npz", lambda b: b[:-105] + bytes([b[-105] ^ 1]) + b[-104:])
        for name in ("frame_000007.png", "aov_000008.npz", "frames.json", "segmentation.csv"):
            (out / name).unlink()
            kept.pop(name)
        run = self.check(0, *render)
        self.assertIn("kept 94 of 121 frames from an earlier run", run.stderr)
        self.assertEqual(contents(out), whole)
        for name, time_ns in kept.items():
            self.assertEqual((out / name).stat().st_mtime_ns, time_ns, name)

        run = self.check(0, *render)
        self.assertIn("kept 121 of 121 frames", run.stderr)
        self.assertEqual(contents(out), whole)

    def test_every_damaged_byte_is_found(self):
        render = ("render", "scene.toml", "--frames", "out", "--aov", "depth", "--size", "16x16", "--resume", "--quiet",
                  "--frames-range", "0-1")
        self.check(0, *render)
        whole = contents(self.folder / "out")
        places = random.Random(1)
        for name in ("frame_000000.png", "aov_000000.npz"):
            for _ in range(3):
                file = self.folder / "out" / name
                at = places.randrange(len(whole[name]))
                damaged = bytearray(whole[name])
                damaged[at] ^= 1 << places.randrange(8)
                file.write_bytes(damaged)
                run = self.run_tumble(*render)
                if run.returncode == 2:   # the mark itself: refused
                    self.assertIn("is of another scene", run.stderr)
                    file.unlink()
                    self.check(0, *render)
                self.assertEqual(contents(self.folder / "out"), whole, f"{name} at {at}")

    def test_comments_ranges_and_workers_do_not_matter(self):
        self.check(0, "render", "scene.toml", "--frames", "out", "--quiet")
        whole = contents(self.folder / "out")
        self.write("scene.toml", "# another comment\n" + program.SCENE.replace("duration = 0.5", "duration = 0.50"))
        run = self.check(0, "render", "scene.toml", "--frames", "out", "--resume", "--workers", "1", "--threads", "2",
                         "--frames-range", "2-3")
        self.assertIn("kept 2 of 2 frames", run.stderr)
        self.assertEqual(contents(self.folder / "out"), whole)
        # A longer clip goes on, for its frames do not depend on the duration.
        run = self.check(0, "render", "scene.toml", "--frames", "out", "--resume", "--duration", "1")
        self.assertIn("kept 6 of 11 frames", run.stderr)
        # The overlays do.
        self.check(0, "render", "scene.toml", "--frames", "text", "--overlay", "clock", "--quiet")
        error = self.check(2, "render", "scene.toml", "--frames", "text", "--overlay", "clock", "--duration", "1",
                           "--resume").stderr
        self.assertIn("differs in the duration of scene.toml (0.5 there, 1 here)", error)

    def test_another_clip_is_refused(self):
        self.check(0, "render", "scene.toml", "--frames", "out", "--aov", "depth", "--quiet")
        whole = contents(self.folder / "out")
        heavier = self.write("heavier.toml", program.SCENE.replace("density = 600.0", "density = 700.0"))
        for arguments, message in ((["scene.toml", "--size", "64x48"], "size (48x32 there, 64x48 here)"),
                                   (["scene.toml", "--samples", "4"], "the samples of scene.toml (1 there, 4 here)"),
                                   (["scene.toml", "--speed", "0.5"], "speed (1 there, 0.5 here)"),
                                   (["scene.toml", "--transparent"], "transparent (no there, yes here)"),
                                   (["scene.toml", "--set", "light.shadows=false"], "the light of scene.toml"),
                                   (["scene.toml", "--aov", "normal"], "AOVs (depth there, normal here)"),
                                   ([heavier], "the bodies of heavier.toml")):
            for how in (["--resume"], ["--frames-range", "0-1"]):
                with self.subTest(arguments):
                    aov = [] if "--aov" in arguments else ["--aov", "depth"]
                    error = self.check(2, "render", *arguments, "--frames", "out", *aov, *how).stderr
                    self.assertIn("the folder holds frames of another clip, which differs in", error)
                    self.assertIn(message, error)
                    self.assertIn("name another folder, or delete this one's frames", error)
        manifest = json.loads((self.folder / "out/frames.json").read_text())
        manifest["version"] = "0.0.9"
        (self.folder / "out/frames.json").write_text(json.dumps(manifest))   # its mark is no longer that of its values
        self.check(0, "render", "scene.toml", "--frames", "out", "--aov", "depth", "--resume")
        self.assertEqual(contents(self.folder / "out"), whole)

    def test_without_a_manifest_each_frame_is_looked_at(self):
        self.check(0, "render", "scene.toml", "--frames", "out", "--quiet")
        (self.folder / "out/frames.json").unlink()
        error = self.check(2, "render", "scene.toml", "--frames", "out", "--samples", "4", "--resume").stderr
        self.assertIn("frame_000000.png: error: --resume: the frame is of another scene, other settings or another version",
                      error)
        (self.folder / "out/frame_000000.png").write_bytes(program.png(48, 32))
        error = self.check(2, "render", "scene.toml", "--frames", "out", "--resume").stderr
        self.assertIn("the picture was not written by render --frames: it has no mark", error)

    def test_the_mark(self):
        self.check(0, "render", "scene.toml", "--frames", "out", "--aov", "depth", "--quiet")
        mark = json.loads((self.folder / "out/frames.json").read_text())["mark"]
        self.assertIn(b"tEXtTumble-Scene\0" + mark.encode(), (self.folder / "out/frame_000002.png").read_bytes())
        aovs = json.loads((self.folder / "out/aovs.json").read_text())["mark"]
        with zipfile.ZipFile(self.folder / "out/aov_000002.npz") as archive:
            self.assertTrue(archive.comment.startswith(b"Tumble-Scene " + aovs.encode() + b" "))
            self.assertIsNone(archive.testzip())

    def test_several_runs_fill_one_folder(self):
        self.check(0, "render", "scene.toml", "--frames", "whole", "--quiet", *CLIP)
        parts = [("--frames-range", "0-60"), ("--frames-range", "40-120"), ("--resume",), ("--resume",)]
        runs = [subprocess.Popen([program.TUMBLE, "render", "scene.toml", "--frames", "out", "--quiet", "--workers", "1",
                                  *part, *CLIP], cwd=self.folder) for part in parts]
        self.assertEqual([run.wait() for run in runs], [0] * len(parts))
        self.assertEqual(contents(self.folder / "out"), contents(self.folder / "whole"))
        self.assertEqual([p.name for p in (self.folder / "out").glob(".*")], [])

    def test_a_run_that_wants_the_folder_alone(self):
        run = self.started("render", "scene.toml", "--frames", "out", "--duration", "5000", "--resume")
        self.assertIn("another run is writing frames there",
                      self.check(1, "render", "scene.toml", "--frames", "out").stderr)
        self.check(0, "render", "scene.toml", "--frames", "out", "--duration", "5000", "--frames-range", "0-2", "--resume")
        run.send_signal(signal.SIGINT)
        error = run.communicate(timeout=60)[1]
        self.assertEqual(run.returncode, 1)
        self.assertIn("error: interrupted; finished frames are kept. To go on:\n  ", error)
        self.assertIn("render scene.toml --frames out --duration 5000 --resume\n", error)


class Kills(ProgramTest):
    """The run is killed when a random amount of its output is there, or after a random time, and continued."""

    def kill_and_continue(self, command, pieces, done, check):
        """Runs the command with KILLS kills until it succeeds; starts over where it succeeds before. `done`: the finished
        pieces, about `pieces` in all; None: the result is there. `check`: looks at the result, and removes it."""
        chance = random.Random(30)
        kills, before = 0, {}
        while kills < KILLS:
            run = subprocess.Popen([program.TUMBLE, *command], cwd=self.folder)
            enough = len(before) + chance.randrange(pieces // KILLS + 1)
            pause = chance.random() * 0.2
            deadline = time.monotonic() + 60
            while run.poll() is None and len(done() or {}) < enough and time.monotonic() < deadline:
                time.sleep(0.002)
            time.sleep(pause)
            run.kill()
            if run.wait() == 0:
                check()
                before = {}
                continue
            kills += 1
            now = done()
            if now is None:
                before = {}
                continue
            self.assertEqual({name: now.get(name) for name in before}, before, "a finished piece is lost")
            before = now
        self.assertEqual(subprocess.run([program.TUMBLE, *command], cwd=self.folder).returncode, 0)
        check()

    def test_frames_and_aovs(self):
        options = ("--aov", "depth,segmentation", "--quiet", "--workers", "2", *CLIP)
        self.check(0, "render", "scene.toml", "--frames", "whole", *options)
        out = self.folder / "out"

        def check():
            self.assertEqual(contents(out), contents(self.folder / "whole"))
            self.assertEqual([p.name for p in out.glob(".*")], [])
            shutil.rmtree(out)
        self.kill_and_continue(("render", "scene.toml", "--frames", "out", "--resume", *options), 121,
                               lambda: {p.name: p.stat().st_ino for p in out.glob("frame_*")}, check)

    def check_clip(self, name, *options):
        options = ("--quiet", "--size", "96x64", "--fps", "10", "--duration", str(2 * KILLS), *options)
        self.check(0, "render", "scene.toml", "-o", "whole" + name, "--resume", *options)
        parts = self.folder / (name + ".parts")

        def done():
            if (self.folder / name).exists():
                return None
            return {p.name: p.stat().st_ino for p in parts.glob("*.sha256")} if parts.exists() else {}

        def check():
            self.assertEqual((self.folder / name).read_bytes(), (self.folder / ("whole" + name)).read_bytes())
            # The ffmpeg of a killed run may hold its hidden file for a moment; a later run removes it.
            self.assertEqual([n for n in self.names() if not n.startswith(".")], [name, "whole" + name])
            (self.folder / name).unlink()
        self.kill_and_continue(("render", "scene.toml", "-o", name, "--resume", *options), 2 * KILLS, done, check)

    def test_mp4(self):
        self.check_clip("a.mp4")

    def test_variable_rate(self):
        self.check_clip("a.mkv", "--variable-rate")

    def test_gif(self):
        self.check_clip("a.gif")

    def test_webm(self):
        self.check_clip("a.webm", "--transparent")


class Segments(ProgramTest):
    def test_times_and_counts(self):
        for name, fps, transparent in (("a.mp4", "29.97", ()), ("a.mov", "24", ()), ("a.mkv", "60", ()), ("a.webm", "25", ()),
                                       ("b.webm", "30", ("--transparent",)), ("b.mov", "30", ("--transparent",)),
                                       ("a.gif", "100", ())):
            with self.subTest(name):
                options = ("--duration", "1.7", "--fps", fps, "--quiet", *transparent)
                self.check(0, "render", "scene.toml", "-o", "plain-" + name, *options)
                self.check(0, "render", "scene.toml", "-o", name, "--resume", *options)
                entries = "width,height,pix_fmt,r_frame_rate,nb_read_frames,start_time"
                self.assertEqual(program.probe(self.folder / name, entries),
                                 program.probe(self.folder / ("plain-" + name), entries))
                self.assertEqual(self.times(name), self.times("plain-" + name))

    def times(self, name):
        out = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "frame=pts_time", "-of", "csv=p=0", name],
                             cwd=self.folder, stdout=subprocess.PIPE, text=True, check=True).stdout
        return [round(float(t.strip(",")) * 500) for t in out.split()]   # to 2 ms: Matroska has whole ones

    def test_a_finished_clip_is_kept(self):
        render = ("render", "scene.toml", "-o", "a.mp4", "--duration", "2", "--resume")
        self.check(0, *render)
        before = (self.folder / "a.mp4").stat().st_mtime_ns
        self.assertIn("kept 21 of 21 frames", self.check(0, *render).stderr)
        self.assertEqual((self.folder / "a.mp4").stat().st_mtime_ns, before)
        self.check(0, *render[:-1], "--seed", "2", "--resume")
        self.check(0, *render[:-1], "--samples", "4", "--resume")
        self.assertNotEqual((self.folder / "a.mp4").stat().st_mtime_ns, before)
        self.assertEqual(self.names(), ["a.mp4"])

    def test_damaged_segments_are_made_again(self):
        render = ("render", "scene.toml", "-o", "a.mp4", "--duration", "300", "--resume", "--quiet")
        run = subprocess.Popen([program.TUMBLE, *render], cwd=self.folder)
        parts = self.folder / "a.mp4.parts"
        while len(list(parts.glob("*.sha256"))) < 5 and run.poll() is None:
            time.sleep(0.01)
        run.kill()
        run.wait()
        whole = contents(parts, "segment_00000[0-4].mp4")
        segment = parts / "segment_000001.mp4"
        segment.write_bytes(segment.read_bytes()[:-100])
        (parts / "segment_000003.sha256").unlink()
        error = self.check(2, "render", "scene.toml", "-o", "a.mp4", "--duration", "2", "--resume").stderr
        self.assertIn("the folder holds segments of another clip, which differs in frames of the clip (0-3000 there, 0-20 here)",
                      error)
        run = subprocess.Popen([program.TUMBLE, *render], cwd=self.folder, stderr=subprocess.DEVNULL)
        while not ((parts / "segment_000003.sha256").exists() and (parts / "segment_000007.sha256").exists()) \
                and run.poll() is None:
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.wait(), 1)
        self.assertEqual(contents(parts, "segment_00000[0-4].mp4"), whole)

    def test_a_folder_with_other_files_stays(self):
        parts = self.folder / "a.mp4.parts"
        parts.mkdir()
        (parts / "notes.txt").write_text("mine")
        self.check(0, "render", "scene.toml", "-o", "a.mp4", "--resume")
        self.assertEqual(self.names(), ["a.mp4", "a.mp4.parts", "a.mp4.parts/notes.txt"])

    def test_a_pipe_is_refused(self):
        os.mkfifo(self.folder / "a.mkv")
        error = self.check(2, "render", "scene.toml", "-o", "a.mkv", "--resume").stderr
        self.assertIn("--resume: 'a.mkv' is a pipe or device", error)


class Encode(ProgramTest):
    def test_missing_frames_are_refused(self):
        self.check(0, "render", "scene.toml", "--frames", "out", "--frames-range", "0-1,4", "--quiet")
        error = self.check(2, "encode", "out", "-o", "a.mkv").stderr
        self.assertIn("out: error: 3 of the clip's 6 frames are missing: 2-3,5 (render --resume draws them, --allow-missing "
                      "encodes the others)", error)
        self.check(0, "encode", "out", "-o", "a.mkv", "--allow-missing", "--quiet")
        self.assertEqual(program.probe(self.folder / "a.mkv", "nb_read_frames"), ["3"])
        self.check(0, "render", "scene.toml", "--frames", "out", "--resume", "--quiet")
        self.check(0, "encode", "out", "-o", "b.mkv", "--quiet")
        self.check(0, "render", "scene.toml", "-o", "c.mkv", "--quiet")
        # The rate is that of the run, and the bytes are those of its clip.
        self.assertEqual((self.folder / "b.mkv").read_bytes(), (self.folder / "c.mkv").read_bytes())

    def test_a_frame_of_another_clip_is_refused(self):
        self.check(0, "render", "scene.toml", "--frames", "out", "--duration", "1", "--quiet")
        self.check(0, "render", "scene.toml", "--frames", "out", "--seed", "3", "--quiet")
        error = self.check(2, "encode", "out", "-o", "a.mkv").stderr
        self.assertIn("frame_000006.png: error: the frame is of another scene, other settings or another version", error)


if __name__ == "__main__":
    unittest.main()
