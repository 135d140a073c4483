"""Changed certificates: ``python mutants.py FILE …`` changes each operation that an output needs, one at a time, and lists the changes
that the checker accepts, but for those that change no output in the group, which it counts.

An operation becomes another one (a sum for a difference or a product, a product for a quotient, another function), and then reads
another register in its first place.
"""

from __future__ import annotations

import json
import random
import sys
from pathlib import Path

try:
    from liestep.verify.claims import CLAIMS, Step, Unlucky, decided
    from liestep.verify.field import drawn, functions
except ImportError:
    # Without the wheel: the checker needs the standard library alone.
    sys.path.append(str(Path(__file__).resolve().parents[1] / "python" / "liestep"))
    from verify.claims import CLAIMS, Step, Unlucky, decided
    from verify.field import drawn, functions

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


def outputs(certificate, seed):
    """All outputs but the constants, where attitudes and increments are in the group and the target is that of the momentum."""
    random.seed(seed)
    functions.drawn.clear()
    step = Step(certificate)
    momentum, history = drawn(step.n), drawn(2 * step.n)
    target = step.run("target", step.here, momentum=momentum)[: step.n]
    factors = step.run("iterate", step.here, target=target)[step.n + 2 :]
    arrays = step.arrays(step.h, step.here, target=target, momentum=momentum, history=history, factors=factors)
    return [x.a for name, program in step.programs.items() if name != "constants" for x in program.run(arrays)]


def is_idle(certificate, other):
    """Whether a change makes none of the outputs another."""
    for seed in range(1000):
        try:
            return outputs(certificate, seed) == outputs(other, seed)
        except Unlucky:
            continue
    return False


def main():
    for file in map(Path, sys.argv[1:]):
        certificate = json.loads(file.read_text(encoding="utf-8"))
        made = passed = idle = 0
        for (name, at, operation, change), one in mutants(certificate):
            made += 1
            if not accepts(one, name):
                continue
            passed += 1
            if is_idle(certificate, one):
                idle += 1
            else:
                print(f"    {file.stem}: {name} {at}: {operation} accepted as {change}", flush=True)
        count = sum(len(places) for places in live(certificate).values())
        print(f"{file.stem}: {made - passed} of {made} changes of {count} operations refused; {idle} change nothing", flush=True)


if __name__ == "__main__":
    main()
