"""Opens the Zarr stores of a grid with xarray and GDAL, and compares them with its netCDF file.

Usage: check_zarr.py PROGRAM LEVEL2_FILE
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import xarray
import zarr

has_version_3 = int(zarr.__version__.split(".")[0]) >= 3


def compare(store, netcdf):
    """Compares every variable and attribute. A store has one more flag, `unavailable`."""
    ours = xarray.open_zarr(store, mask_and_scale=False)
    theirs = xarray.open_dataset(netcdf)
    raw = xarray.open_dataset(netcdf, mask_and_scale=False)
    assert set(ours.variables) == set(theirs.variables), set(ours.variables) ^ set(theirs.variables)
    assert dict(ours.sizes) == dict(theirs.sizes)
    for name, variable in ours.variables.items():
        if variable.ndim == 0:
            continue  # the grid mapping has attributes only
        expected = theirs[name] if variable.dtype == np.float32 else raw[name]
        np.testing.assert_array_equal(variable.values, expected.values, err_msg=name)
    for name in ("stations", "source_files", "history", "vcp", "volume"):
        assert ours.attrs[name] == theirs.attrs[name], name
    for where, attributes in ((ours, theirs.attrs), (ours.VEL, theirs.VEL.attrs)):
        for name in ("method", "predicted_error", "beam_model", "long_name", "units"):
            assert where.attrs.get(name) == attributes.get(name), name
    assert ours.REF_status.attrs["flag_meanings"].split()[4] == "unavailable"
    assert ours.VEL.attrs["predicted_error"]
    print(f"{store.name}: {len(ours.variables)} variables of {ours.REF.size} cells are equal")


def look_with_gdal(store, netcdf):
    """Compares a level and its place on the earth."""
    tif = store.parent / "level.tif"
    # GDAL numbers the dimensions before rows and columns: time 0, level 3.
    subprocess.run(["gdal_translate", "-q", f'ZARR:"{store}":/REF:0:3', tif], check=True)
    theirs = xarray.open_dataset(netcdf)
    for column, row in ((100, 90), (150, 60), (120, 140)):
        place = theirs.isel(x=column, y=row)
        value = subprocess.run(
            ["gdallocationinfo", "-wgs84", "-valonly", tif, repr(float(place.lon)), repr(float(place.lat))],
            check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
        expected = float(place.REF[0, 3])
        assert float(value) == expected or (np.isnan(float(value)) and np.isnan(expected)), (value, expected)
    print("GDAL reads the same values at the same places")


def main(program, volume):
    with tempfile.TemporaryDirectory() as directory:
        directory = pathlib.Path(directory)
        for name in ("grid.nc", "grid.zarr", "grid.zarr3"):
            subprocess.run(
                [program, "grid", volume, "-o", directory / name, "--moment", "REF,VEL", "--tolerance", "250 m",
                 "--extent-km", "300,200", "--fields", "age"], check=True, stdout=subprocess.DEVNULL)
        compare(directory / "grid.zarr", directory / "grid.nc")
        if has_version_3:
            compare(directory / "grid.zarr3", directory / "grid.nc")
        else:
            print(f"grid.zarr3: not read, because zarr {zarr.__version__} has no version 3")
        if pathlib.Path("/usr/bin/gdal_translate").exists():
            look_with_gdal(directory / "grid.zarr", directory / "grid.nc")


main(*sys.argv[1:])
