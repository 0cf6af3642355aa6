"""Runs our benchmarks for the paper's tables and figures. Each function returns results by claim number."""
from . import charts
from .claims import BY_NUMBER, TABLE_1, VOLUMES
from .page import Ours

SITES = (1, 10, 30, 50, 100)
QUICK_SITES = 16
QUICK_ROWS = (1, 10, 100)
HOURS = 5


def known(value):
    """Returns a figure of a benchmark as text. The figure is null if the benchmark had nothing to measure."""
    return 'unknown' if value is None else f'{value:.3g}'


def feed(runs):
    """Runs the national feed. With --quick, runs only its first sites at ten times the speed, which send as much in a second."""
    words = ['--as', 'growing', '--threads', '2', '--work', runs.work / 'feed']
    if runs.quick:
        words += ['--sites', QUICK_SITES, '--speeds', '10 160', '--seconds', '10']
    paced, fast = runs.bench('bench_feed', *words)
    radars = fast['sites'] * fast['sustained_x']
    way = f'{fast["sites"]} sites at {fast["sustained_x"]:g} times their speed'
    results = {
        '1.1': Ours(text=f'{known(paced["latency_p95_s"])} s (p95) after the last chunk'),
        '1.2': Ours(radars, text=way),
        '1.3': Ours(fast['raw_mb_per_s'], text='sustained'),
    }
    rows = runs.bench('bench_kernels', '--runs', '3', '--threads', '1',
                      runs.data / 'volumes' / 'KLBB20160601_150025_V06')
    best = max(row['ratio'] for row in rows if not row['way'].startswith(('libbz2', 'decode')))
    results['1.4'] = Ours(does=True, text=f'{best:.1f} times as fast as libbz2')
    return results


def users(runs):
    """Measures many simultaneous streams of events at the data server."""
    words = ['--hour', '--work', runs.work / 'feed']
    if runs.quick:
        words += ['--sites', QUICK_SITES, '--seconds', '10']
    rows = runs.bench('bench_events', *words)
    row = rows[-1]
    good = row['lost'] == 0 and row['closed'] == 0
    held = f'{row["streams"]} clients at the same time; {row["lost"]} events lost, {row["closed"]} streams closed'
    return {
        '7.3': Ours(does=good, text=held),
        '9.1': Ours(does=good, text=f'{row["streams"]} users get the event of a grid within {known(row["event_p95_ms"])} ms (p95)'),
    }


def sites(runs):
    """Runs figure 8. Returns results and the chart. With --quick, runs one of the five hours and multiplies the minutes by
    five, and leaves out the numbers of sites for which the paper gives no minutes."""
    hours = 1 if runs.quick else HOURS
    scale = HOURS / hours
    counts = QUICK_ROWS if runs.quick else SITES
    rows = []
    for count in counts:
        rows += runs.bench('bench_mosaic', '--only', count, '--alone', '--hours', hours, '--work', runs.work / 'mosaic')
    minutes = {(row['sites'], row['threads']): row['total_s'] * scale / 60 for row in rows}
    note = '' if hours == HOURS else f'extrapolated: {scale:g} times {hours} hour'
    results = {}
    for number, count, threads in (('4.1', 1, 1), ('4.2', 1, 2), ('4.3', 100, 1), ('4.4', 100, 2)):
        results[number] = Ours(minutes[count, threads])
    gains = [f'{100 * (minutes[count, 1] / minutes[count, 2] - 1):.0f} % ({count} sites)' for count in (30, 50, 100)
             if count in counts]
    results['4.5'] = Ours(text=', '.join(gains))
    for number, count in (('4.6', 1), ('4.7', 10)):
        results[number] = Ours(minutes[count, 2] / minutes[count, 1])
    raw_gb = {row['sites']: row['raw_gb'] * scale for row in rows}
    results['4.9'] = Ours(text=f'{1000 * raw_gb[1]:.0f} MB, {raw_gb[100]:.1f} GB')
    chart = charts.sites(
        'Minutes for five hours of data' + (f' (ours: {note})' if note else ''),
        {'2008, in sequence': (charts.PAPER, {1: BY_NUMBER['4.1'].value, 100: BY_NUMBER['4.3'].value}),
         '2008, 512 nodes': ('#e0a98a', {1: BY_NUMBER['4.2'].value, 100: BY_NUMBER['4.4'].value})},
        {'ours, 1 thread': (charts.OURS, {count: minutes[count, 1] for count in counts}),
         'ours, 2 threads': (charts.BEST, {count: minutes[count, 2] for count in counts})})
    return results, chart


def rates(runs):
    """Runs table 1 and figures 6 and 7. Returns results and the three charts."""
    rows = runs.bench('bench_render', '--threads', '2', '--runs', '1' if runs.quick else '4')
    like, best = {}, {}
    for row in rows:
        cell = row['volume'], row['slices']
        if row['method'] == 'riemann':
            like[cell] = row
        if cell not in best or row['fps'] > best[cell]['fps']:
            best[cell] = row
    results, bars, stacks = {}, [], []
    for column, volume in enumerate(VOLUMES):
        for i, slices in enumerate(TABLE_1):
            row, fastest = like[volume, slices], best[volume, slices]
            claim = BY_NUMBER[f'5.{column * len(TABLE_1) + i + 1}']
            results[claim.number] = Ours(row['fps'], text=f'dE {row["de_p99"]:g}')
            bars.append((volume, slices, claim.value, row['fps'], fastest['fps']))
            stacks.append((volume, slices, row['t1_s'], row['t2_s'], row['t3_s']))
    share = [100 * row['t3_s'] / (row['t1_s'] + row['t2_s'] + row['t3_s']) for row in like.values()]
    results['5.16'] = Ours(text=f'drawing takes {min(share):.0f} to {max(share):.0f} % of the time')
    cell = VOLUMES[0], 256
    results['5.17'] = Ours(like[cell]['fps'], text=f'dE {like[cell]["de_p99"]:g}')
    results['5.21'] = Ours(does=True, text='such slices, but front to back')
    machines = charts.machines([
        ('Quadro FX 3500 (table 1)', float(TABLE_1[256][0]), charts.PAPER),
        ('GeForce 8800 GTX (figure 7)', float(BY_NUMBER['5.17'].value), charts.PAPER),
        ('ours, the same way', like[cell]['fps'], charts.OURS),
        (f'ours, {best[cell]["method"]}', best[cell]['fps'], charts.BEST)])
    return results, {'rates': charts.frame_rates(bars), 'steps': charts.steps(stacks), 'machines': machines}
