"""`plot`: files of each kind, several runs in one plot, the messages for wrong names."""

import os

import program

SCENE = program.SCENE
HINGE = """
[[joint]]
name = "hinge"
type = "hinge"
bodies = ["world", "crate"]
anchor = [0.0, 4.0, 0.0]
axis = [0.0, 0.0, 1.0]
"""


class Plot(program.ProgramTest):
    def test_files_of_each_kind(self):
        for name, start in (("p.svg", b"<?xml"), ("p.png", b"\x89PNG"), ("p.pdf", b"%PDF")):
            self.check(0, "plot", "scene.toml", "--of", "energy,body.crate.y", "-o", name)
            self.assertTrue((self.folder / name).read_bytes().startswith(start), name)

    def test_size(self):
        self.check(0, "plot", "scene.toml", "--of", "energy", "-o", "p.png", "--size", "640x320")
        self.assertEqual(program.png_size(self.folder / "p.png"), (640, 320))

    def test_the_same_bytes_for_any_number_of_threads(self):
        for threads in (1, 2):
            self.check(0, "plot", "scene.toml", "--of", "energy", "-o", f"{threads}.svg", "--threads", threads)
        self.assertEqual((self.folder / "1.svg").read_bytes(), (self.folder / "2.svg").read_bytes())

    def test_variants_change_the_plot(self):
        arguments = ("plot", "scene.toml", "--of", "total", "--size", "300x200")
        self.check(0, *arguments, "-o", "one.png")
        self.check(0, *arguments, "--vary", "simulation.integrator=explicit-euler,symplectic-euler", "-o", "two.png")
        self.check(0, *arguments, "--vary", "simulation.gravity=[0,-9.81,0],[0,-1.62,0]", "-o", "vectors.png")
        self.check(0, *arguments, "--vary", "simulation.integrator=exact,rk4", "--difference", "--log", "-o", "difference.png")
        self.assertEqual(len({(self.folder / name).read_bytes() for name in self.names()}), 4)

    def test_several_scenes(self):
        self.write("other.toml", SCENE.replace("3.0, 0.0]", "4.0, 0.0]"))
        self.check(0, "plot", "scene.toml", "other.toml", "--of", "body.crate.y", "-o", "p.svg")

    def test_cairo_and_pango_are_opened_for_plots_alone(self):
        loaded = self.run_tumble("--version", env={**os.environ, "LD_TRACE_LOADED_OBJECTS": "1"}).stdout
        self.assertIn("libassimp", loaded)
        self.assertNotRegex(loaded, "pango|cairo|glib")
        # A file that is no library in the place of Pango.
        (self.folder / "libraries").mkdir()
        for name in ("libpangocairo-1.0.so.0", "libpangocairo-1.0.so"):
            (self.folder / "libraries" / name).write_text("no library")
        without = {"env": {**os.environ, "LD_LIBRARY_PATH": str(self.folder / "libraries")}}
        self.check(0, "simulate", "scene.toml", **without)
        run = self.check(1, "plot", "scene.toml", "--of", "energy", "-o", "p.svg", **without)
        self.assertIn("the library of plots and text cannot be opened (it is in the package libpangocairo-1.0-0)", run.stderr)
        self.assertFalse((self.folder / "p.svg").exists())
        self.assertIn("libpangocairo-1.0-0", self.run_tumble("doctor", **without).stdout)

    def refused(self, message, *arguments):
        run = self.check(2, "plot", *arguments)
        self.assertIn(message, run.stderr)
        self.assertEqual(self.names(), [])

    def test_wrong_names(self):
        scene = ("scene.toml", "-o", "p.svg", "--of")
        self.refused('"enrgy": unknown quantity (did you mean "energy"?)', *scene, "enrgy")
        self.refused('no body has the name "crat" (did you mean "crate"?)', *scene, "body.crat.y")
        self.refused('a body has no quantity "sped" (did you mean "speed"?)', *scene, "body.crate.sped")
        self.refused("must be body.NAME.QUANTITY", *scene, "body.crate")
        self.refused("has an empty name", *scene, "energy,")
        self.refused('unknown key "integratr"', *scene, "energy", "--vary", "simulation.integratr=exact,rk4")
        self.refused("has no values", *scene, "energy", "--vary", "simulation.integrator")
        self.refused("needs two runs or more", *scene, "energy", "--difference")
        self.refused("must end with .svg, .png or .pdf", "scene.toml", "--of", "energy", "-o", "p.jpg")
        self.refused("--size", *scene, "energy", "--size", "0x10")

    def test_quantities_of_joints(self):
        self.write("scene.toml", SCENE + HINGE)
        self.check(0, "plot", "scene.toml", "--of", "joint.hinge.force,joint.hinge.turn_x,total", "-o", "p.png")
        (self.folder / "p.png").unlink()
        scene = ("scene.toml", "-o", "p.svg", "--of")
        self.refused('"joint.hing.force": no joint has the name "hing" (did you mean "hinge"?)', *scene, "joint.hing.force")
        self.refused("this joint locks the coordinate; its free ones: turn_x", *scene, "joint.hinge.turn_z")


if __name__ == "__main__":
    program.main()
