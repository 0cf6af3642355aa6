"""The published system of 2008, claim by claim: every number of it that the page shows stands here, once.

A claim is judged by `how`:
  more, less   the ratio of our value to the paper's, or the other way round: more than 1.05 is beaten, 0.95 and more met
  does         we do it too, or not: met
  betters      it is named as a trouble of the system, and we do not have it: beaten
  none         the two cannot be compared; `why` says the reason
"""
from dataclasses import dataclass

TITLE = 'An Integrated System for Near Real-Time 3D Visualization of NEXRAD Level II Data on TeraGrid'


@dataclass(frozen=True)
class Claim:
    number: str
    text: str
    paper: str  # as the page shows it
    how: str
    value: float | None = None  # the paper's, of more and less
    unit: str = ''  # of ours
    why: str = ''


SECTIONS = {
    '1': 'Feed',
    '2': 'Storage and access',
    '3': 'Grid',
    '4': 'Many sites, in sequence and in parallel (figure 8)',
    '5': 'Rendering (table 1, figures 6 and 7)',
    '6': 'The animation of 24 hours (section 8.1)',
    '7': 'Troubles (section 8.4)',
    '8': 'Remote users',
    '9': 'Its future work',
    '10': 'The systems that it names as the state of the art',
}

# Table 1: frames a second by the number of slices.
VOLUMES = ('128x128x64', '256x256x128', '512x512x256')
TABLE_1 = {64: (20, 18, 4), 128: (15, 12, 4), 256: (8, 8, 3.5), 512: (5, 5, 2.5), 1024: (3, 3, 1.5)}

TWO_MACHINES = 'theirs is a pool of computers, ours is one with {cores} cores, which can gain {most_gain} % at most'
NO_NUMBERS = 'the figure is a drawing without numbers'
NOT_RUN = 'that system was not run beside ours'


def _cells():
    for column, volume in enumerate(VOLUMES):
        for row, slices in enumerate(TABLE_1):
            fps = TABLE_1[slices][column]
            yield Claim(f'5.{column * len(TABLE_1) + row + 1}', f'{volume}, {slices} slices', f'{fps} frames/s', 'more', fps,
                        'frames/s')


CLAIMS = (
    Claim('1.1', 'data are there after their measurement', 'less than 30 s', 'none',
          why="theirs begins at the antenna and is LDM's way, ours at LDM's last chunk; LDM's way is the same for both"),
    Claim('1.2', 'radars of the feed (National Weather Service and Department of Defense)', '121 + 11 radars', 'more', 121 + 11,
          'radars'),
    Claim('1.3', 'rate of the feed, uncompressed', 'about 50 MB/s', 'more', 50, 'MB/s'),
    Claim('1.4', 'a modified bzip2 unpacks the records of LDM', 'it does', 'does'),
    Claim('2.1', 'a shadow directory for each station, registered as data arrive', 'it does', 'does'),
    Claim('2.2', 'a THREDDS server on top', 'it does', 'does'),
    Claim('2.3', 'which the IDV reads', 'it does', 'none', why='the IDV is not in Debian; `scripts/check-siphon` reads with '
          "Unidata's Siphon"),
    Claim('2.4', 'a factory of `RadarSet` objects, one for each station', 'it does', 'does'),
    Claim('2.5', '`buildDataList`: the files of a station and a period', 'it does', 'does'),
    Claim('2.6', '`getOldestFileName`', 'it does', 'does'),
    Claim('2.7', '`getRadarFile`: the file, compressed as it came', 'it does', 'does'),
    Claim('2.8', "`readRadar`: sweeps and radials in memory (RSL's structure there)", 'it does', 'does'),
    Claim('2.9', 'a command line, beside the C++ library', 'it does', 'does'),
    Claim('3.1', 'a box over all sites', 'it does', 'does'),
    Claim('3.2', 'a rectilinear grid, non-uniform', '256 x 256 x 128 cells', 'does'),
    Claim('3.3', 'sites merged by the mean of samples', 'it does', 'does'),
    Claim('3.4', 'gaps filled by interpolation along the vertical', 'it does', 'does'),
    Claim('3.5', 'interpolation in time between two volumes', 'it does', 'does'),
    Claim('4.1', '1 site, in sequence', '0.78 minutes', 'less', 0.78, 'minutes'),
    Claim('4.2', '1 site, in parallel, scheduling included', '6.72 minutes', 'less', 6.72, 'minutes'),
    Claim('4.3', '100 sites, in sequence', '46.87 minutes', 'less', 46.87, 'minutes'),
    Claim('4.4', '100 sites, in parallel, scheduling included', '8.92 minutes', 'less', 8.92, 'minutes'),
    Claim('4.5', '30 sites: gain of parallel over sequence', '77.5 %', 'none', why=TWO_MACHINES),
    Claim('4.6', '50 sites: gain of parallel over sequence', '249 %', 'none', why=TWO_MACHINES),
    Claim('4.7', '100 sites: gain of parallel over sequence', '508.7 %', 'none', why=TWO_MACHINES + '; and see the '
          'contradictions below'),
    Claim('4.8', '1 site: sequence is faster, so parallel takes that much more', '761 %', 'less', 1 + 7.61,
          'times the sequence'),
    Claim('4.9', '10 sites: sequence is faster, so parallel takes that much more', '11 %', 'less', 1 + 0.11,
          'times the sequence'),
    Claim('4.10', 'parallel, from the smallest to a larger number of sites', '"1.14 to 4.75 minutes or 31.7 %"', 'none',
          why='it does not say of which numbers of sites, and contradicts itself'),
    Claim('4.11', 'data of 1 site, five hours of March 21, 2008 (11 to 16 h), uncompressed', '200 MB', 'none',
          why='those files are not here; ours are ten kinds of real and simulated volumes'),
    Claim('4.12', 'data of 100 sites, the same', '27 GB', 'none', why='those files are not here; see the row above'),
    Claim('4.13', 'computers', '512 nodes of two processors', 'none', why='we have one, with {cores} cores'),
    Claim('4.14', 'a processing job for each station, one that merges, ordered by DAGMan on Condor', 'it does', 'does'),
    *_cells(),
    Claim('5.16', 'time of a frame by step: read, update the texture, draw (figure 6)', 'three bars for each cell', 'none',
          why=NO_NUMBERS + '; the sums are the rows above'),
    Claim('5.17', 'the fastest of five machines (figure 7), a GeForce 8800 GTX: 128x128x64, 256 slices', 'about 45 frames/s',
          'more', 45, 'frames/s'),
    Claim('5.18', 'the other four machines of figure 7', 'four bars', 'none', why=NO_NUMBERS),
    Claim('5.19', 'the machine of table 1', 'Pentium 4 at 3.2 GHz, Quadro FX 3500', 'none',
          why='that machine is not here, and ours has no graphics processor'),
    Claim('5.20', 'size of the picture', '796 x 532 pixels', 'does'),
    Claim('5.21', 'slices parallel to the picture, composited back to front', 'it does', 'does'),
    Claim('5.22', "a transfer function of one dimension, like the Weather Service's table", 'it does', 'does'),
    Claim('5.23', 'a window that edits its red, green, blue and alpha', 'it does', 'does'),
    Claim('6.1', 'an animation of a day', '24 hours', 'does'),
    Claim('6.2', 'of the supercells over the Midwest', 'March 12, 2006', 'none',
          why='those files are in the public archive, and this page is made without a network; the commands are below'),
    Claim('6.3', 'seen from above, tilted', 'about 20 degrees', 'does'),
    Claim('7.1', 'files with a negative number of sweeps', 'not read: found by their size and skipped', 'betters'),
    Claim('7.2', 'disk space', 'it ran out', 'betters'),
    Claim('7.3', 'connections to the catalog', 'limited', 'betters'),
    Claim('8.1', 'an interface with a map, for people elsewhere', 'over VNC', 'does'),
    Claim('8.2', 'a region of interest, with many sites', 'it does', 'does'),
    Claim('8.3', 'interactive animation in 3D', 'it does', 'does'),
    Claim('9.1', 'many interactive users', 'planned', 'does'),
    Claim('9.2', 'higher resolution: cells of a grid beside its largest one, 512x512x256', 'planned', 'more', 512 * 512 * 256 / 1e6,
          'million cells'),
    Claim('9.3', 'faster answers by caching and preprocessing', 'planned', 'does'),
    Claim('10.1', 'IDV', 'named', 'none', why=NOT_RUN + '; our netCDF follows the conventions that it reads'),
    Claim('10.2', 'the Java NEXRAD viewer and exporter of NCDC', 'named', 'none', why=NOT_RUN + '; we draw and export, too'),
    Claim('10.3', 'CRAFT and IRAS: Level II over the Internet, live', 'named', 'none',
          why=NOT_RUN + '; CRAFT sent its data by LDM, which feeds our service'),
    Claim('10.4', 'Vis5D and VisAD: shared interactive views', 'named', 'none',
          why=NOT_RUN + '; an address of our viewer holds its view, but two people do not steer one view'),
    Claim('10.5', "Riley et al.: light by particles' optical properties, several fields", 'named', 'none',
          why=NOT_RUN + '; we have light and panels of several moments, and no particles'),
    Claim('10.6', 'Song et al.: physics-based, illustrative, particle and glyph rendering', 'named', 'none',
          why=NOT_RUN + '; we have none of particles and glyphs'),
    Claim('10.7', 'Ueng et al.: Doppler radar in 3D, in three passes', 'named', 'none',
          why=NOT_RUN + '; we draw velocity in 3D, too'),
    Claim('10.8', 'VORTRAC: strength of a hurricane from one Doppler radar', 'named', 'none',
          why=NOT_RUN + '; we have nothing like it'),
)

BY_NUMBER = {claim.number: claim for claim in CLAIMS}
