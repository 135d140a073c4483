"""The command line."""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
import time
from pathlib import Path
from typing import Any

from .claims import verified
from .printed import is_printed


def row(name: str, data: dict[str, Any], found: dict[str, bool | str]) -> str:
    """A line of a table in Markdown."""
    group = " × ".join(factor["name"] for factor in data["factors"])
    unknowns = sum(len(factor["generators"]) for factor in data["factors"])
    operations = sum(len(program["operations"]) for program in data["programs"].values())
    moving = [program for name, program in data["programs"].items() if name not in ("restored", "defect")]
    functions = {name for program in moving for name, *_ in program["operations"] if name.isidentifier()}
    rest = [f"{name}: {holds or 'WRONG'}" for name, holds in found.items() if holds is not True]
    holds = f"{len(found) - len(rest)} of {len(found)}"
    cells = [name, group, str(unknowns), str(operations), ", ".join(sorted(functions)), holds, "; ".join(rest)]
    return "| " + " | ".join(cells) + " |"


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m liestep.verify", description="Checks certificates of steps.")
    parser.add_argument("files", nargs="+", type=Path, help="what `liestep derive --certificate` has written")
    parser.add_argument("--c", type=Path, help="a text in C: its digest and its statements have to be those of the certificate")
    parser.add_argument("--table", action="store_true", help="print the lines of a table in Markdown")
    given = parser.parse_args()
    is_right = True
    for file in given.files:
        began, data = time.process_time(), json.loads(file.read_text(encoding="utf-8"))
        found = verified(data)
        if given.c:
            text = given.c.read_bytes()
            found["digest"] = data["digests"]["c"] == "sha256:" + hashlib.sha256(text).hexdigest()
            found["statements"] = is_printed(data, text.decode())
        is_right &= all(holds is True for holds in found.values())
        if given.table:
            print(row(file.stem, data, found))
            continue
        for name, holds in found.items():
            if holds is not True:
                print(f"{file}: {name}: {holds or 'WRONG'}")
        count = sum(holds is True for holds in found.values())
        print(f"{file}: {data['name']}: {count} of {len(found)} claims hold ({time.process_time() - began:.1f} s)")
    return 0 if is_right or given.table else 1


if __name__ == "__main__":
    sys.exit(main())
