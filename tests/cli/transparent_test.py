"""`render --transparent` and `encode --transparent`: frames and clips with alpha."""

import subprocess

import program


def rgba(path):
    """Width, height and the bytes of the pixels of a PNG with alpha."""
    width, height, channels, pixels = program.png_pixels(path)
    assert channels == 4, f"{path} has no alpha"
    return width, height, pixels


class Transparent(program.ProgramTest):
    def frames_of(self, folder):
        return [path.read_bytes() for path in sorted((self.folder / folder).glob("frame_*.png"))]

    def alpha_of_clip(self, name, decoder):
        out = subprocess.run(["ffmpeg", "-v", "error", "-c:v", decoder, "-i", self.folder / name, "-vf", "alphaextract",
                              "-f", "rawvideo", "-pix_fmt", "gray", "-"], stdout=subprocess.PIPE, check=True)
        return out.stdout

    def test_frames_have_alpha(self):
        self.check(0, "render", "scene.toml", "--transparent", "--frames", "out", "--samples", "4")
        width, height, pixels = rgba(self.folder / "out/frame_000003.png")
        alpha = pixels[3::4]
        self.assertEqual((width, height), (48, 32))
        self.assertEqual({alpha[0], alpha[-1]}, {0})
        self.assertGreater(alpha.count(255), 20)
        self.assertGreater(len(set(alpha)), 10)
        self.check(0, "render", "scene.toml", "--frames", "opaque")
        self.assertEqual((self.folder / "opaque/frame_000003.png").read_bytes()[25], 2)   # RGB

    def test_any_number_of_workers(self):
        for options in ([], ["--shutter", "180"], ["--samples", "4"], ["--size", "31x17", "--samples", "4"]):
            runs = []
            for workers in ("1", "3"):
                self.check(0, "render", "scene.toml", "--transparent", "--frames", workers, "-o", workers + ".webm",
                           "--workers", workers, *options)
                runs.append(self.frames_of(workers) + [(self.folder / (workers + ".webm")).read_bytes()])
            self.assertEqual(len(runs[0]), 7)
            self.assertTrue(runs[0] == runs[1], options)

    def test_panels_and_text(self):
        for workers in ("1", "3"):
            self.check(0, "render", "scene.toml", "--vary", "simulation.steps_per_frame=4,8", "--overlay", "clock",
                       "--transparent", "--frames", workers, "--size", "240x160", "--workers", workers)
        self.assertTrue(self.frames_of("1") == self.frames_of("3"))
        width, height, pixels = rgba(self.folder / "1/frame_000003.png")
        alpha = pixels[3::4]
        self.assertEqual((alpha[0], alpha[-1]), (0, 0))                  # around the panels
        self.assertGreater(max(alpha[:20 * width]), 200)                 # the text above them
        halves = [b"".join(alpha[y * width + x:y * width + x + width // 2] for y in range(50, height))
                  for x in (0, width // 2)]
        self.assertGreater(min(half.count(255) for half in halves), 50)

    def test_motion_blur_is_partly_transparent(self):
        self.check(0, "render", "scene.toml", "--transparent", "--frames", "sharp")
        self.check(0, "render", "scene.toml", "--transparent", "--frames", "blurred", "--shutter", "360")
        sharp, blurred = (rgba(self.folder / name / "frame_000004.png")[2][3::4] for name in ("sharp", "blurred"))
        self.assertEqual(set(sharp), {0, 255})       # one sample per pixel
        self.assertGreater(len(set(blurred)), 6)     # eight images

    def test_aovs_are_the_same(self):
        for name, options in (("with", ["--transparent"]), ("without", [])):
            self.check(0, "render", "scene.toml", "--frames", name, "--aov", "depth,segmentation,motion", *options)
        for path in sorted((self.folder / "with").glob("aov_*")):
            self.assertEqual(program.unmarked(path), program.unmarked(self.folder / "without" / path.name), path.name)

    def test_clips_keep_alpha(self):
        for name, decoder, codec in (("a.webm", "libvpx-vp9", "vp9"), ("a.mov", "prores", "prores")):
            self.check(0, "render", "scene.toml", "--transparent", "--frames", "in", "-o", name)
            self.assertEqual(program.probe(self.folder / name, "codec_name,nb_read_frames"), [codec, "6"])
            alpha = self.alpha_of_clip(name, decoder)
            wanted = b"".join(rgba(path)[2][3::4] for path in sorted((self.folder / "in").glob("*.png")))
            self.assertEqual(len(alpha), len(wanted))
            self.assertLessEqual(max(abs(a - b) for a, b in zip(alpha, wanted)), 20)
            self.check(0, "encode", "in", "-o", "of-frames-" + name, "--fps", "10", "--transparent")
            self.assertTrue((self.folder / ("of-frames-" + name)).read_bytes() == (self.folder / name).read_bytes())

    def test_encode_leaves_alpha_out_unless_told(self):
        self.check(0, "render", "scene.toml", "--transparent", "--frames", "in")
        self.check(0, "encode", "in", "-o", "a.webm")
        self.check(0, "encode", "in", "-o", "a.mp4")
        self.assertEqual(program.probe(self.folder / "a.webm", "pix_fmt"), ["yuv420p"])
        out = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream_tags=alpha_mode", "-of",
                              "default=nw=1:nk=1", self.folder / "a.webm"], stdout=subprocess.PIPE, text=True, check=True)
        self.assertEqual(out.stdout.strip(), "")

    def test_compare_counts_alpha(self):
        self.check(0, "render", "scene.toml", "--transparent", "--frames", "a", "--samples", "4")
        self.check(0, "render", "scene.toml", "--frames", "b", "--samples", "4")
        a, b = "a/frame_000003.png", "b/frame_000003.png"
        self.assertIn("every pixel is the same", self.check(0, "compare", a, a).stdout)
        self.assertIn("by 255 levels", self.check(1, "compare", a, b).stdout)

    def test_formats_without_alpha(self):
        self.check(0, "render", "scene.toml", "--transparent", "--frames", "in")
        for command in (("render", "scene.toml"), ("encode", "in")):
            for name in ("a.mp4", "a.mkv", "a.gif"):
                run = self.check(2, *command, "--transparent", "-o", name)
                self.assertIn(f"{name}: error: a {name[1:]} clip holds no transparency: .webm", run.stderr)
                self.assertIn(".mov", run.stderr)
                self.assertFalse((self.folder / name).exists())

    def test_a_clip_without_a_name_holds_alpha(self):
        self.check(0, "render", "scene.toml", "--transparent")
        self.assertEqual(self.names(), ["scene.webm"])
        self.assertGreater(len(set(self.alpha_of_clip("scene.webm", "libvpx-vp9"))), 1)


if __name__ == "__main__":
    program.main()
