"""Reads the OpenVDB file of a grid with OpenVDB, and compares it with the netCDF file.

Usage: check_vdb.py PROGRAM LEVEL2_FILE
"""
import pathlib
import subprocess
import sys
import tempfile

import netCDF4
import numpy as np
import pyopenvdb


def dense(grid, shape):
    """Returns the values and which voxels are active, with the dimensions z, y, x."""
    values = np.full(shape[::-1], grid.background, np.float32)
    grid.copyToArray(values)
    active = np.zeros(shape[::-1], np.float32)
    mask = pyopenvdb.FloatGrid(0)
    for item in grid.citerOnValues():
        mask.fill(item.min, item.max, 1)
    mask.copyToArray(active)
    return values.T, active.T > 0


def check_moment(moment, grids, metadata, file):
    values, active = dense(grids[moment], file[moment][0].shape)
    expected = file[moment][0]
    assert np.array_equal(active, ~np.ma.getmaskarray(expected)), moment
    assert np.array_equal(values[active], expected.compressed()), moment
    assert (values[~active] == grids[moment].background).all()
    states, _ = dense(grids[moment + "_status"], file[moment][0].shape)
    assert np.array_equal(states, file[moment + "_status"][0]), moment
    of_file = file[moment]
    for name in ("method", "predicted_error", "units"):
        assert metadata[moment][name] == getattr(of_file, name), name
    assert metadata[moment]["stations"] == file.stations and metadata[moment]["time"].endswith("Z")
    nz, ny, nx = expected.shape
    for k, j, i in ((0, 0, 0), (nz - 1, ny - 1, nx - 1), (3, 5, 7)):
        world = grids[moment].transform.indexToWorld((i, j, k))
        assert np.allclose(world, (file["x"][i], file["y"][j], file["z"][k]), atol=1e-6), world
    print(f"{moment}: {values.size} voxels are equal, {active.sum()} active")


def main(program, volume):
    with tempfile.TemporaryDirectory() as directory:
        directory = pathlib.Path(directory)
        for name in ("grid.nc", "grid.vdb"):
            subprocess.run(
                [program, "grid", volume, "-o", directory / name, "--moment", "REF,VEL", "--tolerance", "250 m",
                 "--extent-km", "140,100"], check=True, stdout=subprocess.DEVNULL)
        all_grids, _ = pyopenvdb.readAll(str(directory / "grid.vdb"))
        grids = {grid.name: grid for grid in all_grids}
        assert set(grids) == {"REF", "REF_status", "VEL", "VEL_status"}
        metadata = {grid.name: grid.metadata for grid in pyopenvdb.readAllGridMetadata(str(directory / "grid.vdb"))}
        file = netCDF4.Dataset(directory / "grid.nc")
        for moment in ("REF", "VEL"):
            check_moment(moment, grids, metadata, file)
        alone = pyopenvdb.read(str(directory / "grid.vdb"), "VEL")
        assert alone.activeVoxelCount() == grids["VEL"].activeVoxelCount()


main(*sys.argv[1:])
