"""Finds the real volumes and the command line, and makes a catalog and a cache with it."""

import os
import pathlib
import shutil
import subprocess

BESIDE = pathlib.Path(__file__).resolve().parents[2].parent / "shared" / "data"
DATA = os.environ.get("STORMCELLAR_DATA") or (BESIDE if BESIDE.is_dir() else None)
PROGRAM = os.environ.get("STORMCELLAR_PROGRAM")


def run(*arguments):
    subprocess.run([PROGRAM, *arguments], check=True, capture_output=True)


def make_catalog(folder, files):
    """Copies the files into a drop directory, catalogs them, and returns the directory of the catalog."""
    drop, catalog = pathlib.Path(folder) / "drop", pathlib.Path(folder) / "catalog"
    drop.mkdir()
    for file in files:
        shutil.copy(file, drop)
    run("catalog", "rebuild", "--catalog", catalog, "--drop", drop)
    return catalog


def make_cache(folder, files, start, end, spacing_km=4):
    """Grids the files, and returns the directory of the cache."""
    source, plan = pathlib.Path(folder) / "source", pathlib.Path(folder) / "plan"
    source.mkdir()
    for file in files:
        shutil.copy(file, source)
    run("batch", "plan", "--source", source, "--from", start, "--to", end, "--spacing-km", str(spacing_km),
        "-o", plan)
    run("batch", "run", "--plan", plan, "--task", "0")
    return plan / "cache"
