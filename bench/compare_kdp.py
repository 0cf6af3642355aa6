#!/usr/bin/env python3
"""Compares KDP of stormcellar, recast-radar and Py-ART on synthetic ramps whose KDP is known.

usage: bench/compare_kdp.py [--program build/release/cli/stormcellar]

Needs numpy, netCDF4, recast-radar 0.1.3 and arm_pyart (pip). All programs read the same Level II
file (bench/ramp_volume.py), which has 45 radials of each ramp. Py-ART's methods get phases that
numpy unfolds and whose gates have a correlation coefficient of at least 0.8; their settings are the
defaults, with the radar's band. Prints the root mean square errors in degrees/km on the gates at
which both stormcellar and the other program have a value, with the share of gates that have one.

Exits with status 1 if the error of stormcellar is not the smallest on each ramp.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import warnings

os.environ.setdefault('PYART_QUIET', '1')
warnings.filterwarnings('ignore')

import netCDF4  # noqa: E402
import numpy as np  # noqa: E402
import pyart  # noqa: E402
import recast_radar  # noqa: E402
from ramp_volume import RADIALS, RAMPS, write_ramps  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent.parent


def ours(program, path, folder):
    """Returns KDP as stormcellar writes it to CfRadial; NaN where it is ambiguous."""
    result = folder / 'ours.nc'
    subprocess.run([program, 'info', path, '--moment', 'KDP', '--to', result], check=True,
                   stdout=subprocess.DEVNULL)
    with netCDF4.Dataset(result) as data:
        return np.ma.filled(data['KDP'][:].astype(float), np.nan)


def recast(path):
    radar = recast_radar.process(str(path), 'KDP', band='s').volume.to_pyart()
    return np.ma.filled(radar.fields['specific_differential_phase']['data'].astype(float), np.nan)


def unfolded(radar):
    """Returns a copy of the phases without low correlations, unfolded along each radial."""
    phases = radar.fields['differential_phase']['data'].copy()
    phases.mask = np.ma.getmaskarray(phases) | ~(
        np.ma.filled(radar.fields['cross_correlation_ratio']['data'], 0) >= 0.8)
    for row, mask in zip(phases.data, phases.mask):
        row[~mask] = np.unwrap(row[~mask], period=360)
    return phases


def pyart_methods(path):
    """Yields the name and KDP of each of Py-ART's methods."""
    radar = pyart.io.read_nexrad_archive(str(path))
    radar.add_field('unfolded', {'data': unfolded(radar)})
    retrieve = pyart.retrieve
    for name, method, options in (
            ('maesaka', retrieve.kdp_maesaka, {}),
            ('vulpiani', retrieve.kdp_vulpiani, {'band': 'S'})):
        kdp = method(radar, psidp_field='unfolded', **options)[0]['data']
        yield name, np.ma.filled(kdp.astype(float), np.nan)


def rms(values, truth, where):
    return float(np.sqrt(np.mean((values - truth)[where] ** 2)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--program', default=HERE / 'build/release/cli/stormcellar')
    program = parser.parse_args().program
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / 'KTLX20220108_120000_V06'
        truth = write_ramps(path)
        found = {'recast': recast(path)} | dict(pyart_methods(path))
        own = ours(program, path, pathlib.Path(folder))
    print('root mean square error of KDP, degrees/km: stormcellar / other on common gates')
    print(f'{"ramp":10} {"gates %":>7} {"alone":>7} ' +
          ' '.join(f'{name:>15}' for name in found))
    missed = 0
    for index, ramp in enumerate(RAMPS):
        rows = slice(index * RADIALS, (index + 1) * RADIALS)
        mine, true = own[rows], truth[rows]
        known = np.isfinite(mine)
        cells = []
        for values in found.values():
            both = known & np.isfinite(values[rows])
            here, there = rms(mine, true, both), rms(values[rows], true, both)
            missed += here >= there
            cells.append(f'{here:7.3f}/{there:7.3f}')
        print(f'{ramp[0]:10} {100 * known.mean():7.1f} {rms(mine, true, known):7.3f} ' +
              ' '.join(cells))
    if missed:
        print(f'stormcellar is not the best in {missed} cells', file=sys.stderr)
    return 1 if missed else 0


if __name__ == '__main__':
    sys.exit(main())
