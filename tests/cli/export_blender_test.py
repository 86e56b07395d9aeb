"""`export --keys frames` in Debian's Blender: the matrices of bodies and camera at frames against the simulation.

Exit code 77: skipped, as there is no blender.
"""

import json
import math
import os
import shutil
import subprocess
import sys

import program

SKIPPED = 77
FRAMES = list(range(0, 241, 7)) + [240]

SCENE = """\
format = 1
[simulation]
duration = 4.0
impacts = "exact"
[output]
size = [320, 180]
fps = 60
[camera]
eye = [0.0, 3.0, 9.0]
target = [0.0, 1.0, 0.0]
orbit = 40.0
[[body]]
name = "ground"
type = "fixed"
shape = { type = "plane" }
restitution = 0.9
friction = 0.4
[[body]]
name = "e = 0.9"
shape = { type = "sphere", radius = 0.5 }
position = [-2.0, 1.5, 0.0]
velocity = [0.25, 0.0, 0.0]
angular_velocity = [0.0, 0.0, 6.0]
[[body]]
name = "box"
shape = { type = "box", size = [0.6, 0.3, 0.9] }
position = [3.0, 1.2, 0.0]
velocity = [0.0, 1.0, 0.5]
angular_velocity = [5.0, 4.0, -3.0]
[[body]]
name = "hammer"
shape = { type = "compound", parts = [
  { shape = { type = "box", size = [0.2, 1.0, 0.2] } },
  { shape = { type = "sphere", radius = 0.3 }, position = [0.0, 0.6, 0.0], color = "#0000ff" } ] }
position = [-4.0, 2.0, 0.0]
angular_velocity = [0.0, 2.0, 3.0]
[[body]]
name = "paddle"
type = "kinematic"
shape = { type = "box", size = [0.5, 0.1, 0.5] }
keyframes = [ { time = 0.0, position = [5.0, 1.0, 0.0] }, { time = 0.7, position = [5.0, 2.0, 0.0] },
              { time = 1.2, position = [5.0, 1.0, 0.0], rotation = { axis = [0.0, 0.0, 1.0], angle = 90.0 } } ]
"""

# Smooth shading: with the default, Debian 12's importer fails, as its NumPy has no numpy.bool.
IMPORT = """\
import bpy, json, sys
file, frames = sys.argv[-2], json.loads(sys.argv[-1])
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = 60
bpy.ops.import_scene.gltf(filepath=file, import_shading="SMOOTH")
poses = []
for frame in frames:
    scene.frame_set(frame)
    poses.append({o.name: [list(v) for v in o.matrix_world.decompose()] for o in scene.objects})
json.dump({"types": {o.name: o.type for o in scene.objects}, "poses": poses}, open(file + ".json", "w"))
"""


def y_up(vector):
    """Blender's z is up."""
    x, y, z = vector
    return [x, z, -y]


class ExportToBlender(program.ProgramTest):
    def test_matrices(self):
        self.write("scene.toml", SCENE)
        self.write("import.py", IMPORT)
        self.check(0, "export", "scene.toml", "-o", "clip.glb", "--keys", "frames", "--quiet")
        self.check(0, "simulate", "scene.toml", "--trajectory", "t.csv", "--quiet")
        # The Python in Blender looks for its modules beside the first python3 of PATH: it must be Debian's.
        run = subprocess.run([shutil.which("blender"), "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                              self.folder / "import.py", "--", self.folder / "clip.glb", json.dumps(FRAMES)], text=True, timeout=120,
                             env={**os.environ, "PATH": "/usr/bin:/bin"}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(run.returncode, 0, run.stdout)
        blender = json.loads((self.folder / "clip.glb.json").read_text())
        self.assertEqual(blender["types"]["camera"], "CAMERA")
        self.assertEqual(list(blender["types"].values()).count("LIGHT"), 1)
        rows = {(int(row["frame"]), row["body"]): row for row in self.rows("t.csv")}
        position_error = rotation_error = 0.0
        for frame, poses in zip(FRAMES, blender["poses"], strict=True):
            for body in ("e = 0.9", "box", "hammer", "paddle"):
                row = rows[frame, body]
                place, (w, x, y, z), scale = poses[body]
                position_error = max(position_error, math.dist(y_up(place), [float(row[c]) for c in ("x", "y", "z")]))
                turn, expected = [w, *y_up((x, y, z))], [float(row[c]) for c in ("qw", "qx", "qy", "qz")]
                rotation_error = max(rotation_error, 4 * math.asin(
                    0.5 * min(math.dist(turn, expected), math.dist(turn, [-q for q in expected]))))
                for value, size in zip(scale, {"e = 0.9": (0.5, 0.5, 0.5), "box": (0.6, 0.9, 0.3), "hammer": (1, 1, 1),
                                               "paddle": (0.5, 0.5, 0.1)}[body], strict=True):
                    self.assertAlmostEqual(value, size, places=5)
            angle = math.radians(40.0) * frame / 60
            eye = [9.0 * math.sin(angle), 3.0, 9.0 * math.cos(angle)]
            self.assertLess(math.dist(y_up(poses["camera"][0]), eye), 1e-5)
        print(f"largest errors: {position_error:.2g} m, {rotation_error:.2g} rad")
        self.assertLess(position_error, 1e-5)
        self.assertLess(rotation_error, 1e-5)


if __name__ == "__main__":
    if not shutil.which("blender"):
        print("SKIPPED: there is no blender")
        sys.exit(SKIPPED)
    program.main()
