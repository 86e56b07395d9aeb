"""`method = "notes"`: the trajectories of a script that follows the course notes, in plain Python.

The script shares nothing with the program: own vectors, collision detection and integration.
"""

import math

import program

H = 0.01      # s, step; every step is a frame
STEPS = 200


def add(a, b, s=1.0):
    return [x + s * y for x, y in zip(a, b)]


def scale(a, s):
    return [s * x for x in a]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def norm(a):
    return math.sqrt(dot(a, a))


def apply(m, v):
    return [dot(row, v) for row in m]


def transpose(m):
    return [list(column) for column in zip(*m)]


def inverse_transpose(m):
    det = dot(m[0], cross(m[1], m[2]))
    return [scale(cross(m[1], m[2]), 1.0 / det), scale(cross(m[2], m[0]), 1.0 / det), scale(cross(m[0], m[1]), 1.0 / det)]


def matrix_of(q):
    w, x, y, z = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def nearest_rotation(m):
    for _ in range(30):
        m = [[0.5 * (p + q) for p, q in zip(a, b)] for a, b in zip(m, inverse_transpose(m))]
    return m


class Body:
    """A sphere (one number) or a box (edge lengths); without a mass it is the plane y = 0."""

    def __init__(self, shape, x, v=(0, 0, 0), q=(1, 0, 0, 0), w=(0, 0, 0), e=0.5, mass=None):
        self.shape, self.x, self.q, self.e, self.mass = shape, list(x), scale(q, 1.0 / norm(q)), e, mass
        self.r = matrix_of(self.q)
        self.inverse_mass = 1.0 / mass if mass else 0.0
        if mass is None:
            inertia = [math.inf] * 3
        elif isinstance(shape, float):
            inertia = [0.4 * mass * shape ** 2] * 3
        else:
            a, b, c = shape
            inertia = [mass * (b * b + c * c) / 12, mass * (a * a + c * c) / 12, mass * (a * a + b * b) / 12]
        self.inverse_inertia = [1.0 / i for i in inertia]
        self.p = scale(v, mass or 0.0)
        self.l = [0.0] * 3
        if mass:
            body_l = [i * c for i, c in zip(inertia, apply(transpose(self.r), w))]
            self.l = apply(self.r, body_l)
        self.given = {"velocity": v, "angular_velocity": w, "rotation": q}

    def respond(self, l):       # I^-1(t) l, eq. 3
        return apply(self.r, [i * c for i, c in zip(self.inverse_inertia, apply(transpose(self.r), l))])

    def velocity(self):         # eq. 2
        return scale(self.p, self.inverse_mass)

    def spin(self):             # eq. 4
        return self.respond(self.l) if self.mass else [0.0] * 3

    def point_velocity(self, p):
        return add(self.velocity(), cross(self.spin(), add(p, self.x, -1.0)))

    def corners(self):
        half = scale(self.shape, 0.5)
        for i in range(8):
            yield add(self.x, apply(self.r, [half[k] if i >> k & 1 else -half[k] for k in range(3)]))

    def toml(self):
        if self.mass is None:
            return f'[[body]]\ntype = "fixed"\nshape = {{ type = "plane" }}\nrestitution = {self.e}\n'
        shape = (f'type = "sphere", radius = {self.shape!r}' if isinstance(self.shape, float)
                 else f'type = "box", size = {list(self.shape)!r}')
        w, x, y, z = self.given["rotation"]
        return (f'[[body]]\nshape = {{ {shape} }}\nposition = {self.x!r}\nmass = {self.mass}\n'
                f'velocity = {[float(c) for c in self.given["velocity"]]!r}\n'
                f'angular_velocity = {[float(c) for c in self.given["angular_velocity"]]!r}\n'
                f'rotation = {[float(c) for c in (w, x, y, z)]!r}\nrestitution = {self.e}\n')


def edge_contact(a, b):
    """Two boxes that meet edge on edge: (point, normal from a to b, gap); nothing if an axis separates them."""
    between, best = add(b.x, a.x, -1.0), None
    axes_a, axes_b = transpose(a.r), transpose(b.r)
    half_a, half_b = scale(a.shape, 0.5), scale(b.shape, 0.5)
    candidates = [(axis, None) for axis in axes_a + axes_b]
    candidates += [(cross(u, v), (i, j)) for i, u in enumerate(axes_a) for j, v in enumerate(axes_b)]
    for axis, edges in candidates:
        if norm(axis) < 1e-9:
            continue
        n = scale(axis, math.copysign(1.0, dot(axis, between)) / norm(axis))
        reach = sum(h * abs(dot(n, u)) for h, u in zip(half_a + half_b, axes_a + axes_b))
        gap = dot(n, between) - reach
        if best is None or gap > best[0]:
            best = gap, n, edges
    gap, n, edges = best
    if gap > 0.0:
        return None
    assert edges is not None, "the boxes meet with a face: the script has edges only"
    i, j = edges
    # The middle of the edge of each box that lies farthest towards the other one.
    on_a, on_b = list(a.x), list(b.x)
    for k in range(3):
        if k != i:
            on_a = add(on_a, axes_a[k], math.copysign(half_a[k], dot(n, axes_a[k])))
        if k != j:
            on_b = add(on_b, axes_b[k], -math.copysign(half_b[k], dot(n, axes_b[k])))
    u, v, d = axes_a[i], axes_b[j], add(on_b, on_a, -1.0)
    s = dot(cross(d, v), cross(u, v)) / dot(cross(u, v), cross(u, v))
    return add(on_a, u, s), n, gap


def contacts(a, b):
    """(point, normal from a to b) of the points that touch or overlap."""
    if a.mass is None:
        up = [0.0, 1.0, 0.0]
        if isinstance(b.shape, float):
            return [(add(b.x, up, -b.shape), up)] if b.x[1] - b.shape <= 0.0 else []
        return [(p, up) for p in b.corners() if p[1] <= 0.0]
    if isinstance(a.shape, float):
        d = add(b.x, a.x, -1.0)
        if norm(d) - a.shape - b.shape > 0.0:
            return []
        n = scale(d, 1.0 / norm(d))
        return [(add(a.x, n, a.shape), n)]
    found = edge_contact(a, b)
    return [found[:2]] if found else []


def collide(a, b):
    for p, n in contacts(a, b):
        r_a, r_b = add(p, a.x, -1.0), add(p, b.x, -1.0)
        v_rel = dot(n, add(b.point_velocity(p), a.point_velocity(p), -1.0))
        if v_rel >= 0.0:
            continue
        k = a.inverse_mass + b.inverse_mass
        for body, r in ((a, r_a), (b, r_b)):
            if body.mass:
                k += dot(n, cross(body.respond(cross(r, n)), r))
        j = -(1.0 + max(a.e, b.e)) * v_rel / k      # eq. 20
        for body, r, sign in ((a, r_a, -1.0), (b, r_b, 1.0)):
            if body.mass:
                body.p = add(body.p, n, sign * j)
                body.l = add(body.l, cross(r, n), sign * j)


def move(body, explicit, matrix, gravity):
    v, w = body.velocity(), body.spin()
    body.p = add(body.p, gravity, H * body.mass)
    if not explicit:
        v, w = body.velocity(), body.spin()         # P_n+1 / M, I_n^-1 L_n+1
    body.x = add(body.x, v, H)
    if matrix:
        columns = [add(c, cross(w, c), H) for c in transpose(body.r)]
        body.r = nearest_rotation(transpose(columns))
    else:
        s, u = body.q[0], body.q[1:]
        change = [-dot(w, u)] + add(scale(w, s), cross(w, u))
        q = add(body.q, change, 0.5 * H)
        body.q = scale(q, 1.0 / norm(q))
        body.r = matrix_of(body.q)


def simulate(bodies, explicit, matrix, gravity):
    moving = [body for body in bodies if body.mass]
    for step in range(STEPS + 1):
        for i, body in enumerate(moving):
            yield step, i, list(body.x), [list(row) for row in body.r], body.velocity(), body.spin()
        for i, a in enumerate(bodies):
            for b in bodies[i + 1:]:
                collide(a, b)
        for body in moving:
            move(body, explicit, matrix, gravity)


def plane(e=0.5):
    return Body(None, [0, 0, 0], e=e)


def turned(axis, angle):
    n = scale(axis, math.sin(0.5 * angle) / norm(axis))
    return [math.cos(0.5 * angle), *n]


SCENES = {
    "free fall": lambda: [Body(0.5, [0.0, 9.0, 0.0], v=(1.0, 2.0, -0.5), mass=2.0)],
    "middle axis": lambda: [Body([0.4, 1.0, 0.2], [0.0, 9.0, 0.0], w=(3.0, 0.02, 0.01), mass=1.5)],
    "ball on plane": lambda: [plane(), Body(0.5, [0.0, 1.2, 0.0], v=(0.3, 0.0, 0.1), w=(0.0, 1.0, 2.0), e=0.8, mass=2.0)],
    "box on plane": lambda: [plane(), Body([1.0, 0.6, 0.8], [0.0, 1.4, 0.0], q=turned([1.0, 2.0, 0.5], 0.7), e=0.6,
                                           w=(0.5, 0.2, -0.4), mass=3.0)],
    "flat box on plane": lambda: [plane(), Body([1.0, 0.6, 0.8], [0.0, 0.9, 0.0], e=0.5, mass=3.0)],
    "edge on edge": lambda: [Body([1.0, 1.0, 1.0], [0.0, 0.0, 0.0], q=turned([0.0, 0.0, 1.0], math.pi / 4), mass=1.0, e=0.7),
                             Body([1.0, 1.0, 1.0], [0.15, 2.0, 0.1], v=(0.0, -2.0, 0.0), q=turned([1.0, 0.0, 0.0], math.pi / 4),
                                  mass=2.0, e=0.7)],
    "row of balls": lambda: [Body(0.5, [float(i), 0.0, 0.0], v=(3.0 if i == 0 else 0.0, 0.0, 0.0), e=0.9, mass=1.0 + 0.5 * i)
                             for i in range(5)],
}
WITHOUT_GRAVITY = {"edge on edge", "row of balls"}


class Notes(program.ProgramTest):
    def compare(self, name, explicit, matrix):
        bodies = SCENES[name]()
        gravity = [0.0, 0.0 if name in WITHOUT_GRAVITY else -9.81, 0.0]
        self.write("scene.toml", f'''format = 1
[simulation]
method = "notes"
integrator = "{'explicit' if explicit else 'symplectic'}-euler"
rotation = "{'matrix' if matrix else 'quaternion'}"
duration = {STEPS * H}
steps_per_frame = 1
gravity = {gravity}
[output]
fps = {1 / H}
''' + "".join(body.toml() for body in bodies))
        self.check(0, "simulate", "scene.toml", "--trajectory", "t.csv")
        rows = self.rows("t.csv")
        expected = list(simulate(bodies, explicit, matrix, gravity))
        self.assertEqual(len(rows), len(expected))
        for row, (step, body, x, r, v, w) in zip(rows, expected):
            self.assertEqual(int(row["frame"]), step)
            got = {key: float(row[key]) for key in row if key != "body"}
            rotation = matrix_of([got[key] for key in ("qw", "qx", "qy", "qz")])
            pairs = [*zip((got[key] for key in "xyz"), x), *zip((got["v" + key] for key in "xyz"), v),
                     *zip((got["w" + key] for key in "xyz"), w), *zip(sum(rotation, []), sum(r, []))]
            for value, exact in pairs:
                self.assertAlmostEqual(value, exact, delta=1e-12 * max(1.0, abs(exact)), msg=f"{name}, step {step}, body {body}")

    def test_trajectories_equal_those_of_the_script(self):
        for name in SCENES:
            for explicit in (False, True):
                for matrix in (False, True):
                    with self.subTest(scene=name, explicit=explicit, matrix=matrix):
                        self.compare(name, explicit, matrix)

    def test_an_integrator_that_the_notes_do_not_have(self):
        self.write("scene.toml", 'format = 1\n[simulation]\nmethod = "notes"\nintegrator = "rk4"\n[[body]]\nshape = { type = "sphere", radius = 1.0 }\n')
        output = self.check(2, "simulate", "scene.toml", "--trajectory", "t.csv").stderr
        self.assertIn('scene.toml:4:', output)
        self.assertIn('must be "symplectic-euler" or "explicit-euler" with the method of the notes', output)

    def test_push_out_needs_the_method(self):
        self.write("scene.toml", 'format = 1\n[simulation]\npush_out = true\n[[body]]\nshape = { type = "sphere", radius = 1.0 }\n')
        self.assertIn('scene.toml:3:', self.check(2, "simulate", "scene.toml", "--trajectory", "t.csv").stderr)


if __name__ == "__main__":
    program.main()
