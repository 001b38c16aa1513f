"""What the tests of programs with windows need: a screen without one (Xvfb), the rule that they run at night, and how far pictures are apart."""
import json
import os
import shutil
import subprocess
import sys


def skipped(*programs):
    """The reason not to run now, or "": tests of exporters run in ./check --all (or with --now), where their programs are."""
    if not os.environ.get("ALPENGLOW_NIGHTLY") and "--now" not in sys.argv:
        return "skipped: only in ./check --all (or with --now)"
    missing = [p for p in programs if not shutil.which(p)]
    return "skipped: not installed: " + ", ".join(missing) if missing else ""


class Screen:
    """`with Screen() as environment:` an X server without a screen, for programs that draw by one; DISPLAY is in the environment."""

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24", "-nolisten", "tcp"], pass_fds=[write],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as f:
            number = f.readline().strip()
        if not number:
            raise OSError("Xvfb did not start")
        return dict(os.environ, DISPLAY=":" + number, USER=os.environ.get("USER", "nobody"), LIBGL_ALWAYS_SOFTWARE="1")

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()


def python_with(module):
    """A Python that has a module of Debian's: ours or /usr/bin/python3; "" where none has."""
    for python in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([python, "-c", "import " + module], capture_output=True, check=False).returncode == 0:
            return python
    return ""


def drawn(program, folder, name, hider):
    """NAME.rib drawn as VTK means it (exponents 1 / roughness, no curve): (codes that it is apart from NAME.png on average, "") or (None, why not)."""
    picture = os.path.join(folder, "%s.%s.png" % (name, hider))
    done = subprocess.run([program, "render", "-q", "--hider", hider, "--dialect", "rispec", "--gamma", "1", "--spp", "16", "-o", picture,
                           name + ".rib"], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return None, "status %d\n%s" % (done.returncode, done.stderr)
    done = subprocess.run([program, "diff", picture, os.path.join(folder, name + ".png"), "--json"], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1) or not done.stdout:
        return None, "alpenglow diff: " + done.stdout + done.stderr
    return 255 * json.loads(done.stdout)["all"]["meanAbs"], ""
