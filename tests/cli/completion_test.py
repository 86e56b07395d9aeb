"""Completions of shells: driven as the shells do it, without a screen. Shells that are not installed are skipped."""

import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import time
import unittest

import program

# Runs a completion as bash would after TAB: the words of the line, divided at COMP_WORDBREAKS, are the arguments.
BASH_DRIVER = r"""
source tumble.bash
COMP_WORDBREAKS=$' \t\n"'"'><=;|&(:"
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
function=$(complete -p tumble) function=${function#*-F } function=${function%% *}
"$function" tumble "${COMP_WORDS[-1]}" "${COMP_WORDS[-2]}"
printf '%s\n' "${COMPREPLY[@]}"
"""

# A zsh with completion whose compadd prints the offers as well. It ends after the first completion.
ZSH_START = r"""
PROMPT=
LISTMAX=10000   # does not ask whether to show a long list
unsetopt zle_bracketed_paste prompt_sp 2>/dev/null
autoload -U compinit && compinit -u -D
source ./tumble.zsh
bindkey '^I' complete-word
zstyle ':completion:*' insert-tab false
comppostfuncs=(exit)
compadd() {
    if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return; fi
    typeset -a __found
    builtin compadd -A __found "$@"
    (( $#__found )) && print -rl -- "offer=$IPREFIX"${^__found}
    builtin compadd "$@"
}
print -r -- REA''DY
"""

# Starts it in a terminal, and types a line and TAB.
ZSH_DRIVER = r"""
zmodload zsh/zpty
zpty z zsh -f -i
zpty -w z 'source ./start.zsh'
zpty -r -m z log '*READY*' || exit 2
zpty -w -n z "$1"$'\t'
while zpty -r z log; do print -rn -- "$log"; done
"""


def divided(line):
    """A line as COMP_WORDS: = and : are words of their own."""
    words = []
    for word in line.split(" "):
        pieces = re.findall(r"[=:]+|[^=:]+", word) or [""]
        words += pieces
    return words


def listed_commands(text):
    """The names in the list of subcommands of a help text."""
    listed = re.search(r"^Subcommands:\n((?:  .*\n)+)", text + "\n", re.M)
    return re.findall(r"^  ([a-z-]+) ", listed[1], re.M) if listed else []


class Completion(program.ProgramTest):
    def setUp(self):
        super().setUp()
        for name in (".hidden.toml", "clip.mp4", "other.gif", "frame.png", "model.glb", "note.txt", "table.csv"):
            self.write(name, "")
        (self.folder / "out").mkdir()

    def offers(self, line):
        raise NotImplementedError

    def check_offers(self):
        """Commands, options and choices."""
        everything = ["render", "simulate", "plot", "export", "page", "lesson", "encode", "compare", "info", "doctor", "completion"]
        self.assertLessEqual(set(everything), self.offers("tumble "))
        self.assertEqual(self.offers("tumble simu"), {"simulate"})
        self.assertEqual(self.offers("tumble render --quality "), {"draft", "normal", "best"})
        self.assertEqual(self.offers("tumble render scene.toml --quality dr"), {"draft"})
        self.assertEqual(self.offers("tumble simulate --integrator sp"), {"splitting"})
        self.assertEqual(self.offers("tumble completion "), {"bash", "zsh", "fish"})
        self.assertLessEqual({"--frames", "--quality"}, self.offers("tumble render --"))
        self.assertEqual(self.offers("tumble render --transp"), {"--transparent"})
        self.assertEqual(self.offers("tumble render --fps "), set())

    def check_nested_commands(self):
        """Each command with commands of its own offers these, and their options."""
        for name in listed_commands(self.check(0, "--help").stdout):
            text = self.check(0, name, "--help").stdout
            if parts := listed_commands(text):
                self.assertEqual(self.offers(f"tumble {name} "), set(parts))
                for part in parts:
                    options = re.findall(r"^  (?:-\w,)?(--[a-z-]+)", self.check(0, name, part, "--help").stdout, re.M)
                    self.assertLessEqual(set(options), self.offers(f"tumble {name} {part} --"))

    def check_files(self):
        self.assertEqual(self.offers("tumble render "), {"scene.toml", "out"})
        self.assertEqual(self.offers("tumble render scene.toml "), {"scene.toml", "out"})   # several may be given
        self.assertEqual(self.offers("tumble render -o "), {"clip.mp4", "other.gif", "out"})
        self.assertEqual(self.offers("tumble export scene.toml -o "), {"model.glb", "out"})
        self.assertEqual(self.offers("tumble encode "), {"out"})
        self.assertEqual(self.offers("tumble simulate --trajectory ta"), {"table.csv"})


class Bash(Completion):
    def setUp(self):
        super().setUp()
        if shutil.which("bash") is None:
            self.skipTest("bash is not installed")
        self.write("tumble.bash", self.check(0, "completion", "bash").stdout)
        self.write("driver.bash", BASH_DRIVER)

    def replies(self, line):
        run = subprocess.run(["bash", "--norc", "driver.bash", *divided(line)], cwd=self.folder, capture_output=True, text=True,
                             timeout=60)
        self.assertEqual((run.returncode, run.stderr), (0, ""), line)
        return set(run.stdout.splitlines()) - {""}

    offers = replies

    def test_offers(self):
        self.check_offers()

    def test_nested_commands(self):
        self.check_nested_commands()

    def test_files(self):
        self.check_files()

    def test_values_after_an_equals_sign(self):
        self.assertEqual(self.offers("tumble render --gl=o"), {"osmesa"})
        self.assertEqual(self.offers("tumble render --gl="), {"software", "osmesa", "egl"})
        self.assertEqual(self.offers("tumble render --output=cl"), {"clip.mp4"})
        self.assertEqual(self.offers("tumble render --gl=egl --quality=b"), {"best"})
        self.assertEqual(self.offers("tumble render --set simulation.sleep=false --quality b"), {"best"})
        self.assertEqual(self.offers("tumble render --set simulation.sleep=f"), set())

    def test_lists(self):
        self.assertLessEqual({"contacts", "clock", "none"}, self.offers("tumble render --overlay "))
        self.assertEqual(self.offers("tumble render --aov depth,se"), {"depth,segmentation"})
        self.assertEqual(self.offers("tumble render --aov depth,"),
                         {"depth,normal", "depth,segmentation", "depth,motion", "depth,albedo"})
        self.assertEqual(self.offers("tumble render --aov=depth,se"), {"depth,segmentation"})

    def test_words_and_files_of_one_option(self):
        self.assertEqual(self.offers("tumble simulate scene.toml --impacts "), {"stepped", "exact", "table.csv", "out"})

    def test_values_are_no_arguments(self):
        self.assertEqual(self.offers("tumble encode --fps 30 "), {"out"})
        self.assertEqual(self.offers("tumble encode --fps 30 out "), set())   # it takes one folder
        self.assertEqual(self.offers("tumble render -- --q"), set())

    def test_strange_file_names(self):
        for name in ("a b.toml", "a'b.toml", "a:b.toml", "a$HOME.toml"):
            self.write(name, "")
        self.assertEqual(self.offers("tumble info a"), {"a b.toml", "a'b.toml", "a:b.toml", "a$HOME.toml"})
        self.assertEqual(self.offers("tumble info a:"), {"b.toml"})   # Readline keeps the part before the colon

    def test_choices_are_those_of_the_program(self):
        """Each offered word is in the message about a wrong one."""
        checked = 0
        for command in ("render", "simulate", "page", "export", "encode"):
            text = self.check(0, command, "--help").stdout
            for option, choices in re.findall(r"^  (?:-\w,)?(--[a-z-]+) ([a-z0-9-]+(?:\|[a-z0-9-]+)+)", text, re.M):
                with self.subTest(command=command, option=option):
                    self.assertLessEqual(set(choices.split("|")), self.offers(f"tumble {command} {option} "))
                    inputs = {"encode": ["out", "-o", "x.mp4"], "export": ["scene.toml", "-o", "x.glb"]}
                    run = self.check(2, command, *inputs.get(command, ["scene.toml"]), option, "nonsense")
                    if " requires " in run.stderr:   # of another option
                        continue
                    for word in choices.split("|"):
                        self.assertIn(word, run.stderr)
                    checked += 1
        self.assertGreater(checked, 8)

    def test_an_interactive_shell(self):
        """A line is typed, completed with TAB, and run."""
        script = f"PS1='' PS2=''; bind 'set bell-style none'; tumble() {{ printf '<%s>' \"$@\"; echo; }}; source tumble.bash\n"
        for typed, expected in (("tumble rend\t--qual\tdr\tscene.t\t", "<render><--quality><draft><scene.toml>"),
                                ("tumble render --gl=os\t-o cl\t", "<render><--gl=osmesa><-o><clip.mp4>"),
                                ("tumble render --aov depth,mot\t", "<render><--aov><depth,motion>")):
            self.assertIn(expected, self.typed(script, typed + "\n"), typed)

    def typed(self, script, line):
        child, terminal = pty.fork()
        if child == 0:
            os.chdir(self.folder)
            os.execvpe("bash", ["bash", "--norc", "--noprofile", "-i"], {"PATH": os.environ["PATH"], "TERM": "dumb", "HOME": "/"})
        self.addCleanup(os.close, terminal)
        self.addCleanup(os.waitpid, child, 0)
        os.write(terminal, script.encode())
        os.write(terminal, b"echo READ''Y\n")
        self.read_until(terminal, "READY\r\n")
        os.write(terminal, line.encode())
        os.write(terminal, b"echo DO''NE; exit\n")
        return self.read_until(terminal, "DONE\r\n")

    def read_until(self, terminal, end):
        text, deadline = "", time.monotonic() + 60
        while end not in text and time.monotonic() < deadline:
            if select.select([terminal], [], [], 1)[0]:
                text += os.read(terminal, 4096).decode(errors="replace")
        self.assertIn(end, text)
        return text


class Fish(Completion):
    def setUp(self):
        super().setUp()
        if shutil.which("fish") is None:
            self.skipTest("fish is not installed")
        self.write("tumble.fish", self.check(0, "completion", "fish").stdout)

    def offers(self, line):
        run = subprocess.run(["fish", "--no-config", "-c", "source tumble.fish; complete -C $argv[1]", line], cwd=self.folder,
                             capture_output=True, text=True, timeout=60, env={**os.environ, "HOME": str(self.folder)})
        self.assertEqual((run.returncode, run.stderr), (0, ""), line)
        return {offer.split("\t")[0].rstrip("/") for offer in run.stdout.splitlines()} - {""}

    def test_offers(self):
        self.check_offers()

    def test_nested_commands(self):
        self.check_nested_commands()

    def test_files(self):
        self.check_files()
        self.assertEqual(self.offers("tumble render --output=cl"), {"--output=clip.mp4"})

    def test_lists(self):
        self.assertIn("depth,motion", self.offers("tumble render --aov depth,mo"))


class Zsh(Completion):
    def setUp(self):
        super().setUp()
        if shutil.which("zsh") is None:
            self.skipTest("zsh is not installed")
        self.write("tumble.zsh", self.check(0, "completion", "zsh").stdout)
        self.write("start.zsh", ZSH_START)
        self.write("driver.zsh", ZSH_DRIVER)

    def offers(self, line):
        run = subprocess.run(["zsh", "-f", "driver.zsh", line], cwd=self.folder, capture_output=True, text=True, timeout=60,
                             env={**os.environ, "HOME": str(self.folder), "TERM": "dumb"})
        self.assertEqual((run.returncode, run.stderr), (0, ""), line)
        return set(re.findall(r"offer=([^\r\n]*)", run.stdout))

    def test_values_after_an_equals_sign(self):
        self.assertEqual(self.offers("tumble render --gl=e"), {"--gl=egl"})

    def test_syntax(self):
        run = subprocess.run(["zsh", "-f", "-n", "tumble.zsh"], cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual((run.returncode, run.stderr), (0, ""))

    def test_offers(self):
        self.check_offers()

    def test_nested_commands(self):
        self.check_nested_commands()

    def test_files(self):
        self.check_files()

    def test_lists(self):
        self.assertIn("depth,motion", self.offers("tumble render --aov depth,mo"))
        self.assertNotIn("depth,depth", self.offers("tumble render --aov depth,"))


if __name__ == "__main__":
    program.main()
