"""Reads the Level II files of weather radars (NEXRAD, TDWR) as NumPy arrays and xarray datasets.

    >>> import stormcellar
    >>> volume = stormcellar.Volume(FILE)
    >>> volume.station
    'KTLX'
    >>> volume.sweeps[0].moments["REF"].values().shape
    (367, 460)

Volume needs only NumPy; open_volume(), open_datatree() and open_archive() need xarray. All work is done by the
library libstormcellar.so.0, which releases the interpreter's lock.
"""

import importlib
import typing

from ._library import Error, version
from .accuracies import Table, accuracy
from .caches import Cache
from .catalogs import Catalog, CatalogEntry
from .grids import CellState, Grid, grid, mosaic
from .pictures import Picture, draw
from .volume import Moment, State, Sweep, Volume

if typing.TYPE_CHECKING:
    from .archives import open_archive
    from .trees import open_datatree, open_volume

__all__ = ["Cache", "Catalog", "CatalogEntry", "CellState", "Error", "Grid", "Moment", "Picture", "State", "Sweep",
           "Table", "Volume", "accuracy", "draw", "grid", "mosaic", "open_archive", "open_datatree", "open_volume",
           "version"]


def __getattr__(name: str) -> typing.Any:
    """Imports xarray only when a function that needs it is used."""
    module = {"open_archive": "archives", "open_datatree": "trees", "open_volume": "trees"}.get(name)
    if module:
        return getattr(importlib.import_module(f".{module}", __name__), name)
    raise AttributeError(f"module 'stormcellar' has no attribute '{name}'")
