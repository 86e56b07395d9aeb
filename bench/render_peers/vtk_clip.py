#!/usr/bin/python3
"""Draws falling boxes with VTK, as a user's script would: one actor per box, vtkShadowMapPass, 4 samples, a window that is
not shown (under xvfb, in llvmpipe), vtkWindowToImageFilter, and a pipe into ffmpeg. Boxes, camera, light and the encoder's
settings are those of the scenes in bench/render. VTK simulates nothing: it draws the poses of a file.
  xvfb-run -a bench/render_peers/vtk_clip.py POSES BOXES SIZE WIDTHxHEIGHT FRAMES CLIP EYE.x EYE.y EYE.z
                                          TARGET.x TARGET.y TARGET.z [ORBIT]
POSES: 7 doubles (position, quaternion w x y z; z up) for each box and frame, as scripts/bench-render writes them.
ORBIT: angular velocity of the camera about the target, degrees/s, counterclockwise seen from above."""

import os
import random
import struct
import subprocess
import sys

# These imports register the OpenGL implementations of VTK's classes.
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkFiltersSources import vtkCubeSource, vtkPlaneSource
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter)

FPS = 60
COLORS = ["#c7853d", "#d9a15c", "#2e8087", "#e3c270", "#b5523b", "#4d6b8f"]


def actor_of(source, color):
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*(int(color[i:i + 2], 16) / 255 for i in (1, 3, 5)))
    actor.GetProperty().SetAmbient(0.3)   # without it surfaces in shadow are black
    return actor


def matrix_of(x, y, z, w, a, b, c, size):
    """The matrix of a pose and a size, row by row."""
    rows = [[1 - 2 * (b * b + c * c), 2 * (a * b - w * c), 2 * (a * c + w * b)],
            [2 * (a * b + w * c), 1 - 2 * (a * a + c * c), 2 * (b * c - w * a)],
            [2 * (a * c - w * b), 2 * (b * c + w * a), 1 - 2 * (a * a + b * b)]]
    matrix = vtkMatrix4x4()
    matrix.DeepCopy([size * rows[0][0], size * rows[0][1], size * rows[0][2], x,
                     size * rows[1][0], size * rows[1][1], size * rows[1][2], y,
                     size * rows[2][0], size * rows[2][1], size * rows[2][2], z, 0, 0, 0, 1])
    return matrix


def window_of(boxes, width, height, eye, target):
    renderer = vtkRenderer()
    renderer.SetBackground(0.75, 0.82, 0.9)
    floor = vtkPlaneSource()
    floor.SetOrigin(-40, -40, 0)
    floor.SetPoint1(40, -40, 0)
    floor.SetPoint2(-40, 40, 0)
    renderer.AddActor(actor_of(floor, "#b9bcc2"))
    for box in boxes:
        renderer.AddActor(box)
    light = vtkLight()
    light.SetPosition(-6, 6, 14)
    light.SetFocalPoint(-2, 3, 4)
    light.SetPositional(False)
    renderer.AddLight(light)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(eye[0], -eye[2], eye[1])
    camera.SetFocalPoint(target[0], -target[2], target[1])
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(38)
    renderer.ResetCameraClippingRange()
    renderer.UseShadowsOn()
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(4)
    window.SetSize(width, height)
    window.AddRenderer(renderer)
    return window, renderer


def main():
    if len(sys.argv) not in (13, 14):
        sys.exit(__doc__)
    path, (count, size), shape = sys.argv[1], (int(sys.argv[2]), float(sys.argv[3])), sys.argv[4]
    width, height = map(int, shape.split("x"))
    frames, clip = int(sys.argv[5]), sys.argv[6]
    eye, target = [[float(v) for v in sys.argv[k:k + 3]] for k in (7, 10)]
    orbit = float(sys.argv[13]) if len(sys.argv) > 13 else 0.0

    cube, draw = vtkCubeSource(), random.Random(1)
    boxes = [actor_of(cube, COLORS[i % len(COLORS)]) for i in range(count)]
    sizes = [size * draw.uniform(0.85, 1.1) for _ in boxes]
    window, renderer = window_of(boxes, width, height, eye, target)
    encoder = subprocess.Popen(
        ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", shape, "-framerate", str(FPS),
         "-i", "-", "-vf", "vflip", *os.environ["BENCH_ENCODER"].split(), clip],   # Tumble's, from scripts/bench-render
        stdin=subprocess.PIPE)
    with open(path, "rb") as poses:
        for frame in range(frames):
            for box, own in zip(boxes, sizes):
                box.SetUserMatrix(matrix_of(*struct.unpack("7d", poses.read(56)), own))
            if frame and orbit:
                renderer.GetActiveCamera().Azimuth(orbit / FPS)
            window.Render()
            grab = vtkWindowToImageFilter()
            grab.SetInput(window)
            grab.ReadFrontBufferOff()
            grab.Update()
            encoder.stdin.write(vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).tobytes())
    encoder.stdin.close()
    sys.exit(encoder.wait())


if __name__ == "__main__":
    main()
