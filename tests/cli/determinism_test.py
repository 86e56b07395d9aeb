"""The same scene gives the same bytes: run again, with other threads, on an older processor. (tests/physics compares
optimized and unoptimized code.)"""

import os

import program

HEAP = """\
format = 1
[simulation]
duration = 2.0
steps_per_frame = 8
[output]
fps = 30
[[body]]
type = "fixed"
shape = {{ type = "plane" }}
friction = 0.5
{bodies}"""

SHAPES = ['{ type = "box", size = [1.0, 0.7, 0.4] }', '{ type = "sphere", radius = 0.4 }',
          '{ type = "box", size = [0.5, 0.5, 0.5] }']


def heap(count):
    """Bodies of three kinds that fall onto each other, tilted and rotating."""
    bodies = ""
    for n in range(count):
        bodies += (f"[[body]]\nshape = {SHAPES[n % 3]}\nfriction = 0.4\nrestitution = 0.3\n"
                   f"position = [{0.31 * (n % 4)}, {1.0 + 0.6 * n}, {0.27 * (n % 3)}]\n"
                   f"rotation = {{ axis = [1, {n}, 2], angle = {17 * n} }}\n"
                   f"angular_velocity = [{n % 5}.5, 0.3, -1.0]\n")
    return HEAP.format(bodies=bodies)


class Determinism(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("heap.toml", heap(24))
        self.expected = self.tables()

    def tables(self, *arguments, **options):
        self.check(0, "simulate", "heap.toml", "--trajectory", "t.csv", "--energy", "e.csv", "--quiet", *arguments, **options)
        return (self.folder / "t.csv").read_bytes(), (self.folder / "e.csv").read_bytes()

    def test_it_can_differ(self):
        self.assertNotEqual(self.expected, self.tables("--steps-per-frame", 9))
        self.assertGreater(int(self.rows("e.csv")[-1]["contacts"]), 10, "nothing much touches: the test says little")

    def test_again(self):
        self.assertEqual(self.expected, self.tables())

    def test_any_number_of_threads(self):
        for threads in (1, 2, 3, 8):
            self.assertEqual(self.expected, self.tables("--threads", threads), f"{threads} threads")

    def test_older_processors(self):
        # glibc then selects the functions for a processor without AVX and FMA.
        masked = "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX,-AVX2_Usable,-FMA_Usable"
        self.assertEqual(self.expected, self.tables(env={**os.environ, "GLIBC_TUNABLES": masked}))


if __name__ == "__main__":
    program.main()
