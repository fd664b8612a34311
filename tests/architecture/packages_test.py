#!/usr/bin/env python3
"""docs/dependencies.md gives a reason for each package of tools/packages.txt, and for no other.

    packages_test.py SOURCE_FOLDER
"""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1))


def listed():
    lines = (ROOT / 'tools/packages.txt').read_text().splitlines()
    return [line for line in lines if line.strip() and not line.startswith('#')]


def explained():
    return re.findall(r'^\| `([^`]+)` \| (.*) \|$', (ROOT / 'docs/dependencies.md').read_text(), re.M)


class Packages(unittest.TestCase):
    def test_list_and_reasons_name_the_same_packages_in_the_same_order(self):
        self.assertEqual(listed(), [name for name, _ in explained()])

    def test_every_reason_says_something(self):
        self.assertEqual([name for name, reason in explained() if len(reason.split()) < 4], [])

    def test_no_package_is_listed_twice(self):
        self.assertEqual(len(listed()), len(set(listed())))


if __name__ == '__main__':
    unittest.main()
