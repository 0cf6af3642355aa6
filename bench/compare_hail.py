#!/usr/bin/env python3
"""Compares the hail of stormcellar with pyhail and recast-radar, on the same columns.

usage: bench/compare_hail.py [--program build/release/bench/bench_hail]

Needs numpy, arm_pyart, pyhail 3.4.2 and recast-radar 0.1.3 (pip). The columns are those of profiles
of reflectivity, sampled in two ways:
  levels  250 m and 500 m apart. pyhail computes them with mesh_grid.main().
  beams   The profile is seen by 40 sweeps of a synthetic volume, 0.5 degrees apart. Both peers take
          the volume, and each finds the gates above a place by itself. stormcellar takes heights
          and values of the nearest gates.
A table has SHI, POSH and MESH of each column from all programs, and the largest difference. Exits
with status 1 if MESH differs by more than 1 mm or POSH by more than 1 %.

How the peers integrate: both take the value of each gate for a layer that reaches half way to the
next gates, and the weight of temperature at the center of this layer. stormcellar integrates this
weight over the layer. Levels or beams more than 1 km apart make a difference of several mm.

Two differences are known, and are printed but not counted:
  - pyhail does not hold the warning threshold at its least value, 20 J/m/s, as recast-radar does.
    If 0 C is below 2.45 km, POSH of pyhail differs or is 0.
  - recast-radar gives no value for a SHI below 1 J/m/s (MESH below 2.5 mm).
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
import pyart  # noqa: E402
import recast_radar  # noqa: E402
from pyhail import mesh_formulas, mesh_grid, mesh_ppi  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent.parent
MOST_MM, MOST_PERCENT = 1, 1
LEAST_THRESHOLD_ABOVE_M = 2452  # 57.5 H - 121 = 20 J/m/s at this height of 0 C above the radar
LEAST_SHI_OF_RECAST = 1
RADAR_M = 0  # recast-radar takes heights above the radar, pyhail above sea level
EARTH_M = 6371e3 * 4 / 3
ELEVATIONS = np.arange(0.5, 20.01, 0.5)
RANGES = np.arange(800) * 250.0 + 125
RAYS = 8
GATE = 200  # of the lowest sweep: 50 km from the radar

# Name, heights of 0 and -20 C, and reflectivity by height in km.
PROFILES = [
    ('supercell', 4200, 7300, lambda h: np.interp(h, [0, 6, 11, 14], [58, 66, 48, 10])),
    ('giant hail', 4600, 7800, lambda h: np.interp(h, [0, 4, 9, 14, 16], [60, 72, 70, 50, 0])),
    ('marginal', 3800, 6900, lambda h: np.interp(h, [0, 4, 7, 9], [52, 54, 50, 20])),
    ('low level of 0 C', 2000, 5000, lambda h: np.interp(h, [0, 3, 7, 9], [50, 56, 50, 10])),
    ('flat top', 3500, 6500, lambda h: np.where(h < 8.2, 57.0, 5.0)),
    ('weak above 0 C', 4500, 7600, lambda h: np.interp(h, [0, 4.5, 6, 9], [55, 50, 41, 20])),
    ('tropical rain', 5000, 8300, lambda h: np.interp(h, [0, 5, 6, 15], [52, 45, 34, 5])),
]


def ours(program, columns):
    lines = []
    for zero_m, minus20_m, heights_m, dbz in columns:
        pairs = ' '.join(f'{h:.3f} {z:.6f}' for h, z in zip(heights_m, dbz))
        lines.append(f'{zero_m} {minus20_m} {RADAR_M} {pairs}')
    done = subprocess.run([program, '--profiles'], input='\n'.join(lines), text=True,
                          capture_output=True, check=True)
    return [[float(x) for x in line.split()] for line in done.stdout.splitlines()]


def pyhail_on_levels(zero_m, minus20_m, heights_m, dbz):
    """Returns SHI, POSH and MESH of one column with mesh_grid.main()."""
    shape = (len(heights_m), 3, 3)
    grid = pyart.testing.make_empty_grid(
        shape, ((heights_m[0], heights_m[-1]), (-1e3, 1e3), (-1e3, 1e3)))
    grid.radar_altitude = {'data': np.array([RADAR_M])}
    values = np.ma.array(np.broadcast_to(dbz[:, None, None], shape).copy())
    grid.add_field('dbz', {'data': values})
    fields = mesh_grid.main(grid, 'dbz', [zero_m, minus20_m], radar_band='S',
                            mesh_method='witt1998', speckle_filter=False,
                            near_radar_mask_range=None)
    return [float(fields[name]['data'][0, 1, 1]) for name in ('shi', 'posh', 'mesh_witt1998')]


def arcs_and_heights(elevation_deg):
    angle = np.radians(elevation_deg)
    heights_m = np.sqrt(RANGES**2 + EARTH_M**2 + 2 * RANGES * EARTH_M * np.sin(angle)) - EARTH_M
    return EARTH_M * np.arcsin(RANGES * np.cos(angle) / (EARTH_M + heights_m)), heights_m


def volume_of(profile):
    """Returns the synthetic volume as sweeps of rays and gates."""
    return [np.tile(profile(arcs_and_heights(e)[1] / 1000), (RAYS, 1)) for e in ELEVATIONS]


def column_of(sweeps):
    """Returns heights and values of the gates nearest to the gate of the lowest sweep."""
    arc_m = arcs_and_heights(ELEVATIONS[0])[0][GATE]
    heights_m, dbz = [], []
    for elevation, sweep in zip(ELEVATIONS, sweeps):
        arcs_m, all_m = arcs_and_heights(elevation)
        gate = int(np.argmin(np.abs(arcs_m - arc_m)))
        heights_m.append(all_m[gate] + RADAR_M)
        dbz.append(sweep[0, gate])
    return np.array(heights_m), np.array(dbz)


def pyhail_on_beams(zero_m, minus20_m, sweeps):
    azimuths = [np.arange(RAYS) * 360.0 / RAYS for _ in ELEVATIONS]
    fields = mesh_ppi.main([s.copy() for s in sweeps], list(ELEVATIONS), azimuths,
                           [RANGES for _ in ELEVATIONS], RADAR_M, [zero_m, minus20_m],
                           radar_band='S', mesh_method='witt1998')
    _, shi, mesh, posh = fields
    return [float(field['data'][0, GATE]) for field in (shi, posh, mesh)]


def recast_on_beams(zero_m, minus20_m, sweeps):
    radar = pyart.testing.make_empty_ppi_radar(len(RANGES), RAYS, len(ELEVATIONS))
    radar.range['data'] = RANGES.astype('f4')
    radar.range['meters_to_center_of_first_gate'] = RANGES[0]
    radar.range['meters_between_gates'] = RANGES[1] - RANGES[0]
    radar.fixed_angle['data'] = ELEVATIONS.astype('f4')
    radar.elevation['data'] = np.repeat(ELEVATIONS, RAYS).astype('f4')
    radar.azimuth['data'] = np.tile(np.arange(RAYS) * 360 / RAYS, len(ELEVATIONS)).astype('f4')
    radar.altitude['data'] = np.array([float(RADAR_M)])
    radar.add_field('reflectivity', {
        'data': np.ma.array(np.concatenate(sweeps).astype('f4')), 'units': 'dBZ',
        'standard_name': 'equivalent_reflectivity_factor', '_FillValue': -9999.0})
    with tempfile.TemporaryDirectory() as directory:
        path = os.path.join(directory, 'volume.nc')
        pyart.io.write_cfradial(path, radar)
        volume = recast_radar.read(path)
    made = recast_radar.process(volume, ['SHI', 'POSH', 'MESH'], band='s', strict=True,
                                freezing_level_m=float(zero_m - RADAR_M),
                                minus20c_level_m=float(minus20_m - RADAR_M))
    fields = recast_radar.to_pyart(made.volume).fields
    return [float(np.ma.filled(fields[name]['data'], np.nan)[0, GATE])
            for name in ('SHI', 'POSH', 'MESH')]


def compared_columns():
    """Returns the name, the column and the results of the peers for each column."""
    made = []
    for name, zero_m, minus20_m, profile in PROFILES:
        for step_m in (250, 500):
            heights_m = np.arange(step_m, 18001, step_m, dtype=float)
            dbz = profile(heights_m / 1000)
            made.append((f'{name}, {step_m} m', (zero_m, minus20_m, heights_m, dbz),
                         {'pyhail': pyhail_on_levels(zero_m, minus20_m, heights_m, dbz)}))
        sweeps = volume_of(profile)
        made.append((f'{name}, beams', (zero_m, minus20_m, *column_of(sweeps)),
                     {'pyhail': pyhail_on_beams(zero_m, minus20_m, sweeps),
                      'recast': recast_on_beams(zero_m, minus20_m, sweeps)}))
    return made


def report(name, program, numbers, hail, known=()):
    """Prints a row. Returns true if the numbers agree with ours or are known to differ."""
    shi, posh, mesh = numbers
    agrees = {'mesh': abs(mesh - hail[2]) <= MOST_MM, 'posh': abs(posh - hail[1]) <= MOST_PERCENT}
    missed = [what for what, fine in agrees.items() if not fine]
    verdict = ''.join('  known' if what in known else '  MISS' for what in missed)
    print(f'{name:26}{program:12}{shi:9.1f}{posh:8.1f}{mesh:8.2f}'
          f'{mesh - hail[2]:10.2f}{posh - hail[1]:10.2f}{verdict}')
    return 'MISS' not in verdict


def known_differences(program, column, hail):
    """Returns the numbers in which a peer is known to differ for a column."""
    if program == 'pyhail' and column[0] - RADAR_M < LEAST_THRESHOLD_ABOVE_M:
        return ['posh']
    if program == 'recast' and hail[0] < LEAST_SHI_OF_RECAST:
        return ['mesh', 'posh']
    return []


def check_sizes(hail):
    """Returns true if MESH75 and MESH95 are those of pyhail for our SHI."""
    shi = hail[0]
    return (abs(hail[3] - float(mesh_formulas.mesh_mh2019_75(shi))) < 0.01
            and abs(hail[4] - float(mesh_formulas.mesh_mh2019_95(shi))) < 0.01)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--program', default=HERE / 'build/release/bench/bench_hail')
    columns = compared_columns()
    results = ours(parser.parse_args().program, [column for _, column, _ in columns])
    misses = 0
    print(f'{"column":26}{"program":12}{"SHI":>9}{"POSH":>8}{"MESH":>8}{"mm off":>10}{"% off":>10}')
    for (name, column, peers), hail in zip(columns, results, strict=True):
        report(name, 'stormcellar', hail[:3], hail)
        for program, numbers in peers.items():
            known = known_differences(program, column, hail)
            misses += 0 if report('', program, numbers, hail, known) else 1
        if not check_sizes(hail):
            print(f'{name}: MESH75 or MESH95 differs from pyhail  MISS')
            misses += 1
    print(f'{misses} misses')
    return 1 if misses else 0


if __name__ == '__main__':
    sys.exit(main())
