"""Reads the layers of the map from the packages that hold them."""
import collections
import json
import math
import pathlib
import struct

import shapefile
import shapely.geometry
import shapely.ops

from . import lines

# Boxes that hold the area that US weather radars can see, and a margin: west, south, east, north.
REGIONS = [(-180, 6, -44, 76), (166, 44, 180, 76), (138, 4, 152, 24), (114, 18, 146, 48),
           (-38, 30, -16, 46)]
UNITED_STATES = "840"
GREAT_LAKES = (-92.7, 41.2, -75.9, 49.2)
INLAND_SHARE = 0.9  # a lake is inland if more than this share of it is within the Census' land
# An area of the United States that is not the Census' land belongs to a lake if it is within this distance of the lake.
NEAR_LAKE_DEG = 0.1
SLIVER_DEG = 0.012  # narrower water is left out, because it only shows that two sources differ
LEAST_LAKE_DEG2 = 0.002


def topology(path):
    with open(path, encoding="utf-8") as file:
        data = json.load(file)
    (sx, sy), (tx, ty) = data["transform"]["scale"], data["transform"]["translate"]
    arcs = []
    for arc in data["arcs"]:
        x = y = 0
        points = []
        for dx, dy in arc:
            x, y = x + dx, y + dy
            points.append((x * sx + tx, y * sy + ty))
        arcs.append(points)
    return arcs, data["objects"]


def arcs_of(geometry):
    polygons = geometry.get("arcs", [])
    if geometry.get("type") == "Polygon":
        polygons = [polygons]
    return [arc if arc >= 0 else ~arc for polygon in polygons for ring in polygon for arc in ring]


def owners(objects):
    found = collections.defaultdict(list)
    for geometry in objects["geometries"]:
        for arc in arcs_of(geometry):
            found[arc].append(geometry.get("id"))
    return found


def in_region(line):
    west, east = min(p[0] for p in line), max(p[0] for p in line)
    south, north = min(p[1] for p in line), max(p[1] for p in line)
    return any(west <= r[2] and east >= r[0] and south <= r[3] and north >= r[1] for r in REGIONS)


def in_box(line, box):
    return (min(p[0] for p in line) <= box[2] and max(p[0] for p in line) >= box[0] and
            min(p[1] for p in line) <= box[3] and max(p[1] for p in line) >= box[1])


def runs(line, wanted):
    """Returns the parts of a line whose segments are wanted."""
    run = []
    for one, other in zip(line, line[1:]):
        if wanted(one, other):
            run = run or [one]
            run.append(other)
        elif run:
            yield run
            run = []
    if run:
        yield run


def cut_to_regions(line):
    def inside(one, other):
        at_seam = abs(one[0]) > 179.99 and abs(other[0]) > 179.99
        return not at_seam and in_region([one, other])
    return list(runs(line, inside))


def polygons_of(path, name):
    """Returns (identifier, rings) for each polygon of an object; the first ring is the outline."""
    arcs, objects = topology(path)
    found = []
    for geometry in objects[name]["geometries"]:
        shape = geometry.get("arcs", [])
        for polygon in [shape] if geometry.get("type") == "Polygon" else shape:
            rings = []
            for ring in polygon:
                points = []
                for arc in ring:
                    piece = arcs[arc] if arc >= 0 else arcs[~arc][::-1]
                    points += piece if not points else piece[1:]
                rings.append(points)
            found.append((geometry.get("id"), rings))
    return found


def joined_shape(polygons):
    return shapely.ops.unary_union([shapely.geometry.Polygon(rings[0], rings[1:]).buffer(0)
                                    for _, rings in polygons])


def countries(directory):
    arcs, objects = topology(pathlib.Path(directory) / "countries-10m.json")
    border = []
    for arc, ids in sorted(owners(objects["countries"]).items()):
        if len(ids) != 1 and in_region(arcs[arc]):
            border.extend(cut_to_regions(arcs[arc]))
    return lines.joined(border)


def between_seams(ring):
    """Returns the ring, or if it crosses 180 degrees, its parts on both sides."""
    unrolled = [ring[0]]
    for lon, lat in ring[1:]:
        unrolled.append((lon - 360 * round((lon - unrolled[-1][0]) / 360), lat))
    west, east = min(p[0] for p in unrolled), max(p[0] for p in unrolled)
    if unrolled == ring or unrolled[0] != unrolled[-1]:
        return [ring]
    shape = shapely.geometry.Polygon(unrolled).buffer(0)
    found = []
    for turn in range(math.floor((west + 180) / 360), math.floor((east + 180) / 360) + 1):
        side = shapely.geometry.box(360 * turn - 180, -90, 360 * turn + 180, 90)
        for part in parts_of(shape.intersection(side)):
            found.append([(lon - 360 * turn, lat) for lon, lat in part.exterior.coords])
    return found


def land(directory):
    """Returns closed rings, with land to their left."""
    found = []
    for _, rings in polygons_of(pathlib.Path(directory) / "land-10m.json", "land"):
        for index, whole in enumerate(rings):
            for ring in between_seams(whole):
                if in_region(ring):
                    found.append(lines.turned(ring, index == 0))
    return found


def united_states(directory):
    """Returns the lines of counties and states: the segments that two counties share."""
    states = collections.defaultdict(list)  # the states of the counties on both sides of a segment
    with shapefile.Reader(str(pathlib.Path(directory) / "cb_2016_us_county_500k.shp")) as counties:
        for county in counties.iterShapeRecords():
            points = [(round(lon, 6), round(lat, 6)) for lon, lat in county.shape.points]
            starts = [*county.shape.parts, len(points)]
            for start, end in zip(starts, starts[1:]):
                for segment in zip(points[start:end], points[start + 1:end]):
                    if segment[0] != segment[1]:
                        states[tuple(sorted(segment))].append(county.record["STATEFP"])
    shared = [(list(segment), sides) for segment, sides in states.items() if len(sides) == 2]
    county = [segment for segment, sides in shared if sides[0] == sides[1]]
    state = [segment for segment, sides in shared if sides[0] != sides[1]]
    return lines.joined(county), lines.joined(state)


def roads(directory, name):
    """Returns the lines of a map file of GEMPAK. A file has blocks of 1024 bytes; the first is an index. A block begins
    with the number of its lines and a zero. A line has the number of its points, its box, a number that is not used,
    and the latitude and longitude of each point. All numbers are big-endian, of 4 bytes."""
    data = (pathlib.Path(directory) / name).read_bytes()
    found = []
    for block in range(1024, len(data), 1024):
        count, _ = struct.unpack_from(">ii", data, block)
        at = block + 8
        for _ in range(count):
            (points,) = struct.unpack_from(">i", data, at)
            degrees = [round(value, 3) for value in struct.unpack_from(f">{2 * points}f", data, at + 24)]
            found.append(list(zip(degrees[1::2], degrees[::2])))
            at += 24 + 8 * points
    return lines.joined([line for line in found if len(line) > 1])


def polylines(path):
    """Returns the lines of a file NAME.L of R's package maps: longitude and latitude as floats in radians."""
    data = pathlib.Path(path).read_bytes()
    count = struct.unpack_from("<ii", data)[1]
    for index in range(count):
        offset, points = struct.unpack_from("<II", data, 8 + 28 * index)
        radians = struct.unpack_from(f"<{2 * points}f", data, offset)
        degrees = [round(math.degrees(value), 5) for value in radians]
        yield list(zip(degrees[::2], degrees[1::2]))


def lakes_at_50m(path):
    """Returns the lakes of Natural Earth at 1:50 million. A ring within another ring is an island."""
    found = shapely.geometry.Polygon()
    for line in lines.joined(list(polylines(path))):
        if len(line) > 3 and line[0] == line[-1] and in_region(line):
            found = found.symmetric_difference(shapely.geometry.Polygon(line).buffer(0))
    return found


def parts_of(shape):
    return [part for part in getattr(shape, "geoms", [shape]) if part.geom_type == "Polygon"]


def lakes(options):
    """Returns closed rings, with water to their left. Uses the Census' shore where it has one."""
    drawn = lakes_at_50m(pathlib.Path(options.r_maps) / "lakes.L")
    nation = joined_shape(polygons_of(pathlib.Path(options.us_atlas) / "nation-10m.json", "nation"))
    box = shapely.geometry.box(*GREAT_LAKES)
    census = nation.intersection(box.buffer(1))
    path = pathlib.Path(options.world_atlas) / "countries-10m.json"
    whole = joined_shape([(name, rings) for name, rings in polygons_of(path, "countries")
                          if name == UNITED_STATES and in_box(rings[0], GREAT_LAKES)])
    whole = whole.intersection(box)
    water = []
    for lake in parts_of(drawn):
        covered = lake.intersection(census).area / lake.area
        if not lake.intersects(box) or covered > INLAND_SHARE:
            water.append(lake)
            continue
        missed = whole.intersection(lake.buffer(NEAR_LAKE_DEG)).difference(census)
        missed = missed.buffer(-SLIVER_DEG / 2).buffer(SLIVER_DEG / 2, join_style=2)
        water.append(lake.union(missed).difference(census).buffer(0))
    found = []
    for part in parts_of(shapely.ops.unary_union(water)):
        if part.area > LEAST_LAKE_DEG2:
            found.append(lines.turned(list(part.exterior.coords), True))
            found.extend(lines.turned(list(hole.coords), False) for hole in part.interiors)
    return found


def read_layers(options):
    county, state = united_states(options.counties)
    return {"coast": land(options.world_atlas), "country": countries(options.world_atlas),
            "county": county, "state": state, "lake": lakes(options),
            "interstate": roads(options.roads, "hiisus.nws"), "highway": roads(options.roads, "hiuhus.nws")}
