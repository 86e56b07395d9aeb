"""Standard output and standard error that cannot be written: full, closed, or pipes without a reader. Exit codes stay 0, 1
and 2."""

import os
import subprocess

import program


class Streams(program.ProgramTest):
    def setUp(self):
        super().setUp()
        for name, color in (("a.png", (120, 120, 120)), ("b.png", (0, 0, 0))):
            (self.folder / name).write_bytes(program.png(16, 16, color))
        self.check(0, "render", "scene.toml", "--frames", "in")
        self.full = open("/dev/full", "w")
        self.addCleanup(self.full.close)

    def without_reader(self):
        """A pipe without a reader."""
        ends = os.pipe()
        os.close(ends[0])
        self.addCleanup(os.close, ends[1])
        return ends[1]

    def code(self, arguments, **streams):
        streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **streams}
        return subprocess.run([program.TUMBLE, *arguments], cwd=self.folder, timeout=300, **streams).returncode

    # With the exit code if all output can be written.
    COMMANDS = ((0, "--help"), (0, "--version"), (0, "render", "--help"), (0, "info", "scene.toml"), (0, "doctor"),
                (0, "compare", "a.png", "a.png"), (1, "compare", "a.png", "b.png"), (2, "compare", "a.png", "none.png"),
                (0, "render", "scene.toml", "-o", "a.mkv"), (0, "render", "scene.toml", "--frames", "out"),
                (0, "simulate", "scene.toml", "--energy", "e.csv"), (0, "encode", "in", "-o", "b.mkv"),
                (2, "info", "none.toml"), (2, "render"), (2, "paint"), (2, "render", "scene.toml", "-o", "a.avi"),
                (1, "simulate", "scene.toml", "--energy", "none/e.csv"))

    def test_standard_error_changes_nothing(self):
        for code, *arguments in self.COMMANDS:
            for stream in (self.full, self.without_reader()):
                with self.subTest(arguments=arguments):
                    self.assertEqual(self.code(arguments, stderr=stream), code)

    def test_requested_output_on_standard_output(self):
        cases = ((1, "--help"), (1, "--version"), (1, "encode", "--help"), (1, "info", "scene.toml"), (1, "doctor"),
                 (2, "compare", "a.png", "a.png"), (2, "compare", "a.png", "b.png"),   # 1 means different
                 (1, "simulate", "scene.toml", "--energy", "-"), (1, "simulate", "scene.toml", "--trajectory", "/dev/stdout"))
        for code, *arguments in cases:
            for stream, reason in ((self.full, "No space left"), (self.without_reader(), "Broken pipe")):
                with self.subTest(arguments=arguments):
                    run = subprocess.run([program.TUMBLE, *arguments], cwd=self.folder, timeout=300, stdout=stream,
                                         stderr=subprocess.PIPE, text=True)
                    self.assertEqual(run.returncode, code)
                    self.assertIn("error: cannot write ", run.stderr)
                    self.assertIn(reason, run.stderr)
                    # Both at once.
                    self.assertEqual(self.code(arguments, stdout=stream, stderr=stream), code)

    def test_no_output_requested_on_standard_output(self):
        for arguments in (["render", "scene.toml", "-o", "a.mkv"], ["simulate", "scene.toml", "--energy", "e.csv"],
                          ["encode", "in", "-o", "b.mkv"]):
            self.assertEqual(self.code(arguments, stdout=self.full), 0)

    def test_a_reader_that_takes_one_line(self):
        for code, *arguments in self.COMMANDS:
            with self.subTest(arguments=arguments):
                run = subprocess.run(["/bin/bash", "-c", '"$@" 2>&1 | head -1 > /dev/null; echo ${PIPESTATUS[0]}', "sh",
                                      program.TUMBLE, *arguments], cwd=self.folder, timeout=300, stdout=subprocess.PIPE,
                                     text=True)
                # A race: if the reader has ended in time, the output on standard output is not written.
                self.assertIn(run.stdout, {f"{code}\n", "1\n", "2\n"})

    def test_closed(self):
        for code, *arguments in ((0, "simulate", "scene.toml", "--energy", "e.csv"), (2, "info", "none.toml"),
                                 (1, "info", "scene.toml"), (1, "--version"), (2, "compare", "a.png", "a.png")):
            self.assertEqual(self.code(arguments, stdout=None, stderr=None, preexec_fn=lambda: (os.close(1), os.close(2))),
                             code)


if __name__ == "__main__":
    program.main()
