"""Shared by the tests of farms: a small scene with overlays, and its clip made on this machine alone."""

import collections
import os
import pathlib
import subprocess

TUMBLE = os.environ["TUMBLE"]
GUARD = 300   # s, against a hang

# 12 frames. Boxes that touch, so that a part that began from a wrong state would show it.
SCENE = """\
format = 1
title = "A small pile"
[simulation]
duration = 1.1
steps_per_frame = 8
[output]
size = [48, 32]
fps = 10
samples = 1
[[body]]
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "first"
shape = { type = "box", size = [0.5, 0.5, 0.5] }
position = [0.0, 0.6, 0.0]
angular_velocity = [1.0, 2.0, 0.5]
[[body]]
name = "second"
shape = { type = "box", size = [0.5, 0.5, 0.5] }
position = [0.1, 1.3, 0.0]
[[body]]
name = "third"
shape = { type = "sphere", radius = 0.3 }
position = [0.0, 2.2, 0.1]
"""

LocalClips = collections.namedtuple("LocalClips", "rendered encoded frames")


def run_tumble(folder, *words, **options):
    return subprocess.run([TUMBLE, *map(str, words)], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=GUARD, **options)


def checked(folder, *words):
    run = run_tumble(folder, *words)
    if run.returncode != 0:
        raise RuntimeError(f"{words}: exit code {run.returncode}\n{run.stdout}{run.stderr}")
    return run


def local_clips(folder, scene, *options, ending=".mp4", fps=10, encode=("--quality", "best")):
    """The bytes of `render -o` and of `render --frames` + `encode`, and the folder of the frames."""
    folder = pathlib.Path(folder)
    checked(folder, "render", scene, *options, "--quiet", "-o", "local" + ending, "--frames", "local frames")
    checked(folder, "encode", "local frames", "-o", "encoded" + ending, "--fps", fps, "--quiet", *encode)
    return LocalClips((folder / ("local" + ending)).read_bytes(), (folder / ("encoded" + ending)).read_bytes(),
                      folder / "local frames")
