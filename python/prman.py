"""`import prman` for scripts that were written for Pixar's module: this is alpenglow.prman."""
from alpenglow.prman import *  # noqa: F401,F403
from alpenglow.prman import __all__  # noqa: F401
