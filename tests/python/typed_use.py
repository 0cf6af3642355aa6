"""A program whose types a type checker must accept (scripts/check-python)."""

import pathlib

import numpy as np
import numpy.typing as npt

import stormcellar


def strongest(path: pathlib.Path) -> dict[str, float]:
    volume = stormcellar.Volume(path, moments=["REF", "VEL"])
    reflectivity: npt.NDArray[np.float32] = volume.sweeps[0].moments["REF"].values()
    states: npt.NDArray[np.uint8] = volume.sweeps[0].moments["REF"].states()
    assert (np.isnan(reflectivity) == (states != stormcellar.State.value)).all()
    grid = stormcellar.grid(volume, levels_m=[1000.0, 2000.0], center=(35.3, -97.5))
    tree = stormcellar.open_datatree(path)
    derived: stormcellar.Volume = volume.derive("VELD", dealias="region")
    return {"grid": float(np.nanmax(grid.values())), "sweeps": len(derived.sweeps), "children": len(tree.children)}


def fetch(station: str) -> stormcellar.Volume | None:
    try:
        return stormcellar.Volume(station, time="1999-05-03T23:57Z")
    except stormcellar.Error as error:
        return None if error.code == "not_found" else stormcellar.Volume([b"", b""])
