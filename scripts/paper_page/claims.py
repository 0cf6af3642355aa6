"""The claims of the published system of 2008, with every number of that system that the page shows.

`how` says how a claim is judged:
  more      by our value divided by the paper's: above 1.05 the claim is beaten, from 0.95 on it is met
  less      by the paper's value divided by ours, with the same limits
  does      met if we do the same
  betters   for a trouble of the system of 2008: beaten if we do not have it
  none      the claim is not compared; `why` gives the reason
"""
from dataclasses import dataclass

TITLE = 'An Integrated System for Near Real-Time 3D Visualization of NEXRAD Level II Data on TeraGrid'


@dataclass(frozen=True)
class Claim:
    number: str
    text: str
    paper: str  # as the page shows it
    how: str
    value: float | None = None  # the paper's number, for `more` and `less`
    unit: str = ''  # of our number; empty if the text above the table names it
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
    '9': 'Future work of the paper',
    '10': 'Systems that the paper names as the state of the art',
}

# Table 1: frames a second by the number of slices.
VOLUMES = ('128x128x64', '256x256x128', '512x512x256')
TABLE_1 = {64: (20, 18, 4), 128: (15, 12, 4), 256: (8, 8, 3.5), 512: (5, 5, 2.5), 1024: (3, 3, 1.5)}

NO_NUMBERS = 'a chart without numbers'


def _cells():
    for column, volume in enumerate(VOLUMES):
        for row, slices in enumerate(TABLE_1):
            fps = TABLE_1[slices][column]
            yield Claim(f'5.{column * len(TABLE_1) + row + 1}', f'{volume}, {slices} slices', f'{fps}', 'more', fps)


CLAIMS = (
    Claim('1.1', 'delay of data', 'less than 30 s', 'none', why='we measure only the delay after LDM'),
    Claim('1.2', 'radars of the feed (NWS and DoD)', '121 + 11', 'more', 121 + 11, 'radars'),
    Claim('1.3', 'rate of the feed, uncompressed', 'about 50 MB/s', 'more', 50, 'MB/s'),
    Claim('1.4', "a modified bzip2 unpacks LDM's records", 'yes', 'does'),
    Claim('2.1', 'a shadow directory for each station', 'yes', 'does'),
    Claim('2.2', 'a THREDDS server', 'yes', 'does'),
    Claim('2.3', 'the IDV reads this server', 'yes', 'none', why='the IDV was not run; see `scripts/check-siphon`'),
    Claim('2.4', 'a factory of `RadarSet` objects', 'yes', 'does'),
    Claim('2.5', '`buildDataList`: files of a station and period', 'yes', 'does'),
    Claim('2.6', '`getOldestFileName`', 'yes', 'does'),
    Claim('2.7', '`getRadarFile`: the compressed file', 'yes', 'does'),
    Claim('2.8', '`readRadar`: sweeps and radials', 'yes', 'does'),
    Claim('2.9', 'a command line', 'yes', 'does'),
    Claim('3.1', 'a box over all sites', 'yes', 'does'),
    Claim('3.2', 'a rectilinear, non-uniform grid', '256 x 256 x 128', 'does'),
    Claim('3.3', 'sites merged by the mean', 'yes', 'does'),
    Claim('3.4', 'gaps filled along the vertical', 'yes', 'does'),
    Claim('3.5', 'interpolation in time', 'yes', 'does'),
    Claim('4.1', '1 site, in sequence', '0.78 minutes', 'less', 0.78, 'minutes'),
    Claim('4.2', '1 site, in parallel, with scheduling', '6.72 minutes', 'less', 6.72, 'minutes'),
    Claim('4.3', '100 sites, in sequence', '46.87 minutes', 'less', 46.87, 'minutes'),
    Claim('4.4', '100 sites, in parallel, with scheduling', '8.92 minutes', 'less', 8.92, 'minutes'),
    Claim('4.5', '30, 50, 100 sites: gain of parallel over sequence', '77.5, 249, 508.7 %', 'none',
          why='ideal scaling on {cores} cores gains {most_gain} %'),
    Claim('4.6', '1 site: extra time in parallel, over the time in sequence', '761 %', 'less', 1 + 7.61, 'times as long'),
    Claim('4.7', '10 sites: the same', '11 %', 'less', 1 + 0.11, 'times as long'),
    Claim('4.8', 'time in parallel, from the fewest sites to more', '"1.14 to 4.75 minutes or 31.7 %"', 'none',
          why='the paper does not give the numbers of sites'),
    Claim('4.9', 'data of 1 and 100 sites, 5 hours of March 21, 2008', '200 MB, 27 GB', 'none', why='other files'),
    Claim('4.10', 'computers', '512 nodes of two processors', 'none', why='our run used one computer'),
    Claim('4.11', 'a job for each station, and one job that merges (Condor)', 'yes', 'does'),
    *_cells(),
    Claim('5.16', 'reading, updating, drawing (figure 6)', 'bars', 'none', why=NO_NUMBERS),
    Claim('5.17', 'GeForce 8800 GTX, fastest of figure 7: 128x128x64, 256 slices', 'about 45', 'more', 45),
    Claim('5.18', 'the other four machines of figure 7', 'bars', 'none', why=NO_NUMBERS),
    Claim('5.19', 'the machine of table 1', 'Pentium 4 at 3.2 GHz, Quadro FX 3500', 'none', why='we do not have this machine'),
    Claim('5.20', 'size of the picture', '796 x 532', 'does'),
    Claim('5.21', 'slices parallel to the picture, composited back to front', 'yes', 'does'),
    Claim('5.22', 'a transfer function of one dimension', 'yes', 'does'),
    Claim('5.23', 'a window that edits the transfer function', 'yes', 'does'),
    Claim('6.1', 'an animation of a day', '24 hours', 'does'),
    Claim('6.2', 'supercells over the Midwest', 'March 12, 2006', 'none', why='needs the public archive; commands below'),
    Claim('6.3', 'seen from above, tilted', 'about 20 degrees', 'does'),
    Claim('7.1', 'files with a negative number of sweeps', 'are found by their size and skipped', 'betters'),
    Claim('7.2', 'disk space', 'it ran out', 'betters'),
    Claim('7.3', 'connections to the catalog', 'limited', 'betters'),
    Claim('8.1', 'an interface with a map, remotely', 'over VNC', 'does'),
    Claim('8.2', 'a region with many sites', 'yes', 'does'),
    Claim('8.3', 'interactive animation in 3D', 'yes', 'does'),
    Claim('9.1', 'many interactive users', 'planned', 'does'),
    Claim('9.2', 'more cells than 512x512x256', 'planned', 'more', 512 * 512 * 256 / 1e6, 'million'),
    Claim('9.3', 'faster answers by caching', 'planned', 'does'),
    Claim('10.1', 'IDV, NCDC viewer, CRAFT, IRAS, Vis5D, VisAD, Riley, Song, Ueng, VORTRAC', 'named', 'none', why='not run here'),
)

BY_NUMBER = {claim.number: claim for claim in CLAIMS}
