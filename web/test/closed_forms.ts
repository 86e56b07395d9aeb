/** The height of a ball's center above the floor that it is dropped on, at rest once all its bounces have passed. SI units. */
export function bouncing_height(start: number, radius: number, restitution: number, time: number, gravity = 9.81): number {
  const fall = Math.sqrt((2 * (start - radius)) / gravity);
  if (time < fall) return start - 0.5 * gravity * time * time;
  let speed = gravity * fall, since = time - fall;
  for (;;) {
    speed *= restitution;
    const flight = (2 * speed) / gravity;
    if (since < flight) return radius + speed * since - 0.5 * gravity * since * since;
    if (flight < 1e-12) return radius;
    since -= flight;
  }
}
