#!/usr/bin/env python3
"""Times quasi-vertical profiles over an archive: stormcellar.open_archive() and means over azimuth of a high sweep.

usage: bench_archive.py [--volumes 2000] [--program build/release/cli/stormcellar] [FILE]

Needs xarray. The library is the one that $STORMCELLAR_LIBRARY names. Copies a volume of LDM records (KLOT 2022, unless
another is named) --volumes times into a temporary directory, each with another start in its header, and catalogs the
copies; 2,000 of KLOT need 5.4 GB of disk. Then the page cache is warm. Prints the seconds to open the archive and to
compute the profiles of reflectivity and correlation of its highest sweep on all processors, and where one processor
spends its time. Exits with 1 if the profiles take longer than 15 ms for each volume (30 s for 2,000).
"""

import argparse
import cProfile
import os
import pathlib
import pstats
import subprocess
import sys
import tempfile
import time

import stormcellar

ROOT = pathlib.Path(__file__).resolve().parents[1]
DATA = pathlib.Path(os.environ.get("STORMCELLAR_DATA", ROOT.parent / "shared" / "data"))
MOMENTS = ["DBZH", "RHOHV"]
MOST_SECONDS = 0.015  # for each volume
BLOCK = 8  # volumes that the archive keeps in memory
PROFILED = 100


def copy(file, folder, count):
    """Writes copies of a volume that begin a second after each other: the decoder believes an hour's difference between
    the header and the radials."""
    volume = file.read_bytes()
    milliseconds = int.from_bytes(volume[16:20], "big") // 1000 * 1000
    if volume[:4] != b"AR2V" or count > 3600 or milliseconds + 1000 * count > 86_400_000:
        sys.exit("bench_archive: the volume must begin with AR2V; at most 3,600 copies fit before midnight")
    station = volume[20:24].decode()
    for second in range(count):
        start = milliseconds + 1000 * second
        stamped = volume[:16] + start.to_bytes(4, "big") + volume[20:]
        (folder / f"{station}20220317_{second:06}_V06").write_bytes(stamped)
    return station


def profiles(group):
    """Returns the means over azimuth, read in blocks that are decoded once for all moments."""
    steps = range(0, group.sizes["vcp_time"], BLOCK)
    return [group[MOMENTS].isel(vcp_time=slice(step, step + BLOCK)).mean("azimuth").load() for step in steps]


def seconds_of(call, *arguments):
    began = time.perf_counter()
    result = call(*arguments)
    return time.perf_counter() - began, result


def highest_sweep(archive):
    groups = [node.to_dataset() for node in archive.subtree] if hasattr(archive, "subtree") else list(archive.values())
    return max((group for group in groups if "sweep_fixed_angle" in group),
               key=lambda group: float(group.sweep_fixed_angle))


def print_parts(group, count):
    """Prints where one processor spends its time."""
    processors = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(processors)})
    cpu, profiler = time.process_time(), cProfile.Profile()
    profiler.runcall(lambda: [
        group[name].isel(vcp_time=step).mean("azimuth").load() for step in range(count) for name in MOMENTS])
    cpu = time.process_time() - cpu
    os.sched_setaffinity(0, processors)
    print(f"one processor: {1000 * cpu / count:.1f} ms of CPU for each volume, with the profiler")
    pstats.Stats(profiler).strip_dirs().sort_stats("tottime").print_stats(12)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--volumes", type=int, default=2000)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/cli/stormcellar")
    parser.add_argument("file", nargs="?", type=pathlib.Path, default=DATA / "volumes/KLOT20220317_000842_V06")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        drop, catalog = pathlib.Path(folder) / "drop", pathlib.Path(folder) / "catalog"
        drop.mkdir()
        station = copy(options.file, drop, options.volumes)
        subprocess.run([options.program, "catalog", "rebuild", "--catalog", catalog, "--drop", drop], check=True,
                       stdout=subprocess.DEVNULL)
        opening, archive = seconds_of(stormcellar.open_archive, catalog, station)
        group = highest_sweep(archive)
        print(f"{options.file.name}: {group.sizes['vcp_time']} volumes, opened in {opening:.2f} s")
        cpu = time.process_time()
        reading, parts = seconds_of(profiles, group)
        cpu = time.process_time() - cpu
        limit = MOST_SECONDS * options.volumes
        print(f"profiles of {' and '.join(MOMENTS)} at {float(group.sweep_fixed_angle):.1f} degrees: {reading:.1f} s "
              f"on {len(os.sched_getaffinity(0))} processors ({cpu:.1f} s of CPU), at most {limit:.0f} s are wanted;",
              f"{1000 * reading / options.volumes:.1f} ms for each volume")
        if any(part[MOMENTS[0]].isnull().all("range").any() for part in parts):
            sys.exit("bench_archive: a volume gave no values")
        print_parts(group, min(PROFILED, options.volumes))
    return 0 if reading <= limit else 1


if __name__ == "__main__":
    sys.exit(main())
