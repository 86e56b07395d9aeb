"""scripts/package: the Debian package of the build tree. Skipped where dpkg's tools, cpack or lintian are missing."""

import gzip
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = os.environ["TUMBLE_BUILD"]
TOOLS = ["dpkg-deb", "dpkg-shlibdeps", "cpack", "lintian"]
DATE = "1700000000"


def run(*command, code=0, **options):
    options.setdefault("timeout", 300)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != code:
        raise AssertionError(f"{command}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="tumble-package-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.deb = cls.package("one")
        cls.tree = cls.folder / "tree"
        run("dpkg-deb", "-x", cls.deb, cls.tree)
        cls.control = run("dpkg-deb", "-f", cls.deb).stdout
        cls.files = sorted(str(path.relative_to(cls.tree)) for path in cls.tree.rglob("*") if not path.is_dir())

    @classmethod
    def package(cls, name, umask="022"):
        made = run("sh", "-c", f"umask {umask}; exec \"$@\"", "sh", ROOT / "scripts/package", "--build", BUILD,
                   "--output", cls.folder / name,
                   env={**os.environ, "SOURCE_DATE_EPOCH": DATE, "DEBFULLNAME": "A. Tester", "DEBEMAIL": "tester@debian.org"})
        return pathlib.Path(made.stdout.strip())

    def field(self, name):
        return re.search(rf"^{name}: (.*)", self.control, re.M)[1]

    def program(self, *arguments, **options):
        return run(self.tree / "usr/bin/tumble", *arguments, **options)

    def test_lintian_finds_nothing(self):
        found = run("lintian", "--allow-root", "--fail-on", "none", "--display-info", "--tag-display-limit", "0", self.deb).stdout
        # The folder of libraries of another prefix than /usr has no name of the architecture; scripts/package alone uses /usr.
        others = [line for line in found.splitlines() if "pkg-config-unavailable-for-cross-compilation" not in line]
        self.assertEqual([line for line in others if line[:2] in ("E:", "W:")], [])
        for tag in ("unused-override", "mismatched-override"):
            self.assertNotIn(tag, found)

    def test_the_same_bytes_again(self):
        self.assertEqual(self.package("two", umask="077").read_bytes(), self.deb.read_bytes())

    def test_dependencies(self):
        depends = [name.split(" ")[0] for name in self.field("Depends").split(", ")]
        for name in ("libc6", "libstdc++6", "libpng16-16", "libosmesa6", "libpangocairo-1.0-0", "fonts-inter", "zlib1g", "libassimp5"):
            self.assertIn(name, depends)
        self.assertEqual([name for name in depends if name.endswith("-dev")], [])
        self.assertEqual(self.field("Recommends"), "ffmpeg")
        # Libraries that are opened by name: each is a dependency, or suggested.
        names = {name for path in (ROOT / "src").rglob("*.cpp") for name in re.findall(r'"(lib[\w.-]+?)\.so', path.read_text())}
        self.assertEqual({name.lower() for name in names}, {"libosmesa", "libegl", "libpangocairo-1.0"})

    def test_version_is_that_of_the_program(self):
        version = self.field("Version")
        self.assertRegex(version, r"^\d+\.\d+\.\d+-1$")
        self.assertEqual(self.program("--version").stdout, f"tumble {version[:-2]}\n")
        self.assertTrue(self.deb.name.startswith(f"tumble_{version}_"))

    def test_the_extracted_program_uses_its_own_files(self):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("TUMBLE_")}
        report = self.program("doctor", env=environment).stdout
        self.assertIn(f"{self.tree}/usr/share/tumble/shaders", report)
        scene = self.tree / "usr/share/tumble/assets/scenes/bouncing_balls.toml"
        out = self.folder / "frames"
        self.program("render", scene, "--frames", out, "--duration", "0", "--size", "64x36", "--quiet", env=environment)
        self.assertEqual([path.name for path in out.glob("frame_*")], ["frame_000000.png"])

    def test_files(self):
        pages = [name for name in self.files if name.startswith("usr/share/man/man1/tumble")]
        self.assertGreater(len(pages), 10)
        self.assertTrue(all(re.search(r"\.1\.gz$", name) for name in pages))
        for name in ("usr/bin/tumble", "usr/share/man/man1/tumble.1.gz", "usr/share/bash-completion/completions/tumble",
                     "usr/share/zsh/vendor-completions/_tumble", "usr/share/fish/vendor_completions.d/tumble.fish",
                     "usr/include/tumble/tumble.h", "usr/share/doc/tumble/copyright",
                     "usr/share/doc/tumble/changelog.Debian.gz", "usr/share/doc/tumble/docs/reference/scene-format.md",
                     "usr/share/tumble/shaders/sky.frag", "usr/share/tumble/assets/meshes/gem.obj"):
            self.assertIn(name, self.files)
        for pattern in (r"/libtumble\.so$", r"/tumble\.pc$", r"/tumbleConfig\.cmake$"):
            self.assertEqual(len([name for name in self.files if re.search(pattern, name)]), 1, pattern)
        self.assertNotIn("usr/share/doc/tumble/LICENSE", self.files)

    def test_completions_are_those_of_the_program(self):
        for shell, name in (("bash", "bash-completion/completions/tumble"), ("zsh", "zsh/vendor-completions/_tumble"),
                            ("fish", "fish/vendor_completions.d/tumble.fish")):
            self.assertEqual((self.tree / "usr/share" / name).read_text(), self.program("completion", shell).stdout)

    def test_owner_and_modes(self):
        for line in run("dpkg-deb", "-c", self.deb).stdout.splitlines():
            mode, owner, *_ = line.split()
            self.assertEqual(owner, "root/root", line)
            self.assertIn(mode, ("drwxr-xr-x", "-rwxr-xr-x", "-rw-r--r--", "lrwxrwxrwx"), line)

    def test_copyright_names_what_the_program_contains(self):
        text = (self.tree / "usr/share/doc/tumble/copyright").read_text()
        headers = {name for path in (ROOT / "src").rglob("*") if path.suffix in (".h", ".cpp")
                   for name in re.findall(r"^#include <(Eigen|CLI|toml\+\+|nlohmann|glm|fmt)/", path.read_text(), re.M)}
        self.assertGreaterEqual(len(headers), 6)
        for name in headers:
            self.assertIn(f"\nFiles: {name}/*\n", text)
        paragraphs = text.strip().split("\n\n")
        self.assertTrue(paragraphs[0].startswith("Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/"))
        used = set(re.findall(r"^License: (.*)", "\n".join(p for p in paragraphs if p.startswith("Files:")), re.M))
        # By a paragraph of its own, or where it stands, as in those of the player of pages.
        explained = set(re.findall(r"^License: (.*)\n ", text, re.M))
        self.assertEqual(used, explained)
        license_text = " ".join((ROOT / "LICENSE").read_text().split("\n\n", 2)[2].split())
        self.assertIn(license_text, " ".join(re.sub(r"^ \.?", "", text, flags=re.M).split()))

    def test_licenses_of_the_player(self):
        """From the comments at the head of its files."""
        web = self.folder / "web"
        web.mkdir()
        script = ROOT / "packaging/deb/web-copyright"
        self.assertIn("no licenses", run(script, web, code=1).stderr)
        (web / "player.js").write_text("/*\n@a/font:\nCopyright 2022 A.\nconditions:\n\n1. one\n\nb:\nMIT\n\nCopyright (c) 2001 B\n*/\nlet x;\n")
        (web / "lesson.cjs").write_text("/*\nb:\nMIT\n\nCopyright (c) 2001 B\n*/\n/*\nc:\nno\n*/\n")
        self.assertEqual(run(script, web).stdout, """
Files: web/node_modules/@a/font/*
Copyright: 2022 A.
License: @a/font
 Copyright 2022 A.
 conditions:
 .
 1. one

Files: web/node_modules/b/*
Copyright: 2001 B
License: b
 MIT
 .
 Copyright (c) 2001 B
""")

    def test_changelog(self):
        text = gzip.decompress((self.tree / "usr/share/doc/tumble/changelog.Debian.gz").read_bytes()).decode()
        self.assertTrue(text.startswith(f"tumble ({self.field('Version')}) unstable; urgency=medium\n"))
        self.assertTrue(text.endswith("\n -- A. Tester <tester@debian.org>  Tue, 14 Nov 2023 22:13:20 +0000\n"))

    def test_no_machine_path(self):
        """Texts; the binaries of build/release name their source tree, for shaders before installation."""
        for name in self.files:
            data = (self.tree / name).read_bytes()
            if not data.startswith(b"\x7fELF"):
                self.assertNotIn(str(ROOT).encode(), data, name)
                self.assertNotIn(str(self.folder).encode(), data, name)

    def test_wrong_usage(self):
        script = ROOT / "scripts/package"
        for arguments in (["--what"], ["--build", self.folder], ["--output"], ["--revision", "a b"]):
            done = subprocess.run([script, *arguments], capture_output=True, text=True, timeout=60)
            self.assertNotEqual(done.returncode, 0, arguments)
            self.assertIn("package:", done.stderr)
            self.assertEqual(done.stdout, "")


if __name__ == "__main__":
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        print("skipped: there is no " + ", ".join(missing))
        sys.exit(77)
    if os.environ.get("TUMBLE_SANITIZE"):
        print("skipped: the program is built with a sanitizer")
        sys.exit(77)
    unittest.main(verbosity=2)
