"""Opens a grid as a user would, with netCDF4 and with xarray, and checks what it says.

Usage: check_grid.py PROGRAM LEVEL2_FILE
Grids the file with PROGRAM and compares coordinates with formulae of their own (Vincenty's inverse
on WGS84), so that a wrong projection, axis or unit cannot pass.
"""
import json
import math
import subprocess
import sys
import tempfile

import netCDF4
import numpy as np
import xarray


def vincenty(lat1, lon1, lat2, lon2):
    """Distance in metres and azimuth in degrees on WGS84 (Vincenty 1975)."""
    a, f = 6378137.0, 1 / 298.257223563
    b = a * (1 - f)
    u1, u2 = (math.atan((1 - f) * math.tan(math.radians(x))) for x in (lat1, lat2))
    length = lam = math.radians(lon2 - lon1)
    for _ in range(100):
        s = math.hypot(math.cos(u2) * math.sin(lam),
                       math.cos(u1) * math.sin(u2) - math.sin(u1) * math.cos(u2) * math.cos(lam))
        c = math.sin(u1) * math.sin(u2) + math.cos(u1) * math.cos(u2) * math.cos(lam)
        sigma = math.atan2(s, c)
        sin_alpha = math.cos(u1) * math.cos(u2) * math.sin(lam) / s
        cos2_alpha = 1 - sin_alpha**2
        cos_2m = c - 2 * math.sin(u1) * math.sin(u2) / cos2_alpha
        k = f / 16 * cos2_alpha * (4 + f * (4 - 3 * cos2_alpha))
        new = length + (1 - k) * f * sin_alpha * (
            sigma + k * s * (cos_2m + k * c * (2 * cos_2m**2 - 1)))
        done = abs(new - lam) < 1e-14
        lam = new
        if done:
            break
    w2 = cos2_alpha * (a * a - b * b) / (b * b)
    big_a = 1 + w2 / 16384 * (4096 + w2 * (-768 + w2 * (320 - 175 * w2)))
    big_b = w2 / 1024 * (256 + w2 * (-128 + w2 * (74 - 47 * w2)))
    delta = big_b * s * (cos_2m + big_b / 4 * (
        c * (2 * cos_2m**2 - 1)
        - big_b / 6 * cos_2m * (4 * s * s - 3) * (4 * cos_2m**2 - 3)))
    azimuth = math.atan2(math.cos(u2) * math.sin(lam),
                         math.cos(u1) * math.sin(u2) - math.sin(u1) * math.cos(u2) * math.cos(lam))
    return b * big_a * (sigma - delta), math.degrees(azimuth) % 360


def check_coordinates(data, facts):
    assert data["REF"].dimensions == ("time", "z", "y", "x"), data["REF"].dimensions
    assert data["REF"].shape == (1, len(facts["levels_m"]), facts["ny"], facts["nx"])
    x, y, z = data["x"][:], data["y"][:], data["z"][:]
    for axis, count in ((x, facts["nx"]), (y, facts["ny"])):
        assert np.all(np.diff(axis) == facts["spacing_m"])
        assert axis[0] == -axis[-1] == -(count - 1) / 2 * facts["spacing_m"]
    assert list(z) == facts["levels_m"]
    assert data["z"].positive == "up" and data["z"].units == "m"
    mapping = data[data["REF"].grid_mapping]
    assert mapping.grid_mapping_name == "azimuthal_equidistant"
    center = mapping.latitude_of_projection_origin, mapping.longitude_of_projection_origin
    assert list(center) == facts["center"]
    assert mapping.semi_major_axis == 6378137.0
    assert abs(mapping.inverse_flattening - 298.257223563) < 1e-9
    lat, lon = data["lat"][:], data["lon"][:]
    for iy in range(0, len(y), 41):
        for ix in range(0, len(x), 37):
            arc, azimuth = vincenty(*center, lat[iy, ix], lon[iy, ix])
            assert abs(arc * math.sin(math.radians(azimuth)) - x[ix]) < 0.01
            assert abs(arc * math.cos(math.radians(azimuth)) - y[iy]) < 0.01
    time = netCDF4.num2date(data["time"][0], data["time"].units, data["time"].calendar)
    assert time.strftime("%Y-%m-%dT%H:%M:%S") == facts["time"][:19], (time, facts["time"])


def check_cells(data, facts):
    status = data["status"]
    names = status.flag_meanings.split()
    assert list(status.flag_values) == [0, 1, 2, 3]
    assert names == ["not_seen", "no_echo", "range_folded", "value"]
    cells = np.ma.getdata(status[:])
    for value, name in enumerate(names):
        assert np.count_nonzero(cells == value) == facts["cells"][name], name
    field = data["REF"][:]
    assert data["REF"].units == "dBZ"
    assert data["REF"].standard_name == "equivalent_reflectivity_factor"
    assert np.array_equal(np.ma.getmaskarray(field), cells != 3), "_FillValue for all but values"
    assert field.count() > 0
    assert -60 < field.min() and field.max() < 95


def check_xarray(path, facts):
    with xarray.open_dataset(path) as dataset:
        assert dataset.attrs["Conventions"] == "CF-1.8"
        assert dataset.attrs["source_files"] == facts["file"]
        assert str(dataset["time"].values[0])[:19] == facts["time"][:19]
        assert set(dataset["REF"].coords) >= {"time", "z", "y", "x", "lat", "lon"}
        valued = int(dataset["REF"].notnull().sum())
        assert valued == facts["cells"]["value"]
        strongest = dataset["REF"].max("z").isel(time=0).sel(x=0, y=0, method="nearest")
        assert strongest.dims == ()


def main():
    program, level2_file = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as directory:
        path = directory + "/out.nc"
        command = [program, "grid", level2_file, "-o", path, "--json"]
        facts = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
        with netCDF4.Dataset(path) as data:
            check_coordinates(data, facts)
            check_cells(data, facts)
        check_xarray(path, facts)


if __name__ == "__main__":
    main()
