"""Draws the charts of the page as SVG."""
import math
from html import escape

PAPER, OURS, BEST, THIRD = '#c2703d', '#2f6f9f', '#7fb2d6', '#5a9a6b'
INK, LINE = '#24303a', '#d5dce2'
WIDTH, HEIGHT = 860, 420
LEFT, RIGHT, TOP, BOTTOM = 70, 20, 64, 66


class Chart:
    def __init__(self, title, legend, height=HEIGHT):
        self.height = height
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
            'font-family="DejaVu Sans, Verdana, sans-serif" font-size="13">',
            f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>']
        self.text(LEFT, 24, title, size=16, weight='bold')
        x = LEFT
        for name, color in legend:
            self.rect(x, 36, 12, 12, color)
            self.text(x + 17, 47, name)
            x += 40 + 7.6 * len(name)

    def text(self, x, y, text, anchor='start', size=13, weight='normal', turn=None):
        around = f' transform="rotate({turn} {x:.1f} {y:.1f})"' if turn else ''
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" fill="{INK}" text-anchor="{anchor}" font-size="{size}" '
                          f'font-weight="{weight}"{around}>{escape(str(text))}</text>')

    def rect(self, x, y, width, height, color):
        self.parts.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{max(width, 0):.1f}" height="{max(height, 0):.1f}" '
                          f'fill="{color}"/>')

    def line(self, x1, y1, x2, y2, color=LINE, width=1.0, dashes=''):
        dashed = f' stroke-dasharray="{dashes}"' if dashes else ''
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{color}" '
                          f'stroke-width="{width}"{dashed}/>')

    def dot(self, x, y, color):
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4.5" fill="{color}"/>')

    def svg(self):
        return '\n'.join([*self.parts, '</svg>', ''])


class LogAxis:
    """A logarithmic axis from the power of ten below the least value to the power of ten above the greatest."""
    def __init__(self, values, begin, end):
        self.low = math.floor(math.log10(min(values)))
        self.high = max(math.ceil(math.log10(max(values))), self.low + 1)
        self.begin, self.end = begin, end

    def at(self, value):
        return self.begin + (self.end - self.begin) * (math.log10(value) - self.low) / (self.high - self.low)

    def ticks(self):
        return [10.0**power for power in range(self.low, self.high + 1)]


def number(value):
    return f'{value:.3g}' if value < 1000 else f'{value:.0f}'


def _grid_lines(chart, axis, label):
    for tick in axis.ticks():
        y = axis.at(tick)
        chart.line(LEFT, y, WIDTH - RIGHT, y)
        chart.text(LEFT - 8, y + 4, f'{tick:g}', 'end')
    chart.text(18, (TOP + chart.height - BOTTOM) / 2, label, 'middle', turn=-90)


def frame_rates(cells):
    """Draws a group of bars for each cell of table 1: (volume, slices, paper, ours, best)."""
    chart = Chart('Frames per second, 796 x 532', [('2008, Quadro FX 3500', PAPER), ('ours, the same way', OURS),
                                                   ('ours, the fastest way', BEST)])
    axis = LogAxis([v for cell in cells for v in cell[2:]] + [1.0], chart.height - BOTTOM, TOP)
    _grid_lines(chart, axis, 'frames per second')
    volumes = list(dict.fromkeys(cell[0] for cell in cells))
    step = (WIDTH - LEFT - RIGHT) / (len(cells) + len(volumes))
    base = chart.height - BOTTOM
    for i, (volume, slices, *values) in enumerate(cells):
        x = LEFT + step * (i + volumes.index(volume) + 0.5)
        for k, (value, color) in enumerate(zip(values, (PAPER, OURS, BEST))):
            y = axis.at(value)
            chart.rect(x + k * step * 0.27, y, step * 0.24, base - y, color)
        chart.text(x + step * 0.4, base + 18, slices, 'middle')
    per = len(cells) // len(volumes)
    for i, volume in enumerate(volumes):
        x = LEFT + step * (i * (per + 1) + 0.5 + per / 2)
        chart.text(x, base + 36, f'slices of {volume}', 'middle')
    return chart.svg()


def steps(cells):
    """Draws a stacked bar for each cell: (volume, slices, seconds to read, to prepare, to draw). All bars have one scale."""
    chart = Chart('Time of a frame by step, ours', [('read', THIRD), ('prepare', BEST), ('draw', OURS)])
    most_ms = 1000 * max(sum(cell[2:]) for cell in cells)
    unit = 10 ** math.floor(math.log10(most_ms))
    tick = next(unit * factor for factor in (0.2, 0.5, 1, 2) if most_ms / (unit * factor) <= 6)
    base, top = chart.height - BOTTOM, TOP
    end = tick * math.ceil(most_ms / tick)
    for i in range(round(end / tick) + 1):
        y = base - (base - top) * i * tick / end
        chart.line(LEFT, y, WIDTH - RIGHT, y)
        chart.text(LEFT - 8, y + 4, f'{i * tick:g}', 'end')
    chart.text(18, (top + base) / 2, 'milliseconds', 'middle', turn=-90)
    volumes = list(dict.fromkeys(cell[0] for cell in cells))
    step = (WIDTH - LEFT - RIGHT) / (len(cells) + len(volumes))
    for i, (volume, slices, *seconds) in enumerate(cells):
        x = LEFT + step * (i + volumes.index(volume) + 0.6)
        y = base
        for value, color in zip(seconds, (THIRD, BEST, OURS)):
            tall = (base - top) * 1000 * value / end
            y -= tall
            chart.rect(x, y, step * 0.6, tall, color)
        chart.text(x + step * 0.3, base + 18, slices, 'middle')
    per = len(cells) // len(volumes)
    for i, volume in enumerate(volumes):
        chart.text(LEFT + step * (i * (per + 1) + 0.5 + per / 2), base + 36, f'slices of {volume}', 'middle')
    return chart.svg()


def machines(bars):
    """Draws a horizontal bar for each of `bars`: (name, frames per second, color)."""
    height = TOP + 44 * len(bars) + 16
    chart = Chart('128x128x64, 256 slices: frames per second', [('2008', PAPER), ('ours, on its processor alone', OURS)], height)
    most = max(value for _, value, _ in bars)
    left = 330
    for i, (name, value, color) in enumerate(bars):
        y = TOP + 10 + 44 * i
        chart.text(left - 10, y + 18, name, 'end')
        chart.rect(left, y, (WIDTH - left - 90) * value / most, 28, color)
        chart.text(left + (WIDTH - left - 90) * value / most + 8, y + 19, number(value))
    return chart.svg()


def sites(title, paper, ours):
    """Draws minutes by the number of sites. `paper` and `ours` are {name: (color, {sites: minutes})}. The lines of `paper`
    are dashed, because the paper gives minutes only for their ends."""
    lines = {**paper, **ours}
    chart = Chart(title, [(name, color) for name, (color, _) in lines.items()])
    axis = LogAxis([m for _, points in lines.values() for m in points.values()], chart.height - BOTTOM, TOP)
    _grid_lines(chart, axis, 'minutes')
    across = LogAxis([1, 100], LEFT + 40, WIDTH - RIGHT - 40)
    for count in (1, 10, 30, 50, 100):
        chart.text(across.at(count), chart.height - BOTTOM + 20, count, 'middle')
    chart.text((LEFT + WIDTH - RIGHT) / 2, chart.height - BOTTOM + 42, 'sites', 'middle')
    below = list(lines)[-1]
    for name, (color, points) in lines.items():
        places = [(across.at(count), axis.at(minutes)) for count, minutes in sorted(points.items())]
        for (x1, y1), (x2, y2) in zip(places, places[1:]):
            chart.line(x1, y1, x2, y2, color, 2, '6 5' if name in paper else '')
        for (x, y), count in zip(places, sorted(points)):
            chart.dot(x, y, color)
            chart.text(x, y + 18 if name == below else y - 9, f'{points[count]:.4g}' if name in paper else number(points[count]),
                       'middle', size=11)
    return chart.svg()
