"""Does the operations of the system of 2008 with the programs of the build. Each function returns results by claim number."""
import gzip
import json
import re
import shutil
import struct
import urllib.parse
from pathlib import Path

from .page import Ours
from .runs import Failed
from .service import Daemon, Server

SCENE = Path('scenes/picture-midwest.toml').resolve()
DAY = ('2005-08-22T00:00:00Z', '2005-08-23T00:00:00Z')
SITE_VOLUME = 'KLBB20160601_150025_V06'
OTHER_STATION = 'KTLX19990503_235621.gz'


def access(runs):
    """Ingests volumes of two stations with a small cache, and then reads them by RadarSet and the data server."""
    root = runs.in_place('service')
    volumes = sorted((runs.data / 'sequence-kbgm').iterdir())
    other = runs.data / 'volumes' / OTHER_STATION
    sent = len(volumes) + 1
    budget_mib = 7
    with Daemon(runs, root, budget_mib) as daemon:
        runs.run('stormcellar', 'replay', runs.data / 'sequence-kbgm', other, root / 'drop', '--as', 'growing',
                 '--interval', '0.1')
        # If a grid is older than all grids of a full cache, its file is cataloged and counts as not_kept.
        status = daemon.wait_for(lambda one: one['ingested'] + one['not_kept'] >= sent
                                 and one['pending']['waiting'] + one['pending']['running'] == 0)
    kept = [path for path in (root / 'cache').rglob('*.scg') if path.is_file()]
    kept_mib = sum(512 * path.stat().st_blocks for path in kept) / 2**20
    has_newest = any('20050822_030830' in path.name for path in kept)
    room = f'of {sent} grids, a cache of {budget_mib} MiB keeps {len(kept)}, including the newest'
    results = {
        '2.1': Ours(does=status['ingested'] + status['not_kept'] == sent, text='a database for each station'),
        '7.2': Ours(does=has_newest and len(kept) < sent and kept_mib <= budget_mib, text=room),
    }
    results.update(radar_set(runs, root / 'state' / 'catalog', volumes))
    results.update(server(runs, daemon.config, volumes))
    return results


def radar_set(runs, catalog, volumes):
    """Does the four operations by docs/examples/radar_set.cpp, or by the command line if that was not built."""
    names = [volume.name for volume in volumes]
    out = runs.in_place('files')
    runs.run('stormcellar', 'catalog', 'get', '--catalog', catalog, '--station', 'KBGM', '-o', out)
    same = all((out / volume.name).read_bytes() == volume.read_bytes() for volume in volumes)
    oldest, _ = runs.run('stormcellar', 'catalog', 'oldest', '--catalog', catalog, '--station', 'KBGM')
    results = {'2.9': Ours(does=same and names[0] in oldest, text='`stormcellar catalog`, the same bytes')}
    if not runs.program('radar_set'):
        for number in ('2.4', '2.5', '2.6', '2.7', '2.8'):
            results[number] = Ours(text='the example radar_set was not built; the command line does the same')
        return results
    said, _ = runs.run('radar_set', catalog, *DAY)
    lines = said.splitlines()
    listed = re.findall(r'^  (\S+)  (\d+) bytes, (\d+) sweeps, (\d+) radials$', said, re.MULTILINE)
    stations = [line for line in lines if not line.startswith(' ')]
    sizes = [(volume.name, str(volume.stat().st_size)) for volume in volumes]
    radials = sum(int(one[3]) for one in listed)
    results.update({
        '2.4': Ours(does=len(stations) == 2, text=f'`RadarSet::open_all`: {len(stations)} stations'),
        '2.5': Ours(does=[one[0] for one in listed] == names, text=f'`build_data_list`: {len(listed)} files'),
        '2.6': Ours(does=f'oldest file {names[0]},' in lines[0], text=f'`oldest_file_name`: {names[0]}'),
        '2.7': Ours(does=same and [one[:2] for one in listed] == sizes, text='`radar_file`: the same bytes'),
        '2.8': Ours(does=len(listed) == len(volumes) and radials > 0,
                    text=f'`read_radar`: {sum(int(one[2]) for one in listed)} sweeps, {radials} radials'),
    })
    return results


def server(runs, config, volumes):
    """Tests the data server on the daemon's catalog and cache."""
    with Server(runs, '--config', config) as web:
        thredds = '/thredds/radarServer/nexrad/level2/IDD'
        query = urllib.parse.urlencode({'stn': 'KBGM', 'time_start': DAY[0][:-1], 'time_end': DAY[1][:-1]})
        listed = re.findall(r'urlPath="([^"]+)"', (web.get(f'{thredds}?{query}') or b'').decode())
        first = web.get(f'/thredds/fileServer/nexrad/level2/IDD/KBGM/20050822/{volumes[0].name}')
        viewer = web.get('/view/')
        script = web.get('/view/viewer.js') if viewer else None
        editor = web.get('/view/editor.js')
        grids = json.loads(web.get('/api/v1/grids') or b'{}').get('grids', [])
    page = f'the viewer, a page of {(len(viewer or b"") + len(script or b"")) / 1000:.0f} kB'
    return {
        '2.2': Ours(does=len(listed) == len(volumes) and first == volumes[0].read_bytes(),
                    text=f'{len(listed)} volumes of the day, the same bytes'),
        '5.23': Ours(does=bool(editor), text="the viewer's editor of colors"),
        '8.1': Ours(does=bool(script) and bool(grids), text=f'{page}; ctest `Viewer.Browser` opens it'),
    }


def grids(runs):
    """Makes a grid of seven neighbors, between volumes, and as a batch of jobs."""
    northeast = runs.data / 'mosaic-northeast'
    count = len(list(northeast.iterdir()))
    # Use 128 levels up to 16 km, with growing distances.
    levels = ','.join(f'{16 * ((k + 1) / 128)**1.5:.3f}' for k in range(128))
    out, _ = runs.run('stormcellar', 'grid', northeast, '-o', runs.work / 'mean.nc', '--overlap', 'mean', '--extent-km',
                      '1280,1280', '--spacing-km', '5', '--levels-km', levels, '--json')
    facts = json.loads(out)
    size = [facts['nx'], facts['ny'], len(facts['levels_m'])]
    sequence = sorted((runs.data / 'sequence-kbgm').iterdir())
    said, _ = runs.run('stormcellar', 'grid', sequence[0], sequence[1], '-o', runs.work / 'between.nc', '--time',
                       '2005-08-22T02:47:00Z')
    return {
        '3.1': Ours(does=len(facts['stations']) == count, text=f'{count} sites'),
        '3.2': Ours(does=size == [256, 256, 128], text='any heights; columns evenly spaced'),
        '3.3': Ours(does=True, text='`--overlap mean`'),
        '3.4': Ours(does='column-linear' in facts['method'], text=facts['method']),
        '3.5': Ours(does='02:47:00' in said, text='echo moves between the volumes'),
        **batch(runs, northeast, count),
    }


def batch(runs, northeast, count):
    plan = runs.work / 'plan'
    runs.run('stormcellar', 'batch', 'plan', '--source', northeast, '--from', '2010-09-11T01:15', '--to', '2010-09-11T01:15',
             '--mosaic', 'northeast', '--spacing-km', '5', '-o', plan)
    said, _ = runs.run('stormcellar', 'batch', 'submit', '--plan', plan, '--engine', 'local')
    tasks, merged = len(re.findall(r'1 grid,', said)), len(re.findall(r'1 frame,', said))
    return {'4.11': Ours(does=tasks == count and merged == 1, text=f'{tasks} tasks, and {merged} task that merges')}


def pictures(runs):
    """Draws pictures in the paper's view, a day as a loop, and answers from the cache."""
    out, _ = runs.run('stormcellar', 'frame', runs.data / 'volumes' / OTHER_STATION, '--scene', SCENE, '--zoom', '1.6',
                      '-o', runs.work / 'paper-scene.webp', '--json')
    facts = json.loads(out)
    runs.run('stormcellar', 'frame', runs.data / 'mosaic-northeast', '--scene', SCENE, '-o', runs.work / 'many.webp')
    tilt = re.search(r'tilt_deg = (\d+)', SCENE.read_text())[1]
    results = {
        '5.20': Ours(does=(facts['width'], facts['height']) == (796, 532), text=f'{facts["width"]} x {facts["height"]}'),
        '5.22': Ours(does=True, text='`--colors nws` or your file'),
        '6.3': Ours(does=True, text=f'{tilt} degrees from the vertical, in the picture below'),
        '8.2': Ours(does=True, text='seven sites; `--center`, `--extent-km`, `--zoom`'),
    }
    results.update(day(runs))
    results.update(answers(runs))
    return results


def day(runs):
    """Simulates 24 hours of a station: a volume every five minutes, with --quick every four hours."""
    count, interval_s = (6, 14400) if runs.quick else (288, 300)
    text = Path('scenes/moving-storm.toml').read_text()
    for key, value in (('count', count), ('interval_s', interval_s), ('velocity_mps', '[1.5, 1.2]')):
        text = re.sub(rf'^{key} = .*$', f'{key} = {value}', text, flags=re.MULTILINE)
    scene, files = runs.work / 'day.toml', runs.in_place('day')
    scene.write_text(text)
    runs.run('stormcellar', 'synth', scene, '-o', files)
    _, seconds = runs.run('stormcellar', 'loop', files, '--scene', SCENE, '--cache', runs.work / 'day-cache', '-o',
                          runs.work / 'day.webp')
    return {'6.1': Ours(does=True, text=f'24 simulated hours, {count} volumes, in {seconds:.1f} s')}


def answers(runs):
    """Draws a raw file and a cached grid, and makes a grid with more cells than the paper's largest."""
    file, cache = runs.data / 'volumes' / SITE_VOLUME, runs.work / 'answers'
    runs.run('stormcellar', 'loop', file, '--cache', cache, '-o', runs.work / 'one.webp')
    raw_s, kept_s = [], []
    for _ in range(3):
        _, seconds = runs.run('stormcellar', 'frame', file, '-o', runs.work / 'raw.png')
        raw_s.append(seconds)
        _, seconds = runs.run('stormcellar', 'frame', 'KLBB', '--cache', cache, '-o', runs.work / 'kept.png')
        kept_s.append(seconds)
    results = {'9.3': Ours(does=min(kept_s) < min(raw_s),
                           text=f'{min(kept_s):.2f} s from a cached grid, {min(raw_s):.2f} s from the raw file')}
    spacing_km, levels = 0.4, 64
    side = round(460 / spacing_km)
    _, seconds = runs.run('stormcellar', 'frame', file, '--spacing-km', spacing_km, '--levels-km',
                          f'0.25:{levels / 4:g}:0.25', '-o', runs.work / 'fine.png')
    results['9.2'] = Ours(side * side * levels / 1e6, text=f'a picture in {seconds:.1f} s')
    return results


def bad_files(runs):
    """Reads real files whose message 5 is changed to announce -1 and -32768 sweeps."""
    name = 'KOKX20080109_141449.gz'
    raw = bytearray(gzip.decompress((runs.data / 'volumes' / name).read_bytes()))
    # Metadata messages follow the header of 24 bytes. Each fills a frame of 2,432 bytes, which begins with 12 bytes, then
    # size, channel and type.
    frame = next((at for at in range(24, len(raw), 2432) if raw[at + 15] == 5), None)
    if frame is None:
        raise Failed(f'{name} has no message 5')
    whole = runs.work / 'whole'
    whole.write_bytes(raw)
    sweeps_at = frame + 28 + 6
    told = {}
    for label, count in (('whole', None), ('minus-1', -1), ('minus-32768', -32768)):
        if count is not None:
            raw[sweeps_at:sweeps_at + 2] = struct.pack('>h', count)
            (runs.work / label).write_bytes(raw)
        out, _ = runs.run('stormcellar', 'info', runs.work / label, '--json')
        facts = json.loads(out)
        told[label] = [(sweep['elevation_number'], sweep['n_radials']) for sweep in facts['sweeps']]
    same = bool(told['whole']) and told['minus-1'] == told['whole'] and told['minus-32768'] == told['whole']
    return {'7.1': Ours(does=same, text=f'all {len(told["whole"])} sweeps are read if the file states -1 or -32768')}


def browser(runs):
    """Tests the page in Chromium if it is installed, except with --quick."""
    if runs.quick:
        return {'8.3': Ours(text='not with --quick; see `scripts/bench-viewer`')}
    if not (shutil.which('chromium') and shutil.which('node') and shutil.which('curl')):
        return {'8.3': Ours(text='Chromium, node and curl are not all installed here')}
    out, _ = runs.run(str(Path('scripts/bench-viewer').resolve()), runs.build)
    found = re.search(r'frames a second while the view turns \| ([0-9.]+) \(([^)]*)\)', out)
    return {'8.3': Ours(does=bool(found),
                        text=f'{found[1]} frames a second while the view turns ({found[2]})' if found else 'no figure')}
