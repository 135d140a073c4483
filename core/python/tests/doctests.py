"""The examples of the docstrings, run as tests from what was installed."""

import doctest
import importlib
import pkgutil
import sys

import liestep

failed = attempted = 0
for module in [liestep.__name__, *(f"liestep.{one.name}" for one in pkgutil.iter_modules(liestep.__path__))]:
    if not module.endswith("_native"):
        found = doctest.testmod(importlib.import_module(module))
        failed, attempted = failed + found.failed, attempted + found.attempted
print(f"{attempted} lines of examples, {failed} failed")
sys.exit(failed > 0 or attempted < 20)
