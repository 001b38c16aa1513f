"""The program: finding it, running it, and what it says on the way."""
import functools
import json
import os
import re
import shutil
import signal
import subprocess
import threading

PROGRESS = re.compile(r"\s(\d+)%\s")


class Missing(Exception):
    """The program is not there; the text says what to do."""


def find(preferred=""):
    """The program's path. preferred: what the preferences of the add-on say; else ALPENGLOW_PROGRAM, else PATH. Raises
    Missing."""
    for name in (preferred, os.environ.get("ALPENGLOW_PROGRAM", ""), "alpenglow"):
        found = shutil.which(os.path.expanduser(name)) if name else None
        if found:
            return found
        if name and name == preferred:
            raise Missing("Alpenglow's program is not at %s. Set its path in the preferences of the add-on." % preferred)
    raise Missing("Alpenglow's program is not found. Put it on PATH, or set its path in the preferences of the add-on.")


@functools.lru_cache(maxsize=None)
def knows(program, shadeop, word):
    """Whether the manual of a shadeop has a word: parameters differ between versions of the program."""
    done = subprocess.run([program, "info", "--shadeops", shadeop], capture_output=True, text=True, check=False)
    return re.search(r"\b%s\b" % re.escape(word), done.stdout) is not None


def parameters(program, shader):
    """(name, parameters) of an RSL shader, a file or a name: dicts as `alpenglow info --json` has them. Raises ValueError."""
    done = subprocess.run([program, "info", shader, "--json"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ValueError(done.stderr.strip() or "alpenglow info ended with status %d" % done.returncode)
    found = json.loads(done.stdout)
    shaders = found if isinstance(found, list) else found.get("shaders", [found])
    for one in shaders:
        if "surface" in (one.get("types") or [one.get("type")]):
            return one["name"], one["parameters"]
    raise ValueError("%s is no surface shader" % shader)


class Run:
    """A render that is under way. Its messages are read by a thread, so the program never waits for a reader."""

    def __init__(self, arguments, folder):
        self.part, self.status_line, self.messages = 0.0, "", []
        self.process = subprocess.Popen(
            arguments,
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
        )
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stderr:
            line = line.rstrip()
            found = PROGRESS.search(line)
            if found:
                self.part, self.status_line = int(found.group(1)) / 100, line.strip()
            elif line:
                self.messages.append(line)

    def done(self):
        return self.process.poll() is not None

    def stop(self):
        """Ends it as Ctrl-C does: it keeps what is whole and writes the picture; a second time at once."""
        if not self.done():
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(5)
            except subprocess.TimeoutExpired:
                self.process.kill()

    def finish(self):
        """Waits for the end; the exit status."""
        status = self.process.wait()
        self.reader.join()
        return status
