"""`compare --accept`, JPEG files, pictures of two sizes, times of JUnit; temporary folders of killed runs."""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import xml.etree.ElementTree

import program

GRAY, RED = (120, 120, 120), (200, 60, 60)


class Pictures(program.ProgramTest):
    def put(self, name, color=GRAY, size=(24, 16)):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(program.png(*size, color))
        return path

    def jpeg(self, name, color=GRAY, size=(24, 16), *more):
        """By ffmpeg."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-f", "image2pipe", "-i", "-", "-q:v", "2", "-pix_fmt",
                        "yuvj444p", *more, "-f", "mjpeg", path], input=program.png(*size, color), check=True)
        return path

    def contents(self, folder="."):
        return {str(path.relative_to(self.folder)): os.readlink(path) if path.is_symlink() else path.read_bytes()
                for path in (self.folder / folder).rglob("*") if path.is_symlink() or path.is_file()}

    def verdicts(self, code, *arguments):
        self.check(code, "compare", "a", "b", "--json", "r.json", *arguments)
        images = json.loads((self.folder / "r.json").read_text())["images"]
        return {image["name"]: image["verdict"] for image in images}


class Accept(Pictures):
    def setUp(self):
        super().setUp()
        self.put("a/same.png")
        self.put("b/same.png")
        self.put("a/x.png")
        self.put("b/x.png", RED)
        self.put("a/in/size.png")
        self.put("b/in/size.png", RED, (30, 10))
        self.put("b/new/one.png", RED)

    def test_differing_and_new_pictures_become_references(self):
        before = self.contents("b")
        run = self.check(0, "compare", "a", "b", "--accept", "--junit", "r.xml")
        self.assertIn("accepted: 3 pictures", run.stdout)
        self.assertEqual(xml.etree.ElementTree.parse(self.folder / "r.xml").getroot().get("failures"), "0")
        self.assertEqual({k[2:]: v for k, v in self.contents("a").items()},
                         {k[2:]: v for k, v in before.items()})
        self.assertEqual(self.contents("b"), before)
        self.assertIn("4 same", self.check(0, "compare", "a", "b").stdout)

    def test_missing_ones_stay_and_broken_ones_are_not_taken(self):
        self.put("a/old.png")
        (self.folder / "b/x.png").write_bytes(program.png(24, 16, RED)[:60])
        old = (self.folder / "a/x.png").read_bytes()
        self.check(2, "compare", "a", "b", "--accept")
        self.assertEqual((self.folder / "a/x.png").read_bytes(), old)
        self.assertTrue((self.folder / "a/old.png").exists())
        self.put("b/x.png", RED)
        self.check(3, "compare", "a", "b", "--accept")   # the missing picture remains

    def test_a_broken_reference_is_replaced(self):
        (self.folder / "a/x.png").write_text("no picture")
        self.check(0, "compare", "a", "b", "--accept")
        self.assertEqual((self.folder / "a/x.png").read_bytes(), (self.folder / "b/x.png").read_bytes())

    def test_pictures_within_the_tolerances_stay(self):
        self.put("b/x.png", (121, 120, 120))
        old = (self.folder / "a/x.png").read_bytes()
        self.check(0, "compare", "a", "b", "--accept")
        self.assertEqual((self.folder / "a/x.png").read_bytes(), old)

    def test_nothing_is_written_through_a_link(self):
        self.put("elsewhere/x.png")
        (self.folder / "a/x.png").unlink()
        for name, to in (("x.png", "../elsewhere/x.png"), ("x.png", "same.png"), ("x.png", "../elsewhere/none.png"),
                         ("new", "../elsewhere"), ("new", "in")):
            (self.folder / "a" / name).symlink_to(to)
            before = self.contents()
            run = self.check(2, "compare", "a", "b", "--accept", "--json", "r.json", "--diff", "d", "--report", "r.html")
            self.assertIn("it is a link", run.stderr)
            self.assertEqual(self.contents(), before)
            (self.folder / "a" / name).unlink()
        os.rename(self.folder / "a", self.folder / "real")
        (self.folder / "a").symlink_to("real")   # as the caller names it
        self.check(0, "compare", "a", "b", "--accept")

    def test_platforms(self):
        self.put("a/amd/x.png", (0, 0, 0))
        self.check(0, "compare", "a", "b", "--accept", "--platform", "amd")
        self.assertEqual((self.folder / "a/amd/x.png").read_bytes(), (self.folder / "b/x.png").read_bytes())
        self.assertEqual((self.folder / "a/x.png").read_bytes(), program.png(24, 16, GRAY))
        self.assertTrue((self.folder / "a/amd/new/one.png").exists())

    def test_scenes_clips_and_two_pictures(self):
        self.check(0, "render", "scene.toml", "--frames", "f", "--quiet")
        shutil.copytree(self.folder / "f", self.folder / "g")
        self.put("g/frame_000001.png", RED, (48, 32))
        self.check(0, "compare", "g", "scene.toml", "--accept")
        self.check(0, "compare", "f", "g", "--tolerance", "0", "--fraction", "0")
        self.check(0, "encode", "f", "-o", "c.mp4", "--quality", "best", "--quiet")
        self.put("g/frame_000001.png", RED, (48, 32))
        self.check(0, "compare", "g", "c.mp4", "--accept", "--tolerance", "40", "--window", "255")
        self.check(0, "compare", "g", "c.mp4", "--tolerance", "40", "--window", "255")
        self.assertIn("--accept", self.check(2, "compare", "c.mp4", "g", "--accept").stderr)
        self.check(0, "compare", "a/x.png", "b/x.png", "--accept")
        self.assertEqual((self.folder / "a/x.png").read_bytes(), (self.folder / "b/x.png").read_bytes())
        self.write("a/notes.txt", "notes")
        self.check(2, "compare", "a/notes.txt", "b/x.png", "--accept")
        self.assertEqual((self.folder / "a/notes.txt").read_text(), "notes")


class Jpeg(Pictures):
    def test_jpeg_files_are_compared(self):
        self.jpeg("a/x.jpg")
        self.jpeg("b/x.jpg", (122, 120, 120))
        self.jpeg("a/y.JPEG")
        self.jpeg("b/y.JPEG", RED)
        self.put("a/z.png")
        self.jpeg("b/z.png")   # by its content
        self.assertEqual(self.verdicts(1, "--report", "r.html", "--diff", "d", "--tolerance", "6"),
                         {"x.jpg": "alike", "y.JPEG": "different", "z.png": "same"})
        page = (self.folder / "r.html").read_text()
        self.assertIn("data:image/jpeg;base64,", page)
        self.assertEqual(program.png_size(self.folder / "d/y.JPEG.png"), (24, 16))
        self.check(0, "compare", "a/x.jpg", "a/z.png", "--tolerance", "6")

    def test_the_pixels_are_those_of_ffmpeg(self):
        path = self.folder / "j.jpg"
        subprocess.run(["ffmpeg", "-loglevel", "error", "-f", "lavfi", "-i", "testsrc=size=64x48:duration=1:rate=1",
                        "-frames:v", "1", "-q:v", "2", "-pix_fmt", "yuvj444p", path], check=True)
        subprocess.run(["ffmpeg", "-loglevel", "error", "-i", path, "-pix_fmt", "rgb24", self.folder / "p.png"], check=True)
        self.check(0, "compare", "p.png", "j.jpg", "--tolerance", "3")

    def test_damaged_files(self):
        whole = self.jpeg("a/x.jpg", RED, (64, 64)).read_bytes()
        self.jpeg("b/x.jpg", GRAY, (64, 64))
        for damaged in (whole[:len(whole) * 2 // 3], whole[:20], whole[:-2], b"\xff\xd8\xff" + bytes(100),
                        re.sub(b"(\xff\xc0.{3}).{4}", lambda m: m.group(1) + b"\xff" * 4, whole, flags=re.S)):
            (self.folder / "b/x.jpg").write_bytes(damaged)
            with self.subTest(size=len(damaged)):
                self.assertEqual(self.verdicts(2), {"x.jpg": "broken"})

    def test_pictures_of_other_kinds_are_named(self):
        self.put("a/x.png")
        self.put("b/x.png")
        self.write("a/y.webp", "")
        run = self.check(0, "compare", "a", "b")
        self.assertIn("1 pictures are not compared", run.stderr)
        self.assertIn("y.webp", run.stderr)

    def test_masks_may_be_jpeg(self):
        self.put("a/x.png")
        self.put("b/x.png", RED)
        self.jpeg("mask.jpg", (255, 255, 255))
        self.write("t.toml", 'masks = [{ file = "mask.jpg" }]\n')
        self.check(0, "compare", "a", "b", "--tolerances", "t.toml")


class Sizes(Pictures):
    def test_pictures_of_two_sizes_have_a_picture_of_the_difference(self):
        self.put("a/x.png", GRAY, (24, 16))
        self.put("b/x.png", GRAY, (20, 30))
        self.assertEqual(self.verdicts(2, "--diff", "d", "--report", "r.html"), {"x.png": "broken"})
        width, height, channels, pixels = program.png_pixels(self.folder / "d/x.png")
        self.assertEqual((width, height, channels), (24, 30, 3))
        color = lambda x, y: tuple(pixels[3 * (24 * y + x):][:3])
        self.assertEqual((color(0, 0), color(22, 0), color(0, 20), color(22, 20)),
                         ((40, 40, 40), (136, 136, 40), (40, 136, 40), (0, 0, 0)))
        page = (self.folder / "r.html").read_text()
        self.assertIn('data-role="difference"', page)
        self.assertIn("20 × 30 pixels, the reference 24 × 16", page)
        image = json.loads((self.folder / "r.json").read_text())["images"][0]
        self.assertEqual([image[k] for k in ("width", "height", "image_width", "image_height")], [24, 16, 20, 30])
        run = self.check(2, "compare", "a/x.png", "b/x.png", "--diff", "one.png")
        self.assertIn("different sizes", run.stderr)
        self.assertEqual((self.folder / "one.png").read_bytes(), (self.folder / "d/x.png").read_bytes())
        self.check(2, "compare", "a/x.png", "b/x.png", "--diff", "two.png", "--json", "s.json")
        self.assertEqual((self.folder / "two.png").read_bytes(), (self.folder / "d/x.png").read_bytes())


class Results(Pictures):
    def test_times_of_junit(self):
        self.put("a/x.png")
        self.put("b/x.png", RED)
        self.check(1, "compare", "a", "b", "--junit", "r.xml")
        suite = xml.etree.ElementTree.parse(self.folder / "r.xml").getroot()
        for element in (suite, suite[0]):
            self.assertRegex(element.get("time"), r"^\d+\.\d{3}$")

    def test_no_result_names_a_file_that_is_gone(self):
        self.check(0, "render", "scene.toml", "--frames", "f", "-o", "c.mp4", "--quiet")
        self.put("f/frame_000001.png", RED, (48, 32))
        for under_test in ("scene.toml", "c.mp4"):
            self.check(1, "compare", "f", under_test, "--json", "r.json", "--report", "r.html", "--tolerance", "60",
                       "--window", "255", "--fraction", "0.01")
            for image in json.loads((self.folder / "r.json").read_text())["images"]:
                for side in ("reference", "image"):
                    self.assertTrue(image[side] is None or (self.folder / image[side]).exists(), image[side])
            self.assertIn("data:image/png", (self.folder / "r.html").read_text())
        self.write("golden.toml", 'format = 1\n[[case]]\nname = "c"\nscene = "scene.toml"\n')
        self.check(3, "golden", "check", "golden.toml", "--cache", "none", "--json", "r.json")
        self.assertIsNone(json.loads((self.folder / "r.json").read_text())["images"][0]["image"])


class KilledRuns(Pictures):
    """Each start removes the temporary folders of killed runs."""

    def killed(self, *arguments):
        """The names in the temporary folder once the run has a folder there, and has been killed."""
        run = subprocess.Popen([program.TUMBLE, *arguments], cwd=self.folder, env=self.environment,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while not [path for path in self.temporary.glob("tumble-*/*") if path.name != "mine"] and run.poll() is None and (
                time.monotonic() < deadline):
            time.sleep(0.002)
        run.send_signal(signal.SIGKILL)
        run.wait()
        return [path.name for path in self.temporary.iterdir()]

    def test_their_folders_are_removed(self):
        self.temporary = self.folder / "tmp"
        self.temporary.mkdir()
        self.environment = dict(os.environ, TMPDIR=str(self.temporary))
        (self.temporary / "tumble-page-mine00").mkdir()
        (self.temporary / "tumble-page-mine00/mine").write_text("mine")
        self.write("slow.toml", program.SCENE.replace("duration = 0.5", "duration = 20"))
        self.check(0, "render", "scene.toml", "--frames", "g", "--quiet")
        self.write("golden.toml", 'format = 1\n[[case]]\nname = "c"\nscene = "slow.toml"\nframes = [190]\n')
        for arguments in (("golden", "accept", "golden.toml", "--all"), ("compare", "g", "slow.toml"),
                          ("golden", "check", "golden.toml", "--cache", "none"), ("page", "slow.toml")):
            with self.subTest(arguments=arguments):
                left = len(self.killed(*arguments))
                self.assertTrue(left > 1 or arguments[0] == "page")   # the player may not be built
                deadline = time.monotonic() + 30   # the processes of a killed run end soon
                names = None
                while names != ["tumble-page-mine00"] and time.monotonic() < deadline:
                    self.run_tumble("compare", "g", "scene.toml", "--quiet", env=self.environment)
                    names = [path.name for path in self.temporary.iterdir()]
                    time.sleep(0.05)
                self.assertEqual(names, ["tumble-page-mine00"])
        self.assertEqual((self.temporary / "tumble-page-mine00/mine").read_text(), "mine")


if __name__ == "__main__":
    program.main()
