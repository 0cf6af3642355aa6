"""Compares the counts and weights of a mosaic, as a user reads them, with each site alone.

Usage: check_mosaic.py PROGRAM LEVEL2_FILE LEVEL2_FILE...
Grids all files together with PROGRAM, and each file alone on the same columns. The grids of single
files show how many sites see a cell. Weights are computed from distances by Vincenty's inverse
(check_grid.py).
"""
import json
import subprocess
import sys
import tempfile

import netCDF4
import numpy as np
import xarray

from check_grid import vincenty

COLUMNS = ["--center", "41.8,-75", "--extent-km", "640,640", "--spacing-km", "8",
           "--levels-km", "1,2,4,8"]


def make(program, files, path, options):
    command = [program, "grid", *files, "-o", path, "--json", *COLUMNS, *options]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def seen_alone(program, file, path):
    make(program, [file], path, [])
    with netCDF4.Dataset(path) as data:
        site = (float(data.station_latitude_deg), float(data.station_longitude_deg))
        return site, np.ma.getdata(data["status"][0]) != 0


def arcs(site, data):
    """Returns the distance from a site to every column, in meters."""
    lat, lon = data["lat"][:], data["lon"][:]
    return np.array([[vincenty(*site, lat[j, i], lon[j, i])[0] for i in range(lat.shape[1])]
                     for j in range(lat.shape[0])])


def check(data, alone, weight_of):
    assert data["REF"].ancillary_variables == "status site_count site_weight"
    count, weight = data["site_count"], data["site_weight"]
    assert count.dtype == np.int16 and weight.dtype == np.float32
    for variable in (count, weight):
        assert variable.dimensions == ("time", "z", "y", "x") and variable.units == "1"
        assert variable.long_name and variable.grid_mapping == data["REF"].grid_mapping
        assert not np.ma.is_masked(variable[:]), "0 where no site sees a cell"
    assert count.standard_name == "number_of_observations"
    expected = sum(seen.astype(int) for _, seen in alone)
    counts = np.ma.getdata(count[0])
    assert np.array_equal(counts, expected)
    assert np.array_equal(counts > 0, np.ma.getdata(data["status"][0]) != 0)
    assert set(np.unique(counts)) >= {0, 1, 2}, "the sites overlap, and not everywhere"
    weights = sum(np.where(seen, weight_of(arcs(site, data)), 0.0) for site, seen in alone)
    worst = np.abs(np.ma.getdata(weight[0]) - weights).max()
    assert worst <= 2**-11 + 1e-4, worst


def main():
    program, files = sys.argv[1], sys.argv[2:]
    with tempfile.TemporaryDirectory() as directory:
        path = directory + "/out.nc"
        alone = [seen_alone(program, file, path) for file in files]
        for options, weight_of in (
                ([], lambda arc: np.exp(-(arc / 250e3)**2)),
                (["--overlap-km", "100"], lambda arc: np.exp(-(arc / 100e3)**2)),
                (["--overlap", "mean"], np.ones_like)):
            facts = make(program, files, path, ["--fields", "counts,weights", *options])
            assert facts["fields"] == ["counts", "weights"]
            with netCDF4.Dataset(path) as data:
                check(data, alone, weight_of)
        make(program, files, path, [])
        with xarray.open_dataset(path) as dataset:
            assert "site_count" not in dataset and "site_weight" not in dataset


if __name__ == "__main__":
    main()
