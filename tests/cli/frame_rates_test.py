"""Frame rates as fractions, and sizes that are odd, in files of every format."""

import json

import program

# Small pictures lose much of their colors in a clip.
LOSSY = ("--tolerance", "40", "--fraction", "0.1", "--cluster", "64", "--window", "40", "--shade", "64")
CLIPS = ("a.mp4", "a.mov", "a.mkv", "a.webm", "a.gif")


class Rates(program.ProgramTest):
    def test_a_fraction_is_the_rate_of_the_clip(self):
        self.write("film.toml", program.SCENE.replace("fps = 10", 'fps = "24000/1001"'))
        for clip in ("a.mp4", "a.mov", "a.mkv", "a.webm"):
            with self.subTest(clip):
                self.check(0, "render", "film.toml", "-o", clip)
                rate, average, frames = program.probe(self.folder / clip, "r_frame_rate,avg_frame_rate,nb_read_frames")
                self.assertEqual((rate, average, frames), ("24000/1001", "24000/1001", "12"))
        for rate in ("30000/1001", "60000/1001", "25/2", "100/3", "1/2"):
            with self.subTest(rate):
                self.check(0, "render", "scene.toml", "-o", "b.mp4", "--fps", rate, "--duration", "2")
                self.assertEqual(program.probe(self.folder / "b.mp4", "r_frame_rate"), [rate])
        self.check(0, "render", "scene.toml", "-o", "c.mp4", "--set", "output.fps=24000/1001")
        self.assertEqual((self.folder / "a.mp4").read_bytes(), (self.folder / "c.mp4").read_bytes())

    def test_times_are_whole_multiples(self):
        self.check(0, "render", "scene.toml", "-o", "a.mp4", "--fps", "30000/1001")
        times = program.probe(self.folder / "a.mp4", "time_base,duration_ts")
        base, ticks = times
        self.assertEqual(int(ticks) % 15, 0)   # frames of 0.5 s
        self.assertEqual(int(ticks) // 15 * 30000 % (int(base.split("/")[1]) * 1001 // 1001), 0)
        self.check(0, "simulate", "scene.toml", "--energy", "e.csv", "--fps", "30000/1001")
        rows = self.rows("e.csv")
        self.assertEqual(len(rows), 15)
        self.assertAlmostEqual(float(rows[14]["time"]), 14 * 1001 / 30000, delta=1e-15)

    def test_every_program_of_a_clip_takes_it(self):
        usual = ("scene.toml", "--fps", "24000/1001")
        self.check(0, "render", *usual, "--frames", "out", "-o", "a.mp4", "--resume")
        self.assertEqual(program.probe(self.folder / "a.mp4", "r_frame_rate"), ["24000/1001"])
        self.check(0, "encode", "out", "-o", "b.mp4")
        self.check(0, "encode", "out", "-o", "c.mp4", "--fps", "24000/1001")
        for clip in ("b.mp4", "c.mp4"):
            self.assertEqual(program.probe(self.folder / clip, "r_frame_rate"), ["24000/1001"])
        self.check(0, "compare", "out", "a.mp4", "--fps", "24000/1001", *LOSSY)
        self.check(0, "simulate", *usual, "--checkpoints", "states", "--every", "0.1")
        self.check(0, "render", *usual, "--frames", "parts", "--from-checkpoints", "states", "--frames-range", "6-8")
        self.assertEqual((self.folder / "parts/frame_000007.png").read_bytes(),
                         (self.folder / "out/frame_000007.png").read_bytes())
        self.check(0, "export", *usual, "-o", "a.glb")
        self.check(0, "plot", *usual, "--of", "energy", "-o", "a.svg")
        self.assertIn("12 frames at 24000/1001 frames/s", self.check(0, "info", *usual).stdout)

    def test_other_texts_are_refused(self):
        for wrong in ("0/1", "1/0", "-1/2", "1/-2", "1/2/3", "24000/", "/1001", "1.5/2", "2000000/3", "1/9999999999999999999",
                      "1e3/1", " 1/2", "fast"):
            with self.subTest(wrong):
                run = self.check(2, "render", "scene.toml", "--frames", "out", "--fps=" + wrong)
                self.assertRegex(run.stderr, r"^error: --fps: must be a number .*, or a fraction of two whole numbers from 1 to 1000000")
                self.write("bad.toml", program.SCENE.replace("fps = 10", f"fps = {json.dumps(wrong)}"))
                run = self.check(2, "render", "bad.toml", "--frames", "out")
                self.assertRegex(run.stderr, r"^bad\.toml:8:7: error: fps must be a number .*, or a fraction of two whole numbers")
        self.assertEqual(self.names(), ["bad.toml"])

    def test_panels_of_nearly_the_same_rate(self):
        self.write("film.toml", program.SCENE.replace("fps = 10", 'fps = "24000/1001"'))
        self.write("near.toml", program.SCENE.replace("fps = 10", "fps = 23.976"))
        run = self.check(2, "render", "film.toml", "near.toml")
        self.assertIn("24000/1001", run.stderr)
        self.assertIn("23.976", run.stderr)


class OddSizes(program.ProgramTest):
    def test_the_line_names_the_size_of_the_file(self):
        for clip in CLIPS:
            with self.subTest(clip):
                run = self.check(0, "render", "scene.toml", "-o", clip, "--size", "49x33", "--frames", "out")
                even = clip not in ("a.webm", "a.gif")
                size = ["50", "34"] if even else ["49", "33"]
                self.assertEqual(program.probe(self.folder / clip, "width,height"), size)
                self.assertIn(f"wrote {clip}: 6 frames of {size[0]} x {size[1]}" + (" (49 x 33 with the last column and "
                              "row twice: H.264 has even sizes)" if even else "\n"), run.stderr)
                run = self.check(0, "encode", "out", "-o", "e-" + clip)
                self.assertEqual(program.probe(self.folder / ("e-" + clip), "width,height"), size)
                self.assertIn(f"of {size[0]} x {size[1]}", run.stderr)
                self.check(0, "compare", "out", clip, *LOSSY)
                self.check(0, "compare", clip, "out", *LOSSY)
        self.check(0, "compare", "a.mp4", "a.webm", *LOSSY)

    def test_one_odd_side(self):
        for size, stored, twice in (("49x32", "50 x 32", "column"), ("48x33", "48 x 34", "row")):
            run = self.check(0, "render", "scene.toml", "-o", "a.mp4", "--size", size, "--duration", "0", "--frames", size)
            self.assertIn(f"frames of {stored} ({size.replace('x', ' x ')} with the last {twice} twice", run.stderr)
            self.check(0, "compare", size, "a.mp4", *LOSSY)

    def test_transparent_clips_and_segments_keep_odd_sizes(self):
        for clip in ("a.webm", "a.mov"):
            self.check(0, "render", "scene.toml", "-o", clip, "--size", "49x33", "--transparent", "--duration", "0.2")
            self.assertEqual(program.probe(self.folder / clip, "width,height"), ["49", "33"])
        self.check(0, "render", "scene.toml", "-o", "b.webm", "--size", "49x33", "--resume")
        self.assertEqual(program.probe(self.folder / "b.webm", "width,height"), ["49", "33"])

    def test_another_size_is_no_padding(self):
        self.check(0, "render", "scene.toml", "-o", "a.mp4", "--size", "50x34", "--duration", "0")
        for size in ("48x34", "50x32", "51x34", "49x32"):
            self.check(0, "render", "scene.toml", "--frames", size, "--size", size, "--duration", "0")
            self.assertIn("broken", self.check(2, "compare", size, "a.mp4").stdout)

    def test_the_log_has_both_sizes(self):
        run = self.check(0, "render", "scene.toml", "-o", "a.mp4", "--size", "49x33", "--duration", "0", "--log", "json")
        wrote = next(event for event in map(json.loads, run.stderr.splitlines()) if event["event"] == "wrote")
        self.assertEqual([wrote[key] for key in ("width", "height", "clip_width", "clip_height")], [49, 33, 50, 34])


if __name__ == "__main__":
    program.main()
