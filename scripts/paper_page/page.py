"""Writes the page from the claims and the results of a run, and checks a page."""
import math
import re
import textwrap
from dataclasses import dataclass

from .claims import BY_NUMBER, CLAIMS, SECTIONS, TITLE

NOT_COMPARED = 'not compared: '
NOTHING = '-'
WIDTH = 128


@dataclass
class Ours:
    """The result for a claim: a value for `more` and `less`, else True or False (None: not tried)."""
    value: float | None = None
    does: bool | None = None
    text: str = ''


def shown(value):
    """Returns a number with three digits, as on the page."""
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


def status_of_value(claim, text):
    """Returns the status of our number as on the page, with its ratio."""
    ratio = shown(ratio_of(claim, float(text)))
    return f'{status_of_ratio(float(ratio))} ({ratio})'


def cells_of(claim, ours, facts):
    """Returns the cells `now` and `status` of a row."""
    if claim.how == 'none':
        return ours.text or NOTHING, NOT_COMPARED + claim.why.format(**facts)
    if claim.how in ('more', 'less'):
        if ours.value is None:
            return NOTHING, NOT_COMPARED + (ours.text or 'it was not run')
        text = shown(ours.value)
        return f'{text} {claim.unit}'.strip() + (f' ({ours.text})' if ours.text else ''), status_of_value(claim, text)
    if ours.does is None:
        return NOTHING, NOT_COMPARED + (ours.text or 'it was not run')
    good = 'beaten' if claim.how == 'betters' else 'met'
    return ('yes' if ours.does else 'no') + (f': {ours.text}' if ours.text else ''), good if ours.does else 'not met'


def table_of(section, results, facts):
    lines = ['| no. | claim | 2008 | now | status |', '|---|---|---|---|---|']
    for claim in CLAIMS:
        if claim.number.split('.')[0] != section:
            continue
        ours = results.get(claim.number, Ours())
        now, status = cells_of(claim, ours, facts)
        cells = [claim.number, claim.text, claim.paper, now, status]
        lines.append('| ' + ' | '.join(cell.replace('|', '/') for cell in cells) + ' |')
    return lines


def rows_of(text):
    """Returns the rows of a page: lists of cells by the number of their claim."""
    rows = {}
    for line in text.splitlines():
        if re.match(r'\| \d+\.\d+ \|', line):
            cells = [cell.strip() for cell in line.strip().strip('|').split('|')]
            rows.setdefault(cells[0], []).append(cells)
    return rows


def expected_status(claim, now):
    """Returns the status, or its beginning, that follows from the other cells of the row."""
    if claim.how == 'none' or now == NOTHING:
        return NOT_COMPARED
    if claim.how in ('more', 'less'):
        return status_of_value(claim, now.split()[0])
    good = 'beaten' if claim.how == 'betters' else 'met'
    return good if re.match(r'yes\b', now) else 'not met'


def faults_of(text):
    """Returns the faults of a page: missing or repeated claims, false numbers and statuses."""
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
        if len(found[0]) != 5:
            faults.append(f'{claim.number}: the row has {len(found[0])} cells')
            continue
        _, claimed, paper, now, status = found[0]
        if claimed != claim.text or paper != claim.paper:
            faults.append(f'{claim.number}: "{claimed}, {paper}" and not "{claim.text}, {claim.paper}"')
            continue
        right = expected_status(claim, now)
        good = len(status) > len(right) and status.startswith(right) if right == NOT_COMPARED else status == right
        if not good:
            faults.append(f'{claim.number}: the status is "{status}", and should be "{right}"')
    return faults


def counts_of(text):
    counts = {'beaten': 0, 'met': 0, 'not met': 0, 'not compared': 0}
    for cells in rows_of(text).values():
        counts[re.split(r': | \(', cells[0][-1])[0]] += 1
    return counts


def contradictions():
    """Returns the numbers of figure 8 that contradict each other."""
    def value(number):
        return BY_NUMBER[number].value
    sequence, parallel = value('4.3'), value('4.4')
    first, last, percent = (float(text) for text in re.findall(r'\d+\.\d+', BY_NUMBER['4.8'].paper))
    gain = 100 * (last / first - 1)
    return [
        f'- 4.3 and 4.4 give a gain of {100 * (sequence / parallel - 1):.0f} %, not the 508.7 % of 4.5.',
        f'- In 4.8 the second time is {gain:.1f} % more than the first, {gain / percent:.0f} times the stated {percent:g} %.',
    ]


def paragraph(text):
    return textwrap.wrap(text, WIDTH, break_long_words=False, break_on_hyphens=False)


def command_lines(command):
    """Returns a shell command in lines of the page's width."""
    lines = textwrap.wrap(command, WIDTH - 2, subsequent_indent='    ', break_long_words=False, break_on_hyphens=False)
    return [*(line + ' \\' for line in lines[:-1]), lines[-1]]


def page(results, commands, facts, pictures, mode):
    """Returns the page. `commands`: as a reader types them, by section. `pictures`: the folder of the pictures, with a slash."""
    body = []
    for section, title in SECTIONS.items():
        introduction = [*paragraph(facts['before'][section]), ''] if section in facts['before'] else []
        body += ['', f'## {section}. {title}', *introduction, *table_of(section, results, facts)]
        if section == '4':
            body += ['', "The paper's numbers contradict each other:", *contradictions()]
        for name, caption in facts['charts'].get(section, []):
            body += ['', f'![{caption}]({pictures}{name})']
        body += facts['after'].get(section, [])
        if commands.get(section):
            body += ['', '```', *(line for command in commands[section] for line in command_lines(command)), '```']
    counts = counts_of('\n'.join(body))
    head = [
        '# The published system of 2008, beside ours',
        '',
        *paragraph(f'`scripts/paper` wrote this page in one run{mode}. It compares the claims and numbers of "{TITLE}" (2008) with ours.'),
        '',
        *paragraph(
            f'**{counts["beaten"]} beaten, {counts["met"]} met, {counts["not met"]} not met, '
            f'{counts["not compared"]} not compared.** The ratio in brackets is above 1 if ours is '
            'better: a claim is *beaten* above 1.05, and *met* from 0.95 on. A claim without a number is *met* if we do the same; '
            'a trouble is *beaten* if we do not have it. The run used the commands below the tables, and each benchmark also had '
            'the options `--data ../shared/data --json`.'),
        '',
        *paragraph(f'Machine: {facts["machine"]}.'),
        *(line for note in facts['notes'] for line in (paragraph(note) or [''])),
    ]
    return '\n'.join(head + body) + '\n'
