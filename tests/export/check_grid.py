"""Opens a grid as a user would, with netCDF4 and with xarray, and checks its content.

Usage: check_grid.py PROGRAM LEVEL2_FILE
Grids the file with PROGRAM and compares coordinates with independent formulas (Vincenty's inverse
on WGS84), so that a wrong projection, axis or unit cannot pass.
"""
import json
import math
import shutil
import subprocess
import sys
import tempfile

import netCDF4
import numpy as np
import xarray


def vincenty(lat1, lon1, lat2, lon2):
    """Returns the distance in meters and the azimuth in degrees on WGS84 (Vincenty 1975)."""
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


def snyder_lambert(mapping, lat, lon):
    """Returns x and y on the cone of the CF attributes (Snyder 1987, eqs 14-15, 15-7 to 15-11)."""
    f = 1 / mapping.inverse_flattening
    e = math.sqrt(f * (2 - f))

    def m(deg):
        return math.cos(math.radians(deg)) / math.sqrt(1 - (e * math.sin(math.radians(deg)))**2)

    def t(deg):
        s = e * np.sin(np.radians(deg))
        return np.tan(math.pi / 4 - np.radians(deg) / 2) / ((1 - s) / (1 + s))**(e / 2)

    parallels = np.atleast_1d(mapping.standard_parallel)
    first, last = float(parallels[0]), float(parallels[-1])
    if first == last:
        n = math.sin(math.radians(first))
    else:
        n = math.log(m(first) / m(last)) / math.log(t(first) / t(last))
    scale = mapping.semi_major_axis * m(first) / (n * t(first)**n)
    rho, origin = scale * t(lat)**n, scale * t(mapping.latitude_of_projection_origin)**n
    theta = n * np.radians(lon - mapping.longitude_of_central_meridian)
    return rho * np.sin(theta), origin - rho * np.cos(theta)


def check_azimuthal(data, mapping, facts):
    center = mapping.latitude_of_projection_origin, mapping.longitude_of_projection_origin
    assert list(center) == facts["center"]
    x, y, lat, lon = (data[name][:] for name in ("x", "y", "lat", "lon"))
    for iy in range(0, len(y), 41):
        for ix in range(0, len(x), 37):
            arc, azimuth = vincenty(*center, lat[iy, ix], lon[iy, ix])
            assert abs(arc * math.sin(math.radians(azimuth)) - x[ix]) < 0.01
            assert abs(arc * math.cos(math.radians(azimuth)) - y[iy]) < 0.01


def check_lambert(data, mapping, facts):
    assert list(np.unique(mapping.standard_parallel)) == list(np.unique(facts["parallels_deg"]))
    center = mapping.latitude_of_projection_origin, mapping.longitude_of_central_meridian
    assert list(center) == facts["center"]
    x, y = snyder_lambert(mapping, data["lat"][:], data["lon"][:])
    assert np.abs(x - data["x"][:][np.newaxis, :]).max() < 1e-5
    assert np.abs(y - data["y"][:][:, np.newaxis]).max() < 1e-5


def check_degrees(data, facts):
    assert not {"x", "y"} & set(data.variables) and "coordinates" not in data["REF"].ncattrs()
    for name, count, center, units, standard in (
            ("lat", facts["ny"], facts["center"][0], "degrees_north", "latitude"),
            ("lon", facts["nx"], facts["center"][1], "degrees_east", "longitude")):
        assert data[name].dimensions == (name,)
        assert data[name].units == units and data[name].standard_name == standard
        expected = center + (np.arange(count) - (count - 1) / 2) * facts["spacing_deg"]
        assert np.abs(data[name][:] - expected).max() < 1e-10


def axes(in_degrees):
    return ("lat", "lon") if in_degrees else ("y", "x")


def check_coordinates(data, facts):
    in_degrees = facts["projection"] == "latitude_longitude"
    assert data["REF"].dimensions == ("time", "z", *axes(in_degrees)), data["REF"].dimensions
    assert data["REF"].shape == (1, len(facts["levels_m"]), facts["ny"], facts["nx"])
    assert list(data["z"][:]) == facts["levels_m"]
    assert data["z"].positive == "up" and data["z"].units == "m"
    assert data["status"].grid_mapping == data["REF"].grid_mapping
    mapping = data[data["REF"].grid_mapping]
    assert mapping.semi_major_axis == 6378137.0
    assert abs(mapping.inverse_flattening - 298.257223563) < 1e-9
    expected = {"lambert_conformal": "lambert_conformal_conic"}
    name = expected.get(facts["projection"], facts["projection"])
    assert mapping.grid_mapping_name == name, mapping.grid_mapping_name
    if name == "latitude_longitude":
        check_degrees(data, facts)
    else:
        for axis, count in ((data["x"], facts["nx"]), (data["y"], facts["ny"])):
            assert axis.units == "m" and axis.standard_name.startswith("projection_")
            assert np.all(np.diff(axis[:]) == facts["spacing_m"])
            assert axis[0] == -axis[-1] == -(count - 1) / 2 * facts["spacing_m"]
        check = check_azimuthal if name == "azimuthal_equidistant" else check_lambert
        check(data, mapping, facts)
        assert np.abs(np.diff(data["lon"][:], axis=1)).max() < 1, "continuous"
    time = netCDF4.num2date(data["time"][0], data["time"].units, data["time"].calendar)
    assert time.strftime("%Y-%m-%dT%H:%M:%S") == facts["frame_time"][:19], (time, facts)


def places(dataset):
    """Returns the latitude and longitude of every column."""
    lat, lon = dataset["lat"].values, dataset["lon"].values
    return (lat, lon) if lat.ndim == 2 else np.meshgrid(lat, lon, indexing="ij")


def middle_of_storms(path, site):
    """Returns the mean place of strong echo at 3 km, near the site, on any projection."""
    with xarray.open_dataset(path) as dataset:
        lat, lon = places(dataset)
        field = dataset["REF"].isel(time=0).sel(z=3000, method="nearest").values
        north = lat - site[0]
        east = (lon - site[1]) * np.cos(np.radians(lat))
        near = np.hypot(north, east) < 1.2
        weight = np.where(near & (field > 30), field - 30, 0)
        # Cells in degrees are smaller in the north, so weigh them by their area.
        if dataset["lat"].ndim == 1:
            weight = weight * np.cos(np.radians(lat))
        if weight.sum() == 0:
            return None
        return np.sum(weight * lat) / weight.sum(), np.sum(weight * lon) / weight.sum()


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
        assert str(dataset["time"].values[0])[:19] == facts["frame_time"][:19]
        in_degrees = facts["projection"] == "latitude_longitude"
        rows, columns = axes(in_degrees)
        assert set(dataset["REF"].coords) >= {"time", "z", "lat", "lon", rows, columns}
        assert dataset["lat"].dims == ((rows,) if in_degrees else (rows, columns))
        assert set(dataset.indexes) == {"time", "z", rows, columns}
        valued = int(dataset["REF"].notnull().sum())
        assert valued == facts["cells"]["value"]
        middle = facts["center"] if in_degrees else (0, 0)
        strongest = dataset["REF"].max("z").isel(time=0).sel(
            {rows: middle[0], columns: middle[1]}, method="nearest")
        assert strongest.dims == ()


DETAILS = {"age": "s", "beam_height_offset": "m", "gate_distance": "m", "sample_weight": "1"}


def check_details(program, level2_file, path):
    """Checks the details of cells, for a frame time ten minutes after the volume began."""
    plain = make(program, level2_file, path, [])
    with netCDF4.Dataset(path) as data:
        assert not set(DETAILS) & set(data.variables), "nothing that was not asked for"
        assert data["time"].long_name == "start of the volume"
        field = np.ma.getdata(data["REF"][:]).copy()
    frame = np.datetime64(plain["time"][:19]) + np.timedelta64(600, "s")
    make(program, level2_file, path, ["--fields", "all"])
    with netCDF4.Dataset(path) as data:
        assert np.array_equal(np.ma.getdata(data["REF"][:]), field)
        seen = np.ma.getdata(data["status"][:]) != 0
        since_start = data["age"][:]
    facts = make(program, level2_file, path,
                 ["--fields", "age,height_offset,distance,weight", "--time", f"{frame}Z"])
    assert facts["frame_time"] == f"{frame}Z" and facts["time"] == plain["time"]
    with netCDF4.Dataset(path) as data:
        assert data["time"].long_name == "frame time"
        assert data["REF"].ancillary_variables.split() == ["status", *DETAILS]
        for name, units in DETAILS.items():
            assert data[name].dimensions == ("time", "z", "y", "x")
            assert data[name].units == units and data[name].long_name
            assert data[name].grid_mapping == data["REF"].grid_mapping
            assert np.array_equal(~np.ma.getmaskarray(data[name][:]), seen), name
        age, offset, distance, weight = (data[name][:] for name in DETAILS)
        assert f"{frame}Z" in data["age"].comment
        # Neither volume repeats a cut, so the same sweeps are used for any frame time. The start of
        # a volume may have milliseconds.
        assert np.abs(since_start - age - 600).max() < 1.01
        start, end = (np.datetime64(data.getncattr("time_coverage_" + name).rstrip("Z"))
                      for name in ("start", "end"))
        assert age.min() >= (start - frame) / np.timedelta64(1, "s") - 0.01
        assert age.max() <= (end - frame) / np.timedelta64(1, "s") + 0.01
        assert weight.min() >= 0.499 and weight.max() <= 1 and np.ma.median(weight) == 1
        assert (np.abs(offset) < 8000).all() and offset.min() < -100 and offset.max() > 100
        assert distance.min() >= 0 and np.ma.median(distance) > 50
        # The nearest gate is no farther than the nearest beam plus half a radial's width.
        x, y = np.meshgrid(data["x"][:], data["y"][:])
        half_m = np.hypot(x, y) * math.radians(0.75) + 600
        assert (distance <= np.abs(offset) * 1.01 + half_m).all()


def check_moments(program, level2_file, path):
    """Checks that the file of all moments has the content of each moment's own file."""
    options = ["--extent-km", "120,120", "--fields", "age"]
    facts = make(program, level2_file, path, ["--moment", "all", *options])
    names = [one["moment"] for one in facts["moments"]]
    assert len(names) >= 3 and names[0] == "REF", names
    single = path + ".single.nc"
    with netCDF4.Dataset(path) as data, xarray.open_dataset(path) as dataset:
        assert data.title.split()[1:-2] == names, data.title
        for one in facts["moments"]:
            name = one["moment"]
            alone = make(program, level2_file, single, ["--moment", name, *options])
            assert {key: alone[key] for key in one} == one
            assert data[name].ancillary_variables.split() == [f"{name}_status", f"{name}_age"]
            assert data[name].method == one["method"]
            assert {"time", "z", "y", "x", "lat", "lon"} <= set(dataset[name].coords)
            with netCDF4.Dataset(single) as of_one:
                for together, apart in (
                        (name, name), (f"{name}_status", "status"), (f"{name}_age", "age")):
                    assert data[together].dtype == of_one[apart].dtype
                    assert np.array_equal(np.ma.getdata(data[together][:]),
                                          np.ma.getdata(of_one[apart][:])), together
                assert set(of_one[name].ncattrs()) <= set(data[name].ncattrs())
                assert not {"method", "predicted_error"} & set(of_one[name].ncattrs())
                for variable in ("time", "x", "y", "z", "lat", "lon"):
                    assert np.array_equal(data[variable][:], of_one[variable][:])
    listed = make(program, level2_file, path, ["--moment", f"{names[1]},REF", *options])
    assert [one["moment"] for one in listed["moments"]] == ["REF", names[1]]


def check_maps(program, level2_file, path, options):
    """Compares the GeoTIFF of a map, read by GDAL, with the column maxima of the netCDF."""
    make(program, level2_file, path, options)
    raster = path + ".tif"
    subprocess.run([program, "frame", level2_file, "--product", "composite", "-o", raster, *options],
                   check=True, stderr=subprocess.DEVNULL)
    facts = json.loads(subprocess.run(["gdalinfo", "-json", raster], check=True,
                                      capture_output=True).stdout)
    subprocess.run(["gdal_translate", "-q", "-of", "ENVI", raster, path + ".raw"], check=True)
    west, step_x, _, north, _, step_y = facts["geoTransform"]
    with xarray.open_dataset(path) as dataset:
        rows, columns = dataset["REF"].dims[2:]
        highest = dataset["REF"].isel(time=0).max("z").values[::-1]
        found = np.fromfile(path + ".raw", dtype="<f4").reshape(highest.shape)
        assert np.array_equal(np.isnan(found), np.isnan(highest))
        # Pictures use grids as stored in the cache: reflectivity in steps of half a decibel.
        assert np.nanmax(np.abs(found - highest)) <= 0.2501
        assert np.isfinite(found).sum() > 0
        fields = path + ".map.nc"
        subprocess.run([program, "frame", level2_file, "--product", "composite", "-o", fields,
                        *options], check=True, stderr=subprocess.DEVNULL)
        with xarray.open_dataset(fields) as field:
            assert field["composite"].dims[1:] == (rows, columns)
            written = field["composite"].isel(time=0).values[::-1]
            assert np.array_equal(written, found, equal_nan=True)
            assert np.array_equal(field["status"].isel(time=0).values[::-1] == 3,
                                  np.isfinite(found))
            assert np.array_equal(field[columns], dataset[columns])
        half = abs(step_x) / 2
        assert abs(west + half - float(dataset[columns][0])) < 1e-6 * half
        assert abs(north - half - float(dataset[rows][-1])) < 1e-6 * half
        assert abs(step_x + step_y) < 1e-12 * step_x
    corners = json.loads(subprocess.run(
        ["gdalinfo", "-json", overlay_of(program, level2_file, path, options)], check=True,
        capture_output=True).stdout)["cornerCoordinates"]
    with xarray.open_dataset(path) as dataset:
        lat, lon = places(dataset)
    # The overlay reaches half a cell beyond the outermost centers.
    for edge, inside in ((corners["upperLeft"][1], lat.max()),
                         (-corners["lowerRight"][1], -lat.min()),
                         (-corners["upperLeft"][0], -lon.min()),
                         (corners["lowerRight"][0], lon.max())):
        assert 0 < edge - inside < 0.01, (edge, inside)


def overlay_of(program, level2_file, path, options):
    overlay = path + ".kmz"
    subprocess.run([program, "frame", level2_file, "--product", "composite", "-o", overlay,
                    *options], check=True, stderr=subprocess.DEVNULL)
    return overlay


def make(program, level2_file, path, options):
    command = [program, "grid", level2_file, "-o", path, "--json", *options]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def main():
    program, level2_file = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as directory:
        path = directory + "/out.nc"
        site = make(program, level2_file, path, [])["center"]
        off_site = f"{site[0] + 0.4:.3f},{site[1] - 0.5:.3f}"
        echoes = []
        for options in (
                [],
                ["--center", off_site],
                ["--projection", "lat-lon"],
                ["--projection", "latlon", "--center", off_site, "--spacing-deg", "0.01",
                 "--extent-deg", "5,4"],
                ["--projection", "lambert"],
                ["--projection", "lcc", "--center", off_site, "--parallels", "33,45"]):
            facts = make(program, level2_file, path, options)
            with netCDF4.Dataset(path) as data:
                check_coordinates(data, facts)
                check_cells(data, facts)
            check_xarray(path, facts)
            echoes.append(middle_of_storms(path, site))
        check_details(program, level2_file, path)
        check_moments(program, level2_file, path)
        if shutil.which("gdalinfo"):
            for projection in ("aeqd", "lat-lon", "lambert"):
                check_maps(program, level2_file, path, ["--projection", projection])
        # The storms are at the same places on every map, within a cell.
        stormy = facts["cells"]["value"] > 0.02 * facts["nx"] * facts["ny"] * len(facts["levels_m"])
        assert not stormy or None not in echoes
        for lat, lon in [place for place in echoes[1:] if place]:
            arc, _ = vincenty(*echoes[0], lat, lon)
            assert arc < 1000, (echoes, arc)
        for options in (["--projection", "lat-lon"], ["--projection", "lambert"], []):
            facts = make(program, level2_file, path,
                         ["--center", "13.45,179.98", "--extent-km", "60,40", *options])
            with netCDF4.Dataset(path) as data:
                check_coordinates(data, facts)
            assert facts["cells"]["value"] == 0


if __name__ == "__main__":
    main()
