"""Collects the places that a user may name, from the Census' gazetteer and the cities of the map."""
import csv
import gzip
import math
import re

ENTRY = re.compile(r"\[fips(\d+)\]\ncentroid = \(([-\d.]+), ([-\d.]+)\)\ndescription = (.*), (\w\w)\n")
PLACE, SUBDIVISION = 7, 10  # number of digits in the code of a place, and of a subdivision of a county

# In these states the Census lists towns, or townships, among the subdivisions of counties and not among the places.
TOWNS = {"CT", "MA", "ME", "NH", "RI", "VT"}
TOWNSHIPS = {"NJ"}

# The Census adds these words for the kind of place to its name.
KINDS = re.compile(
    r"( metro| unified| consolidated| metropolitan| zona)?"
    r"( (city|town|village|borough|CDP|municipality|township|corporation|comunidad|urbana|"
    r"urban county|government))?( \(balance\))?$")
SAME_KM = 25  # two entries with one name and state are one place if they are nearer to each other than this


def name_of(description):
    name = KINDS.sub("", description).strip()
    # In names such as "Athens-Clarke County" and "Lynchburg, Moore County", the first part is the city.
    if re.search(r"[-/].* County$", name) or name == "Butte-Silver Bow":
        name = re.split(r"[-/]", name)[0]
    return name.split(",")[0]


def folded(name):
    return name.casefold()


def km_between(a, b):
    east = math.cos(math.radians(a[0])) * (a[1] - b[1])
    return 111.2 * math.hypot(a[0] - b[0], east)


def of_gazetteer(path):
    with gzip.open(path, "rt", encoding="utf-8") as file:
        for code, lat, lon, description, state in ENTRY.findall(file.read()):
            kind = description.rsplit(" ", 1)[-1]
            wanted = len(code) == PLACE or (
                len(code) == SUBDIVISION and (kind == "town" and state in TOWNS
                                              or kind == "township" and state in TOWNSHIPS))
            if wanted:
                yield name_of(description), state, math.degrees(float(lat)), \
                    math.degrees(float(lon)), 0


def of_map(path):
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.reader(line for line in file if not line.startswith("#")):
            name, region, lat, lon, thousands, _county = row
            yield name, region, float(lat), float(lon), int(thousands)


def read(cities, gazetteer):
    """Returns (name, region, latitude, longitude, thousands of people or 0), by name. If both sources have a place, keeps the
    entry of the map."""
    found = {}
    for place in [*of_map(cities), *of_gazetteer(gazetteer)]:
        same = found.setdefault((folded(place[0]), place[1]), [])
        if not any(km_between(place[2:4], other[2:4]) < SAME_KM for other in same):
            same.append(place)
    return [place for key in sorted(found) for place in found[key]]
