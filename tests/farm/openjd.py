"""Job templates of Open Job Description (2023-09): a check against the specification, and an engine that runs them here.

The schema covers the form; faults() adds the rules that a schema cannot say. run() does what a farm does: it resolves the
format strings, divides chunked parameters, and runs the command of each task, several at a time.
"""

import concurrent.futures
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

SCHEMA = pathlib.Path(__file__).resolve().parent / "openjd-2023-09.schema.json"
EXPRESSION = re.compile(r"\{\{\s*([A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*)\s*\}\}")
SCHEMA_CHECK = """import json, sys, jsonschema
schema, templates = json.load(sys.stdin)
validator = jsonschema.Draft202012Validator(schema)
json.dump([["/".join(map(str, error.absolute_path)) + ": " + error.message[:300] for error in validator.iter_errors(template)]
           for template in templates], sys.stdout)
"""


# --- the check

def schema_faults(templates):
    """The violations of the schema, a list for each template; None if no Python here has the package jsonschema (Debian:
    python3-jsonschema)."""
    text = json.dumps([json.loads(SCHEMA.read_text()), templates])
    for python in (sys.executable, "/usr/bin/python3"):
        run = subprocess.run([python, "-c", SCHEMA_CHECK], input=text, capture_output=True, text=True, timeout=120)
        if run.returncode == 0:
            return json.loads(run.stdout)
        if "No module named 'jsonschema'" not in run.stderr:
            raise RuntimeError(run.stderr)
    return None


def faults(template):
    """The violations of the rules that the schema cannot say. Precondition: the schema holds."""
    found = []
    parameters = template.get("parameterDefinitions", [])
    found += repeated("parameter", parameters)
    found += repeated("step", template["steps"])
    for parameter in parameters:
        found += value_faults(parameter, parameter.get("default"), "default")
    submission = {f"{kind}.{p['name']}" for p in parameters for kind in ("Param", "RawParam")
                  if kind == "RawParam" or p["type"] != "PATH"}
    on_host = {f"{kind}.{p['name']}" for p in parameters for kind in ("Param", "RawParam")} | \
              {f"Session.{name}" for name in ("WorkingDirectory", "HasPathMappingRules", "PathMappingRulesFile")}
    found += unknown_names("name", template["name"], submission)
    defaults = {f"{kind}.{p['name']}": str(p["default"]) for p in parameters if "default" in p for kind in ("Param", "RawParam")}
    if set(EXPRESSION.findall(template["name"])) <= set(defaults) and len(resolved(template["name"], defaults)) > 128:
        found.append("name: longer than 128 characters")
    steps = {step["name"]: step for step in template["steps"]}
    for step in template["steps"]:
        where = f"step {step['name']}"
        for dependency in step.get("dependencies", []):
            if dependency["dependsOn"] not in steps:
                found.append(f"{where}: depends on the unknown step {dependency['dependsOn']}")
        found += space_faults(where, step.get("parameterSpace"), template, submission, defaults)
        names = set(on_host)
        for task in step.get("parameterSpace", {}).get("taskParameterDefinitions", []):
            names |= {f"Task.Param.{task['name']}", f"Task.RawParam.{task['name']}"}
        files = step["script"].get("embeddedFiles", [])
        found += repeated(f"{where}: embedded file", files)
        names |= {f"Task.File.{file['name']}" for file in files}
        action = step["script"]["actions"]["onRun"]
        for text in [action["command"], *action.get("args", []), *(file["data"] for file in files)]:
            found += unknown_names(where, text, names)
    if not found and in_order(template) is None:
        found.append("the dependencies of the steps form a cycle")
    return found


def repeated(what, items):
    names = [item["name"] for item in items]
    return [f"{what} {name} is there twice" for name in sorted(set(names)) if names.count(name) > 1]


def unknown_names(where, text, names):
    rest = EXPRESSION.sub("", text)
    found = [f"{where}: braces that are no format string in {text!r}"] if "{{" in rest or "}}" in rest else []
    return found + [f"{where}: unknown name {name}" for name in EXPRESSION.findall(text) if name not in names]


def value_faults(parameter, value, what):
    if value is None:
        return []
    where, kind, found = f"parameter {parameter['name']}: {what}", parameter["type"], []
    if kind in ("STRING", "PATH"):
        if not parameter.get("minLength", 0) <= len(value) <= parameter.get("maxLength", 1024):
            found.append(f"{where}: wrong length")
        if kind == "PATH" and what == "default" and (value.startswith("/") or ".." in pathlib.PurePosixPath(value).parts):
            found.append(f"{where}: submitters take only paths inside the template's folder")
    else:
        number = float(value)
        if number < float(parameter.get("minValue", number)) or number > float(parameter.get("maxValue", number)):
            found.append(f"{where}: out of range")
    if value not in parameter.get("allowedValues", [value]):
        found.append(f"{where}: is not among the allowed values")
    return found


def space_faults(where, space, template, names, defaults):
    if space is None:
        return []
    tasks = space["taskParameterDefinitions"]
    found = repeated(f"{where}: task parameter", tasks)
    chunked = [task for task in tasks if task["type"] == "CHUNK[INT]"]
    if chunked and "TASK_CHUNKING" not in template.get("extensions", []):
        found.append(f"{where}: CHUNK[INT] without the extension TASK_CHUNKING")
    if len(chunked) > 1:
        found.append(f"{where}: more than one CHUNK[INT]")
    groups = re.findall(r"\(([^()]*)\)", space.get("combination", ""))
    if any(task["name"] in re.findall(r"\w+", group) for task in chunked for group in groups):
        found.append(f"{where}: CHUNK[INT] inside an associative combination")
    if "combination" in space and sorted(re.findall(r"\w+", space["combination"])) != sorted(task["name"] for task in tasks):
        found.append(f"{where}: the combination must name each task parameter once")
    for task in tasks:
        texts = task["range"] if isinstance(task["range"], list) else [task["range"]]
        chunks = task.get("chunks", {})
        texts = [text for text in [*texts, chunks.get("defaultTaskCount"), chunks.get("targetRuntimeSeconds")] if isinstance(text, str)]
        for text in texts:
            found += unknown_names(where, text, names)
        if isinstance(task["range"], str) and set(EXPRESSION.findall(task["range"])) <= set(defaults):
            try:
                integers(resolved(task["range"], defaults))
            except ValueError as error:
                found.append(f"{where}: {error}")
    return found


def in_order(template):
    """The steps, each after those that it depends on; None if they depend on one another in a cycle."""
    left, done = list(template["steps"]), []
    while left:
        ready = [step for step in left if all(d["dependsOn"] in [s["name"] for s in done] for d in step.get("dependencies", []))]
        if not ready:
            return None
        done += ready
        left = [step for step in left if step not in ready]
    return done


# --- ranges of integers

def integers(text):
    """The ascending values of an integer range expression, as in "1,3,7-10:2"."""
    values = []
    for element in text.split(","):
        match = re.fullmatch(r"\s*(-?\d+)(?:\s*-\s*(-?\d+)(?:\s*:\s*(-?\d+))?)?\s*", element)
        if not match or match[3] == "0":
            raise ValueError(f"{text!r} is no range of integers")
        first, last, step = int(match[1]), int(match[2] or match[1]), int(match[3] or 1)
        values += range(first, last + (1 if step > 0 else -1), step)
    if len(set(values)) != len(values):
        raise ValueError(f"ranges in {text!r} overlap")
    return sorted(values)


def expression(values):
    """A range expression of ascending values, as engines write it: runs of one step are joined."""
    parts, i = [], 0
    while i < len(values):
        step = values[i + 1] - values[i] if i + 1 < len(values) else 1
        end = i + 1
        while end < len(values) and values[end] - values[end - 1] == step:
            end += 1
        if end - i == 2:
            end = i + 1   # two values are no run
        parts.append(str(values[i]) if end == i + 1 else f"{values[i]}-{values[end - 1]}" + (f":{step}" if step > 1 else ""))
        i = end
    return ",".join(parts)


def chunks(values, size, constraint):
    """Chunks of at most that size. CONTIGUOUS: successive values, evened out, always as a-b. NONCONTIGUOUS: any."""
    if constraint == "NONCONTIGUOUS":
        count = -(-len(values) // size)
        dealt = [values[i::count] for i in range(count)]
        if count > 1 and len(dealt[0]) > 2 and len(dealt[1]) > 0:   # no regular step either
            dealt[0][1], dealt[1][0] = dealt[1][0], dealt[0][1]
        return [expression(sorted(chunk)) for chunk in dealt]
    texts, i = [], 0
    while i < len(values):
        end = i + 1
        while end < len(values) and values[end] == values[end - 1] + 1:
            end += 1
        run, count = values[i:end], -(-(end - i) // size)
        cuts = [len(run) * n // count for n in range(count + 1)]
        texts += [f"{run[a]}-{run[b - 1]}" for a, b in zip(cuts, cuts[1:])]
        i = end
    return texts


# --- the engine

def resolved(text, symbols):
    return EXPRESSION.sub(lambda match: symbols[match[1]], str(text))


def symbols_of(template, folder, values):
    symbols = {}
    for parameter in template.get("parameterDefinitions", []):
        name = parameter["name"]
        if name in values:
            value = str(values[name])
        elif "default" in parameter:
            value = str(parameter["default"])
            if parameter["type"] == "PATH":
                value = str(pathlib.Path(folder) / value)
        else:
            raise ValueError(f"parameter {name} has no value")
        symbols["Param." + name] = symbols["RawParam." + name] = value
    unknown = set(values) - {p["name"] for p in template.get("parameterDefinitions", [])}
    if unknown:
        raise ValueError(f"unknown parameters: {unknown}")
    return symbols


def tasks_of(step, symbols):
    """The values of the task parameters of each task, by name in format strings."""
    tasks = [{}]
    for parameter in step.get("parameterSpace", {}).get("taskParameterDefinitions", []):
        listed = parameter["range"]
        if parameter["type"] == "CHUNK[INT]":
            size = int(resolved(parameter["chunks"]["defaultTaskCount"], symbols))
            values = chunks(integers(resolved(listed, symbols)), size, parameter["chunks"]["rangeConstraint"])
        elif parameter["type"] == "INT" and isinstance(listed, str):
            values = [str(value) for value in integers(resolved(listed, symbols))]
        else:
            values = [resolved(value, symbols) for value in listed]
        tasks = [{**task, "Task.Param." + parameter["name"]: value, "Task.RawParam." + parameter["name"]: value}
                 for task in tasks for value in values]
    return tasks


def run(template, folder, values, workers=3, seed=1):
    """Runs the job, several tasks of a step at a time and in any order. Returns the commands of all tasks, by step. A task
    that fails is an exception."""
    symbols = symbols_of(template, folder, values)
    commands = {}

    def run_task(step, task):
        action = step["script"]["actions"]["onRun"]
        with tempfile.TemporaryDirectory(prefix="tumble-openjd-session-") as session:
            known = {**symbols, **task, "Session.WorkingDirectory": session}
            words = [resolved(text, known) for text in [action["command"], *action.get("args", [])]]
            done = subprocess.run(words, cwd=session, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                  timeout=action.get("timeout", 300), env=dict(os.environ))
        if done.returncode != 0:
            raise RuntimeError(f"step {step['name']}: {words}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
        return words

    for step in in_order(template):
        tasks = tasks_of(step, symbols)
        random.Random(seed).shuffle(tasks)
        with concurrent.futures.ThreadPoolExecutor(workers) as pool:
            commands[step["name"]] = list(pool.map(lambda task, step=step: run_task(step, task), tasks))
    return commands
