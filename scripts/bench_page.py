"""What the pages of the benchmarks share: rows, colours, places in a document. For scripts/plot-*."""

import csv
import subprocess
from pathlib import Path

# Okabe and Ito's palette, told apart by all kinds of colour sight. A program keeps its colour in every plot.
COLORS = {"Tumble": "#0072B2", "Bullet": "#E69F00", "ODE": "#009E73", "MuJoCo": "#CC79A7", "DART": "#6B6B6B"}


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def merged(results, new, key):
    """The rows of both files; where `new` has rows of a key, those of `results` go. Written back to `results`."""
    fresh = read(new)
    replaced = {key(r) for r in fresh}
    kept = [r for r in read(results) if key(r) not in replaced] if results.exists() else []
    rows = kept + fresh
    results.parent.mkdir(parents=True, exist_ok=True)
    with open(results, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return rows


def in_order(items, order):
    """Without repetition, in the order given; what is not named there comes last."""
    found = list(dict.fromkeys(items))
    return sorted(found, key=lambda i: order.index(i) if i in order else len(order))


def file_name(text):
    name = "".join(c if c.isalnum() else "-" for c in text.lower()).strip("-")
    while "--" in name:
        name = name.replace("--", "-")
    return name


def number(x):
    if x in (float("inf"), float("-inf")) or x != x:
        return "–"
    if x == 0.0:
        return "0"
    if 1e-3 <= abs(x) < 1e4:
        return f"{x:.3g}" if abs(x) < 1000 else f"{x:.0f}"
    mantissa, exponent = f"{x:.1e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def table(head, lines):
    return "\n".join(["| " + " | ".join(head) + " |", "|---" * len(head) + "|"] + ["| " + " | ".join(l) + " |" for l in lines])


def save(figure, path):
    figure.savefig(path.with_suffix(".png"))
    figure.savefig(path.with_suffix(".svg"), metadata={"Date": None})


def versions():
    names = {"libbullet-dev": "Bullet", "libode-dev": "ODE", "libmujoco-dev": "MuJoCo", "libdart-dev": "DART"}
    found = []
    for package, name in names.items():
        text = subprocess.run(["dpkg-query", "--show", "--showformat=${Version}", package], capture_output=True, text=True).stdout
        if text:
            found.append(f"{name} {text.split(':')[-1].split('+')[0].split('-')[0]}")
    return ", ".join(found)


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown processor"


def put_between_markers(document, text):
    begin, end = "<!-- measured: begin -->", "<!-- measured: end -->"
    old = document.read_text() if document.exists() else f"{begin}\n{end}\n"
    before, rest = old.split(begin, 1)
    document.write_text(f"{before}{begin}\n\n{text}\n\n{end}{rest.split(end, 1)[1]}")
