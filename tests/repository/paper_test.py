#!/usr/bin/python3
"""Tests that docs/paper.md has each number of the published system once, with a status that follows from the values."""
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / 'scripts'))
from paper_page.claims import BY_NUMBER, CLAIMS, TABLE_1, VOLUMES  # noqa: E402
from paper_page.page import Ours, faults_of, page, rows_of  # noqa: E402

FACTS = {'cores': 2, 'most_gain': 100, 'machine': 'none', 'notes': [], 'charts': {}, 'before': {}, 'after': {}}


def made_page(values):
    """Returns a page with these values of ours; every other claim counts as not tried."""
    return page(values, {'1': ['command']}, FACTS, '', '')


class ThePage(unittest.TestCase):
    text = (ROOT / 'docs/paper.md').read_text()

    def faults_with(self, number, cell, text):
        """Returns the faults of the page after a cell of a row is changed."""
        row = next(line for line in self.text.splitlines() if line.startswith(f'| {number} |'))
        cells = row.split(' | ')
        cells[cell] = text
        return faults_of(self.text.replace(row, ' | '.join(cells)))

    def test_holds_every_number_once(self):
        self.assertEqual(faults_of(self.text), [])

    def test_shows_its_pictures(self):
        pictures = re.findall(r'\]\((images/[^)]+)\)', self.text)
        self.assertGreaterEqual(len(pictures), 4)
        for picture in pictures:
            self.assertTrue((ROOT / 'docs' / picture).is_file(), picture)

    def test_a_row_that_is_missing_or_stands_twice_is_found(self):
        for claim in CLAIMS:
            row = next(line for line in self.text.splitlines() if line.startswith(f'| {claim.number} |'))
            self.assertNotEqual(faults_of(self.text.replace(row, '')), [], claim.number)
            self.assertNotEqual(faults_of(self.text.replace(row, row + '\n' + row)), [], claim.number)

    def test_another_number_of_the_paper_is_found(self):
        for claim in CLAIMS:
            digits = re.search(r'\d', claim.paper)
            if digits:
                other = claim.paper.replace(digits[0], str((int(digits[0]) + 1) % 10), 1)
                self.assertNotEqual(self.faults_with(claim.number, 2, other), [], claim.number)

    def test_another_status_is_found(self):
        for claim in CLAIMS:
            stands = rows_of(self.text)[claim.number][0][-1]
            for status in ('beaten', 'met', 'not met', 'not compared: ', ''):
                if status != stands:
                    self.assertNotEqual(self.faults_with(claim.number, 4, status + ' |'), [], f'{claim.number}: {status}')

    def test_another_ratio_is_found(self):
        ratios = 0
        for number, rows in rows_of(self.text).items():
            if rows[0][-1].endswith(')'):
                other = rows[0][-1].removesuffix(')') + '1)'
                self.assertNotEqual(self.faults_with(number, 4, other + ' |'), [], number)
                ratios += 1
        self.assertGreaterEqual(ratios, 20)


class Statuses(unittest.TestCase):
    def status(self, number, ours):
        text = made_page({number: ours})
        self.assertEqual(faults_of(text), [])
        return re.sub(r' \([0-9.]+\)$', '', rows_of(text)[number][0][-1])

    def test_follow_from_the_ratio(self):
        frames = BY_NUMBER['5.3'].value
        for factor, status in ((20, 'beaten'), (1.06, 'beaten'), (1, 'met'), (0.96, 'met'), (0.9, 'not met')):
            self.assertEqual(self.status('5.3', Ours(frames * factor)), status)
        minutes = BY_NUMBER['4.3'].value
        for factor, status in ((0.05, 'beaten'), (1, 'met'), (1.2, 'not met')):
            self.assertEqual(self.status('4.3', Ours(minutes * factor)), status)

    def test_of_what_was_tried_and_of_what_was_not(self):
        self.assertEqual(self.status('2.5', Ours(does=True)), 'met')
        self.assertEqual(self.status('2.5', Ours(does=False)), 'not met')
        self.assertEqual(self.status('7.1', Ours(does=True)), 'beaten')
        self.assertEqual(self.status('7.1', Ours()), 'not compared: it was not run')
        self.assertEqual(self.status('5.3', Ours(text='no time')), 'not compared: no time')

    def test_without_a_reason_is_a_fault(self):
        text = made_page({}).replace('not compared: it was not run', 'not compared: ')
        self.assertEqual(len([fault for fault in faults_of(text) if fault.startswith('5.3:')]), 1)


class TheTable(unittest.TestCase):
    """Tests that the benchmarks have the same numbers."""
    def test_is_that_of_bench_render(self):
        text = (ROOT / 'bench/bench_render.cpp').read_text()
        for column, volume in enumerate(VOLUMES):
            numbers = ', '.join(f'{TABLE_1[slices][column]:g}' for slices in TABLE_1)
            self.assertIn(f'"{volume}"', text)
            self.assertIn('{' + numbers + '}', text)

    def test_is_that_of_bench_mosaic(self):
        text = (ROOT / 'bench/bench_mosaic.cpp').read_text()
        self.assertIn(f'sequential_min = {BY_NUMBER["4.3"].value}, pool_min = {BY_NUMBER["4.4"].value};', text)

    def test_says_the_value_that_is_compared(self):
        for claim in CLAIMS:
            if claim.how == 'more' and not claim.unit or claim.unit in ('minutes', 'MB/s'):
                self.assertIn(f'{claim.value:g}', claim.paper, claim.number)


class TheScript(unittest.TestCase):
    def run_script(self, *words, **environment):
        return subprocess.run([ROOT / 'scripts/paper', *words], capture_output=True, text=True, check=False,
                              env={'PATH': '/usr/bin:/bin', **environment})

    def test_checks_a_page(self):
        self.assertEqual(self.run_script('--check', ROOT / 'docs/paper.md').returncode, 0)
        self.assertEqual(self.run_script('--check', ROOT / 'docs/README.md').returncode, 1)

    def test_says_its_usage_and_what_is_missing(self):
        self.assertEqual(self.run_script('--fast').returncode, 2)
        skipped = self.run_script('--quick', STORMCELLAR_DATA='/no/such/directory')
        self.assertEqual(skipped.returncode, 77)
        self.assertIn('/no/such/directory', skipped.stderr)


if __name__ == '__main__':
    unittest.main()
