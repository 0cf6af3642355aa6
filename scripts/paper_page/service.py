"""Runs the daemon and the data server while the page needs them."""
import json
import re
import subprocess
import time
import urllib.error
import urllib.request

from .runs import Failed

LONGEST_WAIT_S = 60


def stop(process):
    process.terminate()
    try:
        process.wait(timeout=30)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


class Daemon:
    """Runs stormcellard with drop, state and cache below a directory. `cache_mib` limits its cache."""
    def __init__(self, runs, root, cache_mib):
        self.root, self.config = root, root / 'stormcellard.toml'
        (root / 'drop').mkdir()
        self.config.write_text('[paths]\ndrop = "drop"\nstate = "state"\ncache = "cache"\n'
                               f'[cache]\nbytes = "{cache_mib} MiB"\n')
        with open(root / 'log', 'w') as log:
            self.process = subprocess.Popen([runs.program('stormcellard'), '--config', self.config], stderr=log,
                                            stdin=subprocess.DEVNULL)

    def __enter__(self):
        try:
            self.wait_for(lambda status: status.get('state') == 'running')
        except Failed:
            stop(self.process)
            raise
        return self

    def __exit__(self, *_):
        stop(self.process)

    def status(self):
        try:
            return json.loads((self.root / 'state' / 'status.json').read_text())
        except (OSError, ValueError):
            return {}

    def wait_for(self, good):
        end = time.monotonic() + LONGEST_WAIT_S
        while time.monotonic() < end:
            status = self.status()
            if status and good(status):
                return status
            if self.process.poll() is not None:
                raise Failed('stormcellard ended')
            time.sleep(0.1)
        raise Failed('stormcellard took too long')


class Server:
    """Runs stormcellar serve at a port that it chooses."""
    def __init__(self, runs, *words):
        command = [runs.program('stormcellar'), 'serve', *map(str, words), '--listen', '127.0.0.1:0']
        runs.note(command)
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL,
                                        text=True)
        self.address = None
        for line in self.process.stdout:
            found = re.match(r'listening on (http://\S+?)/?$', line.strip())
            if found:
                self.address = found[1]
                break

    def __enter__(self):
        if self.address is None:
            stop(self.process)
            raise Failed('stormcellar serve does not listen')
        return self

    def __exit__(self, *_):
        stop(self.process)

    def get(self, path):
        """Returns the bytes at a path; None if the server refuses it."""
        try:
            with urllib.request.urlopen(self.address + path, timeout=30) as answer:
                return answer.read()
        except (urllib.error.URLError, OSError):
            return None
