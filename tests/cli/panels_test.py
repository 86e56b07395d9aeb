"""`render` with several scenes or variants, text and plots."""

import program

TEXT = program.SCENE.replace("size = [48, 32]", "size = [480, 400]") + """
[overlay]
show = ["title", "clock", "mode"]
[[caption]]
text = "The box falls"
start = 0.15
end = 0.35
"""
VARY = ("--vary", "simulation.integrator=explicit-euler,exact")


class Panels(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("text.toml", TEXT)

    def frames(self, folder, *arguments):
        """The bytes of all frames, by number."""
        self.check(0, "render", *arguments, "--frames", folder, "--quiet")
        return {int(path.stem[6:]): program.unmarked(path) for path in sorted((self.folder / folder).glob("*.png"))}

    def refused(self, reason, *arguments):
        run = self.check(2, "render", *arguments)
        self.assertIn(reason, run.stderr)
        self.assertEqual(self.names(), ["text.toml"])

    def test_the_same_bytes_with_any_number_of_processes_and_from_any_moment(self):
        arguments = ("text.toml", *VARY, "--plot", "body.crate.y,total", "--shutter", "180", "--blur-samples", "2")
        one = self.frames("one", *arguments, "--workers", "1")
        self.assertEqual(len(one), 6)
        self.assertEqual(self.frames("three", *arguments, "--workers", "3", "--threads", "2"), one)
        late = self.frames("late", *arguments, "--start", "0.25", "--workers", "2")
        self.assertEqual(late, {n: one[n] for n in (3, 4, 5)})

    def test_a_clip_of_several_scenes(self):
        self.write("longer.toml", TEXT.replace("duration = 0.5", "duration = 0.8").replace("[480, 400]", "[64, 64]"))
        run = self.check(0, "render", "text.toml", "longer.toml")
        self.assertIn("wrote text.mp4: 9 frames of 480 x 400", run.stderr)
        self.assertEqual(program.probe(self.folder / "text.mp4", "width,height,nb_read_frames"), ["480", "400", "9"])

    def test_overlays_show_in_pictures_only(self):
        plain = self.frames("plain", "text.toml", "--overlay", "none", "--aov", "depth")
        with_text = self.frames("with-text", "text.toml", "--plot", "energy", "--plot-place", "below", "--aov", "depth")
        for n in range(6):
            self.assertNotEqual(plain[n], with_text[n])
            aovs = [program.unmarked(self.folder / folder / f"aov_{n:06}.npz") for folder in ("plain", "with-text")]
            self.assertEqual(aovs[0], aovs[1])

    def test_places_and_layouts_differ(self):
        pictures = {}
        for name, arguments in {"no plot": (), "inset": ("--plot", "energy"),
                                "beside": ("--plot", "energy", "--plot-place", "beside"),
                                "below": ("--plot", "energy", "--plot-place", "below"), "variants": VARY,
                                "grid": (*VARY, "--layout", "grid", "--vary", "simulation.seed=1,2"),
                                "row": (*VARY, "--layout", "row", "--vary", "simulation.seed=1,2")}.items():
            pictures[name] = self.frames(name.replace(" ", "-"), "text.toml", "--duration", "0", *arguments)[0]
        self.assertEqual(len(set(pictures.values())), len(pictures))
        self.write("text.toml", TEXT.replace("[overlay]", '[overlay]\nplot = ["energy"]'))
        for name, arguments in {"inset": (), "no plot": ("--plot", "none")}.items():
            self.assertEqual(self.frames("file-" + name, "text.toml", "--duration", "0", *arguments)[0], pictures[name])

    def test_a_caption_has_its_time(self):
        self.write("text.toml", TEXT.replace('["title", "clock", "mode"]', "[]"))
        still = ("text.toml", "--set", "simulation.gravity=[0,0,0]", "--set", "body.crate.angular_velocity=[0,0,0]")
        frames = self.frames("out", *still)
        self.assertEqual([frames[n] == frames[0] for n in range(6)], [True, True, False, False, True, True])

    def test_any_picture_size_has_room_for_text(self):
        for size in ("1x1", "17x900", "900x17"):
            self.frames(size, "text.toml", "--size", size, "--duration", "0")

    def test_misuse(self):
        self.refused('--plot: "enrgy": unknown quantity (did you mean "energy"?)', "text.toml", "--plot", "enrgy")
        self.refused("--plot-place: must be", "text.toml", "--plot", "energy", "--plot-place", "above")
        self.refused('--overlay: "clok" is not the name of an overlay', "text.toml", "--overlay", "clok")
        self.refused('unknown key "integratr"', "text.toml", "--vary", "simulation.integratr=exact,rk4")
        self.refused("has no values", "text.toml", "--vary", "simulation.integrator")
        self.refused("--layout: must be one of row, grid", "text.toml", "--layout", "heap")
        self.refused("--aov: needs a single scene (2 are shown side by side)", "text.toml", "scene.toml", "--aov", "depth",
                     "--frames", "out")
        self.refused("need the same frames per second: text.toml (fps 10) has 10, text.toml (fps 20) has 20", "text.toml",
                     "--vary", "output.fps=10,20")
        self.refused("is too small for 2 panels", "text.toml", "scene.toml", "--size", "80x60")
        self.refused("is too small for a plot", "text.toml", "--plot", "energy", "--size", "150x100")
        self.refused('no body has the name "box"', "text.toml", "scene.toml", "--plot", "body.box.y")

    def test_an_unknown_quantity_of_a_scene_names_the_file(self):
        self.write("text.toml", TEXT.replace("[overlay]", '[overlay]\nplot = ["enrgy"]'))
        self.refused('text.toml: error: [overlay] plot: "enrgy": unknown quantity', "text.toml")


if __name__ == "__main__":
    program.main()
