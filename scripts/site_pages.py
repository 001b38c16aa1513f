#!/usr/bin/env python3
"""Collects the pages of the documentation site for mkdocs; scripts/site runs it.

    site_pages.py PAGES CONFIG     PAGES: the folder that gets all pages and pictures; CONFIG: gets mkdocs.yml with a complete nav

Pages are README.md (the index), the other documents below, and docs/. Other files and folders that they link to (scenes, shaders)
become pages that show the text, so that every link works without the checkout. A link that leads nowhere ends with status 1."""
import os
import pathlib
import posixpath
import re
import shutil
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCUMENTS = {"README.md": "index.md", "CONTRIBUTING.md": "contributing.md", "SECURITY.md": "security.md",
             "CHANGES.md": "changes.md", "bench/RESULTS.md": "measurements.md", "LICENSE": "license.md"}
SHOWN = {".sl": "c", ".h": "c", ".cpp": "cpp", ".py": "python", ".rib": "text"}  # files of folders, with their lexers
LEXERS = {"rsl": "c", "sl": "c", "rib": "text"}                                 # languages of fences that Pygments does not know
LINK = re.compile(r"(\]\()([^)\s]+)(\))")  # without its text, which may hold code
FENCE = re.compile(r"^```.*?^```[^\n]*$", flags=re.S | re.M)
SPAN = re.compile(r"(?<!`)(`+)(?!`).*?(?<!`)\1(?!`)", flags=re.S)


def replaced(text, code, outside, inside):
    """The text with both functions applied: to what the pattern `code` matches, and to what lies between."""
    done, end = "", 0
    for found in code.finditer(text):
        done += outside(text[end:found.start()]) + inside(found[0])
        end = found.end()
    return done + outside(text[end:])


class Site:
    def __init__(self, folder):
        self.folder = folder
        self.places = dict(DOCUMENTS)  # source: page, both from their roots
        self.waiting = []              # sources that are linked to and not written yet
        self.dead = []
        for path in sorted((ROOT / "docs").rglob("*")):
            if path.is_file():
                source = path.relative_to(ROOT).as_posix()
                self.places[source] = source.removeprefix("docs/")

    def write(self, page, text):
        path = self.folder / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def place_of(self, source):
        """The page of a file or folder of the checkout; makes one where there is none."""
        if source not in self.places:
            inside = ROOT / source
            self.places[source] = "source/" + source + ("/index.md" if inside.is_dir() else ".md")
            self.waiting.append(source)
        return self.places[source]

    def link(self, source, target):
        """The target of a link on the page of `source`, as the site has it."""
        if re.match(r"[a-z]+:", target) or target.startswith("#"):
            return target
        name, mark, anchor = target.partition("#")
        at = posixpath.normpath(posixpath.join(posixpath.dirname(source), name))
        if at.startswith("..") or not (ROOT / at).exists():
            self.dead.append(f"{source}: {target}")
            return target
        return posixpath.relpath(self.place_of(at), posixpath.dirname(self.places[source]) or ".") + mark + anchor

    def markdown(self, source, text):
        """A document with its links replaced, in mkdocs' Markdown: fences name a language alone, lists follow a blank line."""
        def prose(part):
            part = re.sub(r"^((?![-*] |\d+\. |\s|\||#|>).+)\n(?=[-*] |1\. )", r"\1\n\n", part, flags=re.M)
            return replaced(part, SPAN, lambda p: LINK.sub(lambda m: m[1] + self.link(source, m[2]) + m[3], p), str)
        def fence(code):
            return re.sub(r"^```(\w+)[^\n]*", lambda m: "```" + LEXERS.get(m[1], m[1]), code)
        return replaced(text, FENCE, prose, fence)

    def add_document(self, source):
        text = (ROOT / source).read_text(encoding="utf-8")
        page = self.markdown(source, text) if source.endswith(".md") else f"# Licence\n\n```text\n{text}```\n"
        self.write(self.places[source], page)

    def add_linked(self, source):
        """A page with the text of a file, or with links to the files of a folder."""
        path = ROOT / source
        if path.is_file():
            text = path.read_text(encoding="utf-8", errors="replace").rstrip("\n")
            self.write(self.places[source], f"# {source}\n\n```{SHOWN.get(path.suffix, 'text')}\n{text}\n```\n")
            return
        files = sorted(p for p in path.iterdir() if p.suffix in SHOWN)
        lines = [f"- [{p.name}]({posixpath.relpath(self.place_of(f'{source}/{p.name}'), posixpath.dirname(self.places[source]))})"
                 for p in files]
        self.write(self.places[source], f"# {source}\n\n" + "\n".join(lines) + "\n")

    def build(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        for source in list(self.places):
            if source in DOCUMENTS or source.endswith(".md"):
                self.add_document(source)
            else:
                target = self.folder / self.places[source]
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(ROOT / source, target)
        while self.waiting:
            self.add_linked(self.waiting.pop())


def pages_in(nav):
    """All pages that a nav names."""
    if isinstance(nav, str):
        return {nav}
    parts = nav.values() if isinstance(nav, dict) else nav
    return set().union(*map(pages_in, parts))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    folder, config = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    site = Site(folder)
    site.build()
    if site.dead:
        sys.exit("site_pages.py: these links lead nowhere:\n  " + "\n  ".join(site.dead))
    settings = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
    pages = {p for s, p in site.places.items() if p.endswith(".md") and not p.startswith("source/")}
    last = next(iter(settings["nav"][-1].values()))
    last += sorted(pages - pages_in(settings["nav"]))
    settings["docs_dir"] = str(folder)
    config.write_text(yaml.safe_dump(settings, sort_keys=False), encoding="utf-8")


main()
