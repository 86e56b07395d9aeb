"""`--log json`: every line is an object, and tells what the text log tells; `--profile`: a trace of all frames."""

import json
import os
import unittest

import program

SCENE = """\
format = 1
[simulation]
duration = 0.5
[output]
size = [64, 36]
fps = 20
samples = 1
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.2 }
position = [0.0, 1.0, 0.0]
"""


class LogTest(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("drop.toml", SCENE)

    def events(self, text):
        return [json.loads(line) for line in text.splitlines()]

    def test_a_render(self):
        result = self.check(0, "render", "drop.toml", "-o", "drop.mp4", "--frames", "out", "--log", "json")
        events = self.events(result.stderr)
        names = [event["event"] for event in events]
        self.assertEqual((names[0], names[-1]), ("start", "end"))
        self.assertEqual(events[0]["command"][1:3], ["render", "drop.toml"])
        self.assertEqual(events[-1]["exit_code"], 0)
        wrote = events[names.index("wrote")]
        self.assertEqual((wrote["clip"], wrote["frames"], wrote["count"], wrote["width"]), ("drop.mp4", "out", 11, 64))
        times = events[names.index("times")]
        self.assertEqual(sorted(times["cpu"]), ["aovs", "conversion", "drawing", "png", "simulation", "video"])
        self.assertGreater(times["cpu"]["drawing"], 0)
        moments = [event["t"] for event in events]
        self.assertEqual(moments, sorted(moments))

    def test_a_sweep(self):
        self.write("plan.toml", 'format = 1\nscene = "drop.toml"\n[[axis]]\npath = "body.ball.shape.radius"\nvalues = [0.1, -1, 0.2]\n'
                                '[outputs]\nscene = "none"\ntables = ["energy"]\n')
        events = self.events(self.check(1, "sweep", "plan.toml", "-o", "out", "--log", "json").stderr)
        self.assertEqual((events[0]["event"], events[-1]), ("start", {**events[-1], "event": "end", "exit_code": 1}))
        texts = [event["text"] for event in events if event["event"] == "message"]
        self.assertRegex(texts[0], r"^error: sample 1: .*given -1")
        self.assertRegex(texts[-1], r"^wrote out/manifest.jsonl: 2 samples made, 1 failed")

    def test_another_descriptor(self):
        read, write = os.pipe()
        result = self.check(0, "simulate", "drop.toml", "--trajectory", "t.csv", "--log", "json", "--log-fd", str(write), pass_fds=(write,))
        os.close(write)
        with os.fdopen(read) as log:
            events = self.events(log.read())
        self.assertEqual(result.stderr, "")
        self.assertEqual([events[0]["event"], events[-1]["event"]], ["start", "end"])
        self.assertIn("wrote t.csv", [event.get("text") for event in events])

    def test_errors(self):
        self.write("bad.toml", SCENE.replace("radius = 0.2", "radius = -1"))
        events = self.events(self.check(2, "render", "bad.toml", "-o", "a.mp4", "--log", "json").stderr)
        error = events[-2]
        self.assertEqual((error["event"], error["kind"], error["file"], error["line"]), ("error", "input", "bad.toml", 10))
        self.assertEqual(events[-1]["exit_code"], 2)
        events = self.events(self.check(1, "render", "drop.toml", "-o", "no/a.mp4", "--log", "json").stderr)
        self.assertEqual((events[-2]["kind"], events[-1]["exit_code"]), ("run", 1))

    def test_a_closed_descriptor_is_refused(self):
        result = self.check(2, "render", "drop.toml", "-o", "a.mp4", "--log", "json", "--log-fd", "77")
        self.assertIn("descriptor 77 is not open for writing", result.stderr)
        self.assertEqual(self.names(), ["drop.toml"])

    def test_the_result_is_the_same(self):
        self.check(0, "render", "drop.toml", "--frames", "a", "--quiet")
        self.check(0, "render", "drop.toml", "--frames", "b", "--log", "json", "--profile", "trace.json")
        for frame in range(11):
            name = f"frame_{frame:06}.png"
            self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "b" / name).read_bytes())

    def test_a_trace_has_every_frame(self):
        self.check(0, "render", "drop.toml", "--frames", "out", "-o", "drop.mp4", "--profile", "trace.json", "--quiet")
        trace = json.loads((self.folder / "trace.json").read_text())["traceEvents"]
        spans = [event for event in trace if event["ph"] == "X"]
        for stage in ("simulation", "PNG files", "video"):
            frames = {event["args"]["frame"] for event in spans if event["name"] == stage and "args" in event}
            self.assertLessEqual(set(range(11)), frames, stage)
        self.assertTrue(any(event["name"] == "ffmpeg" for event in spans))
        self.assertTrue(all(event["dur"] >= 0 and event["ts"] >= 0 for event in spans))


if __name__ == "__main__":
    program.main()
