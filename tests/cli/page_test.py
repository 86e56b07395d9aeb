"""`page`: one file without a network, its security policy, its film, and its mistakes."""

import os
import pathlib
import resource

import pages
import program

BALL = """\
format = 1
title = "Ball & <b>floor</b>"
[simulation]
duration = 1.0
steps_per_frame = 4
impacts = "exact"
[output]
size = [320, 180]
fps = 60
samples = 1
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
restitution = 0.5
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.25 }
position = [0.0, 1.0, 0.0]
# </code></pre></details><script>alert(1)</script> {{clips}}
"""
DEMOS = pathlib.Path(__file__).resolve().parent.parent.parent / "assets/scenes"
PLAYER_BYTES = 400_000  # of the built player and its style in a page, at most; the stub has nearly none
ALLOWED = "default-src 'none'; style-src 'unsafe-inline'; img-src data: blob:; media-src data: blob:; font-src data:; base-uri 'none'; form-action 'none'"


class PageTest(pages.PageTestCase):
    def setUp(self):
        super().setUp()
        self.write("scene.toml", BALL)

    def page(self, *arguments, name="scene.html"):
        self.check(0, "page", *arguments, "--quiet")
        return pages.Page(self.folder / name)

    def test_is_one_file_that_loads_nothing(self):
        page = self.page("scene.toml")
        self.assertEqual(self.names(), ["scene.html"])
        for element, attribute, address in page.addresses():
            self.assertRegex(address, r"^(data:|#)", f"{element} {attribute}")
        policy = page.policy()
        scripts = policy.pop("script-src")
        self.assertEqual(policy, {p.split()[0]: p.split()[1:] for p in ALLOWED.split(";")})
        # Both scripts run, and nothing else: their texts are those that the policy has the hashes of.
        running = [e[2] for e in page.all("script") if e[1].get("type") != "text/plain"]
        packed = pages.base64.b64decode(page.one("script", id="tumble-player")[2])
        running.append(pages.zlib.decompress(packed, -15).decode())
        self.assertEqual(scripts, [pages.sha256(text) for text in running])
        for element in page.elements:
            self.assertFalse([name for name in element[1] if name.startswith("on")], element[0])

    def test_text_of_scenes_stays_text(self):
        page = self.page("scene.toml", "--title", "</title><script>1</script>\"'&\x01")
        self.assertEqual(page.one("title")[2], "</title><script>1</script>\"'&\ufffd")
        self.assertEqual(page.one("h1")[2], page.one("title")[2])
        self.assertEqual(page.one("code")[2], BALL)
        self.assertEqual(len(page.all("script")), 3)
        self.assertEqual(page.clip()[0]["title"], page.one("title")[2].replace("\ufffd", "\x01"))

    def test_data(self):
        page = self.page("scene.toml", "--set", "body.ball.position=[0,2,0]", "--overlay", "velocity", "--plot", "body.ball.y")
        header, _ = page.clip()
        self.assertEqual(header["title"], "Ball & <b>floor</b>")
        self.assertEqual(len(header["runs"]), 1)
        self.assertEqual([s["name"] for s in header["sources"]], ["scene.toml", "Options of the command line"])
        self.assertEqual(header["sources"][1]["text"],
                         "--set body.ball.position=[0,2,0]\n--overlay velocity\n--plot body.ball.y\n")
        self.assertEqual(page.one("html")[1]["data-player"], "loading")
        self.assertEqual(page.one("figure", class_="tumble-player")[1]["data-clip"], "clip-1")

    def test_options_of_the_player(self):
        options = self.page("scene.toml").options()
        self.assertEqual(options["layout"], "page")
        self.assertNotIn("plot", options)  # the player chooses
        options = self.page("scene.toml", "--time", 0.5, "--follow", "ball", "--plot", "contacts").options()
        self.assertEqual((options["time"], options["follow"]), (0.5, "ball"))
        self.assertNotIn("plot", options)  # that of the data

    def test_film_and_picture(self):
        page = self.page("scene.toml", "-o", "a.html", name="a.html")
        video = page.one("video")[1]
        self.assertEqual((video["width"], video["height"]), ("320", "180"))
        kind, film = pages.bytes_of(video["src"])
        self.assertEqual(kind, "video/mp4")
        (self.folder / "film.mp4").write_bytes(film)
        self.assertEqual(program.probe(self.folder / "film.mp4", "width,height,r_frame_rate,nb_read_frames"),
                         ["320", "180", "30/1", "31"])
        kind, picture = pages.bytes_of(video["poster"])
        self.assertEqual((kind, picture[:3]), ("image/jpeg", b"\xff\xd8\xff"))
        video = self.page("scene.toml", "--film-size", "160x90").one("video")[1]
        self.assertEqual((video["width"], video["height"]), ("160", "90"))

    def test_without_film(self):
        page = self.page("scene.toml", "--no-film")
        self.assertEqual(page.all("video"), [])
        picture = page.one("img")[1]
        self.assertEqual(pages.bytes_of(picture["src"])[0], "image/jpeg")
        self.assertIn("2 bodies", picture["alt"])
        self.assertEqual(page.options()["alt"], picture["alt"])

    def test_without_ffmpeg(self):
        run = self.check(0, "page", "scene.toml", env={**os.environ, "PATH": str(self.folder)})
        self.assertIn("no film", run.stderr)
        self.assertEqual(pages.bytes_of(pages.Page(self.folder / "scene.html").one("img")[1]["src"])[1][:4], b"\x89PNG")

    def test_variants(self):
        page = self.page("scene.toml", "--vary", "body.floor.restitution=0.2,0.8", "--compare", "ghost")
        header, _ = page.clip()
        self.assertEqual([run["label"] for run in header["runs"]], ["restitution 0.2", "restitution 0.8"])
        self.assertEqual(page.options()["compare"], "ghost")
        page = self.page("scene.toml", "--vary", "body.ball.position=[0,1,0],[0.2,1,0]", "--label", "in the middle", "--label", "<b>beside</b>")
        self.assertEqual([run["label"] for run in page.clip()[0]["runs"]], ["in the middle", "<b>beside</b>"])
        self.write("b.toml", BALL)
        page = self.page("scene.toml", "b.toml", "--no-film")
        self.assertEqual([run["label"] for run in page.clip()[0]["runs"]], ["scene", "b"])
        self.assertEqual([e[2] for e in page.all("summary")], ["scene.toml", "b.toml"])

    def test_download(self):
        link = self.page("scene.toml", "--no-film", "--embed-glb").one("a", download="scene.glb")[1]
        kind, data = pages.bytes_of(link["href"])
        self.check(0, "export", "scene.toml", "-o", "scene.glb", "--quiet")
        self.assertEqual((kind, data), ("model/gltf-binary", (self.folder / "scene.glb").read_bytes()))

    def test_the_bytes_depend_on_the_scene_alone(self):
        self.write("scene.toml", program.SCENE)
        made = set()
        for threads, workers in ((1, 1), (3, 2), (1, 1)):
            self.page("scene.toml", "--threads", threads, "--workers", workers)
            made.add((self.folder / "scene.html").read_bytes())
        self.assertEqual(len(made), 1)
        self.assertNotIn(str(self.folder).encode(), made.pop())

    def test_size_of_a_page_of_a_hundred_bodies(self):
        self.page(DEMOS / "falling_boxes.toml", name="falling_boxes.html")
        self.assertLess((self.folder / "falling_boxes.html").stat().st_size, 1_500_000 - PLAYER_BYTES)

    def test_mistakes(self):
        for message, *arguments in (
                ("missing.toml", "missing.toml"),
                ('unknown key "masss"', "scene.toml", "--set", "body.ball.masss=1"),
                ("--follow: scene.toml has no body 'box'", "scene.toml", "--follow", "box"),
                ("--time: the clip lasts 1 s (given 2)", "scene.toml", "--time", 2),
                ("--plot: ", "scene.toml", "--plot", "body.box.y"),
                ("--compare: needs two runs", "scene.toml", "--compare", "ghost"),
                ("--embed-glb: needs a single run", "scene.toml", "--vary", "body.ball.mass=1,2", "--embed-glb"),
                ("--label: needs one label for each run (given 1 for 2)", "scene.toml", "--vary", "body.ball.mass=1,2", "--label", "light"),
                ("--label: labels tell runs apart (given 'a' twice)", "scene.toml", "--vary", "body.ball.mass=1,2", "--label", "a", "--label", "a"),
                ("--film-size: must be the width", "scene.toml", "--film-size", "big"),
                ("--vary", "scene.toml", "--vary", "body.ball.mass"),
                ("-o", "scene.toml", "-o", "scene.toml")):
            run = self.check(2, "page", *arguments)
            self.assertIn(message, run.stderr)
            self.assertEqual(self.names(), [], arguments)
        self.assertEqual((self.folder / "scene.toml").read_text(), BALL)

    def test_missing_player(self):
        for folder in (self.folder / "nothing", self.folder):
            run = self.check(1, "page", "scene.toml", env={**os.environ, "TUMBLE_WEB": str(folder)})
            self.assertIn("scripts/build-web", run.stderr)
            self.assertIn(str(folder), run.stderr)
            self.assertEqual(self.names(), [])
        # A scene that is wrong is the first thing to say.
        self.check(2, "page", "missing.toml", env={**os.environ, "TUMBLE_WEB": "nothing"})

    def test_a_template_of_another_version(self):
        (self.web / "page.html").write_text("{{title}} {{color}}")
        run = self.check(1, "page", "scene.toml", "--no-film")
        self.assertIn("unknown place '{{color}}'", run.stderr)
        self.assertEqual(self.names(), [])

    def test_failures_keep_the_existing_file(self):
        self.write("scene.html", "old")
        self.check(1, "page", "scene.toml", "--quiet", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000)))
        self.check(1, "page", "scene.toml", "-o", "missing/scene.html")
        self.assertEqual((self.folder / "scene.html").read_text(), "old")
        self.assertEqual(self.names(), ["scene.html"])


if __name__ == "__main__":
    program.main()
