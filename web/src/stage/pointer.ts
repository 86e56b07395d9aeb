// Mouse and touch on the stage. A page with stages must still scroll: one finger that moves up or down scrolls the page, one that
// starts sideways turns the view, and two fingers zoom and move it. The wheel zooms with Ctrl, or while the stage has the focus.
export interface PointerActions {
  /** rad */
  orbit(dx: number, dy: number): void;
  /** Fractions of the height of the stage. */
  pan(dx: number, dy: number): void;
  /** Factor of the distance. */
  zoom(factor: number): void;
  /** CSS pixels from the left and the top of the stage. */
  pick(x: number, y: number): void;
}

/** A press that moves less is a click, px. */
const click_reach = 5;
/** Turned by a drag of one pixel, rad. */
const turn_per_pixel = 0.006;
/** Exponent of the distance's factor for a pixel of a wheel, which has 100 a notch. */
const wheel_step = 0.0018;

interface Contact {
  x: number;
  y: number;
  start_x: number;
  start_y: number;
  button: number;
  moved: boolean;
}

/** Returns what undoes it. */
export function listen(host: HTMLElement, canvas: HTMLElement, actions: PointerActions): () => void {
  const contacts = new Map<number, Contact>();
  const stop = new AbortController();
  const on = <K extends keyof HTMLElementEventMap>(type: K, act: (event: HTMLElementEventMap[K]) => void) =>
    canvas.addEventListener(type, act, { signal: stop.signal, passive: false });
  canvas.style.touchAction = "pan-y";
  canvas.style.cursor = "grab";

  on("pointerdown", (event) => {
    contacts.set(event.pointerId, {
      x: event.clientX, y: event.clientY, start_x: event.clientX, start_y: event.clientY, button: event.button,
      moved: contacts.size > 0,
    });
    canvas.setPointerCapture(event.pointerId);
    canvas.style.cursor = "grabbing";
    host.closest<HTMLElement>("[tabindex]")?.focus({ preventScroll: true });
  });

  on("pointermove", (event) => {
    const contact = contacts.get(event.pointerId);
    if (!contact) return;
    const before = spread(contacts);
    const dx = event.clientX - contact.x;
    const dy = event.clientY - contact.y;
    contact.x = event.clientX;
    contact.y = event.clientY;
    contact.moved ||= Math.hypot(contact.x - contact.start_x, contact.y - contact.start_y) > click_reach;
    if (!contact.moved) return;
    const height = Math.max(canvas.clientHeight, 1);
    if (contacts.size > 1) {
      const after = spread(contacts);
      actions.pan(dx / contacts.size / height, dy / contacts.size / height);
      if (before > 0 && after > 0) actions.zoom(before / after);
    } else if (contact.button === 2 || contact.button === 1 || event.shiftKey) actions.pan(dx / height, dy / height);
    else actions.orbit(turn_per_pixel * dx, turn_per_pixel * dy);
  });

  const end = (event: PointerEvent, click: boolean) => {
    const contact = contacts.get(event.pointerId);
    contacts.delete(event.pointerId);
    if (contacts.size === 0) canvas.style.cursor = "grab";
    if (!click || !contact || contact.moved || contact.button !== 0) return;
    const { left, top } = canvas.getBoundingClientRect();
    actions.pick(event.clientX - left, event.clientY - top);
  };
  on("pointerup", (event) => end(event, true));
  on("pointercancel", (event) => end(event, false));
  on("contextmenu", (event) => event.preventDefault());

  on("wheel", (event) => {
    const focused = host.closest("[tabindex]")?.contains(document.activeElement) ?? false;
    if (!event.ctrlKey && !focused) return;
    event.preventDefault();
    const pixels = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 * event.deltaY : event.deltaY;
    // A pinch on a touch pad arrives as a wheel with Ctrl and small steps.
    actions.zoom(Math.exp(pixels * wheel_step * (event.ctrlKey && Math.abs(pixels) < 50 ? 5 : 1)));
  });
  return () => stop.abort();
}

function spread(contacts: Map<number, Contact>): number {
  const [one, other] = [...contacts.values()];
  return one && other ? Math.hypot(one.x - other.x, one.y - other.y) : 0;
}
