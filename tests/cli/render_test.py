"""`render`: frames and clips, of any size and rate."""

import os
import pty
import re
import subprocess

import program


class Render(program.ProgramTest):
    def test_frames(self):
        run = self.check(0, "render", "scene.toml", "--frames", "out/deep")
        self.assertEqual(sorted(p.name for p in (self.folder / "out/deep").iterdir()), [*program.frame_names(6), "frames.json"])
        for name in program.frame_names(6):
            self.assertEqual(program.png_size(self.folder / "out/deep" / name), (48, 32))
        self.assertIn("wrote out/deep/frame_000000.png to frame_000005.png", run.stderr)
        self.assertIn("simulation", run.stderr)
        self.assertEqual(run.stdout, "")

    def test_the_picture_moves(self):
        self.check(0, "render", "scene.toml", "--frames", "out")
        frames = [(self.folder / "out" / name).read_bytes() for name in program.frame_names(6)]
        self.assertNotEqual(frames[0], frames[3])

    def test_a_clip_by_default(self):
        self.check(0, "render", "scene.toml")
        self.assertEqual(self.names(), ["scene.mp4"])
        self.assertEqual(program.probe(self.folder / "scene.mp4", "codec_name,width,height,pix_fmt,avg_frame_rate,nb_read_frames"),
                         ["h264", "48", "32", "yuv420p", "10/1", "6"])

    def test_both_from_one_run(self):
        self.check(0, "render", "scene.toml", "-o", "a.mkv", "--frames", "out")
        self.assertEqual(program.probe(self.folder / "a.mkv", "nb_read_frames"), ["6"])
        self.assertEqual(self.names(), ["a.mkv", "out"] + ["out/" + name for name in program.frame_names(6)])

    def test_other_formats(self):
        for name, codec in (("a.webm", "vp9"), ("a.gif", "gif"), ("a.mov", "h264")):
            self.check(0, "render", "scene.toml", "-o", name)
            self.assertEqual(program.probe(self.folder / name, "codec_name,width,height,nb_read_frames"),
                             [codec, "48", "32", "6"])

    def test_rates(self):
        for fps, rate, count in (("29.97", "2997/100", 3), ("0.5", "1/2", 1), ("1e6", "1000000/1", 100001)):
            duration = "0.1" if fps != "1e6" else "0.000003"
            self.check(0, "render", "scene.toml", "-o", "a.mp4", "--fps", fps, "--duration", duration)
            expected = count if fps != "1e6" else 4
            self.assertEqual(program.probe(self.folder / "a.mp4", "avg_frame_rate,nb_read_frames"), [rate, str(expected)])

    def test_duration_0_is_one_frame(self):
        self.check(0, "render", "scene.toml", "-o", "a.mp4", "--frames", "out", "--duration", "0")
        self.assertEqual(program.probe(self.folder / "a.mp4", "nb_read_frames"), ["1"])
        self.assertEqual(self.names(), ["a.mp4", "out", "out/frame_000000.png"])

    def test_from_a_moment_on(self):
        self.check(0, "render", "scene.toml", "--frames", "all", "--aov", "motion")
        run = self.check(0, "render", "scene.toml", "-o", "a.mp4", "--frames", "out", "--aov", "motion", "--start", "0.25")
        self.assertIn("wrote a.mp4: 3 frames of 48 x 32", run.stderr)
        self.assertIn("wrote out/frame_000003.png to frame_000005.png", run.stderr)
        self.assertEqual(program.probe(self.folder / "a.mp4", "nb_read_frames"), ["3"])
        self.assertEqual(sorted(p.name for p in (self.folder / "out").iterdir()),
                         [f"aov_{n:06}.npz" for n in (3, 4, 5)] + ["aovs.json"] + program.frame_names(6)[3:] + ["frames.json"])
        for path in (self.folder / "out").iterdir():
            self.assertEqual(path.read_bytes(), (self.folder / "all" / path.name).read_bytes(), path.name)
        self.check(0, "render", "scene.toml", "--frames", "one", "--start", "0.3", "--duration", "0.3")
        self.assertEqual([p.name for p in (self.folder / "one").glob("frame_*")], ["frame_000003.png"])
        self.assertEqual((self.folder / "one/frame_000003.png").read_bytes(),
                         (self.folder / "all/frame_000003.png").read_bytes())
        run = self.check(2, "render", "scene.toml", "--frames", "none", "--start", "0.51")
        self.assertIn("--start: the scene's last frame is at 0.5 s (0.51 was given)", run.stderr)
        self.assertFalse((self.folder / "none").exists())

    RESTING = program.SCENE.replace("position = [0.0, 3.0, 0.0]", "position = [0.0, 0.5, 0.0]").replace(
        "angular_velocity = [1.0, 2.0, 0.5]", "")

    def test_unchanged_pictures_are_drawn_once_and_shown_longer(self):
        self.write("resting.toml", self.RESTING)
        run = self.check(0, "render", "resting.toml", "-o", "a.mp4", "--frames", "out", "--duration", "3", "--variable-rate")
        self.assertIn("wrote a.mp4: 31 frames of 48 x 32, stored as 4 (unchanged pictures are shown longer)", run.stderr)
        self.assertEqual(program.probe(self.folder / "a.mp4", "duration,nb_read_frames"),
                         ["3.100000", "4"])
        self.assertIn("frames/s; 1 drawn;", run.stderr)
        frames = [(self.folder / "out" / name).read_bytes() for name in program.frame_names(31)]
        self.assertEqual(len(set(frames)), 1)
        self.check(0, "render", "resting.toml", "-o", "a.mp4", "--duration", "3")
        self.assertEqual(program.probe(self.folder / "a.mp4", "avg_frame_rate,nb_read_frames"), ["10/1", "31"])

    def test_odd_sizes(self):
        self.check(0, "render", "scene.toml", "-o", "a.mp4", "--frames", "out", "--size", "49x33", "--duration", "0")
        self.assertEqual(program.png_size(self.folder / "out/frame_000000.png"), (49, 33))
        self.assertEqual(program.probe(self.folder / "a.mp4", "width,height"), ["50", "34"])

    def test_threads_workers_and_repetition_change_no_byte(self):
        for name, threads, workers in (("a", 1, 1), ("b", 4, 3), ("c", 4, 2)):
            self.check(0, "render", "scene.toml", "-o", name + ".mp4", "--frames", name, "--threads", threads,
                       "--workers", workers)
        for name in program.frame_names(6):
            a = (self.folder / "a" / name).read_bytes()
            self.assertEqual(a, (self.folder / "b" / name).read_bytes())
            self.assertEqual(a, (self.folder / "c" / name).read_bytes())
        self.assertEqual((self.folder / "a.mp4").read_bytes(), (self.folder / "b.mp4").read_bytes())

    def test_frame_n_shows_time_n(self):
        # Frame 2 at 10 frames/s and frame 4 at 20 show the same moment, with the same fixed step. A camera by the motion
        # would see other frames of it.
        scene = program.SCENE + "[camera]\nfit = \"start\"\n"
        self.write("slow.toml", scene)
        self.check(0, "render", "slow.toml", "--frames", "a")
        self.write("fast.toml", scene.replace("fps = 10", "fps = 20").replace("per_frame = 4", "per_frame = 2"))
        self.check(0, "render", "fast.toml", "--frames", "b")
        self.assertEqual(program.unmarked(self.folder / "a/frame_000002.png"),
                         program.unmarked(self.folder / "b/frame_000004.png"))

    def test_slow_motion(self):
        options = ("--size", "320x240", "--duration", "0.3")
        self.check(0, "render", "scene.toml", "--frames", "a", *options)
        run = self.check(0, "render", "scene.toml", "--frames", "b", "-o", "b.mp4", "--speed", "0.25", *options)
        self.assertIn("wrote b.mp4: 13 frames", run.stderr)
        self.assertEqual(program.probe(self.folder / "b.mp4", "r_frame_rate,nb_read_frames"), ["10/1", "13"])
        for n in range(4):
            self.assertEqual(program.unmarked(self.folder / f"a/frame_{n:06}.png"),
                             program.unmarked(self.folder / f"b/frame_{4 * n:06}.png"))
        for speed in ("0", "-1", "1e4", "fast"):
            self.check(2, "render", "scene.toml", "--speed", speed)

    def test_motion_blur(self):
        options = ("--size", "64x48", "--duration", "0.2")
        self.check(0, "render", "scene.toml", "--frames", "sharp", *options)
        self.check(0, "render", "scene.toml", "--frames", "blurred", "--shutter", "180", "--workers", "2", *options)
        self.check(0, "render", "scene.toml", "--frames", "again", "--shutter", "180", "--workers", "1", *options)
        for name in program.frame_names(3):
            blurred = program.unmarked(self.folder / "blurred" / name)
            self.assertNotEqual(program.unmarked(self.folder / "sharp" / name), blurred)
            self.assertEqual(program.unmarked(self.folder / "again" / name), blurred)

    def test_almost_empty_scenes(self):
        self.write("empty.toml", "format = 1\n[simulation]\nduration = 0.1\n[output]\nsize = [32, 32]\n")
        self.check(0, "render", "empty.toml", "--frames", "out")
        self.assertEqual(len(list((self.folder / "out").glob("frame_*"))), 7)

    def test_memory_does_not_grow_with_the_length_of_a_clip(self):
        def peak(seconds):
            run = self.check(0, "render", "scene.toml", "-o", "a.mp4", "--duration", seconds)
            return int(re.search(r"peak memory (\d+) MiB", run.stderr)[1])

        self.assertLess(peak("120"), peak("6") + 10)   # 1201 and 61 frames, the queues full in both

    def test_quiet_is_silent(self):
        run = self.check(0, "render", "scene.toml", "--frames", "out", "--quiet")
        self.assertEqual(run.stdout + run.stderr, "")

    def test_older_frames_are_noted(self):
        self.check(0, "render", "scene.toml", "--frames", "out")
        run = self.check(0, "render", "scene.toml", "--frames", "out", "--duration", "0.2")
        self.assertIn("3 older frames are still in the folder, from out/frame_000003.png on", run.stderr)

    def test_a_bar_on_a_terminal(self):
        ours, its = pty.openpty()
        # Ten times as long as from bar to bar.
        run = subprocess.Popen([program.TUMBLE, "render", "scene.toml", "--frames", "out", "--duration", "30", "--fps", "60"],
                               cwd=self.folder, stderr=its)
        os.close(its)
        said = b""
        try:
            while part := os.read(ours, 4096):
                said += part
        except OSError:   # raised at the end of a terminal
            pass
        os.close(ours)
        self.assertEqual(run.wait(timeout=60), 0)
        self.assertRegex(said.decode(), r"\r\[#*\.*\] +\d+ %  \d+ of 1801 frames, \d+\.\d frames/s")
        self.assertIn("wrote out/frame_000000.png", said.decode())


if __name__ == "__main__":
    program.main()
