"""The perceptual metrics of `compare` beside other programs, on frames of a scene: SSIM beside scikit-image (Debian's
python3-skimage), FLIP beside the authors' package flip_evaluator. Exit code 77 where neither is installed."""

import json
import os
import subprocess
import sys

import program

PYTHON = os.environ.get("TUMBLE_PEER_PYTHON", "/usr/bin/python3")  # may have packages that this Python lacks

# Prints the mean of a metric of the pictures a.png and b.png. The luma is not rounded to levels, as in the program.
SSIM = """
import numpy, PIL.Image
from skimage.metrics import structural_similarity
a, b = (numpy.asarray(PIL.Image.open(f).convert("RGB"), float) @ [0.299, 0.587, 0.114] for f in ("a.png", "b.png"))
print(structural_similarity(a, b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=255))
"""
FLIP = """
import flip_evaluator
print(flip_evaluator.evaluate("a.png", "b.png", "LDR")[1])
"""


def has(module):
    return subprocess.run([PYTHON, "-c", f"import {module}"], stderr=subprocess.DEVNULL, check=False).returncode == 0


PEERS = {name: has(module) for name, module in {"ssim": "skimage.metrics", "flip": "flip_evaluator"}.items()}


class Metrics(program.ProgramTest):
    def setUp(self):
        super().setUp()
        # Both limits fail: each metric is measured.
        self.write("tolerances.toml", "flip = 0.0\nssim = 1.0\n")

    def frame(self, name, *options):
        self.check(0, "render", "scene.toml", "--frames", "out", "--start", 0.4, "--duration", 0.5, "--size", "160x90",
                   "--quiet", *options)
        os.rename(self.folder / "out/frame_000004.png", self.folder / name)

    def figures(self):
        run = self.run_tumble("compare", "a.png", "b.png", "--tolerances", "tolerances.toml", "--json", "r.json")
        self.assertIn(run.returncode, (0, 1), run.stderr)
        (image,) = json.loads((self.folder / "r.json").read_text())["images"]
        return {figure["metric"]: figure["value"] for figure in image["figures"]}

    def compare(self, metric, peer, tolerance):
        if not PEERS[metric]:
            self.skipTest(f"no peer of {metric} is installed")
        self.frame("a.png")
        for change in ("body.crate.position=[0.05, 3.0, 0.0]", "light.shadows=false"):
            self.frame("b.png", "--set", change)
            run = subprocess.run([PYTHON, "-c", peer], cwd=self.folder, stdout=subprocess.PIPE, text=True, check=True)
            self.assertAlmostEqual(self.figures()[metric], float(run.stdout), delta=tolerance, msg=change)

    def test_ssim(self):
        self.compare("ssim", SSIM, 2e-6)

    def test_flip(self):
        self.compare("flip", FLIP, 2e-6)


if __name__ == "__main__":
    if not any(PEERS.values()):
        sys.exit(77)
    program.main()
