"""Ways to draw on the CPU: OSMesa, and EGL's software device where OSMesa is missing. Frames have the same bytes by both."""

import glob
import subprocess
import unittest

import program

OSMESA = glob.glob("/usr/lib/*/libOSMesa.so*")


def without_osmesa(*words):
    """A command in whose view of the file system the libraries of OSMesa are empty files."""
    hide = "; ".join(f"mount --bind /dev/null {path}" for path in OSMESA)
    return ["unshare", "--mount", "--map-root-user", "sh", "-c", hide + '; exec "$@"', "sh", *words]


def can_hide():
    try:
        return subprocess.run(without_osmesa("true"), capture_output=True).returncode == 0
    except OSError:
        return False


class GlBackend(program.ProgramTest):
    def frames(self, backend):
        self.check(0, "render", "scene.toml", "--frames", backend, "--gl", backend, "--quiet")
        return {path.name: path.read_bytes() for path in (self.folder / backend).iterdir()}

    def test_the_same_files_by_each_backend(self):
        if "llvmpipe" not in self.check(0, "doctor").stdout.split("OpenGL, egl")[1].split("\n")[0]:
            self.skipTest("EGL does not draw on the CPU here")
        osmesa = self.frames("osmesa")
        self.assertEqual(len([name for name in osmesa if name.endswith(".png")]), 6)
        self.assertEqual(self.frames("software"), osmesa)
        self.assertEqual(self.frames("egl"), osmesa)

    @unittest.skipUnless(OSMESA and can_hide(), "OSMesa cannot be hidden here")
    def test_egl_takes_the_place_of_osmesa(self):
        def run(*words):
            return subprocess.run(without_osmesa(program.TUMBLE, *words), cwd=self.folder, capture_output=True, text=True)

        expected = self.frames("osmesa")
        drawn = run("render", "scene.toml", "--frames", "hidden", "--quiet")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.assertEqual({path.name: path.read_bytes() for path in (self.folder / "hidden").iterdir()}, expected)
        report = run("doctor")
        self.assertRegex(report.stdout, r"drawing by +ok +EGL's software device")
        refused = run("render", "scene.toml", "--frames", "none", "--gl", "osmesa")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("the rendering library cannot be opened", refused.stderr)


if __name__ == "__main__":
    unittest.main()
