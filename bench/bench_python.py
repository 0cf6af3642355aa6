#!/usr/bin/env python3
"""Times the Python package beside our C++ programs and other readers of Level II, in one run on one thread.

usage: bench_python.py [--runs 5] [--data DIR] [--build DIR] [--all] [--archive 2000] [FILE ...]

Needs xarray 2024.10 or later. xradar, Py-ART (arm_pyart), recast-radar, radrs and radish-rs (pip) are measured where they are
installed. The library is the one that $STORMCELLAR_LIBRARY names; our programs are those of --build. Prints the least of the
runs in seconds, for the busy volume KLBB 2016 unless files are named, with every moment in memory:
  tree, packed            a tree of datasets with the codes of the file, or the reader's packed arrays; beside our decoder
  tree, float             a tree of datasets with values; beside our decoder
  tree, float and states  the same, and why gates have no value; no other reader tells this
  grid                    512 x 512 x 32 cells of reflectivity from a volume in memory; beside our command line
  Cache                   the dataset of 10,000 grids of 4 km, opened but not read
A row ends with our share of the fastest other reader, our share of our C++, and the largest allowed shares. With --all it also
prints how many real files each reader opens as a tree, and with --archive the rows of bench_archive.py for so many volumes.
Exits with 1 if ours is not the fastest in a row.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("RAYON_NUM_THREADS", "1")

import stormcellar  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[1]
SIDE_M, LEVELS_M = 256_000, (500, 16_000)  # of the grid
# The largest allowed time of a row: of our C++, and of the fastest other reader.
ALLOWED = {"tree, packed": (1.15, 0.4), "tree, float": (1.5, 0.4), "grid": (1.1, 0.1)}
CACHED_GRIDS, MOST_CACHE_S = 10_000, 0.3


def loaded(tree):
    """Reads every variable of a tree into memory."""
    for node in tree.subtree:
        node.to_dataset().load()
    return tree


def ours():
    def grid(file):
        volume = stormcellar.Volume(file)
        return lambda: stormcellar.grid(volume, columns=512, rows=512)

    return {
        "tree, packed": lambda file: loaded(stormcellar.open_datatree(file, packed=True, status=False)),
        "tree, float": lambda file: loaded(stormcellar.open_datatree(file, status=False)),
        "tree, float and states": lambda file: loaded(stormcellar.open_datatree(file)),
        "grid": grid,
    }


def xradar():
    from xradar.io import open_nexradlevel2_datatree

    return {"tree, float": lambda file: loaded(open_nexradlevel2_datatree(file)),
            "tree, packed": lambda file: loaded(open_nexradlevel2_datatree(file, mask_and_scale=False))}


def pyart():
    import pyart

    def read(file):
        radar = pyart.io.read_nexrad_archive(str(file))
        for field in radar.fields.values():
            field["data"]
        return radar

    return {"tree, float": read}


def recast():
    import recast_radar

    def grid(file):
        volume = recast_radar.read(str(file))
        limits_m = (LEVELS_M, (-SIDE_M, SIDE_M), (-SIDE_M, SIDE_M))
        return lambda: recast_radar.grid(volume, fields=["DBZH"], shape=(32, 512, 512), limits_m=limits_m)

    return {"tree, float": lambda file: loaded(recast_radar.open_datatree(str(file))),
            "tree, packed": lambda file: loaded(recast_radar.open_datatree(str(file), decode=False)),
            "grid": grid}


def radrs():
    from radrs.xradar import open_datatree

    return {"tree, float": lambda file: loaded(open_datatree(str(file)))}


def radish():
    from radish import open_datatree

    return {"tree, float": lambda file: loaded(open_datatree(str(file)))}


READERS = {"stormcellar": ours, "recast-radar": recast, "radish-rs": radish, "radrs": radrs, "Py-ART": pyart, "xradar": xradar}


def least_seconds(call, runs):
    times = []
    for _ in range(runs):
        began = time.perf_counter()
        call()
        times.append(time.perf_counter() - began)
    return min(times)


def seconds_of_command_line(build, file, runs):
    """Returns the least seconds of our C++ by the names of rows."""
    kernels = subprocess.run([build / "bench/bench_kernels", "--threads", "1", "--runs", str(runs), "--json", file], check=True,
                             capture_output=True)
    decoding = next(row["ms"] for row in json.loads(kernels.stdout)["rows"] if row["way"] == "decode, threads 1") / 1000
    with tempfile.TemporaryDirectory() as folder:
        command = [build / "cli/stormcellar", "grid", file, "-o", pathlib.Path(folder) / "grid.nc", "--extent-km", "512,512",
                   "--threads", "1", "--json"]
        reports = [json.loads(subprocess.run(command, check=True, capture_output=True).stdout) for _ in range(runs)]
    gridding = min(report["geometry_s"] + report["grid_s"] for report in reports)
    return {"tree, packed": decoding, "tree, float": decoding, "grid": gridding}


def print_row(file, row, seconds, cpp):
    """Prints a row. Returns whether ours is the fastest."""
    mine = seconds["stormcellar"]
    others = [value for name, value in seconds.items() if name != "stormcellar"]
    print(f"{file.name:28} {row:24} " + "  ".join(f"{name} {value:.3f}" for name, value in seconds.items()), end="")
    most_of_cpp, most_of_others = ALLOWED.get(row, (None, None))
    if others:
        print(f"; {mine / min(others):.2f} of the fastest other (allowed {most_of_others})", end="")
    if row in cpp:
        print(f"; {mine / cpp[row]:.2f} of our C++, {cpp[row]:.3f} (allowed {most_of_cpp})", end="")
    print(flush=True)
    return not others or mine < min(others)


def measure(readers, file, options):
    """Prints the rows of a file. Returns whether ours is the fastest in each."""
    cpp = seconds_of_command_line(options.build, file, options.runs)
    best = True
    for row in ("tree, packed", "tree, float", "tree, float and states", "grid"):
        seconds = {}
        for name, ways in readers.items():
            if row not in ways:
                continue
            try:
                call = ways[row](file) if row == "grid" else lambda: ways[row](file)
                # Others need seconds for a grid.
                seconds[name] = least_seconds(call, 1 if row == "grid" and name != "stormcellar" else options.runs)
            except Exception as error:
                print(f"{file.name:28} {row:24} {name}: {type(error).__name__}: {str(error)[:80]}")
        best = print_row(file, row, seconds, cpp) and best
    return best


def measure_cache(options):
    """Prints the time to open a cache of many grids. All are links to one grid."""
    os.environ["STORMCELLAR_PROGRAM"] = str(options.build / "cli/stormcellar")
    sys.path.append(str(ROOT / "tests/python"))
    from cellar import make_cache

    with tempfile.TemporaryDirectory() as folder:
        cache = make_cache(folder, [options.data / "volumes/KTLX19990503_235621.gz"], "1999-05-03", "1999-05-04")
        grid = next(cache.rglob("KTLX_REF_*.scg"))
        for index in range(CACHED_GRIDS - 1):
            day, minute = divmod(index, 24 * 60)
            name = f"199906{day + 1:02}"
            directory = grid.parent.parent / name
            directory.mkdir(exist_ok=True)
            os.link(grid, directory / f"KTLX_REF_{name}_{minute // 60:02}{minute % 60:02}00_000.scg")
        seconds = least_seconds(lambda: stormcellar.Cache(cache).open("KTLX"), options.runs)
        count = stormcellar.Cache(cache).open("KTLX").sizes["time"]
    print(f"{'Cache':28} {f'{count} grids':24} stormcellar {seconds:.3f} (allowed {MOST_CACHE_S})", flush=True)


def opened(readers, files):
    for name, ways in readers.items():
        count = 0
        for file in files:
            try:
                ways["tree, float"](file)
                count += 1
            except Exception:
                pass
        print(f"{name} opens {count} of {len(files)} real files")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--data", type=pathlib.Path,
                        default=os.environ.get("STORMCELLAR_DATA", ROOT.parent / "shared" / "data"))
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--archive", type=int, help="also run bench_archive.py with this number of volumes")
    parser.add_argument("--all", action="store_true", help="also count the real files that each reader opens")
    parser.add_argument("files", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    readers = {}
    for name, make in READERS.items():
        try:
            readers[name] = make()
        except ImportError as error:
            print(f"{name} is left out: {error}")
    files = options.files or [pathlib.Path(options.data) / "volumes" / "KLBB20160601_150025_V06"]
    best = all([measure(readers, file, options) for file in files])
    measure_cache(options)
    if options.all:
        folders = ("volumes", "sequence-kbgm", "mosaic-northeast")
        opened(readers, [file for folder in folders for file in sorted((pathlib.Path(options.data) / folder).iterdir())
                         if file.is_file()])
    if options.archive:
        sys.stdout.flush()
        subprocess.run([sys.executable, ROOT / "bench/bench_archive.py", "--volumes", str(options.archive), "--program",
                        options.build / "cli/stormcellar"], check=False)
    return 0 if best else 1


if __name__ == "__main__":
    sys.exit(main())
