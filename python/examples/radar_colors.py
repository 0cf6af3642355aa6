"""Colors of the National Weather Service for matplotlib."""

from matplotlib.colors import BoundaryNorm, ListedColormap


def _classes(bounds, colors):
    return {"cmap": ListedColormap(["#" + color for color in colors.split()]), "norm": BoundaryNorm(bounds, len(bounds) - 1)}


# Arguments of pcolormesh(): dBZ and m/s.
REFLECTIVITY = _classes([5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80],
                        "04E9E7 019FF4 0300F4 02FD02 01C501 008E00 FDF802 E5BC00 FD9500 FD0000 D40000 BC0000 F800FD "
                        "9854C6 FDFDFD")
VELOCITY = _classes([-64, -33, -25.5, -18.5, -13.5, -10, -5, -0.5, 0.5, 5, 10, 13.5, 18.5, 25.5, 33, 64],
                    "02FC02 01E401 01C501 07AC04 068F03 047202 7C977B 808080 987777 890000 A20000 B90000 D80000 EF0000 "
                    "FE0000")
RANGE_FOLDED = ListedColormap(["#77007D"])
