"""The layers of the map, out of the packages that hold them."""
import collections
import json
import math
import pathlib
import struct

from . import lines

# What US weather radars can see, and some way about it: west, south, east, north.
REGIONS = [(-180, 15.5, -50, 74), (170, 48, 180, 74), (141, 9, 150, 20), (122, 22, 136, 44),
           (-34, 34, -21, 43)]
GREAT_LAKES = (-92.7, 41.2, -75.9, 49.2)
SAME_LINE_M = 1500  # nearer than this, a shore of the Census is a line of Natural Earth's at 1:10 million
SAME_SHORE_M = 5000  # the same between the Census' shores and those of Natural Earth at 1:50 million


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


def runs(line, wanted):
    """The parts of a line whose segments are wanted."""
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


def countries(directory):
    arcs, objects = topology(pathlib.Path(directory) / "countries-10m.json")
    coast, border = [], []
    for arc, ids in sorted(owners(objects["countries"]).items()):
        if in_region(arcs[arc]):
            (coast if len(ids) == 1 else border).extend(cut_to_regions(arcs[arc]))
    return lines.joined(coast), lines.joined(border)


class Nearness:
    """Whether a point is within some metres of lines in a box (west, south, east, north)."""

    CELLS_PER_DEGREE = 10

    def __init__(self, lines_, box, distance_m):
        self.distance_m = distance_m
        self.cells = collections.defaultdict(list)
        for line in lines_:
            for one, other in zip(line, line[1:]):
                if box[0] <= one[0] <= box[2] and box[1] <= one[1] <= box[3]:
                    steps = 1 + int(200 * max(abs(one[0] - other[0]), abs(one[1] - other[1])))
                    for i in range(steps):
                        x = one[0] + (other[0] - one[0]) * i / steps
                        y = one[1] + (other[1] - one[1]) * i / steps
                        self.cells[self.cell(x, y)].append((x, y))

    def cell(self, x, y):
        return (math.floor(x * self.CELLS_PER_DEGREE), math.floor(y * self.CELLS_PER_DEGREE))

    def is_near(self, point):
        east = lines.METRES_PER_DEGREE * math.cos(math.radians(point[1]))
        cx, cy = self.cell(*point)
        return any(math.hypot((x - point[0]) * east,
                              (y - point[1]) * lines.METRES_PER_DEGREE) < self.distance_m
                   for i in (-1, 0, 1) for j in (-1, 0, 1)
                   for x, y in self.cells.get((cx + i, cy + j), ()))


def united_states(directory, border):
    """Counties, states, and the shores of the Great Lakes, where the Census' counties end."""
    arcs, objects = topology(pathlib.Path(directory) / "counties-10m.json")
    county, state, shore = [], [], []
    near = Nearness(border, GREAT_LAKES, SAME_LINE_M)
    box = GREAT_LAKES

    def is_shore(one, other):
        return all(box[0] < p[0] < box[2] and box[1] < p[1] < box[3] and not near.is_near(p)
                   for p in (one, other))

    for arc, ids in sorted(owners(objects["counties"]).items()):
        if len(ids) == 1:
            shore.extend(runs(arcs[arc], is_shore))
        elif ids[0][:2] == ids[1][:2]:
            county.append(arcs[arc])
        else:
            state.append(arcs[arc])
    return lines.joined(county), lines.joined(state), lines.joined(shore)


def polylines(path):
    """The lines of a file NAME.L of R's package maps: longitude and latitude as floats in radians."""
    data = pathlib.Path(path).read_bytes()
    count = struct.unpack_from("<ii", data)[1]
    for index in range(count):
        offset, points = struct.unpack_from("<II", data, 8 + 28 * index)
        radians = struct.unpack_from(f"<{2 * points}f", data, offset)
        degrees = [round(math.degrees(value), 5) for value in radians]
        yield list(zip(degrees[::2], degrees[1::2]))


def lakes(directory, coast, shore):
    """Natural Earth's large lakes, without what the finer coast and shore already have."""
    box = (-180, 15, -50, 74)
    known = Nearness(coast + shore, box, SAME_SHORE_M)

    def is_new(one, other):
        return not known.is_near(one) and not known.is_near(other)

    found = []
    for line in polylines(pathlib.Path(directory) / "lakes.L"):
        for part in cut_to_regions(line):
            found.extend(runs(part, is_new))
    return lines.joined(found)


def read_layers(options):
    coast, border = countries(options.world_atlas)
    county, state, shore = united_states(options.us_atlas, border)
    return {"coast": coast, "country": border, "county": county, "state": state,
            "lake": shore + lakes(options.r_maps, coast, shore)}
