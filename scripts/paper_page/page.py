"""Writes the page from claims and what a run gave, and checks a page."""
import math
import re
from dataclasses import dataclass

from .claims import BY_NUMBER, CLAIMS, SECTIONS, TITLE

CANNOT = 'cannot be compared: '
NO_RATIO = '-'


@dataclass
class Ours:
    """What a run gave for a claim: a value for more and less, else whether it does (None: nobody tried)."""
    value: float | None = None
    does: bool | None = None
    text: str = ''
    by: str = ''  # letters of the commands


def shown(value):
    """A number with three digits, as the page has it."""
    if abs(value) >= 1000:
        return f'{value:.0f}'
    return f'{value:.3g}'


def ratio_of(claim, value):
    if claim.how == 'more':
        return value / claim.value
    return claim.value / value if value else math.inf


def status_of_ratio(ratio):
    if ratio > 1.05:
        return 'beaten'
    return 'met' if ratio >= 0.95 else 'not met'


def cells_of(claim, ours, facts):
    """The cells `ours`, `ratio` and `status` of a row."""
    if claim.how == 'none':
        return ours.text or NO_RATIO, NO_RATIO, CANNOT + claim.why.format(**facts)
    if claim.how in ('more', 'less'):
        if ours.value is None:
            return NO_RATIO, NO_RATIO, CANNOT + (ours.text or 'it was not run')
        text = shown(ours.value)
        ratio = shown(ratio_of(claim, float(text)))
        return (f'{text} {claim.unit}' + (f' ({ours.text})' if ours.text else ''), ratio, status_of_ratio(float(ratio)))
    if ours.does is None:
        return NO_RATIO, NO_RATIO, CANNOT + (ours.text or 'it was not run')
    good = 'beaten' if claim.how == 'betters' else 'met'
    return ('yes' if ours.does else 'no') + (f': {ours.text}' if ours.text else ''), NO_RATIO, good if ours.does else 'not met'


def table_of(section, results, facts):
    lines = ['| no. | claim | 2008 | now | ratio | by | status |', '|---|---|---|---|--:|---|---|']
    for claim in CLAIMS:
        if claim.number.split('.')[0] != section:
            continue
        ours = results.get(claim.number, Ours())
        now, ratio, status = cells_of(claim, ours, facts)
        cells = [claim.number, claim.text, claim.paper, now, ratio, ours.by or NO_RATIO, status]
        lines.append('| ' + ' | '.join(cell.replace('|', '/') for cell in cells) + ' |')
    return lines


def rows_of(text):
    """The rows of a page: lists of cells by the number of their claim."""
    rows = {}
    for line in text.splitlines():
        if re.match(r'\| \d+\.\d+ \|', line):
            cells = [cell.strip() for cell in line.strip().strip('|').split('|')]
            rows.setdefault(cells[0], []).append(cells)
    return rows


def expected_status(claim, now, ratio):
    """What the status must be, or begin with, by what stands in the row."""
    if claim.how == 'none' or now == NO_RATIO:
        return CANNOT
    if claim.how in ('more', 'less'):
        right = shown(ratio_of(claim, float(now.split()[0])))
        return status_of_ratio(float(right)) if ratio == right else f'for a ratio of {right}'
    good = 'beaten' if claim.how == 'betters' else 'met'
    return good if re.match(r'yes\b', now) else 'not met'


def faults_of(text):
    """What is wrong with a page: claims that are missing or stand twice, numbers and statuses that are false."""
    faults = []
    rows = rows_of(text)
    for number in rows:
        if number not in BY_NUMBER:
            faults.append(f'{number}: the paper has no such claim')
    for claim in CLAIMS:
        found = rows.get(claim.number, [])
        if len(found) != 1:
            faults.append(f'{claim.number}: {claim.text} ({claim.paper}) stands {len(found)} times')
            continue
        if len(found[0]) != 7:
            faults.append(f'{claim.number}: the row has {len(found[0])} cells')
            continue
        _, claimed, paper, now, ratio, _, status = found[0]
        if claimed != claim.text or paper != claim.paper:
            faults.append(f'{claim.number}: "{claimed}, {paper}" and not "{claim.text}, {claim.paper}"')
            continue
        right = expected_status(claim, now, ratio)
        good = len(status) > len(right) and status.startswith(right) if right == CANNOT else status == right
        if not good:
            faults.append(f'{claim.number}: the status is "{status}", and should be "{right}"')
    return faults


def counts_of(text):
    counts = {'beaten': 0, 'met': 0, 'not met': 0, 'cannot be compared': 0}
    for cells in rows_of(text).values():
        counts[cells[0][-1].split(':')[0]] += 1
    return counts


def contradictions(results):
    """What in the numbers of figure 8 does not follow from each other."""
    def value(number):
        return BY_NUMBER[number].value
    sequence, parallel = value('4.3'), value('4.4')
    first, last, percent = (float(text) for text in re.findall(r'\d+\.\d+', BY_NUMBER['4.10'].paper))
    gain = 100 * (last / first - 1)
    return [
        f'- 4.7 does not follow from 4.3 and 4.4: their quotient is {sequence / parallel:.2f}, a gain of '
        f'{100 * (sequence / parallel - 1):.0f} %.',
        f'- 4.10: the second time is {gain:.1f} % more than the first, {gain / percent:.0f} times what it says: perhaps a slip of the '
        'decimal point.',
        f'- 4.8 follows from 4.1 and 4.2: {100 * (value("4.2") / value("4.1") - 1):.1f} %.',
    ]


def command_line(letter, text, seconds):
    return f'{letter}  {text}' + ('' if seconds is None else f'    # {seconds:.1f} s')


def page(results, commands, facts, pictures, mode):
    """The page. `commands`: (letter, text, seconds) by section. `pictures`: the folder of the pictures, with a slash."""
    body = []
    for section, title in SECTIONS.items():
        body += ['', f'## {section}. {title}', *facts['before'].get(section, []), *table_of(section, results, facts)]
        if section == '4':
            body += ['', 'Its numbers beside each other:', '', *contradictions(results)]
        for name, caption in facts['charts'].get(section, []):
            body += ['', f'![{caption}]({pictures}{name})']
        body += facts['after'].get(section, [])
        if commands.get(section):
            body += ['', '```', *(command_line(*command) for command in commands[section]), '```']
    counts = counts_of('\n'.join(body))
    head = [
        '# The published system of 2008, beside ours',
        '',
        f'`scripts/paper` wrote this page in one run{mode}. It holds every claim and every number of "{TITLE}" (2008), '
        'each once, beside ours.',
        '',
        f'**{counts["beaten"]} beaten, {counts["met"]} met, {counts["not met"]} not met, '
        f'{counts["cannot be compared"]} cannot be compared.** The ratio is above 1 where ours is better. *Beaten* begins at 1.05 and '
        '*met* at 0.95; a claim without a number is *met* if we do the same, and a trouble is *beaten* if we do not have it. '
        '*By* names the commands below the table; the seconds behind them are their whole time.',
        '',
        f'Machine: {facts["machine"]}.',
        *facts['notes'],
    ]
    return '\n'.join(head + body) + '\n'
