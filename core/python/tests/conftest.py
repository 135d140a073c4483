"""What the tests share."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import liestep as ls

DATA = Path(__file__).resolve().parents[3] / "tests" / "data"
L_D = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(rho + F * rho))"


def read(name: str) -> Any:
    """A reference of the repository, of 25 digits or more."""
    return json.loads((DATA / f"{name}.json").read_text())


def numbers(values: Any) -> np.ndarray:
    """Texts of many digits as doubles."""
    return np.array(values, dtype=float)


def heavy_top(J_d: Any = (2, 2, 1), m: float = 1.0, g: float = 9.81, rho: Any = (0, 0, 1)) -> ls.Term:
    """(3.13) as Rust has it."""
    return ls.lagrangian("SO3", advected={"w": "up"}, l_d=L_D, J_d=J_d, m=m, g=g, rho=rho, up=[0, 0, 1])


@pytest.fixture
def top() -> ls.Term:
    return heavy_top()
