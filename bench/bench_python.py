#!/usr/bin/env python3
"""Times the Python package beside other readers of Level II, in one run on one thread.

usage: bench_python.py [--runs 5] [--data DIR] [--all] [FILE ...]

Needs xarray 2024.10 or later. xradar, Py-ART (arm_pyart), recast-radar, radrs and radish-rs (pip) are measured where they are
installed. The library is the one that $STORMCELLAR_LIBRARY names. Prints the least of the runs in seconds, for the busy volume
KLBB 2016 unless files are named, with every moment in memory:
  tree, packed   a tree of datasets with the codes of the file, or the reader's packed arrays
  tree, float    a tree of datasets with values; ours also with states
  grid           512 x 512 x 32 cells of reflectivity from a volume in memory
With --all it also prints how many real files each reader opens as a tree. Exits with 1 if ours is not the fastest in a row.
"""

import argparse
import os
import pathlib
import sys
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("RAYON_NUM_THREADS", "1")

import stormcellar  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[1]


def loaded(tree):
    """Reads every variable of a tree into memory."""
    for node in tree.subtree:
        node.to_dataset().load()
    return tree


def ours():
    return {
        "tree, packed": lambda file: loaded(stormcellar.open_datatree(file, packed=True, status=False)),
        "tree, float": lambda file: loaded(stormcellar.open_datatree(file, status=False)),
        "tree, float and states": lambda file: loaded(stormcellar.open_datatree(file)),
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

    return {"tree, float": lambda file: loaded(recast_radar.open_datatree(str(file))),
            "tree, packed": lambda file: loaded(recast_radar.open_datatree(str(file), decode=False))}


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


def measure(readers, file, runs):
    """Prints the rows of a file. Returns whether ours is the fastest in each."""
    best = True
    for row in ("tree, packed", "tree, float", "tree, float and states"):
        seconds = {}
        for name, ways in readers.items():
            if row not in ways:
                continue
            try:
                seconds[name] = least_seconds(lambda: ways[row](file), runs)
            except Exception as error:
                print(f"{file.name:28} {row:24} {name}: {type(error).__name__}: {str(error)[:80]}")
        others = [value for name, value in seconds.items() if name != "stormcellar"]
        ratio = seconds["stormcellar"] / min(others) if others else float("nan")
        best = best and not ratio >= 1
        print(f"{file.name:28} {row:24} " + "  ".join(f"{name} {value:.3f}" for name, value in seconds.items())
              + f"  (ours: {ratio:.2f} of the fastest other)")
    volume = stormcellar.Volume(file)
    grid = least_seconds(lambda: stormcellar.grid(volume, columns=512, rows=512), runs)
    print(f"{file.name:28} {'grid':24} stormcellar {grid:.3f}")
    return best


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
    best = all([measure(readers, file, options.runs) for file in files])
    if options.all:
        folders = ("volumes", "sequence-kbgm", "mosaic-northeast")
        opened(readers, [file for folder in folders for file in sorted((pathlib.Path(options.data) / folder).iterdir())
                         if file.is_file()])
    return 0 if best else 1


if __name__ == "__main__":
    sys.exit(main())
