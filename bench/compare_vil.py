#!/usr/bin/env python3
"""Compares the VIL of stormcellar and recast-radar with the truth of simulated columns.

usage: bench/compare_vil.py [--program build/release/cli/stormcellar]

Needs numpy, tifffile, arm_pyart and recast-radar 0.1.3 (pip). Py-ART 2.3 has no VIL and only lends
its classes. `stormcellar synth` makes a volume of VCP 212 (17 sweeps from 0.5 to 19.5 degrees), and
both programs read its file. There are four kinds of columns, each at six distances:
  constant   40 dBZ up to 10 km
  elevated   40 dBZ from 3 to 9 km
  ramp       45 dBZ up to 3 km, above that 3 dB/km less, up to 12 km
  core       55 dBZ up to 5 km, above that a parabola in dB, with 10 dBZ at 14 km
The truth is the integral of 3.44e-6 Z^(4/7) (Greene and Clark 1972) from the height of the radar up.
The number of stormcellar is from the map of `frame --product vil`, in the column of the axis. The
number of recast-radar is from the gate of its lowest sweep at the same place.

At 20 km the highest beam is at 7 km, so neither program sees the tops. Plateaus have edges between
two beams, so their error is up to half of the distance of the beams. recast-radar continues the
lowest gate with echo down to the radar, also through air in which lower beams found no echo.

Exits with status 1 if the root mean square error of stormcellar is not the smallest for each kind.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import warnings

os.environ.setdefault('RAYON_NUM_THREADS', '1')
os.environ.setdefault('PYART_QUIET', '1')
warnings.filterwarnings('ignore')

import numpy as np  # noqa: E402
import recast_radar  # noqa: E402
import tifffile  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent.parent
DISTANCES_KM = (20, 40, 60, 80, 100, 120)
RADAR_KM = 0.390  # KTLX
EARTH_M = 6371e3 * 4 / 3
HALF_GRID_KM = 230

# Name, feature of the scene with its keys, reflectivity by height in km.
KINDS = [
    ('constant', 'box', 'top_km = 10\npeak_dbz = 40\nedge_km = 1\nradii_km = [5, 5]',
     lambda h: np.where(h < 10, 40.0, -99)),
    ('elevated', 'box', 'base_km = 3\ntop_km = 9\npeak_dbz = 40\nedge_km = 1\nradii_km = [5, 5]',
     lambda h: np.where((h > 3) & (h < 9), 40.0, -99)),
    ('ramp', 'layer', 'top_km = 12\nmelting_km = 3\npeak_dbz = 45\nradii_km = [9, 9]',
     lambda h: np.where(h < 12, 45 - 3 * np.maximum(h - 3, 0), -99)),
    ('core', 'storm', 'core_km = 5\ntop_km = 14\npeak_dbz = 55\nradii_km = [9, 9]',
     lambda h: 55 - 45 * (np.maximum(h - 5, 0) / 9) ** 2),
]


def axis_of(kind, index):
    """Returns the axis of a column in km east and north, in the middle of a column of the grid."""
    azimuth = np.radians(90 * kind + 45 * (index % 2) + 10)
    east, north = np.sin(azimuth), np.cos(azimuth)
    return [np.floor(DISTANCES_KM[index] * part) + 0.5 for part in (east, north)]


def write_scene(path):
    lines = ['[radar]\nstation = "KTLX"\n[volumes]\ncount = 1\nvcp = 212\n'
             'start = "2024-06-01T22:00:00Z"\n']
    for kind, (_, feature, keys, _) in enumerate(KINDS):
        for index in range(len(DISTANCES_KM)):
            east, north = axis_of(kind, index)
            lines.append(f'[[{feature}]]\nposition_km = [{east}, {north}]\n{keys}\n')
    path.write_text('\n'.join(lines))


def truth_of(profile):
    heights = np.linspace(RADAR_KM, 20, 200_001)
    dbz = profile(heights)
    liquid = np.where(dbz > -20, 3.44e-6 * 10 ** (np.minimum(dbz, 56) / 10 * 4 / 7), 0)
    return float(np.trapezoid(liquid, 1000 * heights))


def ours(program, path, folder):
    """Returns the map of VIL, with rows from north to south."""
    result = folder / 'vil.tif'
    subprocess.run([program, 'frame', path, '--product', 'vil', '-o', result], check=True,
                   capture_output=True)
    return tifffile.imread(result)


def in_map(values, east, north):
    return float(values[int(HALF_GRID_KM - north), int(HALF_GRID_KM + east)])


class PeerMap:
    """The VIL of recast-radar, on the gates of its lowest sweep."""

    def __init__(self, path):
        made = recast_radar.process(str(path), 'VIL', band='s', strict=True)
        radar = made.volume.to_pyart()
        begin, end = radar.get_start_end(0)
        self.azimuths = radar.azimuth['data'][begin:end + 1]
        ranges = radar.range['data']
        angle = np.radians(radar.fixed_angle['data'][0])
        heights = np.sqrt(ranges**2 + EARTH_M**2 + 2 * ranges * EARTH_M * np.sin(angle)) - EARTH_M
        self.arcs_m = EARTH_M * np.arcsin(ranges * np.cos(angle) / (EARTH_M + heights))
        self.values = np.ma.filled(radar.fields['VIL']['data'][begin:end + 1], np.nan)

    def at(self, east, north):
        azimuth = np.degrees(np.arctan2(east, north))
        ray = np.argmin(np.abs((self.azimuths - azimuth + 180) % 360 - 180))
        gate = np.argmin(np.abs(self.arcs_m - 1000 * np.hypot(east, north)))
        return float(self.values[ray, gate])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--program', default=HERE / 'build/release/cli/stormcellar')
    program = parser.parse_args().program
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_scene(folder / 'scene.toml')
        subprocess.run([program, 'synth', folder / 'scene.toml', '-o', folder / 'files'],
                       check=True, capture_output=True)
        path = next((folder / 'files').iterdir())
        mine, peer = ours(program, path, folder), PeerMap(path)
    print('VIL, kg/m2; the error is in %')
    print(f'{"column":10}{"km":>5}{"stormcellar":>13}{"truth":>9}{"recast":>9}{"ours %":>9}'
          f'{"theirs %":>10}')
    missed = []
    for kind, (kind_name, _, _, profile) in enumerate(KINDS):
        truth, errors = truth_of(profile), []
        for index, distance in enumerate(DISTANCES_KM):
            place = axis_of(kind, index)
            found = in_map(mine, *place), peer.at(*place)
            errors.append([100 * (value / truth - 1) for value in found])
            print(f'{kind_name:10}{distance:5}{found[0]:13.2f}{truth:9.2f}{found[1]:9.2f}'
                  f'{errors[-1][0]:9.1f}{errors[-1][1]:10.1f}')
        rms = np.sqrt(np.nanmean(np.square(errors), axis=0))
        print(f'{kind_name:10}{"rms":>5}{"":31}{rms[0]:9.1f}{rms[1]:10.1f}')
        if not rms[0] < rms[1]:
            missed.append(kind_name)
    if missed:
        print(f'stormcellar is not the best for: {", ".join(missed)}', file=sys.stderr)
    return 1 if missed else 0


if __name__ == '__main__':
    sys.exit(main())
