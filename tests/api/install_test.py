"""The build tree installed into a temporary prefix, and the examples built by a CMake project outside the source tree.

Run it alone with: ctest -R api_install_test
"""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TUMBLE = os.environ["TUMBLE"]
CMAKE = os.environ.get("CMAKE", "cmake")
CXX = os.environ.get("CXX", "c++")
SANITIZE = os.environ.get("TUMBLE_SANITIZE", "")

# Other flags than the library's: none of them may matter.
FLAGS = "-O0 -march=native -ffast-math -Wall -Wextra -Wpedantic -Werror" + (f" -fsanitize={SANITIZE}" if SANITIZE else "")
SCENE = ROOT / "assets/scenes/paddle.toml"
FRAME = 20
FRAMES_PER_SECOND = 60   # of the scene


def run(*command, code=0, **options):
    options.setdefault("timeout", 120)
    environment = {name: value for name, value in os.environ.items() if name != "TUMBLE_SHADERS"}
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          env={**environment, **options.pop("env", {})}, **options)
    if done.returncode != code:
        raise AssertionError(f"{command}: exit code {done.returncode}\n{done.stdout.decode()}\n{done.stderr.decode()}")
    return done


def without_mark(png):
    """A frame of the program without the chunk that names its scene, which a library's picture has not."""
    at = png.index(b"tEXtTumble-Scene") - 4
    return png[:at] + png[at + 12 + int.from_bytes(png[at:at + 4], "big"):]


def links_of(text):
    """The relative links of a page, without their anchors."""
    text = re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S))
    found = re.findall(r"\]\(<?([^()\s>]+)>?\)", text)
    return [link.split("#")[0] for link in found if not re.match(r"[a-z][a-z0-9+.-]*:|#", link)]


class InstallTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="tumble-install-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        run(CMAKE, "--install", os.environ["TUMBLE_BUILD"], "--prefix", cls.folder / "first")
        # Moved: nothing in the tree may name the prefix that it was installed to.
        cls.prefix = (cls.folder / "first").rename(cls.folder / "prefix")
        cls.library = next(path for path in cls.prefix.rglob("libtumble.so"))
        cls.project = cls.folder / "project"
        shutil.copytree(ROOT / "examples", cls.project)
        cls.build = cls.folder / "build"
        run(CMAKE, "-S", cls.project, "-B", cls.build, f"-DCMAKE_PREFIX_PATH={cls.prefix}", f"-DCMAKE_CXX_COMPILER={CXX}",
            f"-DCMAKE_CXX_FLAGS={FLAGS}")
        run(CMAKE, "--build", cls.build)

    def test_trajectory_equals_that_of_the_program(self):
        table = run(self.build / "trajectory_table", SCENE).stdout
        run(TUMBLE, "simulate", SCENE, "--trajectory", self.folder / "program.csv", "--quiet")
        self.assertEqual(table, (self.folder / "program.csv").read_bytes())
        self.assertGreater(table.count(b"\n"), 100)

    def test_frame_equals_that_of_the_program(self):
        out, frames = self.folder / "frame.png", self.folder / "frames"
        run(self.build / "golden_frame", SCENE, FRAME, out)
        run(TUMBLE, "render", SCENE, "--duration", FRAME / FRAMES_PER_SECOND, "--frames", frames, "--quiet")
        golden = frames / f"frame_{FRAME:06}.png"
        self.assertEqual(out.read_bytes(), without_mark(golden.read_bytes()))
        run(self.build / "golden_frame", SCENE, FRAME, out, golden)
        other = run(self.build / "golden_frame", SCENE, FRAME, out, frames / "frame_000000.png", code=1)
        self.assertIn(b"differs", other.stderr)

    def test_clip_holds_every_frame(self):
        clip = self.folder / "tower.mp4"
        run(self.build / "clip_from_code", clip)
        frames = run("ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames",
                     "-of", "default=nw=1:nk=1", clip).stdout
        self.assertEqual(int(frames), 61)

    def test_clip_equals_that_of_the_program(self):
        source = self.folder / "clip.cpp"
        source.write_text("""#include <tumble/tumble.h>
            int main(int, char** arguments) {
                tumble::LoadOptions options;
                options.duration = 0.5;
                const tumble::Scene scene = tumble::load_scene(arguments[1], options);
                const tumble::ClipTiming timings[] = {{}, {0.3, 180.0, 3}};
                for (int i = 0; i < 2; ++i) {
                    tumble::FrameSequence frames(scene, timings[i]);
                    tumble::Renderer renderer(scene);
                    tumble::ClipWriter clip(arguments[2 + i], scene.output());
                    for (int frame = 0; frame < frames.frame_count(); ++frame)
                        clip.write(renderer.render_blurred(frames.next()));
                    clip.finish();
                }
            }
            """)
        place = self.library.parent
        run(CXX, "-std=c++17", *FLAGS.split(), source, f"-I{self.prefix / 'include'}", f"-L{place}",
            f"-Wl,-rpath,{place}", "-ltumble", "-o", self.folder / "clip")
        ours = [self.folder / "ours.mkv", self.folder / "ours-slow.mkv"]
        run(self.folder / "clip", SCENE, *ours)
        slow = ["--speed", 0.3, "--shutter", 180, "--blur-samples", 3]
        for clip, options in zip(ours, [[], slow]):
            theirs = self.folder / "theirs.mkv"
            run(TUMBLE, "render", SCENE, "--duration", 0.5, "-o", theirs, "--quiet", *options)
            self.assertEqual(clip.read_bytes(), theirs.read_bytes(), options)

    def test_program_of_the_tutorial(self):
        page = (ROOT / "docs/tutorials/from-cpp.md").read_text()
        blocks = dict(re.findall(r"```(cpp|cmake)\n(.*?)```", page, re.S))
        self.assertLessEqual(blocks["cpp"].count("\n"), 32)
        project = self.folder / "tutorial"
        project.mkdir()
        (project / "fall.cpp").write_text(blocks["cpp"])
        (project / "CMakeLists.txt").write_text(blocks["cmake"])
        run(CMAKE, "-S", project, "-B", project / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}",
            f"-DCMAKE_CXX_COMPILER={CXX}", f"-DCMAKE_CXX_FLAGS={FLAGS}")
        run(CMAKE, "--build", project / "build")
        run(project / "build/fall", cwd=project)
        self.assertTrue((project / "fall.mp4").is_file())

    def test_examples_have_at_most_60_lines(self):
        for example in (ROOT / "examples").glob("*.cpp"):
            self.assertLessEqual(len(example.read_text().splitlines()), 60, example.name)

    def test_error_has_the_place_and_the_exit_code_of_the_program(self):
        scene = self.folder / "wrong.toml"
        scene.write_text("format = 1\n[simulation]\nduratoin = 1\n")
        ours = run(self.build / "trajectory_table", scene, code=2).stderr
        self.assertEqual(ours, run(TUMBLE, "simulate", scene, code=2).stderr)
        self.assertIn(b"wrong.toml:3:1: error: unknown key", ours)

    def test_pkg_config_builds_the_same_program(self):
        pkg_config = shutil.which("pkg-config")
        if pkg_config is None:
            self.skipTest("pkg-config is not installed")
        path = {"PKG_CONFIG_PATH": str(next(self.prefix.rglob("tumble.pc")).parent)}
        words = run(pkg_config, "--cflags", "--libs", "tumble", env=path).stdout.decode().split()
        program = self.folder / "by-pkg-config"
        run(CXX, "-std=c++17", *FLAGS.split(), self.project / "trajectory_table.cpp", *words, "-o", program)
        table = run(program, SCENE, env={"LD_LIBRARY_PATH": str(self.library.parent)}).stdout
        self.assertEqual(table, run(self.build / "trajectory_table", SCENE).stdout)
        version = re.search(r"project\(tumble VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertEqual(run(pkg_config, "--modversion", "tumble", env=path).stdout.decode().strip(), version)

    def test_the_commands_of_the_tutorial_without_cmake(self):
        page = (ROOT / "docs/tutorials/from-cpp.md").read_text()
        commands = re.search(r"Without CMake:\n\n```sh\n(.*?)```", page, re.S)[1]
        home = self.folder / "home"
        home.mkdir()
        (home / "tumble").symlink_to(self.prefix)
        (home / "fall.cpp").write_text(re.search(r"```cpp\n(.*?)```", page, re.S)[1])
        compiler = home / "bin/c++"
        compiler.parent.mkdir()
        compiler.write_text(f'#!/bin/sh\nexec {CXX} {FLAGS} "$@"\n')
        compiler.chmod(0o755)
        run("bash", "-eu", "-c", commands, cwd=home,
            env={"HOME": str(home), "PATH": f"{compiler.parent}:{os.environ['PATH']}"})
        self.assertTrue((home / "fall.mp4").is_file())

    def test_each_header_stands_alone(self):
        headers = sorted((self.prefix / "include/tumble").glob("*.h"))
        self.assertEqual([h.name for h in headers], sorted(h.name for h in (ROOT / "include/tumble").glob("*.h")))
        for header in headers:
            self.assertNotRegex(header.read_text(), r"#include <(?!tumble/|stddef\.h>|stdint\.h>)[^>]*[/.]",
                                header.name)   # the library of C++ has no folders; live.h is for C
            unit = self.folder / "header.cpp"
            unit.write_text(f"#include <tumble/{header.name}>\n")
            run(CXX, "-std=c++17", "-fsyntax-only", *FLAGS.split(), f"-I{self.prefix / 'include'}", unit)

    def test_library_exports_its_interface_only(self):
        nm = shutil.which("nm")
        if nm is None:
            self.skipTest("nm is not installed")
        names = run(nm, "--dynamic", "--defined-only", "--demangle", "--format=posix", self.library).stdout.decode()
        others = [name for name in names.splitlines() if "tumble::v0::" not in name and not re.match("tumble_[a-z_]+ T", name)]
        self.assertEqual(others, [])

    def test_installed_shaders_are_used(self):
        other = self.folder / "other"
        shutil.copytree(self.prefix, other, symlinks=True)
        sky = other / "share/tumble/shaders/sky.frag"
        sky.write_text("no shader\n")
        moved = {"LD_LIBRARY_PATH": str(other / self.library.parent.relative_to(self.prefix))}
        program = self.folder / "golden_frame"
        shutil.copy(self.build / "golden_frame", program)
        # The path to the library that CMake put into the program comes first only as RPATH, not as RUNPATH.
        error = run(program, SCENE, 0, self.folder / "sky.png", code=1, env=moved).stderr.decode()
        self.assertIn(str(sky), error)
        self.assertFalse((self.folder / "sky.png").exists())

    def test_installed_program_runs(self):
        run(self.prefix / "bin/tumble", "simulate", SCENE, "--duration", "0.1", "--quiet")
        self.assertTrue((self.prefix / "bin/tumble").is_file())

    def test_no_link_of_the_documents_leads_out_of_the_installed_tree(self):
        documents = self.prefix / "share/doc/tumble"
        pages = sorted(documents.rglob("*.md"))
        self.assertEqual(len(pages), 3 + len(list((ROOT / "docs").rglob("*.md"))))
        links = [(page, link) for page in pages for link in links_of(page.read_text())]
        self.assertGreater(len(links), 200)
        for page, link in links:
            target = (page.parent / link).resolve()
            self.assertTrue(target.is_relative_to(self.prefix.resolve()) and target.exists(),
                            f"{page.relative_to(documents)}: {link}")
        self.assertTrue(any(link.endswith("include/tumble/world.h") for _, link in links))

    def test_manual_pages_completions_and_scenes_are_installed(self):
        share = self.prefix / "share"
        for shell, place in (("bash", "bash-completion/completions/tumble"), ("zsh", "zsh/site-functions/_tumble"),
                             ("fish", "fish/vendor_completions.d/tumble.fish")):
            self.assertEqual((share / place).read_bytes(), run(TUMBLE, "completion", shell).stdout)
        run(TUMBLE, "man-pages", self.folder / "man1")
        pages = {page.name: page.read_bytes() for page in (self.folder / "man1").iterdir()}
        self.assertEqual({page.name: page.read_bytes() for page in (share / "man/man1").iterdir()}, pages)
        self.assertIn("tumble-render.1", pages)
        run(self.prefix / "bin/tumble", "info", share / "tumble/assets/scenes/furniture.toml")
        listed = (pathlib.Path(os.environ["TUMBLE_BUILD"]) / "install_manifest.txt").read_text()
        self.assertIn("/share/man/man1/tumble-render.1\n", listed)

    def test_license_and_documents_are_installed(self):
        documents = self.prefix / "share/doc/tumble"
        for name in ["LICENSE", "README.md", "CHANGELOG.md", "docs/reference/cpp-api.md", "examples/CMakeLists.txt"]:
            self.assertTrue((documents / name).is_file(), name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
