"""Values without effect, and bodies that overlap at the start, are named."""

import program

BOUNCE = """format = 1
[simulation]
duration = 0.8
[output]
size = [192, 96]
fps = 20
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.2 }
position = [0, 0.6, 0]
velocity = [5, 0, 0]
"""
OF_FLOOR = BOUNCE.replace('{ type = "plane" }', '{ type = "plane" }\nrestitution = 0.5\nfriction = 0')


class AlikeRuns(program.ProgramTest):
    def warnings(self, scene, vary, *options):
        self.write("bounce.toml", scene)
        said = {}
        for command, *arguments in (("render", "-o", "c.mkv"), ("plot", "--of", "body.ball.y", "-o", "p.svg")):
            run = self.check(0, command, "bounce.toml", *arguments, "--vary", vary, *options)
            said[command] = [line for line in run.stderr.splitlines() if "move alike" in line]
        self.assertEqual(said["render"], said["plot"])
        return said["plot"]

    def test_each_value_acts_on_a_floor_without_one(self):
        for vary in ("body.ball.restitution=0.2,0.5,0.8", "body.ball.friction=0.1,0.3"):
            self.assertEqual(self.warnings(BOUNCE, vary), [])

    def test_the_value_of_the_floor_wins(self):
        line, = self.warnings(OF_FLOOR, "body.ball.restitution=0.2,0.5,0.8")
        self.assertIn("'restitution 0.2', 'restitution 0.5' move alike", line)
        self.assertNotIn("0.8", line)
        self.assertIn("restitution_rule", line)
        line, = self.warnings(OF_FLOOR, "body.ball.friction=0.1,0.3")
        self.assertIn("friction = 0", line)

    def test_another_rule_lets_it_act(self):
        self.assertEqual(self.warnings(OF_FLOOR, "body.ball.restitution=0.2,0.5,0.8", "--set", "contact.restitution_rule=average"), [])
        self.assertEqual(self.warnings(OF_FLOOR, "body.ball.friction=0.1,0.3", "--set", "contact.friction_rule=maximum"), [])

    def test_values_of_the_picture_and_equal_values_may_move_alike(self):
        for vary in ("body.ball.color=\"#ff0000\",\"#00ff00\"", "output.samples=1,4", "body.ball.restitution=0.5,0.50"):
            run = self.check(0, "render", "scene.toml", "--vary", vary.replace("body.ball", "body.1"), "-o", "c.mkv", "--duration", "0.1", "--size", "192x96")
            self.assertNotIn("move alike", run.stderr)

    def test_without_effect_for_another_reason(self):
        line, = self.warnings(BOUNCE, "simulation.seed=1,2")
        self.assertIn("no effect on the motion", line)

    def test_quiet(self):
        self.assertEqual(self.warnings(OF_FLOOR, "body.ball.restitution=0.2,0.5", "--quiet"), [])


OVERLAP = """format = 1
[simulation]
duration = 0.1
[output]
size = [192, 96]
[[body]]
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "crate"
shape = { type = "box", size = [1, 1, 1] }
position = [0, 0.3, 0]
[[body]]
name = "near"
shape = { type = "box", size = [1, 1, 1] }
position = [5, 0.499, 0]
"""


class Overlaps(program.ProgramTest):
    def test_simulate_render_and_info_name_them(self):
        self.write("overlap.toml", OVERLAP)
        for command in (["simulate", "overlap.toml", "--energy", "e.csv"], ["render", "overlap.toml", "-o", "c.mkv"],
                        ["render", "overlap.toml", "-o", "c.mkv", "--vary", "body.crate.friction=0.1,0.2"], ["info", "overlap.toml"]):
            run = self.check(0, *command)
            lines = [line for line in run.stderr.splitlines() if "overlap" in line]
            self.assertEqual(len(lines), 1, run.stderr)
            self.assertIn("warning: bodies '0' and 'crate' overlap by 0.2 m at the start, 20 % of", lines[0])

    def test_quiet(self):
        self.write("overlap.toml", OVERLAP)
        self.assertEqual(self.check(0, "simulate", "overlap.toml", "--energy", "e.csv", "--quiet").stderr, "")

    def test_many_are_counted(self):
        self.write("overlap.toml", OVERLAP.replace("position = [0, 0.3, 0]", "position = [0, 0.3, 0]\ngrid = { count = [10, 1, 1], spacing = 1.5 }"))
        said = self.check(0, "simulate", "overlap.toml", "--energy", "e.csv").stderr
        self.assertEqual(said.count("overlap by"), 6)
        self.assertIn("more pairs of bodies overlap", said)


if __name__ == "__main__":
    program.main()
