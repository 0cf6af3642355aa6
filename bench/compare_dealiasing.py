#!/usr/bin/env python3
"""Compares the dealiasing of stormcellar with recast-radar and Py-ART, in one run on one thread.

usage: bench/compare_dealiasing.py [--program build/release/bench/bench_dealias] [--data DIR]
       [--pyart] [--cases FILE ...] [--edges FILE ...]

Needs numpy and recast-radar 0.1.3 (pip); --pyart also needs arm_pyart, and unravel if UNRAVEL is
wanted. All run in this process or in bench_dealias, one after the other.

1. Folded again (--cases): the truth is every gate on which recast's methods `pyart` and `volume`
   agree at the real Nyquist velocity. The velocities are folded again at 20, 16, 12 and 8.5 m/s.
   Prints the wrong gates in %, and the seconds, of each method. For stormcellar it also prints which
   share of the wrong and of the right gates is marked ambiguous.
2. One sweep folded again (--pyart): the same for sweeps of a tornado and a hurricane, with Py-ART's
   region and phase methods and UNRAVEL. The truth is every gate on which region and UNRAVEL agree.
   A turn that is common to all gates of a phase result is taken out.
3. Edges that are left (--edges, else every volume): pairs of adjacent gates that still differ by
   more than the Nyquist velocity, at the real Nyquist velocity, and the seconds. A dash marks a
   file that the other program does not read.

Exits with status 1 if `anchored` has more wrong gates or edges than another method.
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
SWEEPS = [('KTLX19990503_235621.gz', 1), ('KCRP20170826_044114.trimmed.ar2v', 1)]
UNKNOWN = -128
MISSED = []  # cells in which another method is better


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--program', default=HERE / 'build/release/bench/bench_dealias')
    parser.add_argument('--data', type=pathlib.Path,
                        default=os.environ.get('STORMCELLAR_DATA', HERE.parent / 'shared/data'))
    parser.add_argument('--pyart', action='store_true', help='run Py-ART and UNRAVEL, too')
    parser.add_argument('--cases', nargs='*', default=CASES, metavar='FILE')
    parser.add_argument('--edges', nargs='*', default=None, metavar='FILE')
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


def folds_of(truth, velocity, nyquist):
    """Returns the right fold numbers, and UNKNOWN where the truth is NaN."""
    folds = (truth - velocity) / (2 * nyquist)
    return np.where(np.isfinite(folds), np.round(folds), UNKNOWN)


def ours_of_case(options, case, name, others_have):
    """Returns our results on a case, and notes it if another method has fewer wrong gates."""
    rungs = ours(options.program, [case], '--case')
    check(name, rungs['anchored']['wrong_pct'], others_have)
    return rungs


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
            case = scratch / 'case'
            write_case(case, radar, velocity, folds_of(truth, velocity, nyquist), nyquist)
            rungs = ours_of_case(options, case, f'{name} {nyquist}', row[::2])
            for rung in ('region', 'anchored'):
                row += [rungs[rung][key] for key in
                        ('wrong_pct', 'seconds', 'marked_wrong_pct', 'marked_right_pct')]
            print_row(name, nyquist, *row)


def check(cell, ours_has, others_have):
    """Notes a cell in which another method has fewer wrong gates or edges."""
    best = min((float(other) for other in others_have if other != '-'), default=ours_has)
    if ours_has > best:
        MISSED.append(f'{cell}: {ours_has} instead of {best}')


def unravel_sweep(radar, velocity, nyquist):
    """Returns the velocities of UNRAVEL, and the seconds."""
    import unravel
    start = time.process_time()
    found, _ = unravel.dealiasing_process_2D(
        radar.range['data'].astype(float), radar.azimuth['data'].astype(float),
        float(radar.elevation['data'].mean()), velocity.copy(), nyquist)
    return np.ma.filled(found.astype(float), np.nan), time.process_time() - start


def pyart_sweep(radar, velocity, nyquist, method):
    """Returns the velocities of a method of Py-ART, and the seconds."""
    import pyart
    # The phase method does not end if a masked gate holds NaN.
    masked = np.ma.array(np.nan_to_num(velocity), mask=np.isnan(velocity))
    radar.add_field_like('velocity', 'again', masked, replace_existing=True)
    valid = pyart.filters.GateFilter(radar)
    valid.exclude_invalid('again')
    # Legacy sweeps have radials that overlap, which its check refuses.
    options = {'skip_checks': True} if method == 'unwrap_phase' else {}
    start = time.process_time()
    found = getattr(pyart.correct, f'dealias_{method}')(
        radar, vel_field='again', gatefilter=valid, nyquist_vel=nyquist, **options)
    return np.ma.filled(found['data'].astype(float), np.nan), time.process_time() - start


def compare_sweeps(options, scratch):
    import pyart
    try:
        import unravel  # noqa: F401
    except ImportError:
        print('no sweeps: the truth needs unravel')
        return
    print_row('file', 'nyquist', *[f'{name} %\ts' for name in ('region', 'phase', 'unravel')],
              *[f'{rung} %\ts' for rung in ('ours region', 'anchored')])
    for name, number in SWEEPS:
        volume = pyart.io.read_nexrad_archive(str(options.data / 'volumes' / name))
        radar = volume.extract_sweeps([number])
        real = nyquists_of(radar)[0]
        raw = field(radar, 'velocity')
        agreed = pyart_sweep(radar, raw, real, 'region_based')[0]
        known = np.abs(agreed - unravel_sweep(radar, raw, real)[0]) < 1
        truth = np.where(known, agreed, np.nan)
        for nyquist in NYQUISTS:
            velocity = (truth + nyquist) % (2 * nyquist) - nyquist
            row = []
            for method in ('region_based', 'unwrap_phase', 'unravel'):
                found, seconds = (unravel_sweep(radar, velocity, nyquist) if method == 'unravel'
                                  else pyart_sweep(radar, velocity, nyquist, method))
                turns = np.round((found - truth) / (2 * nyquist))
                if method == 'unwrap_phase':
                    turns -= np.nan_to_num(np.nanmedian(turns[known]))
                row += [f'{100 * (turns[known] != 0).mean():.2f}', f'{seconds:.3f}']
            case = scratch / 'case'
            write_case(case, radar, velocity, folds_of(truth, velocity, nyquist), nyquist)
            rungs = ours_of_case(options, case, f'{name} {nyquist}', row[::2])
            for rung in ('region', 'anchored'):
                row += [rungs[rung]['wrong_pct'], rungs[rung]['seconds']]
            print_row(name, nyquist, *row)


def edges_of_others(path, options):
    """Returns the edges that other methods leave, and their seconds; dashes for unread files."""
    row = []
    try:
        for method in ('pyart', 'volume'):
            radar, seconds = recast(recast_radar.read(path), method)
            row += [edges(radar, field(radar, 'corrected_velocity')), f'{seconds:.3f}']
    except (ValueError, RuntimeError, recast_radar.DecodeError):
        row = ['-'] * 4
    if not options.pyart:
        return row
    try:
        if row[0] == '-':
            import pyart
            radar = pyart.io.read_nexrad_archive(path)
        found, seconds = pyart_region(radar)
        return row + [edges(radar, np.ma.filled(found.astype(float), np.nan)), f'{seconds:.3f}']
    except Exception:  # Py-ART raises errors of many kinds about files that it does not read.
        return row + ['-', '-']


def compare_edges(options):
    files = options.edges
    if files is None:
        files = sorted(path.name for path in (options.data / 'volumes').iterdir())
    print_row('file', 'raw', *[f'{name} edges\ts' for name in ('pyart', 'volume')],
              *(['py-art edges\ts'] if options.pyart else []),
              *[f'{rung} edges\ts' for rung in ('ours region', 'anchored')])
    for name in files:
        path = str(options.data / 'volumes' / name)
        try:
            rungs = ours(options.program, [path])
        except subprocess.CalledProcessError:
            continue
        if rungs['region']['gates'] == 0:
            continue
        row = edges_of_others(path, options)
        check(name, rungs['anchored']['jumps'], row[::2])
        for rung in ('region', 'anchored'):
            row += [rungs[rung]['jumps'], rungs[rung]['seconds']]
        print_row(name, rungs['off']['jumps'], *row)


def main():
    options = arguments()
    with tempfile.TemporaryDirectory() as scratch:
        if options.cases:
            compare_cases(options, pathlib.Path(scratch))
        if options.pyart:
            compare_sweeps(options, pathlib.Path(scratch))
    if options.edges != []:
        compare_edges(options)
    for cell in MISSED:
        print('missed:', cell)
    return 1 if MISSED else 0


if __name__ == '__main__':
    sys.exit(main())
