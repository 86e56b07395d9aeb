"""Pages for tests: a built player without Node, and the parts of a page."""

import base64
import hashlib
import html.parser
import json
import os
import pathlib
import re
import shutil
import unittest.mock
import zlib

import program

TEMPLATE = pathlib.Path(__file__).resolve().parent.parent.parent / "web/src/page.html"
LOADER, PLAYER = "document.title;", "document.body;"


def sha256(text):
    return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"


def deflated(data):
    squeeze = zlib.compressobj(9, zlib.DEFLATED, -15)
    return squeeze.compress(data) + squeeze.flush()


def make_web_folder(folder):
    """A web folder with the template of the source tree and a player that does nothing. Returns its path."""
    values = {"hashes": f"{sha256(LOADER)} {sha256(PLAYER)}", "icon": "data:,", "style": "p { margin: 0 }", "loader": LOADER, "contents": "",
              "player": base64.b64encode(deflated(PLAYER.encode())).decode()}
    folder.mkdir()
    text = re.sub(r"\[\[(\w+)\]\]", lambda m: values[m[1]], TEMPLATE.read_text(encoding="utf-8"))
    (folder / "page.html").write_text(text, encoding="utf-8")
    return folder


class PageTestCase(program.ProgramTest):
    """With a built player, self.web, in the environment."""

    def setUp(self):
        super().setUp()
        self.web = make_web_folder(self.folder.parent / (self.folder.name + "-web"))
        self.addCleanup(shutil.rmtree, self.web)
        environment = unittest.mock.patch.dict(os.environ, {"TUMBLE_WEB": str(self.web)})
        environment.start()
        self.addCleanup(environment.stop)


class Page(html.parser.HTMLParser):
    """The elements of a page: (tag, attributes, text directly in it), in order."""

    EMPTY = {"meta", "link", "img", "br", "source", "hr", "input"}

    def __init__(self, path):
        super().__init__()
        self.text = pathlib.Path(path).read_text(encoding="utf-8")
        self.elements, self.open = [], []
        self.feed(self.text)
        self.close()
        assert not self.open, f"{path}: not closed: {self.open}"

    def handle_starttag(self, tag, attributes):
        element = [tag, dict(attributes), ""]
        self.elements.append(element)
        if tag not in self.EMPTY:
            self.open.append(element)

    def handle_endtag(self, tag):
        element = self.open.pop()
        assert element[0] == tag, f"</{tag}> ends <{element[0]}>"

    def handle_data(self, data):
        for element in self.open:
            element[2] += data

    def all(self, tag, **attributes):
        wanted = {name.rstrip("_").replace("_", "-"): value for name, value in attributes.items()}
        return [e for e in self.elements if e[0] == tag and all(e[1].get(n) == v for n, v in wanted.items())]

    def one(self, tag, **attributes):
        found = self.all(tag, **attributes)
        assert len(found) == 1, f"{len(found)} elements {tag} {attributes}"
        return found[0]

    def policy(self):
        content = self.one("meta", http_equiv="Content-Security-Policy")[1]["content"]
        return {part.split()[0]: part.split()[1:] for part in content.split(";")}

    def clip(self, identifier="clip-1"):
        """The header of a clip's data, and its binary part."""
        data = zlib.decompress(base64.b64decode(self.one("script", id=identifier)[2], validate=True), -15)
        size = int.from_bytes(data[:4], "little")
        return json.loads(data[4:4 + size]), data[4 + size:]

    def options(self):
        return json.loads(self.one("figure", class_="tumble-player")[1]["data-options"])

    def addresses(self):
        """Everything that a browser would load or follow."""
        names = ("src", "href", "poster", "srcset", "action", "data", "background")
        listed = [(e[0], n, v) for e in self.elements for n, v in e[1].items() if n in names]
        return listed + [("style", "url", a) for e in self.all("style") for a in re.findall(r"url\(([^)]*)\)|@import", e[2])]


def bytes_of(address):
    """The media type and the bytes of a data address."""
    kind, data = re.fullmatch(r"data:([^;,]+);base64,(.*)", address).groups()
    return kind, base64.b64decode(data, validate=True)


def plain(text):
    """HTML without tags and character references."""
    return html.unescape(re.sub(r"<[^>]*>", "", text))
