"""Reads the surfaces of a grid by the glTF specification, and compares them with its netCDF file.

Usage: check_gltf.py PROGRAM LEVEL2_FILE
If the package trimesh is there, it must read the same triangles.
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

import netCDF4
import numpy as np


def read(path):
    """Returns the document of a .glb file, and a function that reads its arrays."""
    data = path.read_bytes()
    magic, version, length, text = struct.unpack("<4sIII", data[:16])
    assert (magic, version, length, data[16:20]) == (b"glTF", 2, len(data), b"JSON")
    document = json.loads(data[20:20 + text])
    begin = 20 + text + 8
    assert data[begin - 4:begin] == b"BIN\0"

    def array(number):
        accessor = document["accessors"][number]
        view = document["bufferViews"][accessor["bufferView"]]
        kind, width = {5126: ("<f4", 3), 5125: ("<u4", 1)}[accessor["componentType"]]
        numbers = np.frombuffer(data, kind, accessor["count"] * width, begin + view["byteOffset"])
        return numbers.reshape(-1, 3)

    return document, array


def check_surface(points, value, grid, stretch):
    """Each point must be in a box of seen cells, whose values are on both sides of `value`."""
    inside = (grid["REF"][0].filled(-99) >= value)
    seen = np.isin(grid["status"][0], (1, 3))
    x, y, z = (grid[name][:].astype(float) for name in "xyz")
    column = np.clip(np.searchsorted(x, points[:, 0], "right") - 1, 0, len(x) - 2)
    row = np.clip(np.searchsorted(y, -points[:, 2], "right") - 1, 0, len(y) - 2)
    level = np.clip(np.searchsorted(z, points[:, 1] / stretch, "right") - 1, 0, len(z) - 2)
    corners = [(level + i, row + j, column + k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    of_corners = np.stack([inside[corner] for corner in corners])
    both = of_corners.any(axis=0) & ~of_corners.all(axis=0)
    all_seen = np.stack([seen[corner] for corner in corners]).all(axis=0)
    # A point on the border of two boxes may be found in the wrong box.
    assert both.mean() > 0.999 and all_seen.mean() > 0.999, (value, both.mean(), all_seen.mean())


def main(program, volume):
    with tempfile.TemporaryDirectory() as directory:
        directory = pathlib.Path(directory)
        shape = ["--extent-km", "240,240", "--moment", "REF"]
        for name, options in (("grid.nc", []), ("grid.glb", ["--surfaces", "20,45,60", "--exaggeration", "3"])):
            subprocess.run([program, "grid", volume, "-o", directory / name, *shape, *options], check=True,
                           stdout=subprocess.DEVNULL)
        grid = netCDF4.Dataset(directory / "grid.nc")
        document, array = read(directory / "grid.glb")
        extras = document["scenes"][0]["extras"]
        assert extras["method"] == grid.method and extras["stations"] == grid.stations
        triangles = []
        for node in document["nodes"]:
            primitive = document["meshes"][node["mesh"]]["primitives"][0]
            points = array(primitive["attributes"]["POSITION"])
            corners = array(primitive["indices"])
            accessor = document["accessors"][primitive["attributes"]["POSITION"]]
            assert np.allclose(points.min(axis=0), accessor["min"]) and np.allclose(points.max(axis=0), accessor["max"])
            assert corners.max() < len(points)
            assert np.abs(points[:, [0, 2]]).max() <= 120_000
            check_surface(points, node["extras"]["value"], grid, 3)
            triangles.append(len(corners))
        assert [node["name"] for node in document["nodes"]] == ["REF 20 dBZ", "REF 45 dBZ", "REF 60 dBZ"]
        assert triangles[0] > triangles[1] > triangles[2] > 10, triangles
        print("triangles:", *triangles, "bytes:", (directory / "grid.glb").stat().st_size)
        try:
            import trimesh
        except ImportError:
            print("trimesh is not installed")
            return
        scene = trimesh.load(directory / "grid.glb", process=False)
        assert [len(mesh.faces) for mesh in scene.geometry.values()] == triangles
        assert scene.bounds[1][1] > 30_000
        print("trimesh reads the same triangles")


main(*sys.argv[1:])
