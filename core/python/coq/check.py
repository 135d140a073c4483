"""Certificates by Coq: ``python check.py FILE.json … [--mutants]``. One line each, with what was proved, declined or refused, and time.

With ``--mutants N`` every N-th operation that an output of a program needs is changed, one at a time; those that are accepted are
listed. Operations behind outputs that no stated claim is of are among them.
"""

from __future__ import annotations

import argparse
import ast
import copy
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import write

HERE = Path(__file__).resolve().parent
OTHER = {"+": "-", "-": "+", "*": "+", "/": "*"}
LIMIT = 45
# A divisor and the argument of a function have few terms: products of more aren't computed until all of these are known.
SHORT = 2000
ROUNDS = 20


def compiled(folder: Path, name: str) -> tuple[str, bool]:
    """What Coq says of a file of the folder, and whether it accepts it."""
    command = ["coqc", "-q", "-noglob", "-R", str(folder), "Liestep", str(folder / f"{name}.v")]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, cwd=folder)
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


def said(folder: Path, name: str, text: str) -> tuple[str, bool]:
    (folder / f"{name}.v").write_text(text, encoding="utf-8")
    return compiled(folder, name)


def prepared(folder: Path, data: dict[str, Any]) -> write.Problem:
    """A certificate, with the divisors and the rules for functions that its claims ask for."""
    problem = write.Problem(data)
    for _ in range(ROUNDS):
        answer, _ = said(folder, "Asked", write.questions(problem, SHORT))
        found = re.search(r"= (\[.*\])\s*: list", re.sub(r"%\w+", "", answer), re.DOTALL)
        if not found or not problem.answer(ast.literal_eval(found[1].replace(";", ","))):
            break
    return problem


def verdicts(folder: Path, problem: write.Problem) -> dict[str, str]:
    """What the check finds of each claim, without a proof."""
    answer, _ = said(folder, "Found", write.verdicts(problem))
    return dict(re.findall(r"\((\w+), (Holds|Wrong|Open)\)", answer)) or {"all": answer.strip()}


def line(folder: Path, data: dict[str, Any]) -> tuple[str, bool]:
    """What is proved of a certificate, and whether nothing is refused."""
    try:
        problem = prepared(folder, data)
    except write.field.Declined as reason:
        return f"declined: {reason}", True
    claims = problem.claims()
    declined = [f"{name.lower()}: {reason}" for name, reason in claims.items() if reason]
    answer, is_right = said(folder, "Proof", write.proof(problem))
    if is_right and "Closed under the global context" in answer:
        return "; ".join([f"{len(problem.stated)} of {len(claims)} proved", *(f"declined {one}" for one in declined)]), True
    found = verdicts(folder, problem)
    return "; ".join(f"{name.lower()}: {verdict}" for name, verdict in found.items() if verdict != "Holds") or answer, False


def mutants(data: dict[str, Any], step: int) -> Any:
    """The certificate with one operation changed, for every so many-th that an output needs."""
    for name in ("constants", "target", "newton", "finish", "seen"):
        program = data["programs"][name]
        first = len(program["inputs"]) + len(program["literals"])
        needed = set(program["outputs"])
        for at, (_, *read) in reversed(list(enumerate(program["operations"]))):
            needed |= set(read) if first + at in needed else set()
        live = [(at, one) for at, one in enumerate(program["operations"]) if first + at in needed]
        for at, (sign, *read) in live[::step]:
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
            began = sum(os.times()[:4])
            said, accepted = line(folder, data)
            is_right &= accepted
            print(f"{file.stem}: {said} ({sum(os.times()[:4]) - began:.1f} s)", flush=True)
            if given.mutants:
                found = {place: verdicts(folder, prepared(folder, other)) for place, other in mutants(data, given.mutants)}
                passed = [place for place, each in found.items() if set(each.values()) == {"Holds"}]
                print(f"{file.stem}: {len(found) - len(passed)} of {len(found)} changed operations refused; others: {', '.join(passed)}")
    return 0 if is_right else 1


if __name__ == "__main__":
    sys.exit(main())
