"""The documents: every relative link and anchor leads somewhere, every named file exists, every page is linked.

Run it alone with: python3 tests/cli/docs_links_test.py
"""

import pathlib
import re
import unittest
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
README_LINES = 80   # most that the README may have

FENCE = re.compile(r"^(`{3,}|~{3,}).*?^\1`*\s*$", re.M | re.S)
CODE = re.compile(r"(`+)(.+?)\1", re.S)
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^()\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*\s*$", re.M)
# A file or folder of the project in backticks. Words in capitals, stars and dots in a row stand for something else.
NAMED_FILE = re.compile(r"^(?:src|tests|scripts|bench|shaders|assets|docs|examples|include|cmake)/[a-z0-9_./+-]*$")


def documents():
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "bench").rglob("*.md"), ROOT / "course" / "README.md"]
    return {page.relative_to(ROOT).as_posix(): page.read_text(encoding="utf-8") for page in sorted(pages)}


def without_fences(text):
    return FENCE.sub("", text)


def anchors(text):
    """The anchors of the headings, by GitHub's rule: lower case, no punctuation, hyphens for spaces, numbers for repeats."""
    found, seen = set(), {}
    for heading in HEADING.findall(without_fences(text)):
        plain = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        found.add(f"{slug}-{count}" if count else slug)
    return found


def links(text):
    return LINK.findall(CODE.sub("", without_fences(text)))


def is_relative(link):
    return not re.match(r"[a-z][a-z0-9+.-]*:|//", link)


def resolve(page, link):
    """The file that a relative link leads to, as a path below the root, and the anchor in it."""
    target, _, anchor = urllib.parse.unquote(link).partition("#")
    path = (ROOT / page).parent / target if target else ROOT / page
    return path.resolve(), anchor


def broken_links(pages):
    broken = []
    for page, text in pages.items():
        for link in filter(is_relative, links(text)):
            path, anchor = resolve(page, link)
            if not path.is_relative_to(ROOT) or not path.exists():
                broken.append(f"{page}: there is no file '{link}'")
            elif anchor:
                name = path.relative_to(ROOT).as_posix()
                if anchor not in anchors(pages.get(name, "")):
                    broken.append(f"{page}: there is no heading '#{anchor}' in {name}")
    return broken


def missing_files(pages):
    missing = []
    for page, text in pages.items():
        for _, word in CODE.findall(without_fences(text)):
            if NAMED_FILE.match(word) and not (ROOT / word).exists() and not list(ROOT.glob(word + ".*")):
                missing.append(f"{page}: there is no file or folder '{word}'")
    return missing


def unreached_pages(pages):
    reached, waiting = set(), ["README.md"]
    while waiting:
        page = waiting.pop()
        if page in reached or page not in pages:
            continue
        reached.add(page)
        for link in filter(is_relative, links(pages[page])):
            path, _ = resolve(page, link)
            if path.is_relative_to(ROOT):
                waiting.append(path.relative_to(ROOT).as_posix())
    return sorted(set(pages) - reached)


class Documents(unittest.TestCase):
    maxDiff = None

    def test_links_and_anchors(self):
        pages = documents()
        self.assertGreater(sum(len(links(text)) for text in pages.values()), 50)
        self.assertEqual(broken_links(pages), [])

    def test_named_files_exist(self):
        self.assertEqual(missing_files(documents()), [])

    def test_every_page_is_linked(self):
        self.assertEqual(unreached_pages(documents()), [])

    def test_the_readme_is_short(self):
        self.assertLessEqual(len(documents()["README.md"].splitlines()), README_LINES)


class TheTestItself(unittest.TestCase):
    def test_broken_links_are_found(self):
        pages = {"README.md": "# A [b] `c`\n\n[x](missing.md) [y](#a-b-c) [z](#d) `[w](no.md)`\n\n```\n[v](no.md)\n```\n"}
        self.assertEqual(broken_links(pages), ["README.md: there is no file 'missing.md'",
                                               "README.md: there is no heading '#d' in README.md"])

    def test_missing_files_are_found(self):
        self.assertEqual(missing_files({"README.md": "`src/no_such_folder/x.h` `tests/cli` `scripts/NAME` `src/a b`"}),
                         ["README.md: there is no file or folder 'src/no_such_folder/x.h'"])

    def test_unlinked_pages_are_found(self):
        self.assertEqual(unreached_pages({"README.md": "[a](docs/a.md)", "docs/a.md": "[r](../README.md)", "docs/b.md": ""}),
                         ["docs/b.md"])

    def test_repeated_headings_are_numbered(self):
        self.assertEqual(anchors("# A\n## A\n### `[[body]]` and [l](x)\n"), {"a", "a-1", "body-and-l"})


if __name__ == "__main__":
    unittest.main(verbosity=2)
