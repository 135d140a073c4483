"""Certificates: each operation of a step, changed alone, is refused, and so is another text."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from liestep.verify import verified
from mutants import accepts, live, mutants

import liestep as ls

J = [1, 2, 2.5]


def plate():
    """A plate in a plane, tied to two points by springs."""
    spring = "(a - p).norm_squared() + (a - F * p).norm_squared()"
    return ls.lagrangian("SE2", advected={"a": "anchor"}, J=[[2, 0, 0], [0, 3, 0], [0, 0, 1]], k=3, p=[0.1, 0.2, 1], anchor=ls.point([1, 0]),
                         l_d=f"((F - I) * J * (F - I).transpose()).trace() / (2 * h) - h * k * ({spring}) / 4")


def needle():
    """A sum of functions that aren't rational."""
    return ls.body(J, kinetic="geodesic") + ls.lagrangian(
        "SO3", advected={"w": "up"}, l_d="h * k * (w.dot(a).sin() + w.dot(F * a).sin() + w.dot(a).exp() + w.dot(F * a).exp() "
        "+ (2 + w.dot(a)).ln() + (2 + w.dot(F * a)).ln() + w.dot(exp(b) * a) + w.dot(F * (exp(b) * a)))",
        k=0.5, a=[0.1, 0.2, 0.3], b=[0.3, 0, 0.1], up=[0, 0, 1])


SUMS = {
    "a falling top": lambda: ls.body(J) + ls.gravity(m=0.5, rho=[0.1, 0.2, 0.3]) + ls.drag(c=0.3, J=J),
    "a plate": plate,
    "a needle": needle,
    "a Cayley body": lambda: ls.body(J, kinetic="cayley") + ls.dipole(moment=[0.1, 0.4, 0], field=[2, 1, 0]),
}


def data(name):
    return json.loads(SUMS[name]().certificate)


@pytest.mark.parametrize("name", SUMS)
def test_a_certificate_is_accepted(name):
    found = verified(data(name))
    assert found and all(holds is True for holds in found.values()), found


@pytest.mark.parametrize(("name", "idle"), [
    # h³ of the uneven shares of drag, whose sum is the whole impulse: in the momentum after a step they cancel as `Fᵀ vee(F)`
    # is `vee(F)`, so that any other value is right, too.
    ("a falling top", [("constants", 46, "*", 0, 57)]),
    ("a Cayley body", []),
])
def test_each_operation_counts(name, idle):
    """On other groups there are operations on what is zero in each element, which may be any."""
    certificate = data(name)
    assert live(certificate) == {program: list(range(len(one["operations"]))) for program, one in certificate["programs"].items()}
    # Each operation becomes another one, and each tenth reads another register; `mutants.py` has both for all.
    tried = [(place, made) for place, made in mutants(certificate) if place[3][0] != place[2][0] or place[1] % 10 == 0]
    survived = {(program, at, *operation) for (program, at, operation, _), made in tried if accepts(made, program)}
    assert survived == set(idle)


def test_functions_count():
    """Each tenth operation of the needle's programs, and each function."""
    each = mutants(data("a needle"))
    tried = [(place, made) for place, made in each if (place[1] % 10 == 0 and place[3][0] != place[2][0]) or place[2][0].isidentifier()]
    assert {place[2][0] for place, _ in tried} >= {"cos", "exp", "log_ratio_2", "stumpff_5", "sqrt", "+", "-", "*", "/"}
    assert [place for place, made in tried if accepts(made, place[0])] == []


@pytest.mark.parametrize(("text", "other", "wrong"), [
    ("-0.5 * h * m", "0.5 * h * m", "residual"),
    ("rho + F * rho", "rho + F.transpose() * rho", "momentum"),
    ("eta * (c - end)", "eta * (c + end)", "residual"),
    ("eta_next * end", "eta_next.norm_squared() * end * eta", "work"),
])
def test_another_text_is_refused(text, other, wrong):
    certificate = data("a falling top")
    texts = [" ".join(one.split()) for one in certificate["texts"]]
    changed = [one.replace(text, other) for one in texts]
    assert changed != texts
    assert verified(certificate | {"texts": changed})[wrong] is False


def test_exactly(tmp_path):
    """The claims that are rational, as identities of rational functions."""
    pytest.importorskip("flint", reason="python-flint isn't installed")
    file = tmp_path / "pendulum.json"
    pendulum = ls.lagrangian("SO2", advected={"w": "up"}, J=2, m=3, rho=[0.1, 0.2], up=[0, 1],
                             l_d="((F - I) * (F - I).transpose()).trace() * J / (2 * h) - h * m * w.dot(rho + F * rho) / 2")
    file.write_text(pendulum.certificate)
    path = [str(Path(ls.__file__).parent), *sys.path]
    script = Path(__file__).with_name("exact.py")
    paths = {"PYTHONPATH": os.pathsep.join(path)}
    done = subprocess.run([sys.executable, str(script), str(file)], capture_output=True, text=True, env=paths)
    lines = done.stdout.splitlines()
    assert done.returncode == 0, done.stdout + done.stderr
    others = [line for line in lines if not line.endswith(": True")]
    assert len(lines) == 17 and len(others) == 2 and all("sqrt isn't rational" in line for line in others)


def test_what_has_no_rule_is_said():
    certificate = data("a falling top")
    changed = [one.replace("vee(F)", "vee(F.tanh())") for one in certificate["texts"]]
    found = verified(certificate | {"texts": changed})
    assert found["residual"] == "the method tanh"


def test_the_checker_needs_nothing_else(tmp_path):
    file = tmp_path / "top.json"
    file.write_text(SUMS["a falling top"]().certificate)
    folder = Path(ls.__file__).parent
    alone = [sys.executable, "-S", "-c", "import runpy, sys; sys.path.insert(0, sys.argv.pop(1)); runpy.run_module('verify', run_name='__main__')"]
    for command, path in [([sys.executable, "-m", "liestep.verify"], []), (alone, [str(folder)])]:
        done = subprocess.run([*command, *path, str(file)], capture_output=True, text=True)
        assert done.returncode == 0 and "18 of 18 claims hold" in done.stdout, done.stderr
