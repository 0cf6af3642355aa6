"""Reads the list of cities, and checks each city of the United States against its county."""
import csv
import math
import pathlib

from . import lines, sources

AT_MOST_KM = 4  # a city may be this far outside its county, because the lines of counties are simplified


def rings_of(directory):
    arcs, objects = sources.topology(pathlib.Path(directory) / "counties-10m.json")
    found = {}
    for geometry in objects["counties"]["geometries"]:
        polygons = geometry.get("arcs", [])
        if geometry.get("type") == "Polygon":
            polygons = [polygons]
        rings = []
        for polygon in polygons:
            for ring in polygon:
                points = []
                for arc in ring:
                    points += arcs[arc] if arc >= 0 else arcs[~arc][::-1]
                rings.append(points)
        found.setdefault(geometry.get("properties", {}).get("name"), []).append(rings)
    return found


def km_outside(point, rings):
    """Returns the distance in km from the point to the nearest segment of the rings, or 0 if the rings enclose the point."""
    inside = False
    nearest = math.inf
    east = lines.METRES_PER_DEGREE * math.cos(math.radians(point[1])) / 1000
    north = lines.METRES_PER_DEGREE / 1000
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
            if (ay > point[1]) != (by > point[1]):
                inside ^= point[0] < ax + (point[1] - ay) * (bx - ax) / (by - ay)
            px, py = (point[0] - ax) * east, (point[1] - ay) * north
            dx, dy = (bx - ax) * east, (by - ay) * north
            length2 = dx * dx + dy * dy
            share = min(1, max(0, (px * dx + py * dy) / length2)) if length2 else 0
            nearest = min(nearest, math.hypot(px - share * dx, py - share * dy))
    return 0 if inside else nearest


def read(path, us_atlas):
    """Returns (name, latitude, longitude, population), largest first."""
    counties = rings_of(us_atlas)
    places = []
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.reader(line for line in file if not line.startswith("#")):
            name, region, lat, lon, thousands, county = row
            lat, lon = float(lat), float(lon)
            if county:
                off = min((km_outside((lon, lat), rings) for rings in counties.get(county, [])),
                          default=math.inf)
                if off > AT_MOST_KM:
                    raise ValueError(f"{name}, {region} is {off:.1f} km outside {county}")
            places.append((name, lat, lon, int(thousands) * 1000))
    return sorted(places, key=lambda place: (-place[3], place[0], place[1]))
