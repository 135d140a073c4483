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
import resource
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import write

HERE = Path(__file__).resolve().parent
OTHER = {"+": "-", "-": "+", "*": "+", "/": "*"}
TABLE = HERE / "proved.txt"
LIMIT = 30
# A divisor and the argument of a function have few terms: sums and products of more aren't computed until all of these are known.
SHORT = 300
ROUNDS = 20


def limited() -> None:
    """Processor time, which other programs don't take."""
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT + 5))


def compiled(folder: Path, name: str) -> tuple[str, bool]:
    """What Coq says of a file of the folder, and whether it accepts it."""
    command = ["coqc", "-q", "-noglob", "-R", str(folder), "Liestep", str(folder / f"{name}.v")]
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder, preexec_fn=limited)
    if done.returncode == -signal.SIGXCPU:
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


def prepared(folder: Path, problem: write.Problem, names: list[str]) -> write.Problem:
    """A problem with the divisors and the rules for functions that these claims ask for."""
    for _ in range(ROUNDS):
        answer, _ = said(folder, "Asked", write.questions(problem, SHORT, names))
        found = re.search(r"= (\[.*\])\s*: list", re.sub(r"%\w+", "", answer), re.DOTALL)
        if not found or not problem.answer(ast.literal_eval(found[1].replace(";", ","))):
            break
    return problem


def verdict(folder: Path, problem: write.Problem, name: str) -> str:
    """What the check finds of a claim, without a proof."""
    answer, _ = said(folder, "Found", write.verdict(problem, name))
    found = re.search(r"= (Holds|Wrong|Open)", answer)
    return found[1] if found else answer.strip()


def proved(folder: Path, problem: write.Problem, names: list[str]) -> bool:
    answer, is_right = said(folder, "Proof", write.proof(problem, names))
    return is_right and "Closed under the global context" in answer


def unproved(folder: Path, problem: write.Problem, names: list[str]) -> list[str]:
    """Those of some claims of which a proof isn't found."""
    return [] if proved(folder, problem, names) else [name for name in names if not proved(folder, problem, [name])]


def line(folder: Path, data: dict[str, Any]) -> tuple[str, int, bool]:
    """What is proved of a certificate, the number of claims, and whether nothing is refused."""
    try:
        problem = write.Problem(data)
        prepared(folder, problem, problem.stated)
    except write.field.Declined as reason:
        return f"declined: {reason}", 0, True
    claims = problem.claims()
    rest = {name.lower(): f"declined {name.lower()}: {reason}" for name, reason in claims.items() if reason}
    left = unproved(folder, problem, problem.stated)
    if left:
        problem = prepared(folder, write.Problem(data, is_exact=True), left)
        for name in unproved(folder, problem, left):
            rest[name.lower()] = f"{name.lower()}: {verdict(folder, problem, name)}"
    count = len(claims) - len(rest)
    is_right = not any(one.endswith((": Wrong", ": Open")) for one in rest.values())
    return "; ".join([f"{count} of {len(claims)} proved", *rest.values()]), count, is_right


def checked_again(folder: Path) -> bool:
    """Whether the last certificate's proofs and all that they need are accepted by Coq's own checker, without an axiom."""
    command = ["coqchk", "-silent", "-o", "-R", str(folder), "Liestep", "Liestep.Proof"]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.returncode == 0 and "* Axioms: <none>" in done.stdout + done.stderr


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
    parser.add_argument("--coqchk", action="store_true", help="check the library and each proof once more by `coqchk`, without an axiom")
    parser.add_argument("--table", action="store_true", help=f"write the counts into {TABLE.name}; without, fewer than there are wrong")
    given = parser.parse_args()
    is_right, counts = True, dict(line.split(": ") for line in TABLE.read_text(encoding="utf-8").splitlines())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        library(folder)
        for file in given.files:
            data = json.loads(file.read_text(encoding="utf-8"))
            began = sum(os.times()[:4])
            said, count, accepted = line(folder, data)
            print(f"{file.stem}: {said} ({sum(os.times()[:4]) - began:.1f} s)", flush=True)
            if given.table:
                counts[file.stem] = said.partition(" proved")[0]
            elif count < int(counts.get(file.stem, "0").split()[0]):
                print(f"{file.stem}: {counts[file.stem]} in {TABLE.name}")
                accepted = False
            if given.coqchk and not checked_again(folder):
                print(f"{file.stem}: refused by coqchk")
                accepted = False
            is_right &= accepted
            if given.mutants:
                print_mutants(folder, file.stem, data, given.mutants)
    if given.table:
        TABLE.write_text("".join(f"{name}: {count}\n" for name, count in sorted(counts.items())), encoding="utf-8")
    return 0 if is_right else 1


def print_mutants(folder: Path, name: str, data: dict[str, Any], step: int) -> None:
    """Which of the changed certificates are accepted; the divisors and rules are those of the right one."""
    problem, count, passed = write.Problem(data), 0, []
    prepared(folder, problem, problem.stated)
    for place, other in mutants(data, step):
        count += 1
        if proved(folder, problem.changed(other), problem.stated):
            passed.append(place)
    print(f"{name}: {count - len(passed)} of {count} changed operations refused; others: {', '.join(passed)}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
