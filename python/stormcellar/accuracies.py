"""The accuracy of grids, measured on a volume."""

from __future__ import annotations

import ctypes
import html
import typing

from . import _library
from ._library import Handle, call, sized
from .grids import grid_options
from .volume import volume_of

if typing.TYPE_CHECKING:
    import pandas
    import numpy.typing as npt

    from .volume import Source, Volume


class Table(list[dict[str, typing.Any]]):
    """Rows of a table, which Jupyter shows.

    >>> Table([{"step": "frame", "rung": 0}]).to_pandas()["step"].tolist()
    ['frame']
    """

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a pandas.DataFrame, and needs pandas.

        >>> list(Table([{"step": "frame", "rung": 0}]).to_pandas().columns)
        ['step', 'rung']
        """
        from pandas import DataFrame

        return DataFrame(list(self))

    def _repr_html_(self) -> str:
        def line(cells, tag):
            return "<tr>" + "".join(f"<{tag}>{html.escape(_text(cell))}</{tag}>" for cell in cells) + "</tr>"

        head = line(self[0], "th") if self else ""
        return f"<table>{head}{''.join(line(row.values(), 'td') for row in self)}</table>"


def accuracy(source: Volume | Source, moment: str = "REF", *, columns: int = 0, rows: int = 0, spacing_m: float = 0.0,
             levels_m: npt.ArrayLike | None = None, center: tuple[float, float] | None = None,
             average_in_z: bool = False, threads: int = 1, sample: int = 0, rounds: int = 0,
             **options: typing.Any) -> Table:
    """Measures on a volume, or a file, how exact and how fast each way of gridding (rung) is, and returns a Table with
    the rows of `stormcellar accuracy`. A row compares one rung of one step with the exact chain on the same gates:

    `step`, `rung` (from cheap to exact) and `name`; `time_s` of the first grid and `kept_time_s` of further ones;
    `position_max_m` and `position_rms_m`; `value_rms`, `value_p95`, `value_p99` and `value_max` in `value_unit`, over
    cells with a value in both grids; `status_disagreement`, the share of cells with another state; `pareto`, whether no
    other rung of the step is as fast and as exact. Unknown figures are NaN. The step "chain" has whole chains.

    `sample` columns (0: 2,000) are compared, and times are the fastest of `rounds` (0: 3). The other arguments are
    those of grid(); the usual grid takes 20 s. docs/accuracy.md explains the figures.

    >>> table = stormcellar.accuracy(FILE, columns=60, rows=60, spacing_m=4000, levels_m=[2000], sample=200, rounds=1)
    >>> [row["name"] for row in table if row["step"] == "interpolation"]
    ['nearest', 'linear up the column', 'eight-point', 'beam-weighted']
    """
    volume = volume_of("accuracy", source, options, moments=moment, threads=threads)
    asked = grid_options(moment, columns, rows, spacing_m, levels_m, center, None, False, average_in_z, threads)
    how = sized(_library.LadderOptions, columns=sample, rounds=rounds)
    pointer, count = ctypes.c_void_p(), ctypes.c_size_t()
    call("ladder_measure", volume._handle.pointer, ctypes.byref(asked), ctypes.byref(how), ctypes.byref(pointer),
         ctypes.byref(count))
    ladder = Handle("ladder", pointer)
    return Table(_row(ladder, i) for i in range(count.value))


def _row(ladder, index):
    facts = sized(_library.Rung)
    call("ladder_describe", ladder.pointer, index, ctypes.byref(facts))
    figures = {name: getattr(facts, name) for name, kind in facts._fields_ if kind is ctypes.c_double}
    return {"step": facts.step.decode(), "rung": facts.rung, "name": facts.name.decode(), **figures,
            "value_unit": facts.value_unit.decode(), "pareto": bool(facts.pareto)}


def _text(cell):
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)
