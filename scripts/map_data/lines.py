"""Joins, simplifies and cuts lines of (longitude, latitude) in degrees."""
import collections
import math

METRES_PER_DEGREE = 111320.0


def joined(pieces):
    """Joins pieces to longer lines at each point where exactly two pieces meet."""
    ends = collections.defaultdict(list)
    for index, piece in enumerate(pieces):
        ends[piece[0]].append(index)
        ends[piece[-1]].append(index)
    used = [False] * len(pieces)

    def grow(line):
        while line[0] != line[-1]:
            here = ends[line[-1]]
            free = [i for i in here if not used[i]]
            if len(here) != 2 or not free:
                break
            used[free[0]] = True
            piece = pieces[free[0]]
            line += (piece if piece[0] == line[-1] else piece[::-1])[1:]
        return line

    result = []
    for index, piece in enumerate(pieces):
        if used[index]:
            continue
        used[index] = True
        line = grow(list(piece))
        result.append(grow(line[::-1]))
    return result


def simplified(line, tolerance_m):
    """Simplifies a line (Douglas and Peucker 1973), with a tolerance in meters. Keeps both ends."""
    if len(line) < 3:
        return list(line)
    east = METRES_PER_DEGREE * math.cos(math.radians(sum(p[1] for p in line) / len(line)))
    plane = [(p[0] * east, p[1] * METRES_PER_DEGREE) for p in line]
    keep = [False] * len(line)
    keep[0] = keep[-1] = True
    todo = [(0, len(line) - 1)]
    while todo:
        first, last = todo.pop()
        ax, ay = plane[first]
        dx, dy = plane[last][0] - ax, plane[last][1] - ay
        length2 = dx * dx + dy * dy
        worst, at = tolerance_m * tolerance_m, -1
        for i in range(first + 1, last):
            px, py = plane[i][0] - ax, plane[i][1] - ay
            if length2 > 0:
                share = min(1.0, max(0.0, (px * dx + py * dy) / length2))
                px, py = px - share * dx, py - share * dy
            if px * px + py * py > worst:
                worst, at = px * px + py * py, i
        if at >= 0:
            keep[at] = True
            todo += [(first, at), (at, last)]
    return [p for p, kept in zip(line, keep) if kept]


def is_speck(points, tolerance_m, units_per_degree):
    """Returns true for a line of one point, or an island smaller than twice the tolerance."""
    if len(points) < 2:
        return True
    if points[0] != points[-1]:
        return False
    unit = METRES_PER_DEGREE / units_per_degree
    high = (max(p[1] for p in points) - min(p[1] for p in points)) * unit
    wide = ((max(p[0] for p in points) - min(p[0] for p in points)) * unit *
            math.cos(math.radians(points[0][1] / units_per_degree)))
    return math.hypot(wide, high) < 2 * tolerance_m


def signed_area(ring):
    """Returns the area of a closed ring; positive if it runs counterclockwise."""
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:])) / 2


def turned(ring, counterclockwise):
    return ring if (signed_area(ring) > 0) == counterclockwise else ring[::-1]


def cut_at(points, axis, limit, keep_above):
    """Returns the part of an open ring on one side of a line (Sutherland and Hodgman 1974), in whole units."""
    kept = []
    sign = 1 if keep_above else -1
    for one, other in zip(points[-1:] + points[:-1], points):
        inside = sign * (other[axis] - limit) >= 0
        if inside != (sign * (one[axis] - limit) >= 0):
            # Start from the lower end, so that both sides of the line get the same point.
            low, high = sorted((one, other), key=lambda p: p[axis])
            share = (limit - low[axis]) / (high[axis] - low[axis])
            crossing = [0, 0]
            crossing[axis] = limit
            crossing[1 - axis] = round(low[1 - axis] + share * (high[1 - axis] - low[1 - axis]))
            kept.append(tuple(crossing))
        if inside:
            kept.append(other)
    return [p for i, p in enumerate(kept) if p != kept[i - 1]]


def tiles_of(ring, side):
    """Cuts a closed ring of whole units into square tiles. Returns (column, row, closed ring) for each tile."""
    def strips(points, axis):
        first = min(p[axis] for p in points) // side
        last = -(-max(p[axis] for p in points) // side)
        for index in range(first, last):
            part = cut_at(points, axis, index * side, True)
            part = cut_at(part, axis, (index + 1) * side, False) if part else part
            if len(part) >= 3:
                yield index, part

    for column, strip in strips(ring[:-1], 0):
        for row, part in strips(strip, 1):
            if signed_area(part + part[:1]) != 0:
                yield column, row, part + part[:1]
