"""The Debian package in a bare Debian 12: apt installs it, it renders, and its removal leaves nothing.

Skipped where this is not root, or mmdebstrap or the mirror is missing. The bare system is kept in the build folder. Run it
alone with: ctest -R cli_bare_root_test.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["TUMBLE_BUILD"])
CACHE = BUILD / "bare-root"
TOOLS = ["mmdebstrap", "unshare", "mount", "chroot", "tar", "dpkg-deb", "dpkg-shlibdeps", "cpack"]

# Files that apt and dpkg keep about each installation, and caches that libraries make.
KEPT = re.compile(r"var/lib/(dpkg/|apt/|systemd/|ucf/)|var/cache/|var/log/|etc/(ld\.so\.cache|\.pwd\.lock|(passwd|group|g?shadow|sub[ug]id)-?$)"
                  r"|(root|tmp|run|dev|proc|sys)(/|$)")

IN_ROOT = """
set -eu
mount -t proc proc "$1/proc"
mount --rbind /dev "$1/dev"
mount -t tmpfs tmpfs "$1/dev/shm"
cp /etc/resolv.conf "$1/etc/resolv.conf"
shift_root=$1
shift
exec chroot "$shift_root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
"""


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def bare_system():
    """The file of a minimal Debian 12, made once."""
    archive = CACHE / "debian-12.tar"
    if not archive.exists():
        CACHE.mkdir(exist_ok=True)
        part = CACHE / f"part-{os.getpid()}.tar"
        made = subprocess.run(["mmdebstrap", "--variant=minbase", "bookworm", part], capture_output=True, text=True, timeout=1200)
        if made.returncode != 0:
            part.unlink(missing_ok=True)
            skip("mmdebstrap made no bare system: " + " ".join(made.stderr.splitlines()[-3:]))
        part.rename(archive)
    return archive


class BareRoot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        archive = bare_system()
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="tumble-bare-root-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.system = cls.folder / "system"
        cls.system.mkdir()
        subprocess.run(["tar", "-xf", archive, "-C", cls.system], check=True)
        made = subprocess.run([ROOT / "scripts/package", "--build", BUILD, "--output", cls.system / "root"], check=True,
                              capture_output=True, text=True, env={**os.environ, "DEBFULLNAME": "A", "DEBEMAIL": "a@debian.org"})
        cls.deb = "/root/" + pathlib.Path(made.stdout.strip()).name
        update = cls.attempt("apt-get", "-qq", "update")
        if update.returncode != 0:
            cls.doClassCleanups()
            skip("the mirror does not answer: " + update.stderr)

    @classmethod
    def attempt(cls, *command, timeout=1200):
        return subprocess.run(["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c", IN_ROOT, "sh", cls.system, *command],
                              capture_output=True, text=True, timeout=timeout)

    def within(self, *command):
        done = self.attempt(*command)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def listing(self):
        """Names, kinds and sizes of all files, without those that any installation changes."""
        found = {}
        for folder, folders, files in os.walk(self.system):
            for name in folders + files:
                path = pathlib.Path(folder) / name
                place = str(path.relative_to(self.system))
                if not KEPT.match(place):
                    state = path.lstat()
                    found[place] = (oct(state.st_mode), state.st_uid, state.st_gid, 0 if path.is_dir() else state.st_size)
        return found

    def test_install_render_purge(self):
        before = self.listing()
        self.within("apt-get", "-qq", "install", "--no-install-recommends", "--yes", self.deb)
        self.program_without_ffmpeg()
        self.within("apt-get", "-qq", "install", "--no-install-recommends", "--yes", "ffmpeg", "man-db", "bash-completion")
        self.program_with_everything()
        self.within("dpkg", "--verify", "tumble")

        self.within("apt-get", "-qq", "purge", "--yes", "tumble")
        removed = self.listing()
        self.assertEqual([name for name in removed if "tumble" in name], [])
        kept = [str(p.relative_to(self.system)) for p in (self.system / "var").rglob("*tumble*")]
        self.assertEqual([name for name in kept if not name.startswith("var/cache/man/")], [])   # man keeps pages that were shown
        self.within("apt-get", "-qq", "install", "--no-install-recommends", "--yes", self.deb)
        self.within("apt-get", "-qq", "purge", "--yes", "tumble")
        self.assertEqual(self.listing(), removed)
        self.within("apt-get", "-qq", "purge", "--yes", "--auto-remove", "ffmpeg", "man-db", "bash-completion")
        after = self.listing()
        self.assertEqual(sorted(set(before) - set(after)), [])
        # apt keeps packages that others recommend; each further file is one of theirs.
        more = sorted(set(after) - set(before))
        if more:
            self.within("dpkg", "--search", *("/" + name for name in more))

    def program_without_ffmpeg(self):
        """The dependencies alone: frames and tables, and a report of the missing ffmpeg."""
        report = self.attempt("tumble", "doctor")
        self.assertEqual(report.returncode, 1, report.stdout)
        self.assertIn("try: apt-get install ffmpeg", report.stdout)
        self.assertRegex(report.stdout, r"OpenGL, osmesa +ok")
        self.assertRegex(report.stdout, r"font +ok +Inter\n")
        self.assertRegex(report.stdout, r"shaders +ok +/usr/share/tumble/shaders\n")
        self.within("tumble", "render", "/usr/share/tumble/assets/scenes/bouncing_balls.toml", "--frames", "/root/frames",
                    "--duration", "0.1", "--size", "160x90", "--quiet")
        self.assertTrue((self.system / "root/frames/frame_000003.png").read_bytes().startswith(b"\x89PNG"))

    def program_with_everything(self):
        version = self.within("dpkg-query", "-W", "-f", "${Version}", "tumble")
        self.assertEqual(self.within("tumble", "--version"), f"tumble {version.rsplit('-', 1)[0]}\n")
        report = self.within("tumble", "doctor")
        self.assertIn("All requirements are met", report)
        print(report)
        self.within("tumble", "render", "/usr/share/tumble/assets/scenes/bouncing_balls.toml", "-o", "/root/clip.mp4",
                    "--frames", "/root/all", "--duration", "0.5", "--size", "320x180", "--quiet")
        frames = self.within("ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of",
                             "default=nw=1:nk=1", "/root/clip.mp4")
        self.assertEqual(int(frames), len(list((self.system / "root/all").glob("frame_*"))))
        self.same_frames_as_the_build()
        self.assertIn("--frames", self.within("man", "tumble-render"))
        offers = self.within("bash", "-c", ". /usr/share/bash-completion/bash_completion; _completion_loader tumble; "
                             "COMP_WORDS=(tumble render --quality ''); COMP_CWORD=3; _tumble; echo \"${COMPREPLY[@]}\"")
        self.assertEqual(offers, "draft normal best\n")

    def same_frames_as_the_build(self):
        out = self.folder / "frames"
        subprocess.run([BUILD / "tumble", "render", ROOT / "assets/scenes/bouncing_balls.toml", "--frames", out, "--duration", "0.5",
                        "--size", "320x180", "--quiet"], check=True)
        for frame in out.iterdir():
            self.assertEqual(frame.read_bytes(), (self.system / "root/all" / frame.name).read_bytes(), frame.name)


if __name__ == "__main__":
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if os.geteuid() != 0:
        skip("only root can make a bare system")
    if missing:
        skip("there is no " + ", ".join(missing))
    if os.environ.get("TUMBLE_SANITIZE"):
        skip("the program is built with a sanitizer")
    unittest.main(verbosity=2)
