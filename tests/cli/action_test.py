"""The GitHub Action (action.yml): its structure, and its shell steps run in order as a runner does. Needs python3-yaml."""

import os
import pathlib
import re
import subprocess
import sys

import golden_test
import program

try:
    import yaml
except ImportError:
    print("python3-yaml is missing")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
ACTION = yaml.safe_load((ROOT / "action.yml").read_text())


class Action(golden_test.Golden):
    def setUp(self):
        super().setUp()
        for name in ("bin", "temp"):
            (self.folder / name).mkdir()
        os.symlink(program.TUMBLE, self.folder / "bin/tumble")

    def filled(self, text, values):
        """The text with its expressions replaced."""
        return re.sub(r"\$\{\{ *([^}]*?) *\}\}", lambda match: values[match.group(1)], str(text))

    def run_steps(self, **inputs):
        """Runs the shell steps of the action; the values of all expressions, and the code of the last step."""
        values = {f"inputs.{name}": str(inputs.get(name, one.get("default", "")))
                  for name, one in ACTION["inputs"].items()}
        values |= {"github.action_path": str(ROOT), "runner.temp": str(self.folder / "temp")}
        code = 0
        for step in ACTION["runs"]["steps"]:
            if "run" not in step:
                continue
            self.assertEqual(step["shell"], "bash")
            output = self.folder / "output"
            output.write_text("")
            environment = {"PATH": f"{self.folder / 'bin'}:/usr/bin:/bin", "RUNNER_TEMP": values["runner.temp"],
                           "HOME": str(self.folder / "home"), "GITHUB_OUTPUT": str(output),
                           "GITHUB_STEP_SUMMARY": str(self.folder / "summary")}
            environment |= {name: self.filled(text, values) for name, text in step.get("env", {}).items()}
            run = subprocess.run(["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", self.filled(step["run"], values)],
                                 cwd=self.folder, env=environment, text=True, capture_output=True, timeout=300)
            code = run.returncode
            if step["name"] != "Verdict":
                self.assertEqual(code, 0, run.stderr)
            for line in output.read_text().splitlines():
                name, value = line.split("=", 1)
                values[f"steps.{step['id']}.outputs.{name}"] = value
        return values, code

    def test_missing_alike_and_different(self):
        values, code = self.run_steps(suite="golden.toml")
        self.assertEqual((values["steps.check.outputs.verdict"], code), ("3", 3))
        self.golden(0, "accept", "--all")
        values, code = self.run_steps(suite="golden.toml")
        self.assertEqual((values["steps.check.outputs.verdict"], code), ("0", 0))
        self.change("#808080", "#888888")
        values, code = self.run_steps(suite="golden.toml", cases="fall", platform="none")
        self.assertEqual((values["steps.check.outputs.verdict"], code), ("1", 1))
        uploaded = next(step for step in ACTION["runs"]["steps"] if step.get("uses", "").startswith("actions/upload-artifact"))
        report = pathlib.Path(self.filled(uploaded["with"]["path"], values))
        self.assertIn("color of floor", (report / "report.html").read_text())
        self.assertIn("color of floor", (self.folder / "summary").read_text())
        for name in ("result.json", "result.xml", "images/new_fall_000024.png"):
            self.assertTrue((report / name).exists(), name)

    def test_a_suite_with_a_mistake(self):
        self.write("golden.toml", "format = 2\n")
        self.assertEqual(self.run_steps(suite="golden.toml")[1], 2)

    def test_no_input_is_code(self):
        """Inputs reach the shell by the environment alone: in the text of a step they could be commands."""
        for step in ACTION["runs"]["steps"]:
            self.assertNotIn("${{", step.get("run", ""))

    def test_its_structure(self):
        self.assertEqual(ACTION["runs"]["using"], "composite")
        names = set(ACTION["inputs"])
        used = set(re.findall(r"inputs\.(\w+)", (ROOT / "action.yml").read_text()))
        self.assertEqual(used, names)
        for one in ACTION["inputs"].values():
            self.assertTrue(one["description"])

    def test_the_example_workflow(self):
        workflow = yaml.safe_load((ROOT / "examples/github/golden.yml").read_text())
        steps = workflow["jobs"]["golden"]["steps"]
        given = next(step for step in steps if "tumble" in step["uses"])["with"]
        self.assertLessEqual(set(given), set(ACTION["inputs"]))
        self.assertIn("suite", given)


if __name__ == "__main__":
    program.main()
