"""Reads products in GRIB2 with GDAL, and compares them with their netCDF files.

Usage: check_grib.py PROGRAM LEVEL2_FILE
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import netCDF4
import numpy as np

# The product, its options, category and number in WMO's table 4.2, and the factor from our unit to WMO's.
PRODUCTS = (
    ("composite", [], "16 5", 1),
    ("cappi", ["--height-km", "2"], "16 4", 1),
    ("echotop", [], "16 3", 1000),
    ("vil", [], "15 3", 1),
    ("mesh", [], "1 31", 0.001),
)


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def band_of(grib, number):
    """Returns the numbers of a band, from the south, and the coordinates that GDAL gives to them."""
    text = grib.with_suffix(".xyz")
    run("gdal_translate", "-q", "-of", "XYZ", "-b", number, grib, text)
    x, y, values = np.loadtxt(text, unpack=True)
    width = len(np.unique(x))
    order = np.lexsort((x, y))
    return x[order].reshape(-1, width), y[order].reshape(-1, width), values[order].reshape(-1, width)


def check(program, volume, directory, projection, product, options, parameter, factor):
    grib, netcdf = directory / f"{product}.grib2", directory / f"{product}.nc"
    shape = ["--projection", projection, "--extent-km", "200,160", "--product", product, *options]
    for path in (grib, netcdf):
        run(program, "frame", volume, "-o", path, *shape)
    facts = json.loads(subprocess.run(["gdalinfo", "-json", grib], check=True, stdout=subprocess.PIPE).stdout)
    described = facts["bands"][0]["metadata"][""]
    assert described["GRIB_DISCIPLINE"].startswith("0"), described
    assert described["GRIB_PDS_TEMPLATE_NUMBERS"].startswith(parameter + " "), described
    assert "Processed_radar_observations" in described["GRIB_IDS"], described
    file = netCDF4.Dataset(netcdf)
    name = product if product != "echotop" else "echo_top"
    name = next(known for known in (name, product) if known in file.variables)
    ours = file[name][0]
    x, y, values = band_of(grib, 1)
    _, _, states = band_of(grib, 2)
    is_missing = np.ma.getmaskarray(ours)
    assert not is_missing.all(), "the product has no value here"
    expected = ours.filled(0) * factor
    span = expected[~is_missing].max() - expected[~is_missing].min()
    assert np.abs(values - expected)[~is_missing].max() <= span / 60_000, product
    assert (values[is_missing] == facts["bands"][0]["noDataValue"]).all()
    assert np.array_equal(states, file["status"][0])
    if projection == "latitude_longitude":
        assert np.abs(x[0] - file["lon"][:]).max() < 1e-4 and np.abs(y[:, 0] - file["lat"][:]).max() < 1e-4
    text = grib.read_bytes()
    for word in (b"gridding: ", b"gridding_error: ", b"status: 0 not_seen, 1 no_echo"):
        assert word in text, word
    print(f"{projection} {product}: {values.size} columns are equal, {grib.stat().st_size} bytes")


def main(program, volume):
    with tempfile.TemporaryDirectory() as directory:
        for projection in ("latitude_longitude", "lambert_conformal"):
            for case in PRODUCTS:
                check(program, volume, pathlib.Path(directory), projection, *case)


main(*sys.argv[1:])
