"""`encode`: a clip from existing frames."""

import os

import program


class Encode(program.ProgramTest):
    def frames(self, count, width=40, height=30):
        (self.folder / "in").mkdir()
        for n in range(count):
            data = program.png(width, height, boxes=[(2 + 3 * n, 10, 6, 6, (220, 60, 30))])
            (self.folder / "in" / f"frame_{n:06}.png").write_bytes(data)

    def fails(self, code, *parts, clip="a.mp4"):
        run = self.check(code, "encode", "in", "-o", clip)
        for part in parts:
            self.assertIn(part, run.stderr)
        self.assertEqual([name for name in self.names() if not name.startswith("in")], [])

    def test_a_clip(self):
        self.frames(8)
        run = self.check(0, "encode", "in", "-o", "a.mp4", "--fps", "29.97")
        self.assertIn("wrote a.mp4: 8 frames of 40 x 30", run.stderr)
        self.assertEqual(program.probe(self.folder / "a.mp4", "width,height,avg_frame_rate,nb_read_frames"),
                         ["40", "30", "2997/100", "8"])

    def test_60_frames_a_second_by_default(self):
        self.frames(2)
        self.assertEqual(self.check(0, "encode", "in", "-o", "a.webm", "--quiet").stderr, "")
        self.assertEqual(program.probe(self.folder / "a.webm", "avg_frame_rate,nb_read_frames"), ["60/1", "2"])

    def test_the_same_as_render_makes(self):
        self.check(0, "render", "scene.toml", "-o", "a.mp4", "--frames", "in")
        self.check(0, "encode", "in", "-o", "b.mp4", "--fps", "10")
        self.assertEqual((self.folder / "a.mp4").read_bytes(), (self.folder / "b.mp4").read_bytes())

    def test_qualities(self):
        self.frames(8)
        for ending in ("mp4", "webm", "gif"):
            clips = {}
            for quality in ("draft", "normal", "best"):
                self.check(0, "encode", "in", "-o", f"{quality}.{ending}", "--quality", quality)
                clips[quality] = (self.folder / f"{quality}.{ending}").read_bytes()
            self.check(0, "encode", "in", "-o", f"default.{ending}")
            self.assertTrue((self.folder / f"default.{ending}").read_bytes() == clips["normal"], ending)
            if ending != "gif":   # of two colors, which every GIF holds
                self.assertEqual(len(set(clips.values())), 3, ending)
        for command in (("encode", "in"), ("render", "scene.toml")):
            run = self.check(2, *command, "-o", "a.mp4", "--quality", "good")
            self.assertIn("--quality: must be one of draft, normal, best (was 'good')", run.stderr)
            self.assertFalse((self.folder / "a.mp4").exists())

    def test_a_gap(self):
        self.frames(5)
        (self.folder / "in/frame_000002.png").unlink()
        self.fails(2, "in/frame_000002.png: error: the frame is missing", "frame_000004.png")

    def test_the_first_is_missing(self):
        self.frames(3)
        (self.folder / "in/frame_000000.png").unlink()
        self.fails(2, "in/frame_000000.png: error: the frame is missing")

    def test_mixed_sizes(self):
        self.frames(3)
        (self.folder / "in/frame_000001.png").write_bytes(program.png(41, 30))
        self.fails(2, "in/frame_000001.png: error: the frame is 41 x 30 pixels, but the first one is 40 x 30")

    def test_broken_frames(self):
        self.frames(3)
        (self.folder / "in/frame_000001.png").write_bytes(b"no picture")
        self.fails(2, "in/frame_000001.png: error: not a whole PNG")
        (self.folder / "in/frame_000001.png").write_bytes(program.png(40, 30)[:90])   # its header is valid
        self.fails(2, "in/frame_000001.png: error: not a whole PNG")

    def test_a_frame_that_is_a_pipe_or_device_is_refused(self):
        self.frames(3)
        frame = self.folder / "in/frame_000001.png"
        for make in (lambda: os.mkfifo(frame), lambda: frame.symlink_to("/dev/zero"), lambda: frame.symlink_to("/dev/tty")):
            frame.unlink()
            make()
            run = self.check(2, "encode", "in", "-o", "a.mp4", timeout=60)
            self.assertIn("in/frame_000001.png: error: is not a regular file", run.stderr)
            self.assertFalse((self.folder / "a.mp4").exists())

    def test_other_files_do_not_matter(self):
        self.frames(2)
        for name in ("notes.txt", "frame_1.png", "frame_000007.jpg", "frame_00000x.png", ".frame_000002.part-1.png"):
            (self.folder / "in" / name).write_text("")
        self.check(0, "encode", "in", "-o", "a.mp4")
        self.assertEqual(program.probe(self.folder / "a.mp4", "nb_read_frames"), ["2"])

    def test_no_frames(self):
        (self.folder / "in").mkdir()
        self.fails(2, "in: error: the folder holds no frames")

    def test_no_folder(self):
        self.fails(2, "in: error: cannot be read as a folder")

    def test_wrong_endings_and_rates(self):
        self.frames(2)
        self.fails(2, "unknown kind of clip", clip="a.jpeg")
        for fps in ("0", "-5", "nan", "1e7"):
            self.check(2, "encode", "in", "-o", "a.mp4", f"--fps={fps}")

    def test_no_ffmpeg(self):
        self.frames(2)
        run = self.check(1, "encode", "in", "-o", "a.mp4", env={**os.environ, "PATH": str(self.folder)})
        self.assertIn("apt-get install ffmpeg", run.stderr)


if __name__ == "__main__":
    program.main()
