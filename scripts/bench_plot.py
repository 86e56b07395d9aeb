"""Work-precision plots of the pages of docs/results: error against CPU time. For scripts/plot-accuracy and plot-joints."""

import math

import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

from bench_page import COLORS, save

MARKERS, LINES = "osD^", ["-", "--", ":", "-."]   # of the variants of reference engines, in their order


def variant_styles(variants, ours):
    """Marker, line and marker size of each (program, variant), the same in all plots; `ours`: those of Tumble's variants."""
    order, styles = {}, {}
    for program, variant in variants:
        known = order.setdefault(program, [])
        if variant not in known:
            known.append(variant)
    for program, known in order.items():
        for i, variant in enumerate(known):
            style = (MARKERS[i % len(MARKERS)], LINES[i % len(LINES)], 5)
            styles[program, variant] = ours.get(variant, style) if program == "Tumble" else style
    return styles


def step_name(rate):
    return f"1/{rate:.0f}"


PLACES = [(7, 0, "left", "center"), (0, 7, "center", "bottom"), (-7, 0, "right", "center"), (0, -7, "center", "top"),
          (5, 5, "left", "bottom"), (-5, 5, "right", "bottom"), (5, -5, "left", "top"), (-5, -5, "right", "top")]


class Labels:
    """Puts labels beside points, each at the first of eight places where it covers no point, no label and no curve."""

    def __init__(self, figure, axes, curves):
        self.axes, self.renderer = axes, figure.canvas.get_renderer()
        radius = 4.5 * figure.dpi / 72
        self.taken, self.lines = [], []   # boxes, and points every few pixels along the curves
        for curve in curves:
            pixels = [tuple(axes.transData.transform(p)) for p in curve]
            self.taken += [(x - radius, y - radius, x + radius, y + radius) for x, y in pixels]
            for (x0, y0), (x1, y1) in zip(pixels, pixels[1:]):
                n = max(1, int(math.hypot(x1 - x0, y1 - y0) / 3))
                self.lines += [(x0 + (x1 - x0) * k / n, y0 + (y1 - y0) * k / n) for k in range(n + 1)]
        box = axes.get_window_extent(self.renderer)
        self.inside = (box.x0, box.y0, box.x1, box.y1)

    def free(self, box, over_lines):
        i = self.inside
        if box[0] < i[0] or box[1] < i[1] or box[2] > i[2] or box[3] > i[3]:
            return False
        if any(box[0] < t[2] and t[0] < box[2] and box[1] < t[3] and t[1] < box[3] for t in self.taken):
            return False
        return over_lines or not any(box[0] < x < box[2] and box[1] < y < box[3] for x, y in self.lines)

    def put(self, x, y, text, color, needed):
        """A required label may cover a curve if there is no other place."""
        for over_lines in (False, True) if needed else (False,):
            for dx, dy, ha, va in PLACES:
                label = self.axes.annotate(text, (x, y), (dx, dy), textcoords="offset points", ha=ha, va=va, fontsize=7.5,
                                           color=color, zorder=5,
                                           bbox=dict(facecolor="white", edgecolor="none", alpha=0.75, pad=0.4))
                e = label.get_window_extent(self.renderer)   # of the text; its white ground is a little larger
                box = (e.x0 - 1, e.y0 - 1, e.x1 + 1, e.y1 + 1)
                if self.free(box, over_lines):
                    self.taken.append(box)
                    return
                label.remove()


def limits(values):
    """Room around the values, and at least a decade."""
    low, high = math.log10(min(values)), math.log10(max(values))
    room = max(0.25, 0.06 * (high - low), 0.5 * (1.0 - (high - low)))
    return 10.0 ** (low - room), 10.0 ** (high + room)


def work_precision(curves, styles, title, axis, path):
    """Error over CPU time. curves: (program, variant) -> rows with rate, error and cpu, by falling step. False: no rows."""
    found = {k: [r for r in v if math.isfinite(r["error"]) and r["cpu"] > 0.0] for k, v in curves.items()}
    found = {k: v for k, v in found.items() if v}
    if not found:
        return False
    figure, axes = plt.subplots(figsize=(9.2, 5.2), dpi=110)
    figure.subplots_adjust(left=0.095, right=0.715, top=0.91, bottom=0.115)
    everything = [r for v in found.values() for r in v]
    # An error of zero has no place on a logarithmic axis: it is drawn a decade below the smallest error.
    floor = 0.1 * min((r["error"] for r in everything if r["error"] > 0.0), default=1e-16)
    shown = lambda r: r["error"] or floor
    handles, program_before = [], None
    for (program, variant), points in found.items():
        marker, line, size = styles[program, variant]
        look = dict(color=COLORS.get(program, "black"), linestyle=line, marker=marker, markersize=size,
                    linewidth=2.0 if program == "Tumble" else 1.3, markeredgecolor="white", markeredgewidth=0.6)
        axes.plot([r["cpu"] for r in points], [shown(r) for r in points], zorder=3 if program == "Tumble" else 2,
                  **look)
        if program != program_before:
            handles.append(Line2D([], [], linestyle="none", label=program))
            program_before = program
        handles.append(Line2D([], [], label=variant, **look))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(*limits([r["cpu"] for r in everything]))
    axes.set_ylim(*limits([shown(r) for r in everything]))
    axes.set_title(title, fontsize=12, loc="left", fontweight="bold")
    axes.set_xlabel("CPU seconds per simulated second")
    axes.set_ylabel(axis)
    axes.grid(True, which="major", color="#dddddd", linewidth=0.8)
    axes.tick_params(which="minor", length=0)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    legend = figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.725, 0.92), frameon=False, fontsize=9,
                           handlelength=3.2, labelspacing=0.45)
    for text in legend.get_texts():
        if text.get_text() in COLORS:
            text.set_fontweight("bold")
            text.set_color(COLORS[text.get_text()])
            text.set_x(-38)   # program names stand over the line samples
    figure.text(0.73, 0.03, "left and down is better\nlabels: step in s" +
                ("\nlowest row: no error at all" if any(r["error"] == 0.0 for r in everything) else ""),
                fontsize=8, color="#555555", va="bottom")
    figure.canvas.draw()
    labels = Labels(figure, axes, [[(r["cpu"], shown(r)) for r in points] for points in found.values()])
    # The ends of the curves first, Tumble's before the others; then labels for which there is space.
    ranked = []
    for order, ((program, _), points) in enumerate(found.items()):
        for i, r in enumerate(points):
            end = i in (0, len(points) - 1)
            ranked.append((not end, program != "Tumble", order, i, r, program))
    for inner, _, _, _, r, program in sorted(ranked, key=lambda x: x[:4]):
        labels.put(r["cpu"], shown(r), step_name(r["rate"]), COLORS.get(program, "black"), not inner)
    save(figure, path)
    plt.close(figure)
    return True
