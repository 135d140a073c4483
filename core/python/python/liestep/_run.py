"""Runs: columns of numbers, in the memory where Rust wrote them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _arrays, _native
from ._gradient import Differentiable
from ._state import State
from ._tables import written
from .errors import ColumnError, Error, SceneError, SetupError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


class Columns:
    """Columns by their names, which nobody can change; NumPy and Arrow look at them where they are."""

    def __init__(self, table: _native.Table) -> None:
        self._table = table
        self._names = [name for name, _ in table.columns]

    @property
    def names(self) -> list[str]:
        """The names of the columns."""
        return list(self._names)

    @property
    def units(self) -> dict[str, str]:
        """The unit of each column, and nothing where none is known."""
        return dict(self._table.columns)

    def __len__(self) -> int:
        return len(self._table)

    def __getitem__(self, name: str) -> Array:
        import numpy as np

        if not isinstance(name, str) or name not in self._names:
            raise ColumnError(f"there is no column {_arrays.shown(name)}: there are {', '.join(self._names)}")
        return np.asarray(self._table.view(self._names.index(name), None))

    def group(self, start: str) -> Array:
        """The columns that begin with this, a row for each row; none of them is copied where they stand side by side."""
        import numpy as np

        places = [place for place, name in enumerate(self._names) if isinstance(start, str) and name.startswith(start)]
        if not places:
            raise ColumnError(f"no column begins with {_arrays.shown(start)}: there are {', '.join(self._names)}")
        if places[-1] - places[0] >= len(places):
            return np.stack([self[self._names[place]] for place in places], axis=1)
        return np.asarray(self._table.view(places[0], len(places)))

    def __arrow_c_stream__(self, requested_schema: Any = None) -> Any:
        return self._table.__arrow_c_stream__(requested_schema)

    @property
    def table(self) -> Any:
        """The columns as a table of pyarrow, without a copy."""
        import pyarrow

        return pyarrow.table(self)

    def to_pandas(self) -> Any:
        """The columns as a frame of pandas."""
        import pandas

        return pandas.DataFrame({name: self[name] for name in self._names})

    def _ipython_key_completions_(self) -> list[str]:
        return self.names

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {len(self)} rows of {', '.join(self._names)}>"


class Happenings(Columns):
    """When an event happened, and the motion then."""

    def __init__(self, table: _native.Table, rising: list[bool]) -> None:
        super().__init__(table)
        self._rising = rising

    @property
    def times(self) -> Array:
        """When, s."""
        return self["t"]

    @property
    def rising(self) -> NDArray[np.bool_]:
        """Whether the quantity rose."""
        import numpy as np

        return np.array(self._rising, dtype=bool)


#: Runs beside one of so many steps are made in a blink.
QUICK = 20_000


class Motion(Columns):
    """Columns of a motion."""

    @property
    def time(self) -> Array:
        """The times of the rows, s."""
        return self["t"]

    @property
    def energy(self) -> Array:
        """The energy, J."""
        return self["energy"]

    @property
    def velocity(self) -> Array:
        """The body velocity, on SO(3) in the axes of the body in rad/s, a row for each row."""
        return self.group("velocity_")

    @property
    def momentum(self) -> Array:
        """The body momentum, in the same axes, a row for each row."""
        return self.group("momentum_")


def _labelled(name: str, unit: str) -> str:
    return f"{name}, {unit}" if unit else name


def rotations(quaternions: Array) -> Array:
    """The matrices of unit quaternions ``w, x, y, z``, a row for each."""
    import numpy as np

    w, x, y, z = quaternions.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


class Run(Motion, Differentiable):
    """What was recorded of a run.

    Attributes
    ----------
    steps, iterations : int
        How many steps were made, and the iterations of all their equations.
    step : float
        The length of a step, s.
    events : dict of Happenings
        By the names of the events.
    ended_by : str or None
        The event that stopped it.
    choice, method : str and dict, or None
        The table of all methods that were compared for an accuracy, and the arguments of `liestep.Stepper` that make the same
        steps.
    """

    def __init__(
        self,
        title: str,
        about: str,
        step: float,
        made: dict[str, Any],
        names: list[str],
        estimate: Callable[[Run], float | None] | None = None,
    ) -> None:
        super().__init__(made["table"])
        self.title = title
        self.about = about
        self.step = step
        self.steps: int = made["steps"]
        self.iterations: int = made["iterations"]
        pairs = zip(names, made["events"], strict=True)
        self.events = {name: Happenings(table, rising) for name, (table, rising) in pairs}
        ending = made["ending"]
        self.ended_by: str | None = None if ending is None else names[ending]
        self.choice: str | None = made.get("choice")
        self.method: dict[str, Any] | None = None
        self._error: float | None = made.get("error")
        self._estimate = estimate

    @property
    def error(self) -> float | None:
        """About how far the last state is off, as a share: attitude and velocity together, each by its own size.

        An attitude on SO(3) that is off by an angle has about 0.8 times as much, in rad. A run to an accuracy has measured it.
        The error of another run is estimated when it is first read: by two runs of twice and four times the step, or, where
        these say nothing, by two of a half and a quarter. There is none where the runs don't agree with each other as those of a
        method do, where steps have lengths of their own, and where an event has ended the run.
        """
        if self._estimate is not None:
            self._error, self._estimate = self._estimate(self), None
        return self._error

    def __getstate__(self) -> dict[str, Any]:
        if self._origin is None or self._origin.does_pickle():
            return self.__dict__
        # A signal by a function that doesn't pickle leaves no other runs.
        return {**self.__dict__, "_error": self.error, "_estimate": None, "_origin": None}

    @property
    def _said(self) -> str:
        """How it was made, and how far it is off where that takes no time."""
        error = None if self._estimate is not None and self.steps > QUICK else self.error
        return self.about if error is None else f"{self.about}, off by {error:.1g} at the end"

    @property
    def quaternion(self) -> Array:
        """The attitude on SO(3), body to space, as unit quaternions ``w, x, y, z``."""
        if "q_w" not in self._names:
            raise ColumnError(f"a rotation is one on SO3: there are {', '.join(self._names)}")
        return self.group("q_")

    @property
    def attitude(self) -> Any:
        """The attitude: SciPy's ``Rotation`` on SO(3) where there is SciPy, else matrices, body to space.

        On other groups the columns of the attitude, a row for each row.
        """
        if "q_w" not in self._names:
            return self._attitudes()
        try:
            from scipy.spatial.transform import Rotation
        except ImportError:
            return self.matrix
        return Rotation.from_quat(self.quaternion[:, [1, 2, 3, 0]])

    def _attitudes(self) -> Array:
        """The columns of the attitude, a row for each row."""
        import numpy as np

        end = next(place for place, name in enumerate(self._names) if name.startswith("velocity_"))
        return np.stack([self[name] for name in self._names[1:end]], axis=1)

    @property
    def matrix(self) -> Array:
        """The attitudes on SO(3) as matrices, body to space."""
        return rotations(self.quaternion)

    @property
    def axis(self) -> Array:
        """The third axis of the body, in space."""
        return self.matrix[:, :, 2]

    @property
    def tilt(self) -> Array:
        """The angle of that axis from the third of space, rad."""
        import numpy as np

        return np.arccos(np.clip(self.axis[:, 2], -1, 1))

    @property
    def spatial_momentum(self) -> Array:
        """The momentum in space, a row for each row: on SO(3) the angular momentum, kg m²/s; elsewhere by the generators."""
        import numpy as np

        if "q_w" not in self._names:
            return self.group("spatial_momentum_")
        return np.asarray(np.einsum("nij,nj->ni", self.matrix, self.momentum))

    def plot(self, axes: Any = None) -> Any:
        """Velocity and energy over time, by matplotlib, on two axes if they are given; returns the figure.

        ``run.plot().savefig("run.png")`` saves it.
        """
        import numpy as np

        if axes is None:
            try:
                import matplotlib.pyplot as plt
            except ImportError as error:
                raise Error("a plot takes matplotlib, which isn't installed: `pip install matplotlib`, or write `run.svg()`") from error
            _, axes = plt.subplots(2, 1, sharex=True, constrained_layout=True)
        names = [name for name in self._names if name.startswith("velocity_")]
        axes[0].plot(self.time, self.velocity, label=names)
        # Components of several units, as those of SE(3), have none in common.
        units = {self.units[name] for name in names}
        axes[0].set(ylabel=_labelled("velocity", units.pop() if len(units) == 1 else ""), title=self.title)
        axes[0].legend(loc="upper right")
        off, rounding = abs(self.energy - self.energy[0]), 2.0**-52 * abs(self.energy[0])
        # Where nothing is off by more than rounding that is what is shown; else zeros would stretch the axis.
        axes[1].semilogy(self.time, off.clip(min=rounding) if off.max() < 64 * rounding else np.where(off > rounding, off, np.nan))
        axes[1].set(xlabel="time, s", ylabel=_labelled("energy from its start", self.units["energy"]))
        return axes[0].figure

    def html(self, path: str | Path | None = None) -> str:
        """The page that plays a motion on SO(3) in a browser; written to a file, if one is given."""
        page = _native.page(self._table, self.title, self._said)
        if path is not None:
            Path(path).write_text(page, encoding="utf-8")
        return page

    def svg(self) -> str:
        """The picture, as a notebook shows it."""
        return _native.picture(self._table, self.title, self._said)

    def _repr_svg_(self) -> str:
        return self.svg()

    def __repr__(self) -> str:
        ended = f", ended by {self.ended_by}" if self.ended_by else ""
        return f"<Run of {self.title}: {self.steps} {self._said}, {len(self)} rows{ended}>"


@dataclass(frozen=True)
class Happening:
    """An event of a scene's file."""

    name: str
    time: float
    rising: bool


@dataclass(frozen=True)
class _Pickled:
    """The texts of a file's run: its summary, its picture and its page."""

    summary: str
    svg: str
    html: str

    def picture(self) -> str:
        return self.svg

    def page(self) -> str:
        return self.html


class SceneRun(Motion):
    """The run of a scene's file, with the columns of its table."""

    def __init__(self, run: _native.FileRun) -> None:
        super().__init__(run.table)
        self._run: _native.FileRun | _Pickled = run
        self.steps = run.steps
        self.events = [Happening(*one) for one in run.events]

    def __getstate__(self) -> dict[str, Any]:
        run = self._run
        return {**self.__dict__, "_run": _Pickled(run.summary, run.picture(), run.page())}

    @property
    def summary(self) -> str:
        """Lines about its beginning and its end."""
        return self._run.summary

    def svg(self) -> str:
        """The picture that the file asks for."""
        return self._run.picture()

    def html(self, path: str | Path | None = None) -> str:
        """The page that plays it."""
        page = self._run.page()
        if path is not None:
            Path(path).write_text(page, encoding="utf-8")
        return page

    def _repr_svg_(self) -> str:
        return self.svg()

    def __repr__(self) -> str:
        return self.summary.rstrip()


class Scene:
    """A scene's file; see `liestep.scene`."""

    def __init__(self, path: str | Path, text: str | None = None) -> None:
        if not isinstance(path, (str, Path)):
            raise SceneError(f"a scene is made of a file's name, or of tables, not of {_arrays.shown(path)}")
        self._path, self._text = str(path), None if text is None else _arrays.text("text", text)
        self._file = _native.File(self._path, text)

    @property
    def title(self) -> str:
        """What it is called."""
        return self._file.title

    @property
    def text(self) -> str | None:
        """The text of the scene; none of one that is read from a file."""
        return self._text

    def run(self) -> SceneRun:
        """Makes the run that the file says."""
        return SceneRun(self._file.run())

    def start(self) -> State:
        """The state at the file's start, for a loop of your own with its step.

        Examples
        --------
        A pendulum of two rods whose elbow is driven:

        >>> import liestep as ls
        >>> text = '''
        ... title = "Acrobot"
        ... gravity = { g = 9.81, up = [0, 0, 1] }
        ... body = [
        ...     { name = "upper", m = 1, moments = [0.1, 0.1, 0.001] },
        ...     { name = "fore", m = 1, moments = [0.1, 0.1, 0.001] },
        ... ]
        ... joint = [
        ...     { kind = "pin", bodies = ["space", "upper"], at = [[0, 0, 0], [0, 0, 0.5]], axes = [[0, 1, 0], [0, 1, 0]] },
        ...     { name = "elbow", kind = "pin", bodies = ["upper", "fore"], at = [[0, 0, -0.5], [0, 0, 0.5]],
        ...       axes = [[0, 1, 0], [0, 1, 0]] },
        ... ]
        ... run = { step = 0.001, duration = 1 }
        ... '''
        >>> state = ls.scene("acrobot.toml", text).start()
        >>> state.step(100, torque={"elbow": 1.0})
        >>> angle, rate = state.joints["elbow"]
        >>> angle > 0 and rate > 0
        True
        """
        return State(self, self._file.start())

    def _resumed(self, numbers: list[float]) -> _native.State:
        return self._file.resume(numbers)

    def _seen(self, numbers: list[float]) -> dict[str, Any]:
        raise SetupError("what a file's scene carries along has no names here: read the attitude")

    def _given(self, parameters: Mapping[str, Any]) -> list[float]:
        raise SetupError("parameters of a file's scene are those of the file: take a term, as `ls.body(J) + …`")

    def __reduce__(self) -> tuple[Any, ...]:
        return Scene, (self._path, self._text)

    def __repr__(self) -> str:
        return f"<Scene {self.title}: {self._file.about}>"


def scene(path: str | Path | Mapping[str, Any], text: str | None = None) -> Scene:
    """A scene from a file of TOML, from its text, or from its tables: one body, or several with joints and springs.

    Every key is on the page of `liestep_scene::SceneFile`.

    Parameters
    ----------
    path : str, Path or mapping
        The file; or the tables that it would have, with numbers, texts with a unit, lists, arrays and signals as values. Mistakes of tables
        have the lines of `Scene.text`.
    text : str, optional
        The text of the file, which isn't read then.

    Examples
    --------
    >>> import liestep as ls
    >>> text = '''
    ... title = "A wing nut"
    ... [body]
    ... moments = [1.0, 2.0, 2.5]
    ... [start]
    ... euler = [0, 0, 0]
    ... velocity = [0.001, "2 rad/s", 0.001]
    ... [run]
    ... step = "20 ms"
    ... duration = 20
    ... '''
    >>> len(ls.scene("wing-nut.toml", text).run())
    1001
    >>> tables = {
    ...     "title": "A wing nut", "body": {"moments": [1.0, 2.0, 2.5]}, "run": {"step": "20 ms", "duration": 20},
    ...     "start": {"euler": [0, 0, 0], "velocity": [0.001, "2 rad/s", 0.001]},
    ... }
    >>> len(ls.scene(tables).run())
    1001
    """
    if isinstance(path, Mapping):
        if text is not None:
            raise SceneError("a scene is made of tables or of a text, and these are both")
        return Scene("scene.toml", written(path))
    return Scene(path, text)
