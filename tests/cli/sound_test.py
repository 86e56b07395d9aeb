"""Sound of impacts: --sound of render and of simulate."""

import array
import subprocess
import unittest
import wave

import program

BOUNCE = """\
format = 1
[simulation]
duration = 1.5
integrator = "exact"
impacts = "exact"
[output]
size = [48, 32]
fps = 20
samples = 1
[materials.steel]
sound = "metal"
restitution = 0.8
[[body]]
name = "ground"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.1 }
material = "steel"
position = [0, 1, 0]
"""


def samples_of(path):
    with wave.open(str(path)) as sound:
        assert (sound.getnchannels(), sound.getsampwidth(), sound.getframerate()) == (1, 2, 48000)
        return array.array("h", sound.readframes(sound.getnframes()))


class Sound(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("bounce.toml", BOUNCE)

    def streams(self, clip):
        """(kind, codec, duration in s) of the streams of a clip."""
        text = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream=codec_type,codec_name:format=duration",
                               "-of", "default=nw=1:nk=1", str(self.folder / clip)], capture_output=True, text=True).stdout
        words = text.split()
        return set(zip(words[1:-1:2], words[0:-1:2])), float(words[-1])

    def test_the_clicks_are_at_the_times_of_the_impact_table(self):
        self.check(0, "simulate", "bounce.toml", "--sound", "s.wav", "--impacts", "i.csv", "--quiet")
        samples = samples_of(self.folder / "s.wav")
        self.assertEqual(len(samples), 31 * 2400)
        first = float(self.rows("i.csv")[0]["time"])
        heard = next(i for i, value in enumerate(samples) if value != 0)
        self.assertLessEqual(abs(heard - first * 48000), 1.5)

    def test_clips_of_each_kind_have_the_sound(self):
        for name, codecs in [("c.mp4", {("video", "h264"), ("audio", "aac")}), ("c.mkv", {("video", "h264"), ("audio", "aac")}),
                             ("c.webm", {("video", "vp9"), ("audio", "opus")})]:
            self.check(0, "render", "bounce.toml", "-o", name, "--sound", "--quiet")
            found, duration = self.streams(name)
            self.assertEqual(found, codecs)
            self.assertAlmostEqual(duration, 1.55, delta=0.06)

    def test_the_same_clip_twice_and_in_segments_with_any_workers(self):
        self.check(0, "render", "bounce.toml", "-o", "a.mp4", "--sound", "--quiet")
        self.check(0, "render", "bounce.toml", "-o", "b.mp4", "--sound", "--workers", "2", "--quiet")
        self.assertEqual((self.folder / "a.mp4").read_bytes(), (self.folder / "b.mp4").read_bytes())
        self.check(0, "render", "bounce.toml", "-o", "r.mp4", "--sound", "--resume", "--quiet")
        found, duration = self.streams("r.mp4")
        self.assertEqual(found, {("video", "h264"), ("audio", "aac")})
        self.assertAlmostEqual(duration, 1.55, delta=0.06)

    def test_a_resumed_clip_has_the_sound_that_is_asked_for(self):
        for sound, streams in [([], 1), (["--sound"], 2), (["--sound"], 2), ([], 1)]:
            self.check(0, "render", "bounce.toml", "-o", "r.mp4", "--resume", "--quiet", *sound)
            self.assertEqual(len(self.streams("r.mp4")[0]), streams)

    def test_a_clip_without_the_option_has_no_sound(self):
        self.check(0, "render", "bounce.toml", "-o", "a.mp4", "--quiet")
        self.assertEqual(self.streams("a.mp4")[0], {("video", "h264")})

    def test_faults(self):
        for arguments, message in [
            (["render", "bounce.toml", "--frames", "f", "--sound"], "--sound: needs a clip"),
            (["render", "bounce.toml", "-o", "a.gif", "--sound"], "--sound: a GIF has no sound"),
            (["simulate", "bounce.toml", "--sound", "s.mp3"], "s.mp3"),
            (["simulate", "bounce.toml", "--sound", "s.wav", "--checkpoints", "c"], "--sound: is of a whole run"),
        ]:
            self.assertIn(message, self.check(2, *arguments).stderr)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["bounce.toml", "scene.toml"])
        self.write("loud.toml", BOUNCE.replace('"metal"', '"brass"'))
        self.assertIn('metal', self.check(2, "simulate", "loud.toml", "--sound", "s.wav").stderr)


if __name__ == "__main__":
    unittest.main()
