"""Runs the programs of a build and remembers their commands for the page."""
import json
import shutil
import subprocess
import sys
import time
from pathlib import Path


BENCH_WORDS = ' --data ../shared/data --json'  # options of every benchmark, which the page shows only once, above the tables


class Failed(Exception):
    """A command failed; the page reports it in the rows that need the command."""


class Runs:
    def __init__(self, build, data, work, quick):
        self.build, self.data, self.work, self.quick = build, data, work, quick
        self.section = ''
        self.commands = {}  # lists of commands by section, as a reader types them, each once
        self.machine = None

    def program(self, name):
        """Returns the path of a program of the build; None if it was not built."""
        for folder in ('cli', 'daemon', 'bench'):
            path = self.build / folder / name
            if path.is_file():
                return path
        return None

    def shown(self, words):
        """Returns a command for a reader: without paths of this machine, and without the middle of long words."""
        places = ((f'{self.build}/cli/', ''), (f'{self.build}/daemon/', ''), (f'{self.build}/bench/', ''), (f'{self.build}', 'BUILD'),
                  (str(self.data), '../shared/data'), (f'{self.work}/', ''), (f'{Path.cwd()}/', ''))
        shown = []
        for word in map(str, words):
            for path, name in places:
                word = word.replace(path, name)
            if len(word) > 160:
                word = f'{word[:12]}...{word[-7:]}'
            shown.append(f"'{word}'" if ' ' in word else word)
        return ' '.join(shown)

    def note(self, words):
        """Adds a command to the page."""
        commands, text = self.commands.setdefault(self.section, []), self.shown(words).removesuffix(BENCH_WORDS)
        if text not in commands:
            commands.append(text)

    def run(self, name, *words, timeout_s=7200):
        """Runs a program of the build or of the system. Returns (standard output, seconds)."""
        program = self.program(name) or shutil.which(name)
        if not program:
            raise Failed(f'{name} is not there')
        command = [str(program), *map(str, words)]
        print('paper:', self.shown(command), file=sys.stderr, flush=True)
        begin = time.monotonic()
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=timeout_s, cwd=self.work,
                              stdin=subprocess.DEVNULL)
        seconds = time.monotonic() - begin
        if done.returncode != 0:
            last = (done.stderr.strip() or done.stdout.strip() or 'nothing was said').splitlines()[-1]
            raise Failed(f'{name} ended with status {done.returncode}: {last}')
        self.note(command)
        return done.stdout, seconds

    def bench(self, name, *words):
        """Runs a benchmark. Returns its rows."""
        out, _ = self.run(name, *words, '--data', self.data, '--json')
        said = json.loads(out)
        self.machine = self.machine or said['machine']
        return said['rows']

    def in_place(self, name):
        path = Path(self.work) / name
        path.mkdir(parents=True, exist_ok=True)
        return path
