"""Runs clang-tidy-19 on sources, with the flags of a configured build. Files that the build compiles in a group
(cmake/quick.cmake) are checked as a group where several of them are asked for: most of the time goes into headers."""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess

FINDING = re.compile(r"^(.+?):(\d+):(\d+): (?:error|warning): (.*)$")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"([^"]+)"', re.M)


def git(root, *args):
    done = subprocess.run(["git", "-C", str(root), *args], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else ""


def base_commit(root):
    """The commit that changes are counted from; empty where there is none, as in a clone of depth 1."""
    if named := os.environ.get("ALPENGLOW_LINT_BASE"):
        return git(root, "rev-parse", "--verify", "--quiet", named + "^{commit}") or named
    head, upstream = git(root, "rev-parse", "HEAD"), git(root, "merge-base", "HEAD", "@{upstream}")
    if upstream and upstream != head:
        return upstream
    return git(root, "rev-parse", "--verify", "--quiet", "HEAD^")


def changed(root, files):
    base = base_commit(root) or "HEAD"
    names = git(root, "diff", "--name-only", base, "--").splitlines()
    names += git(root, "ls-files", "--others", "--exclude-standard").splitlines()
    return sorted(set(names) & set(files))


class Unit:
    """What is given to clang-tidy at once: a file, or a group of files."""

    def __init__(self, main, flags, folder):
        self.main, self.flags, self.folder = main, flags, folder


class Build:
    """The compile database: which unit holds a source, with which flags."""

    def __init__(self, root, folder):
        self.root, self.folder = root, folder
        self.alone, self.groups, self.group_of = {}, {}, {}
        for entry in json.loads((folder / "compile_commands.json").read_text()):
            path = pathlib.Path(os.path.normpath(os.path.join(entry["directory"], entry["file"])))
            unit = Unit(path, tidy_flags(entry), entry["directory"])
            if "/Unity/" in str(path):
                members = [m for m in map(self.relative, INCLUDE.findall(path.read_text())) if m]
                self.groups.setdefault(path, (unit, members))
                for m in members:
                    self.group_of.setdefault(m, path)
            elif name := self.relative(path):
                self.alone.setdefault(name, unit)

    def relative(self, path):
        path = pathlib.Path(path)
        ours = path.is_relative_to(self.root) and not path.is_relative_to(self.folder) and path.is_file()
        return str(path.relative_to(self.root)) if ours else ""

    def units(self, files):
        """The units that check these sources; a group when at least three of its files are asked for."""
        chosen, by_group = {}, {}
        for f in files:
            if f in self.alone:
                chosen[f] = self.alone[f]
            elif f in self.group_of:
                by_group.setdefault(self.group_of[f], []).append(f)
        for group, members in by_group.items():
            unit = self.groups[group][0]
            if len(members) >= 3:
                chosen[str(group)] = unit
            else:
                chosen.update({m: Unit(self.root / m, unit.flags, unit.folder) for m in members})
        return list(chosen.values())

    def sources(self):
        return list(self.alone) + list(self.group_of)


def tidy_flags(entry):
    """The flags of a compile command without compiler, outputs, and the precompiled header, whose text is included instead."""
    words = entry.get("arguments") or shlex.split(entry["command"])
    start = next(i for i, w in enumerate(words) if w.startswith("-") and i and not words[i - 1].endswith(("cmake", "-E")))
    flags, i = [], start
    while i < len(words):
        if words[i] in ("-o", "-MF", "-MT", "-MQ"):
            i += 2
        elif words[i] == "-Xclang" and words[i + 1] == "-include-pch":
            i += 4
        elif words[i] in ("-c", "-MD", "-Winvalid-pch", "-fpch-instantiate-templates", "-Werror") or words[i] == entry["file"]:
            i += 1
        elif words[i] == "-Xclang" and words[i + 1] in ("-fno-pch-timestamp", "-emit-pch"):
            i += 2
        else:
            flags.append(words[i])
            i += 1
    return flags


class Includes:
    """Which files of the repository a source includes, itself and through others."""

    def __init__(self, root):
        self.root, self.direct = root, {}

    def of(self, name):
        if name not in self.direct:
            found = []
            for text in INCLUDE.findall((self.root / name).read_text(encoding="utf-8")):
                for folder in (os.path.dirname(name), "src", "tests", "include"):
                    at = os.path.normpath(os.path.join(folder, text))
                    if (self.root / at).is_file():
                        found.append(at)
                        break
            self.direct[name] = found
        return self.direct[name]

    def closure(self, names):
        seen, left = set(), list(names)
        while left:
            if (name := left.pop()) not in seen:
                seen.add(name)
                left += self.of(name)
        return seen


def with_includers(files, build, includes):
    """Sources as they are; for a header, one source that includes it, of the same folder if there is one."""
    known, chosen = build.sources(), set()
    for f in files:
        if f.endswith((".cpp", ".c")):
            chosen.add(f)
            continue
        users = [s for s in known if s.endswith(".cpp") and f in includes.closure([s])]
        users.sort(key=lambda s: (os.path.dirname(s) != os.path.dirname(f), len(includes.closure([s])), s))
        chosen.update(users[:1])
    return sorted(chosen)


def run(root, unit):
    command = ["clang-tidy-19", "--quiet", f"--config-file={root / '.clang-tidy'}",
               f"--header-filter=^{re.escape(str(root))}/(src|tests|bench|include)/", str(unit.main), "--", *unit.flags]
    done = subprocess.run(command, cwd=unit.folder, capture_output=True, text=True)
    found = []
    for line in done.stdout.splitlines():
        if m := FINDING.match(line):
            path = os.path.normpath(os.path.join(unit.folder, m.group(1)))
            name = os.path.relpath(path, root) if path.startswith(str(root) + os.sep) else path
            found.append((name, int(m.group(2)), m.group(4)))
    if done.returncode and not found:
        found.append((os.path.relpath(unit.main, root), 1, "clang-tidy-19: " + (done.stderr or done.stdout).strip()[-300:]))
    return found


def check(root, folder, files):
    """Messages of clang-tidy about `files`. Units that passed before, unchanged, are not run again."""
    if not (folder / "compile_commands.json").is_file():
        return [f"{folder}: no compile_commands.json: configure and build first"]
    build, includes = Build(root, folder), Includes(root)
    units = build.units(with_includers(files, build, includes))
    passed_file = folder / "tidy-passed.txt"
    passed = set(passed_file.read_text().split()) if passed_file.is_file() else set()
    config = (root / ".clang-tidy").read_bytes()

    def digest(unit):
        members = build.groups[unit.main][1] if unit.main in build.groups else [str(unit.main.relative_to(root))]
        h = hashlib.sha256(config + "\0".join(unit.flags).encode())
        for name in sorted(includes.closure(members)):
            h.update(name.encode() + b"\0" + (root / name).read_bytes())
        return h.hexdigest()

    waiting = [(u, d) for u in units if (d := digest(u)) not in passed]
    found = set()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for (unit, key), messages in zip(waiting, pool.map(lambda w: run(root, w[0]), waiting)):
            found.update(messages)
            if not messages:
                with passed_file.open("a") as out:
                    out.write(key + "\n")
    return [f"{name}:{line}: {text}" for name, line, text in sorted(found)]
