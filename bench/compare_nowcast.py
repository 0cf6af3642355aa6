#!/usr/bin/env python3
"""Compares our nowcasts with persistence and with the extrapolation of pysteps, on real sequences.

usage: bench/compare_nowcast.py [--program build/release/cli/stormcellar] [--data DIR]
       [--sequence FILE ...] [--images 2]

Needs numpy, netCDF4 and pysteps 1.21 with opencv (pip).

Each volume but the first and the last is treated as the latest. `stormcellar nowcast` makes a grid
from this volume and from earlier volumes for the time of each later volume, which is held out. pysteps gets
the same maps, which are the maxima of the columns of our grids: its dense Lucas-Kanade motion of the
last maps (--images), and its semi-Lagrangian extrapolation. Beyond the last volume there is no truth,
so a lead without a row is not measured.

A row has the mean absolute error in dB over columns that all maps have seen and that reach 5 dBZ in
one of them, and CSI at 20 and 35 dBZ, of us, pysteps and persistence. Values below 0 dBZ and no echo
count as 0. Columns that one forecast cannot know (its echo would come from an unseen place) count for
none of them.

Exits with status 1 if our error is larger, or a CSI smaller, than that of persistence or of pysteps
at any lead.
"""
import argparse
import datetime
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import warnings

warnings.filterwarnings('ignore')
os.environ.setdefault('PYSTEPSRC', '')

import netCDF4  # noqa: E402
import numpy as np  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent.parent
LEAST_ECHO = 5
THRESHOLDS = (20, 35)
NAMES = ('ours', 'pysteps', 'persistence')
MISSED = []  # scores in which another forecast is better


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--program', default=HERE / 'build/release/cli/stormcellar')
    parser.add_argument('--data', type=pathlib.Path,
                        default=os.environ.get('STORMCELLAR_DATA', HERE.parent / 'shared/data'))
    parser.add_argument('--sequence', nargs='+', metavar='FILE',
                        help='volumes of one radar; default: the sequences of the data')
    parser.add_argument('--images', type=int, default=2,
                        help='number of maps from which pysteps takes the motion')
    return parser.parse_args()


def sequences(options):
    """Returns the files and the number of volumes of each sequence by its name."""
    if options.sequence:
        return {'sequence': [(name, 0) for name in options.sequence]}
    found = {}
    for folder in sorted(options.data.glob('sequence-*')):
        found[folder.name] = [(str(path), 0) for path in sorted(folder.iterdir())]
    several = options.data / 'volumes/KBBX20060113_170337.gz'
    if several.exists():
        found['four volumes of KBBX'] = [(str(several), volume) for volume in (1, 2, 3, 4)]
    return found


def grid(options, name, volume, path):
    """Grids a volume and returns its map, the middle of its time in seconds, and its start."""
    choice = ['--volume', str(volume)] if volume else []
    subprocess.run([options.program, 'grid', name, *choice, '-o', path], check=True,
                   capture_output=True)
    return read(path)


def read(path):
    with netCDF4.Dataset(path) as data:
        status = data['status'][0].filled(0)
        values = np.where(status == 3, data['REF'][0].filled(0), 0)
        ends = [datetime.datetime.fromisoformat(data.getncattr(f'time_coverage_{end}')[:-1])
                for end in ('start', 'end')]
        middle = (ends[0].timestamp() + ends[1].timestamp()) / 2
        start = data.title.split()[-1]
        dbz = np.maximum(values, 0).max(axis=0)
        return np.where((status > 0).any(axis=0), dbz, np.nan), middle, start


def ours(options, files, latest, minutes, directory):
    """Returns our map for each lead from the volumes until the time of the latest."""
    names = list(dict.fromkeys(name for name, _ in files))
    leads = ','.join(f'{lead:.6f}' for lead in minutes)
    run = subprocess.run([options.program, 'nowcast', *names, '--time', latest, '--minutes', leads,
                          '--json', '-o', directory / 'nowcast.nc'], check=True, capture_output=True)
    return [read(lead['file'])[0] for lead in json.loads(run.stdout)['leads']]


def pysteps_maps(maps, times, minutes):
    """Returns the map of pysteps for each lead."""
    from pysteps import extrapolation, motion
    shown = np.array([np.nan_to_num(one) for one in maps])
    # Lucas-Kanade takes one interval for all maps.
    interval = (times[-1] - times[0]) / (len(times) - 1) / 60
    field = motion.get_method('LK')(shown)
    steps = [lead / interval for lead in minutes]
    moved = extrapolation.get_method('semilagrangian')(
        maps[-1], field, steps, interp_order=1, allow_nonfinite_values=True)
    return list(moved)


def csi(forecast, truth, threshold):
    either = ((forecast >= threshold) | (truth >= threshold)).sum()
    return ((forecast >= threshold) & (truth >= threshold)).sum(), either


class Tally:
    """Sums over the hindcasts of a lead."""

    def __init__(self):
        self.hindcasts, self.columns, self.leads = 0, 0, []
        self.error = dict.fromkeys(NAMES, 0.0)
        self.csi = {name: np.zeros((len(THRESHOLDS), 2)) for name in NAMES}

    def add(self, lead, forecasts, truth):
        seen = ~np.isnan(truth)
        for forecast in forecasts.values():
            seen &= ~np.isnan(forecast)
        truth = truth[seen]
        forecasts = {name: forecast[seen] for name, forecast in forecasts.items()}
        echo = np.maximum.reduce([truth, *forecasts.values()]) >= LEAST_ECHO
        self.hindcasts += 1
        self.leads.append(lead)
        self.columns += int(echo.sum())
        for name, forecast in forecasts.items():
            self.error[name] += float(np.abs(forecast - truth)[echo].sum())
            for i, threshold in enumerate(THRESHOLDS):
                self.csi[name][i] += csi(forecast, truth, threshold)

    def rows(self):
        """Returns the scores by name: the error, then each CSI."""
        return {name: [self.error[name] / self.columns,
                       *(both / either if either else np.nan for both, either in self.csi[name])]
                for name in NAMES}


def compare(options, files, directory):
    """Returns the tallies by lead, in steps of five minutes."""
    read_grids = [grid(options, name, volume, directory / f'{i}.nc')
                  for i, (name, volume) in enumerate(files)]
    maps, times, starts = zip(*read_grids)
    tallies = {}
    for latest in range(1, len(files) - 1):
        minutes = [(time - times[latest]) / 60 for time in times[latest + 1:]]
        minutes = [lead for lead in minutes if lead <= 60]
        moved = ours(options, files, starts[latest], minutes, directory)
        first = max(0, latest + 1 - options.images)
        theirs = pysteps_maps(maps[first:latest + 1], times[first:latest + 1], minutes)
        for i, lead in enumerate(minutes):
            forecasts = dict(zip(NAMES, (moved[i], theirs[i], maps[latest])))
            tallies.setdefault(round(lead / 5) * 5, Tally()).add(lead, forecasts,
                                                                 maps[latest + 1 + i])
    return tallies


def report(name, tallies):
    print(f'\n{name}')
    head = f'{"lead":>5} {"n":>2}'
    for score in ('mean error, dB', *(f'CSI({threshold} dBZ)' for threshold in THRESHOLDS)):
        head += f' | {score:^29}'
    print(head)
    print(' ' * 8 + ''.join(' | ' + ' '.join(f'{one:>9}' for one in ('ours', 'pysteps', 'persist.'))
                            for _ in range(1 + len(THRESHOLDS))))
    for lead, tally in sorted(tallies.items()):
        scores = tally.rows()
        line = f'{np.mean(tally.leads):5.1f} {tally.hindcasts:>2}'
        for i in range(1 + len(THRESHOLDS)):
            line += ' | ' + ' '.join(f'{scores[one][i]:9.3f}' for one in NAMES)
            sign = 1 if i == 0 else -1
            for other in NAMES[1:]:
                if sign * scores['ours'][i] > sign * scores[other][i]:
                    MISSED.append(f'{name}: {other} is better at {np.mean(tally.leads):.1f} min')
        print(line)


def main():
    options = arguments()
    for name, files in sequences(options).items():
        with tempfile.TemporaryDirectory() as directory:
            report(name, compare(options, files, pathlib.Path(directory)))
    print()
    for miss in MISSED:
        print('missed:', miss)
    return 1 if MISSED else 0


if __name__ == '__main__':
    sys.exit(main())
