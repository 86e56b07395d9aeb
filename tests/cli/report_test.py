"""`render --report`: the figures of the page against the tables of `simulate`, its parts, and its mistakes."""

import os
import re

import pages
import program

PUSHED = """\
format = 1
title = "Pushed crate"
[simulation]
duration = 1.0
steps_per_frame = 4
[output]
size = [64, 48]
fps = 20
samples = 1
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
friction = 0.4
restitution = 0.3
[[body]]
name = "crate"
shape = { type = "box", size = [1.0, 1.0, 1.0] }
mass = 2.0
position = [0.0, 0.8, 0.0]
velocity = [2.0, 0.0, 0.0]
friction = 0.4
[[force]]
body = "crate"
force = [3.0, 0.0, 0.0]
"""


def number(text):
    """The number at the start of a text of a page."""
    text = text.replace("\u2212", "-").replace("\u202f", "").replace("\u2009", "")
    value = re.match(r"-?[\d.]+(\u00d710-?\d+)?", text)[0]
    mantissa, _, power = value.partition("\u00d710")
    return float(mantissa) * 10.0 ** int(power or 0)


class ReportTest(pages.PageTestCase):
    def setUp(self):
        super().setUp()
        self.write("scene.toml", PUSHED)

    def report(self, *arguments):
        self.check(0, "render", "scene.toml", "--report", "r.html", "--quiet", *arguments)
        return pages.Page(self.folder / "r.html")

    def rows_of(self, page, caption):
        """The cells of the table with that caption."""
        table = re.search(rf"<caption>{caption}.*?</table>", page.text, re.S)[0]
        cells = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.S) for row in re.findall(r"<tr.*?</tr>", table, re.S)]
        return [[pages.plain(cell) for cell in row] for row in cells]

    def test_energies_are_those_of_the_table(self):
        page = self.report("--frames", "out")
        self.check(0, "simulate", "scene.toml", "--energy", "e.csv", "--quiet")
        table = [{name: float(value) for name, value in row.items()} for row in self.rows("e.csv")]
        shown = {row[0]: row[1:] for row in self.rows_of(page, "Energies in joules")}
        balance = [r["total"] + r["impact_loss"] + r["friction_loss"] - r["work"] for r in table]
        first, last = table[0], table[-1]
        self.assertGreater(last["work"], 1.0)
        for name, start, end in (("kinetic, translation", first["kinetic_linear"], last["kinetic_linear"]),
                                 ("potential", first["potential"], last["potential"]),
                                 ("total", first["total"], last["total"]),
                                 ("+ losses by friction", 0.0, last["friction_loss"]),
                                 ("\u2212 work of drives, wind and forces", 0.0, last["work"]),
                                 ("balance", balance[0], balance[-1])):
            for text, value in zip(shown[name], (start, end, end - start)):
                self.assertAlmostEqual(number(text), value, delta=6e-5 * abs(value) + 1e-12, msg=name)
        self.assertNotIn("elastic", shown)
        residual = max(abs(b - balance[0]) for b in balance)
        said = re.search(r"it is off by (.*?) at most", pages.plain(page.text))[1]
        self.assertAlmostEqual(number(said), residual, delta=0.06 * residual)

    def test_contacts_and_impacts(self):
        page = self.report("--frames", "out")
        self.check(0, "simulate", "scene.toml", "--impacts", "i.csv", "--contacts", "c.csv", "--quiet")
        impacts, contacts = self.rows("i.csv"), self.rows("c.csv")
        text = pages.plain(page.text)
        self.assertIn(f"{len(impacts)} impulses act at contact points", text)
        largest = max(float(row["impulse"]) for row in impacts)
        self.assertAlmostEqual(number(re.search(r"The largest is (.*?), between floor and crate", text)[1]), largest, delta=1e-3 * largest)
        names = {"stick": "sticking", "slip": "sliding", "asleep": "asleep", "open": "touching without load"}
        counted = {name: sum(row["state"] == state for row in contacts if row["a"]) for state, name in names.items()}
        shown = {row[0]: number(row[1]) for row in self.rows_of(page, "Contact points by state")[1:]}
        self.assertEqual(shown, {name: count for name, count in counted.items() if count > 0})
        self.assertGreater(counted["sliding"], 0)

    def test_parts(self):
        page = self.report("--set", "body.crate.mass=3", "-o", "clip.mp4")
        self.assertEqual(self.names(), ["clip.mp4", "r.html"])
        self.assertEqual([e[2] for e in page.all("h2")],
                         ["Energy balance", "Contacts and impacts", "Time and files", "Versions", "Scene"])
        self.assertEqual(page.one("body")[1]["class"], "report")
        self.assertEqual([e[2] for e in page.all("code")], [PUSHED, "--set body.crate.mass=3\n"])
        times = {row[0] for row in self.rows_of(page, "CPU time")}
        self.assertEqual(times, {"simulation", "drawing", "conversion of colors", "encoding"})
        versions = {row[0]: row[1] for row in self.rows_of(page, "Programs")}
        self.assertIn("Mesa", versions["OpenGL"])
        self.assertIn("ffmpeg version", versions["ffmpeg"])
        self.assertIn("clip.mp4: 21 frames of 64 \u00d7 48 at 20 a second", self.rows_of(page, "Files")[0][1])
        self.assertEqual(pages.bytes_of(page.one("video")[1]["src"])[0], "video/mp4")
        for element, attribute, address in page.addresses():
            self.assertRegex(address, r"^(data:|#)", f"{element} {attribute}")

    def test_with_frames_only(self):
        page = self.report("--frames", "out")
        self.assertNotIn("scene.mp4", self.names())
        self.assertEqual({row[0] for row in self.rows_of(page, "CPU time")}, {"simulation", "drawing", "PNG frames"})

    def test_the_frames_stay_the_same(self):
        self.check(0, "render", "scene.toml", "--frames", "a", "--quiet")
        self.report("--frames", "b")
        for name in program.frame_names(21):
            self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "b" / name).read_bytes())

    def test_variants(self):
        page = self.report("--vary", "body.crate.friction=0,1", "--size", "240x120", "--frames", "out")
        self.assertEqual([e[2] for e in page.all("h2", class_="run")], ["friction 0", "friction 1"])
        self.assertEqual(len(page.all("dl", class_="figures")), 2)

    def test_mistakes(self):
        for code, message, *arguments in (
                (2, "--report", "scene.toml", "-o", "r.mp4", "--report", "r.mp4"),
                (2, "--report", "scene.toml", "--report", "scene.toml"),
                (2, "unknown key", "scene.toml", "--report", "r.html", "--set", "body.crate.masss=1")):
            run = self.check(code, "render", *arguments)
            self.assertIn(message, run.stderr)
            self.assertEqual(self.names(), [])
        run = self.check(1, "render", "scene.toml", "--report", "r.html", env={**os.environ, "TUMBLE_WEB": "nothing"})
        self.assertIn("scripts/build-web", run.stderr)
        self.assertEqual(self.names(), [])


if __name__ == "__main__":
    program.main()
