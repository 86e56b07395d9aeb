"""`lesson`: pages from Markdown, stated numbers checked against the runs, and mistakes with their places."""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import unittest

import pages
import program

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
COMPILER = ROOT / "build/web/lesson.cjs"
HEAD = """\
+++
title = "Bounce & rest"
summary = "How high?"
order = {order}
+++

Text with $\\vrel$.

"""
SCENE = """\
[simulation]
duration = 1.0
impacts = "exact"
integrator = "exact"
[output]
size = [64, 36]
fps = 100
samples = 1
[[body]]
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.1 }
restitution = 0.5
position = [0.0, 1.1, 0.0]
"""
STAGE = """\
```tumble
format = 1
title = "Drop"
[stage]
id = "drop"
alt = "A ball falls on a floor."
caption = "A *ball*."
""" + SCENE + "```\n"
# Falls 1 m: v = sqrt(2 g), and the impulse is m (1 + e) v.
NUMBERS = """
```measure
stage = "drop"
[[row]]
label = "speed"
expected = {speed}
tolerance = 1e-9
unit = "m/s"
check = {{ impact = 1, column = "v_before" }}
[[row]]
label = "start"
expected = 1.1
tolerance = 1e-12
check = {{ of = "body.ball.y", take = "max" }}
```

```quiz
question = "How fast after it?"
stage = "drop"
unit = "m/s"
answer = {answer}
tolerance = 1e-3
check = {{ impact = 1, column = "v_after" }}
```
"""
SPEED = -(2 * 9.81) ** 0.5
CONVERGENCE = """
```convergence
of = "body.ball.y"
at = 0.2
integrators = ["explicit-euler", "rk4"]
steps_per_frame = [1, 2, 4, 8]
exact = {exact}
slopes = {{ explicit-euler = {slope} }}
format = 1
[stage]
alt = "Errors."
""" + SCENE.replace('impacts = "exact"\n', "").replace("{", "{{").replace("}", "}}") + "```\n"
FALLEN = 1.1 - 0.5 * 9.81 * 0.2**2


@unittest.skipUnless(shutil.which("node"), "there is no node on the PATH")
@unittest.skipUnless(COMPILER.exists(), "there is no build/web/lesson.cjs (scripts/build-web)")
class LessonTest(pages.PageTestCase):
    def setUp(self):
        super().setUp()
        shutil.copy(COMPILER, self.web)

    def lesson(self, name, text, order=1):
        self.write(name, HEAD.format(order=order) + text)

    def mistake(self, text, expected, *options):
        """The text after the head fails with this message, and nothing is written."""
        self.lesson("a.md", text)
        result = self.check(2, "lesson", "a.md", "-o", "site", *options)
        self.assertRegex(result.stderr, expected)
        self.assertFalse((self.folder / "site").exists())

    def line_of(self, text, part):
        return (HEAD.format(order=1) + text)[:(HEAD.format(order=1) + text).index(part)].count("\n") + 1

    def test_pages_contents_and_links(self):
        self.lesson("last.md", STAGE + NUMBERS.format(speed=SPEED, answer=-SPEED / 2), order=7)
        self.lesson("first.md", STAGE.replace("drop", "throw") + "See [](last.md).\n", order=-1)
        self.check(0, "lesson", "last.md", "first.md", "-o", "site", "--title", "A & B", "--quiet")
        self.assertEqual(sorted(f.name for f in (self.folder / "site").iterdir()), ["first.html", "index.html", "last.html"])
        last = pages.Page(self.folder / "site/last.html")
        for element, attribute, address in last.addresses():
            self.assertRegex(address, r"^(data:|#|[a-z]+\.html$)", f"{element} {attribute}")
        text = (self.folder / "site/last.html").read_text(encoding="utf-8")
        self.assertIn("first.html", text)
        self.assertIn("Bounce &amp; rest", text)
        self.assertIn("−4.42944691807", text)   # measured
        self.assertNotIn("<!--", text)
        self.assertEqual(len(last.all("script", id="clip-drop")), 1)
        figure = last.one("figure", id="drop")
        self.assertEqual(figure[1]["data-clip"], "clip-drop")
        picture = last.one("img")
        self.assertEqual(picture[1]["alt"], "A ball falls on a floor.")
        self.assertTrue(picture[1]["src"].startswith("data:image/"))
        index = (self.folder / "site/index.html").read_text(encoding="utf-8")
        self.assertLess(index.index("first.html"), index.index("last.html"))
        self.assertIn("<h1>A &amp; B</h1>", index)

    def test_the_example_of_the_guide(self):
        guide = (ROOT / "docs/how-to/lessons.md").read_text(encoding="utf-8")
        example = re.search(r"````markdown\n(.*?)````", guide, re.DOTALL)[1]
        message = re.search(r"^drop\.md:.*", guide, re.MULTILINE)[0]
        self.write("drop.md", example)
        self.assertIn(message, self.check(2, "lesson", "drop.md", "--check", "--no-pictures").stderr.splitlines())
        self.write("drop.md", example.replace("answer = 4.429", "answer = 3.544"))
        self.check(0, "lesson", "drop.md", "-o", "site", "--no-pictures", "--quiet")

    def test_threads_change_nothing(self):
        self.lesson("a.md", STAGE + NUMBERS.format(speed=SPEED, answer=-SPEED / 2) + STAGE.replace("drop", "again")
                    + CONVERGENCE.format(exact=FALLEN, slope=1))
        for threads in (1, 3):
            self.check(0, "lesson", "a.md", "-o", f"site{threads}", "--threads", threads, "--quiet")
        for name in ("a.html", "index.html"):
            self.assertEqual((self.folder / "site1" / name).read_bytes(), (self.folder / "site3" / name).read_bytes())

    def test_a_stated_number_that_the_run_does_not_give(self):
        text = STAGE + NUMBERS.format(speed=SPEED + 1e-6, answer=-SPEED / 2)
        line = self.line_of(text, "expected = ")
        self.mistake(text, rf"^a\.md:{line}:1: error: expected, of 'speed': the lesson has .* m/s, the run .* m/s "
                           r"\(deviation 1e-06, allowed 1e-09\)$")
        text = STAGE + NUMBERS.format(speed=SPEED, answer=2.3)
        self.mistake(text, rf"^a\.md:{self.line_of(text, 'answer = ')}:1: error: answer: the lesson has 2\.3 m/s")

    def test_all_mistakes_are_told_in_order(self):
        text = STAGE + NUMBERS.format(speed=1, answer=2)
        self.lesson("a.md", text)
        errors = self.check(2, "lesson", "a.md", "-o", "site").stderr.splitlines()
        self.assertEqual([int(e.split(":")[1]) for e in errors],
                         [self.line_of(text, "expected = "), self.line_of(text, "answer = ")])

    def test_mistakes_of_scenes_have_the_line_of_the_lesson(self):
        text = STAGE.replace("radius = 0.1", "radius = -0.1")
        line = self.line_of(text, "radius")
        self.mistake(text, rf"^a\.md:{line}:\d+: error: .*radius")
        self.mistake(STAGE.replace("restitution", "restitutio"), r'^a\.md:\d+:\d+: error: unknown key "restitutio"')
        self.mistake(STAGE.replace("alt =", 'set = ["simulation.gravty=1"]\nalt ='), r"^a\.md:14:1: error: set: ")
        self.mistake(STAGE.replace("alt =", 'plot = "body.bal.y"\nalt ='), r'^a\.md:14:1: error: plot: .*"bal"')
        self.mistake(STAGE.replace("alt =", 'follow = "bal"\nalt ='), r"^a\.md:14:1: error: follow: no body")
        self.mistake(STAGE.replace("alt =", "time = 3.0\nalt ="), r"time: the run ends at 1 s \(given 3\)")

    def test_mistakes_of_the_text_have_their_column(self):
        self.mistake("Text $\\foo$.", r"^a\.md:9:7: error: TeX: unknown command '\\foo'")

    def test_checks_of_missing_quantities(self):
        numbers = NUMBERS.format(speed=SPEED, answer=-SPEED / 2)
        self.mistake(STAGE + numbers.replace("impact = 1", "impact = 90", 1), r"check: the run has \d+ impacts \(asked for impact 90\)")
        self.mistake(STAGE + numbers.replace("ball.y", "ball.q"), r"a body has no quantity")
        self.mistake(STAGE + numbers.replace('take = "max"', 'take = "at", at = 2.0'), r"the run ends at 1 s")
        self.mistake(STAGE + numbers.replace('take = "max"', 'take = "max", run = 1'), r"the stage has 1 runs")

    def test_slopes_are_measured(self):
        self.lesson("a.md", CONVERGENCE.format(exact=FALLEN, slope=1))
        self.check(0, "lesson", "a.md", "-o", "site", "--quiet")
        text = (self.folder / "site/a.html").read_text(encoding="utf-8")
        rows = re.findall(r"<tr><th scope=\"row\">(.*?)</th>.*?<td[^>]*>.*?</td><td[^>]*>(.*?)</td>", text)
        # Explicit Euler is of first order; a parabola has no error of fourth order.
        self.assertEqual(rows, [("explicit-euler", "1.00"), ("rk4", "none")])
        shutil.rmtree(self.folder / "site")
        self.mistake(CONVERGENCE.format(exact=FALLEN, slope=2), r"slopes: explicit-euler has slope 2 in the lesson, and 1\.000 in the runs")
        self.mistake(CONVERGENCE.format(exact=FALLEN, slope=1).replace("at = 0.2", "at = 0.205"), r"at: must be the time of a frame")

    def test_a_scene_file_and_its_variants(self):
        self.write("drop.toml", "format = 1\n" + SCENE)
        block = '```tumble\n[stage]\nid = "drop"\nscene = "drop.toml"\nvary = ["body.ball.restitution=0.2,0.8"]\nalt = "A ball."\n```\n'
        measure = ('```measure\nstage = "drop"\n[[row]]\nlabel = "e"\nexpected = 0.8\ntolerance = 1e-12\n'
                   'check = { impact = 1, column = "restitution", run = 1 }\n```\n')
        self.lesson("a.md", block + measure)
        self.check(0, "lesson", "a.md", "-o", "site", "--quiet")
        shutil.rmtree(self.folder / "site")
        self.mistake(block.replace("drop.toml", "missing.toml"), r"^a\.md:12:1: error: scene: there is no file missing\.toml")

    def test_numbers_are_checked_in_the_run(self):
        block = ('```numbers\nstage = "drop"\nequation = \'\'\'\\vrelp\'\'\'\nvalue = "vrelp"\nexpression = "{}"\n```\n')
        # Begins with the second impact, at rest before the first.
        text = STAGE + block.format("-e*vrel")
        self.lesson("a.md", text)
        self.check(0, "lesson", "a.md", "-o", "site", "--quiet", "--no-pictures")
        shutil.rmtree(self.folder / "site")
        text = STAGE + block.format("-0.6*vrel")
        self.mistake(text, rf"^a\.md:{self.line_of(text, 'value = ')}:1: error: value: the left side is 2\.2147\d+ and the right "
                           r"side 2\.657\d+ at 0\.45\d+ s in the run \(residual 0\.17, allowed 1e-06\)$")
        self.lesson("a.md", text.replace('value = "vrelp"', 'value = "vrelp"\ntolerance = 0.2'))
        self.check(0, "lesson", "a.md", "--check", "--quiet", "--no-pictures")
        self.mistake(text.replace('stage = "drop"\neq', 'stage = "drop"\nimpact = 900\neq'),
                     r":\d+:1: error: impact: the run has \d+ impacts \(asked for impact 900\)")
        self.mistake(text.replace('stage = "drop"\neq', 'stage = "drop"\nrun = 1\neq'), r"run: the stage has 1 runs")
        now = text.replace('stage = "drop"\neq', 'stage = "drop"\nmoment = "now"\neq').replace('value = "vrelp"', 'value = "P"')
        self.mistake(now.replace("-0.6*vrel", "1.01*m*v"), r"error: value: the left side is \(0, .*residual 0\.0099")
        self.lesson("a.md", now.replace("-0.6*vrel", "m*v"))
        self.check(0, "lesson", "a.md", "--check", "--quiet", "--no-pictures")

    def test_runs_have_the_labels_of_the_lesson(self):
        varied = 'vary = ["body.ball.position=[0,1.1,0],[0.2,1.1,0]"]\nlabels = ["in the middle", "beside \'it\' <b>"]\nalt ='
        self.lesson("a.md", STAGE.replace("alt =", varied))
        self.check(0, "lesson", "a.md", "-o", "site", "--quiet", "--no-pictures")
        header, _ = pages.Page(self.folder / "site/a.html").clip("clip-drop")
        self.assertEqual([run["label"] for run in header["runs"]], ["in the middle", "beside 'it' <b>"])
        shutil.rmtree(self.folder / "site")
        self.mistake(STAGE.replace("alt =", varied.replace(', "beside \'it\' <b>"', "")),
                     r"^a\.md:15:1: error: labels: needs one label for each run \(given 1 for 2\)")
        self.mistake(STAGE.replace("alt =", varied.replace("in the middle", "beside 'it' <b>")), r"labels: labels tell runs apart .* twice")
        self.mistake(STAGE.replace("alt =", varied.replace("in the middle", "")), r"labels: labels tell runs apart")

    def test_malformed_texts_are_mistakes_with_places(self):
        self.mistake("Text [a](%E0%A4%A).", r"^a\.md:9:10: error: the address .* malformed percent escape")
        self.lesson("a.md", "## One\n\n[](#one) %%text:99%%\n")
        self.check(0, "lesson", "a.md", "--check", "--quiet")
        for ending, expected in ((b"\xff", "is not UTF-8"), (b"\x00", r"control character U\+0000"), (b"$\\includegraphics{a.b'>}$", "cannot stand")):
            (self.folder / "a.md").write_bytes(HEAD.format(order=1).encode() + b"Text " + ending)
            self.assertRegex(self.check(2, "lesson", "a.md", "-o", "site").stderr, rf"^a\.md:9:\d+: error: .*{expected}")
        self.assertFalse((self.folder / "site").exists())

    def test_pictures_are_regular_files_of_the_lessons_folder(self):
        outside = self.folder.parent / (self.folder.name + "-outside.png")
        outside.write_bytes(b"secret")
        self.addCleanup(outside.unlink)
        (self.folder / "pictures").mkdir()
        (self.folder / "pictures/right.png").write_bytes(b"\x89PNG")
        (self.folder / "link_in.png").symlink_to("pictures/right.png")
        self.lesson("a.md", "![A](pictures/right.png) ![B](link_in.png)\n")
        self.check(0, "lesson", "a.md", "-o", "site", "--quiet")
        self.assertEqual((self.folder / "site/a.html").read_text(encoding="utf-8").count("data:image/png;base64,iVBORw=="), 2)
        shutil.rmtree(self.folder / "site")
        (self.folder / "link_out.png").symlink_to(outside)
        (self.folder / "folder_out").symlink_to(self.folder.parent)
        (self.folder / "folder.png").mkdir()
        os.mkfifo(self.folder / "pipe.png")
        for address, expected in (
                ("link_out.png", "outside of the lesson's folder"), (f"folder_out/{outside.name}", "outside of the lesson's folder"),
                (f"../{outside.name}", "outside of the lesson's folder"), ("folder.png", "not a regular file"),
                ("pipe.png", "not a regular file"), ("missing.png", "there is no such file")):
            self.mistake(f"Text ![A]({address})\n", rf"^a\.md:9:6: error: cannot read the picture '.*': .*{expected}")

    def test_the_compiler_ends_with_the_program(self):
        self.lesson("a.md", STAGE)
        # A compiler that never ends.
        self.write("hang.cjs", "JSON.stringify = () => { for (;;); };")
        started = subprocess.Popen([program.TUMBLE, "lesson", "a.md", "--check"], cwd=self.folder,
                                   env={**os.environ, "NODE_OPTIONS": f"--require {self.folder}/hang.cjs"})
        compiler = self.wait_for(lambda: self.child_of(started.pid))
        started.kill()
        started.wait()
        try:
            self.wait_for(lambda: not pathlib.Path(f"/proc/{compiler}").exists() or self.is_zombie(compiler))
        finally:
            if pathlib.Path(f"/proc/{compiler}").exists():
                os.kill(compiler, signal.SIGKILL)

    def wait_for(self, condition):
        for _ in range(600):
            if found := condition():
                return found
            time.sleep(0.05)
        self.fail("nothing happened in 30 s")

    @staticmethod
    def child_of(parent):
        """The Node.js process of that parent, once it runs its own program."""
        for status in pathlib.Path("/proc").glob("[0-9]*/stat"):
            try:
                name, rest = status.read_text().rsplit(")", 1)
                if int(rest.split()[1]) == parent and "node" in name:
                    return int(status.parent.name)
            except OSError:
                pass
        return None

    @staticmethod
    def is_zombie(process):
        try:
            return pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
        except OSError:
            return True

    def test_the_contents_have_pictures(self):
        self.lesson("a.md", STAGE)
        self.lesson("b.md", "No stage.\n", order=2)
        self.check(0, "lesson", "a.md", "b.md", "-o", "site", "--quiet")
        index = pages.Page(self.folder / "site/index.html")
        picture = pages.Page(self.folder / "site/a.html").one("img")
        self.assertEqual([image[1]["src"] for image in index.all("img")], [picture[1]["src"]])
        self.check(0, "lesson", "a.md", "b.md", "-o", "bare", "--quiet", "--no-pictures")
        self.assertEqual(pages.Page(self.folder / "bare/index.html").all("img"), [])

    def test_check_writes_nothing(self):
        self.lesson("a.md", STAGE + NUMBERS.format(speed=SPEED, answer=-SPEED / 2))
        self.check(0, "lesson", "a.md", "--check", "--quiet")
        self.assertEqual(self.names(), ["a.md"])

    def test_without_node_it_says_what_to_install(self):
        self.lesson("a.md", STAGE)
        result = self.check(1, "lesson", "a.md", "-o", "site", env={**os.environ, "PATH": str(self.folder)})
        self.assertIn("Node.js", result.stderr)
        self.assertIn("apt-get install nodejs", result.stderr)

    def test_usage(self):
        self.check(2, "lesson", "missing.md", "-o", "site")
        self.lesson("a.md", STAGE)
        self.assertIn("-o", self.check(2, "lesson", "a.md").stderr)
        self.lesson("index.md", STAGE)
        self.assertIn("'index' is taken", self.check(2, "lesson", "index.md", "-o", "site").stderr)


if __name__ == "__main__":
    program.main()
