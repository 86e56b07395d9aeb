// Stages live only near the part of the page in view: browsers drop the oldest WebGL context beyond 16.

export interface PooledView {
  readonly element: HTMLElement;
  readonly live: boolean;
  wake(): void;
  sleep(): void;
}

const most_live = 8;

/** From the middle of the window, pixels. */
function distance(view: PooledView): number {
  const box = view.element.getBoundingClientRect();
  return Math.abs((box.top + box.bottom) / 2 - innerHeight / 2);
}

class StagePool {
  private views: PooledView[] = [];
  private observer = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const view = this.views.find((each) => each.element === entry.target);
      if (view && entry.isIntersecting) this.wake(view);
    }
  }, { rootMargin: "300px 0px" });

  add(view: PooledView): void {
    this.views.push(view);
    this.observer.observe(view.element);
    const box = view.element.getBoundingClientRect();
    if (box.bottom > -300 && box.top < innerHeight + 300) this.wake(view);
  }

  wake(view: PooledView): void {
    if (view.live) return;
    const live = this.views.filter((each) => each.live);
    if (live.length >= most_live) live.reduce((far, each) => (distance(each) > distance(far) ? each : far)).sleep();
    view.wake();
  }
}

let pool: StagePool | null = null;

export function stage_pool(): StagePool {
  return (pool ??= new StagePool());
}
