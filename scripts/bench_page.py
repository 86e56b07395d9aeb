"""Shared parts of the pages of docs/results: rows, runs, colors, markers. For scripts/plot-* and bench-render."""

import csv
import datetime
import subprocess
from pathlib import Path

# Okabe and Ito's palette, distinct in all kinds of color vision. A program has the same color in every plot.
COLORS = {"Tumble": "#0072B2", "Bullet": "#E69F00", "ODE": "#009E73", "MuJoCo": "#CC79A7", "DART": "#6B6B6B"}


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


RUN_FIELDS = ["case", "program", "date", "commit", "processor", "engines", "command"]


def record_runs(results, rows, command):
    """Notes in runs.csv beside the results when, at which commit and where the rows of each case and program were measured."""
    path = results.parent / "runs.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    where = {"date": datetime.date.today().isoformat(), "commit": commit(), "processor": processor(),
             "engines": versions(), "command": command}
    fresh = {(r["case"], r["program"]): {"case": r["case"], "program": r["program"], **where} for r in rows}
    runs = {(r["case"], r["program"]): r for r in (read(path) if path.exists() else [])} | fresh
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=RUN_FIELDS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(runs.values())


def runs_table(results):
    """The provenance of a page: one line for all cases of one date, commit, processor and command."""
    path = results.parent / "runs.csv"
    runs = read(path) if path.exists() else []
    groups = {}
    for run in runs:
        groups.setdefault(tuple(run[f] for f in RUN_FIELDS[2:]), []).append((run["case"], run["program"]))
    programs = {case: {r["program"] for r in runs if r["case"] == case} for case in dict.fromkeys(r["case"] for r in runs)}
    lines = []
    for where, pairs in sorted(groups.items(), reverse=True):
        names = []
        for case in dict.fromkeys(c for c, _ in pairs):
            here = [p for c, p in pairs if c == case]
            names.append(case if len(here) == len(programs[case]) else f"{case} ({', '.join(here)})")
        date, hash_, cpu, engines, command = where
        lines.append([date, hash_, cpu, engines, f"`{command}`", "all cases" if len(groups) == 1 else "; ".join(names)])
    return ("Absolute times depend on the machine; ratios between programs of one run vary less.\n\n"
            + table(["date", "commit", "processor", "reference programs, from Debian", "command", "cases"], lines))


def merged(results, new, key, command):
    """The rows of both files; the rows of `new` replace those of `results` with the same key. Written back to `results`."""
    fresh = read(new)
    record_runs(results, fresh, command)
    replaced = {key(r) for r in fresh}
    kept = [r for r in read(results) if key(r) not in replaced] if results.exists() else []
    rows = kept + fresh
    with open(results, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return rows


def in_order(items, order):
    """Without repetition, in the given order; other items come last."""
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
    figure.savefig(path.with_suffix(".svg"), metadata={"Date": None})


def versions():
    names = {"libbullet-dev": "Bullet", "libode-dev": "ODE", "libmujoco-dev": "MuJoCo", "libdart-dev": "DART", "python3-vtk9": "VTK"}
    found = []
    for package, name in names.items():
        text = subprocess.run(["dpkg-query", "--show", "--showformat=${Version}", package], capture_output=True, text=True).stdout
        if text:
            found.append(f"{name} {text.split(':')[-1].split('+')[0].split('-')[0]}")
    return ", ".join(found)


def commit():
    git = lambda *words: subprocess.run(["git", *words], capture_output=True, text=True, cwd=Path(__file__).parent).stdout.strip()
    changed = git("status", "--porcelain", "--untracked-files=no", "--", "../src", "../bench")
    return git("rev-parse", "--short", "HEAD") + (" with local changes" if changed else "")


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip().replace("(R)", "")
    return "unknown processor"


def put_between_markers(document, text):
    begin, end = "<!-- measured: begin -->", "<!-- measured: end -->"
    old = document.read_text() if document.exists() else f"{begin}\n{end}\n"
    before, rest = old.split(begin, 1)
    document.write_text(f"{before}{begin}\n\n{text}\n\n{end}{rest.split(end, 1)[1]}")
