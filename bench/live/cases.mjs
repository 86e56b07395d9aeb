// Scenes of the benchmark of live modules, each with the error of a run. Lengths in m, g = 9.81 m/s^2.
const gravity = 9.81;

/** Height of the lowest point of a ball that is dropped from `height` and bounces with e = `restitution`. */
function bounces(height, restitution, time) {
  let start = Math.sqrt(2 * height / gravity), speed = gravity * start;
  if (time < start) return height - 0.5 * gravity * time * time;
  for (;;) {
    speed *= restitution;
    const flight = 2 * speed / gravity;
    if (flight < 1e-9) return 0;
    if (time < start + flight) return speed * (time - start) - 0.5 * gravity * (time - start) ** 2;
    start += flight;
  }
}

const radius = 0.1, edge = 0.4;

export const cases = [
  {
    name: "a ball, dropped 1 m, e = 0.8, 3 s", error: "largest error of the height, m",
    frames: 180, fps: 60, steps: 16, impacts: "exact", restitution: 0.8, friction: 0.5,
    bodies: [{ radius, height: 1 + radius }],
    error_of(heights) {
      return Math.max(...heights.map(([height], n) => Math.abs(height - radius - bounces(1, this.restitution, n / this.fps))));
    },
  },
  {
    name: "a stack of 10 boxes at rest, 5 s", error: "largest change of a height, m",
    frames: 300, fps: 60, steps: 4, impacts: "stepped", restitution: 0, friction: 0.5,
    bodies: Array.from({ length: 10 }, (_, k) => ({ size: [edge, edge, edge], height: (k + 0.5) * edge })),
    error_of(heights) {
      return Math.max(...heights.flatMap((row) => row.map((height, k) => Math.abs(height - this.bodies[k].height))));
    },
  },
];
