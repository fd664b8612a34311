#!/usr/bin/env python3
"""docs/cli.md lists every subcommand and every option, and nothing that is not there.

    documentation_test.py HEXSPLINE CLI_MD
"""
import re
import subprocess
import sys
import unittest
from pathlib import Path

DOCUMENT = Path(sys.argv.pop())
PROGRAM = sys.argv.pop()
COMMON = 'Options of every subcommand'


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True).stdout


def subcommands():
    """Names listed by `hexspline --help`."""
    return re.findall(r'^  ([a-z]+) +\S', run('--help'), re.M)


def options_in_help(command):
    """`--long` or `-s, --long` of each option that `hexspline COMMAND --help` lists."""
    found = set()
    for line in run(command, '--help').splitlines():
        match = re.match(r'  (?:-(\w) \[ --([\w-]+) \]|--([\w-]+)|-(\w))(?:\s|$)', line)
        if match:
            short, long = match[1] or match[4], match[2] or match[3]
            found.add(', '.join(([f'-{short}'] if short else []) + ([f'--{long}'] if long else [])))
    return found


def sections():
    """Title -> options in the first column of the tables below it."""
    result, title = {}, None
    for line in DOCUMENT.read_text().splitlines():
        if line.startswith('## '):
            title = line[3:].strip().strip('`')
            result[title] = []
        match = re.match(r'\| `((?:-\w, )?--[\w-]+)', line)
        if match and title:
            result[title].append(match[1])
    return result


class Documentation(unittest.TestCase):
    def test_every_subcommand_has_a_section_in_the_order_of_the_help_text(self):
        documented = [title for title in sections() if re.fullmatch('[a-z]+', title)]
        self.assertEqual(documented, subcommands())

    def test_options_of_every_subcommand_are_documented_and_those_documented_exist(self):
        documented = sections()
        common = set(documented[COMMON])
        self.assertGreater(len(common), 5)
        for command in subcommands():
            with self.subTest(command=command):
                self.assertEqual(options_in_help(command), set(documented[command]) | common)

    def test_no_option_is_documented_twice(self):
        for title, options in sections().items():
            self.assertEqual(len(options), len(set(options)), title)


if __name__ == '__main__':
    unittest.main()
