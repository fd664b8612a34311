"""What the tests of the subcommands share: the program, the sample parts, a fresh folder for each test.

Each test is called as NAME_test.py HEXSPLINE DATA.
"""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

DATA = Path(sys.argv.pop()).resolve()
PROGRAM = str(Path(sys.argv.pop()).resolve())
ROD = DATA / 'rod'


class CommandTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_program(self, *arguments, code=0, **environment):
        """Runs the program in the test's folder and checks its exit code; an error is one line on stderr."""
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, env={**os.environ, **environment})
        self.assertEqual(done.returncode, code, done.stderr)
        errors = [line for line in done.stderr.splitlines() if ': error: ' in line]
        self.assertEqual(len(errors), 0 if code == 0 else 1, done.stderr)
        return done
