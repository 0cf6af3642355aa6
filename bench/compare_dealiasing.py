#!/usr/bin/env python3
"""Compares the dealiasing of stormcellar with recast-radar and Py-ART, in one run on one thread.

usage: bench/compare_dealiasing.py [--program build/release/bench/bench_dealias] [--data DIR]
       [--pyart] [--cases FILE ...] [--edges FILE ...]

Needs numpy and recast-radar 0.1.3 (pip); --pyart also needs arm_pyart. All run in this process or
in bench_dealias, one after the other.

1. Folded again (--cases): the true velocities are those of the gates on which recast's methods
   `pyart` and `volume` agree at the real Nyquist velocity. They are folded again at 20, 16, 12 and
   8.5 m/s. Prints the wrong gates in %, and the seconds, of each method. For stormcellar it also
   prints which share of the wrong and of the right gates is marked ambiguous.
2. Edges that are left (--edges): counts the pairs of adjacent gates that, dealiased at the real
   Nyquist velocity, still differ by more than it. Prints the counts and the seconds.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import warnings

os.environ.setdefault('RAYON_NUM_THREADS', '1')
os.environ.setdefault('PYART_QUIET', '1')
warnings.filterwarnings('ignore')

import numpy as np  # noqa: E402
import recast_radar  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent.parent
NYQUISTS = (20, 16, 12, 8.5)
CASES = ['KTLX19990503_235621.gz', 'KLIX20050828_180149.gz', 'KLBB20160601_150025_V06']
EDGES = CASES + ['KLOT20220317_000842_V06', 'KOKX20080109_141449.gz', 'KBBX20060113_170337.gz']
UNKNOWN = -128


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--program', default=HERE / 'build/release/bench/bench_dealias')
    parser.add_argument('--data', type=pathlib.Path,
                        default=os.environ.get('STORMCELLAR_DATA', HERE.parent / 'shared/data'))
    parser.add_argument('--pyart', action='store_true', help="run Py-ART's region method, too")
    parser.add_argument('--cases', nargs='*', default=CASES, metavar='FILE')
    parser.add_argument('--edges', nargs='*', default=EDGES, metavar='FILE')
    return parser.parse_args()


def recast(source, method):
    """Returns the dealiased volume as a Py-ART radar, and the seconds."""
    start = time.process_time()
    result = recast_radar.process(source, 'VRADDH', dealias_method=method)
    seconds = time.process_time() - start
    return result.volume.to_pyart(), seconds


def pyart_region(radar):
    """Returns the velocities of Py-ART's region method, and the seconds."""
    import pyart
    start = time.process_time()
    field = pyart.correct.dealias_region_based(radar, vel_field='velocity', gatefilter=False,
                                               nyquist_vel=nyquists_of(radar))
    return field['data'], time.process_time() - start


def nyquists_of(radar):
    """Returns the Nyquist velocity of each sweep."""
    by_ray = radar.instrument_parameters['nyquist_velocity']['data']
    return [float(by_ray[start]) for start in radar.sweep_start_ray_index['data']]


def field(radar, name):
    return np.ma.filled(radar.fields[name]['data'].astype(float), np.nan)


def sweeps(radar):
    starts, ends = radar.sweep_start_ray_index['data'], radar.sweep_end_ray_index['data']
    return [slice(int(start), int(end) + 1) for start, end in zip(starts, ends)]


def edges(radar, velocity):
    """Counts the pairs of adjacent gates that differ by more than the Nyquist velocity."""
    nyquist = radar.instrument_parameters['nyquist_velocity']['data'].astype(float)[:, None]
    count = 0
    for rays in sweeps(radar):
        here, limit = velocity[rays], np.where(nyquist[rays] > 0, nyquist[rays], np.inf)
        count += int((np.abs(here - np.roll(here, -1, axis=0)) > limit).sum())
        count += int((np.abs(here[:, 1:] - here[:, :-1]) > limit).sum())
    return count


def ours(program, files, *options):
    """Returns the rows of bench_dealias by rung."""
    run = subprocess.run([program, '--json', *options, *files], check=True, capture_output=True)
    return {row['rung']: row for row in json.loads(run.stdout)['rows']}


def write_case(path, radar, velocity, folds, nyquist):
    """Writes a file for bench_dealias --case."""
    doppler = [rays for rays in sweeps(radar) if (folds[rays] != UNKNOWN).any()]
    ranges = radar.range['data']
    with open(path, 'wb') as file:
        file.write(np.int32(len(doppler)).tobytes())
        for rays in doppler:
            shape = [*velocity[rays].shape, round(ranges[0]), round(ranges[1] - ranges[0])]
            file.write(np.array(shape, 'i4').tobytes())
            for of_rays in (radar.azimuth['data'], radar.elevation['data']):
                file.write(of_rays[rays].astype('f4').tobytes())
            file.write(np.full(shape[0], nyquist, 'f4').tobytes())
            file.write(velocity[rays].astype('f4').tobytes())
            file.write(folds[rays].astype('i1').tobytes())


def folded_again(raw, radar, truth, nyquist, path):
    """Writes the volume with velocities folded at `nyquist` as CfRadial. Returns the velocities."""
    import pyart
    velocity = (truth + nyquist) % (2 * nyquist) - nyquist
    made = raw.to_pyart()
    made.fields['velocity']['data'] = np.ma.masked_invalid(velocity).astype('float32')
    real = radar.instrument_parameters['nyquist_velocity']['data']
    made.instrument_parameters['nyquist_velocity']['data'] = np.where(
        real > 0, nyquist, 0).astype('float32')
    made.metadata = {key: int(value) if isinstance(value, (bool, np.bool_)) else value
                     for key, value in made.metadata.items()}
    pyart.io.write_cfradial(path, made)
    return velocity


def print_row(*cells):
    print('\t'.join(str(cell) for cell in cells), flush=True)


def compare_cases(options, scratch):
    methods = ['region', 'pyart', 'volume'] + (['py-art'] if options.pyart else [])
    print_row('file', 'nyquist', *[f'{name} %\ts' for name in methods],
              *[f'{rung} %\ts\tmarked wrong %\tright %' for rung in ('ours region', 'anchored')])
    for name in options.cases:
        raw = recast_radar.read(str(options.data / 'volumes' / name))
        radar, _ = recast(raw, 'pyart')
        agreed = field(radar, 'corrected_velocity')
        other = field(recast(raw, 'volume')[0], 'corrected_velocity')
        known = np.isfinite(field(radar, 'velocity')) & (np.abs(agreed - other) < 1)
        truth = np.where(known, agreed, np.nan)
        for nyquist in NYQUISTS:
            path = str(scratch / 'case.nc')
            velocity = folded_again(raw, radar, truth, nyquist, path)
            again = recast_radar.read(path)
            row = []
            for method in methods:
                if method == 'py-art':
                    found, seconds = pyart_region(again.to_pyart())
                    found = np.ma.filled(found.astype(float), np.nan)
                else:
                    made, seconds = recast(again, method)
                    found = field(made, 'corrected_velocity')
                wrong = ~(np.abs(found - truth) < nyquist)
                row += [f'{100 * wrong[known].mean():.2f}', f'{seconds:.3f}']
            folds = np.where(known, np.round((truth - velocity) / (2 * nyquist)), UNKNOWN)
            write_case(scratch / 'case', radar, velocity, folds, nyquist)
            rungs = ours(options.program, [scratch / 'case'], '--case')
            for rung in ('region', 'anchored'):
                row += [rungs[rung][key] for key in
                        ('wrong_pct', 'seconds', 'marked_wrong_pct', 'marked_right_pct')]
            print_row(name, nyquist, *row)


def compare_edges(options):
    methods = ['pyart', 'volume']
    print_row('file', *[f'{name} edges\ts' for name in methods],
              *(['py-art edges\ts'] if options.pyart else []),
              *[f'{rung} edges\ts' for rung in ('ours region', 'anchored')])
    for name in options.edges:
        path = str(options.data / 'volumes' / name)
        row = []
        for method in methods:
            radar, seconds = recast(recast_radar.read(path), method)
            row += [edges(radar, field(radar, 'corrected_velocity')), f'{seconds:.3f}']
        if options.pyart:
            found, seconds = pyart_region(radar)
            row += [edges(radar, np.ma.filled(found.astype(float), np.nan)), f'{seconds:.3f}']
        rungs = ours(options.program, [path])
        for rung in ('region', 'anchored'):
            row += [rungs[rung]['jumps'], rungs[rung]['seconds']]
        print_row(name, *row)


def main():
    options = arguments()
    with tempfile.TemporaryDirectory() as scratch:
        if options.cases:
            compare_cases(options, pathlib.Path(scratch))
    if options.edges:
        compare_edges(options)


if __name__ == '__main__':
    sys.exit(main())
