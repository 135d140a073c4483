"""Certificates by Coq: ``python check.py FILE.json … [--mutants]``. One line each, with what was proved, declined or refused, and time.

With ``--mutants`` each operation of a certificate's programs that something reads is changed, one at a time, and has to be refused.
"""

from __future__ import annotations

import argparse
import copy
import json
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import write

HERE = Path(__file__).resolve().parent
OTHER = {"+": "-", "-": "+", "*": "+", "/": "*"}
LIMIT = 60


def compiled(folder: Path, name: str) -> tuple[str, bool]:
    """What Coq says of a file of the folder, and whether it accepts it."""
    command = ["coqc", "-q", "-noglob", "-R", str(folder), "Liestep", str(folder / f"{name}.v")]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return f"more than {LIMIT} s", False
    return done.stdout + done.stderr, done.returncode == 0


def library(folder: Path) -> None:
    """The checker, in the folder."""
    for name in ("Numbers", "Step", "Sound"):
        (folder / f"{name}.v").write_text((HERE / f"{name}.v").read_text(encoding="utf-8"), encoding="utf-8")
        said, is_right = compiled(folder, name)
        if not is_right:
            raise SystemExit(f"{name}.v: {said}")


def verdicts(folder: Path, data: dict[str, Any]) -> dict[str, str]:
    """What the check finds of each claim, without a proof."""
    (folder / "Found.v").write_text(write.proof(data, verdicts=True)[0], encoding="utf-8")
    said, _ = compiled(folder, "Found")
    return dict(re.findall(r"\((\w+), (Holds|Wrong|Unknown)\)", said)) or {"all": said.strip()}


def line(folder: Path, data: dict[str, Any]) -> tuple[str, bool]:
    """What is proved of a certificate, and whether nothing is refused."""
    try:
        text, claims = write.proof(data)
    except write.field.Declined as reason:
        return f"declined: {reason}", True
    declined = [f"{name.lower()}: {reason}" for name, reason in claims.items() if reason]
    stated = [name for name, reason in claims.items() if not reason]
    (folder / "Proof.v").write_text(text, encoding="utf-8")
    said, is_right = compiled(folder, "Proof")
    if is_right and "Closed under the global context" in said:
        return "; ".join([f"{len(stated)} of {len(claims)} proved", *(f"declined {one}" for one in declined)]), True
    found = verdicts(folder, data)
    return "; ".join(f"{name.lower()}: {verdict}" for name, verdict in found.items() if verdict != "Holds") or said, False


def mutants(data: dict[str, Any], step: int) -> Any:
    """The certificate with one operation changed, for each that an output needs."""
    for name in ("constants", "target", "newton", "finish", "seen"):
        program = data["programs"][name]
        first = len(program["inputs"]) + len(program["literals"])
        for at, (sign, *read) in list(enumerate(program["operations"]))[::step]:
            changed = copy.deepcopy(data)
            other = ["+", *read, *read] if len(read) == 1 else [OTHER[sign], *read]
            changed["programs"][name]["operations"][at] = other
            yield f"{name} {first + at}", changed


def main() -> int:
    parser = argparse.ArgumentParser(prog="python check.py", description="Checks certificates by Coq.")
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--mutants", type=int, metavar="STEP", help="change each so many-th operation, one at a time")
    given = parser.parse_args()
    is_right = True
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        library(folder)
        for file in given.files:
            data = json.loads(file.read_text(encoding="utf-8"))
            began = time.perf_counter()
            said, accepted = line(folder, data)
            is_right &= accepted
            print(f"{file.stem}: {said} ({time.perf_counter() - began:.1f} s)", flush=True)
            if given.mutants:
                found = {place: verdicts(folder, other) for place, other in mutants(data, given.mutants)}
                passed = [place for place, each in found.items() if set(each.values()) == {"Holds"}]
                print(f"{file.stem}: {len(found) - len(passed)} of {len(found)} changed operations refused; others: {', '.join(passed)}")
    return 0 if is_right else 1


if __name__ == "__main__":
    sys.exit(main())
