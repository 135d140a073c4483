"""Changed certificates: ``python mutants.py FILE …`` changes each operation that an output needs, one at a time, and lists the changes
that the checker accepts.

An operation becomes another one (a sum for a difference or a product, a product for a quotient, another function), and then reads
another register in its first place.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "python" / "liestep"))

from verify.claims import CLAIMS, Step, decided  # noqa: E402

OTHER = {"+": "-", "-": "+", "*": "+", "/": "*"}


def first_of(program):
    """The register of the first operation."""
    return len(program["inputs"]) + len(program["literals"])


def needed(program, outputs):
    """The registers that some outputs need."""
    first, found = first_of(program), set(outputs)
    for at, (_, *read) in reversed(list(enumerate(program["operations"], first))):
        found |= set(read) if at in found else set()
    return found


def live(certificate):
    """For each program the places of operations that an output needs; of the constants, an output that another program needs."""
    programs = certificate["programs"]
    reads = {name: needed(one, one["outputs"]) for name, one in programs.items()}
    others = [(programs[name], read) for name, read in reads.items() if name != "constants"]
    used = {tuple(one["inputs"][at]) for one, read in others for at in read if at < len(one["inputs"])}
    constants = programs["constants"]
    reads["constants"] = needed(constants, [at for k, at in enumerate(constants["outputs"]) if ("constants", k) in used])
    return {name: [at for at in range(len(one["operations"])) if at + first_of(one) in reads[name]] for name, one in programs.items()}


def changes(operation, register):
    """Another operation on the registers, and the operation on another register, which is none that it reads, and before its own."""
    name, *read = operation
    if len(read) == 2:
        yield [OTHER[name], *read]
    else:
        yield ["+", *read, *read] if name == "-" else ["cos" if name == "exp" else "exp", *read]
    if others := [at for at in range(register) if at not in read]:
        yield [name, others[register % len(others)], *read[1:]]


def mutants(certificate):
    """Certificates with one change of a live operation: the program, the operation's place, the operation, the change, the certificate."""
    for name, places in live(certificate).items():
        program = certificate["programs"][name]
        for at in places:
            for change in changes(program["operations"][at], first_of(program) + at):
                operations = [*program["operations"][:at], change, *program["operations"][at + 1 :]]
                programs = certificate["programs"] | {name: program | {"operations": operations}}
                yield (name, at, program["operations"][at], change), certificate | {"programs": programs}


def accepts(certificate, program):
    """Whether all claims hold; those of the changed program are asked first."""
    step = Step(certificate)
    for claim in sorted(certificate["claims"], key=lambda claim: claim["of"] != program):
        holds, step = decided(step, CLAIMS[claim["name"]])
        if holds is not True:
            return False
    return True


def main():
    for file in map(Path, sys.argv[1:]):
        certificate = json.loads(file.read_text(encoding="utf-8"))
        made = [(place, accepts(one, place[0])) for place, one in mutants(certificate)]
        passed = [place for place, is_accepted in made if is_accepted]
        count = sum(len(places) for places in live(certificate).values())
        print(f"{file.stem}: {len(made) - len(passed)} of {len(made)} changes of {count} operations refused", flush=True)
        for name, at, operation, change in passed:
            print(f"    {name} {at}: {operation} accepted as {change}", flush=True)


if __name__ == "__main__":
    main()
