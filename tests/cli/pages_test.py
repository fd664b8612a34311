#!/usr/bin/env python3
"""The commands that README.md and the pages of docs/ print do what they promise, and figures of the tutorial are those of its commands.

    pages_test.py HEXSPLINE DATA

They run as printed, in the order of the page, in a folder with data/ and with the sample rod under the names that they use.
"""
import json
import os
import re
import shlex
import unittest

from printed_commands import copy_mesh, copy_parts, make_inputs, printed_commands, run_printed, samples
from program import DATA, CommandTest

DOCS = DATA.parent / 'docs'
COMMANDS = ('run', 'segment', 'polycube', 'map', 'improve', 'spline', 'check', 'convert', 'plugins')
NUMBERS = {'ten': 10, 'twenty': 20, 'thirty': 30}


def number(text):
    """Of what a person writes: 1,014."""
    return float(text.replace(',', ''))


def cube():
    """The unit cube as STL text."""
    facets = []
    for axis in range(3):
        u, v = [(0, 0, 0)[:axis] + (1,) + (0, 0, 0)[axis + 1:] for axis in ((axis + 1) % 3, (axis + 2) % 3)]
        for side in (0, 1):
            at = tuple(side if k == axis else 0 for k in range(3))
            ring = [tuple(a + i * b + j * c for a, b, c in zip(at, u, v)) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
            ring = ring if side else ring[::-1]
            facets += [(ring[0], ring[1], ring[2]), (ring[0], ring[2], ring[3])]
    return 'solid cube\n' + ''.join(
        'facet normal 0 0 0\nouter loop\n' + ''.join('vertex {} {} {}\n'.format(*corner) for corner in facet) + 'endloop\nendfacet\n'
        for facet in facets) + 'endsolid cube\n'


class Pages(CommandTest):
    def setUp(self):
        super().setUp()
        os.symlink(DATA, self.folder / 'data')

    def run_page(self, page, done=()):
        """Runs the commands of a page but for those that are done; their number."""
        commands = [words for words in printed_commands(page.read_text()) if words[1] in COMMANDS]
        for words in commands:
            if words not in done and not any('my_segmenter' in word for word in words):
                with self.subTest(page=page.name, command=shlex.join(words)):
                    run_printed(self, words, self.folder)
        return len(commands)

    def report(self, *arguments):
        return json.loads(self.run_program(*arguments, '--json', '-').stdout)

    def test_the_tutorial_and_its_figures_and_then_the_tour(self):
        page = (DOCS / 'tutorial.md').read_text()
        self.assertGreaterEqual(self.run_page(DOCS / 'tutorial.md'), 9)

        def figure(pattern):
            found = re.findall(pattern, page)
            self.assertEqual(len(found), 1, pattern)
            return found[0]

        mesh = self.report('check', '4-improve.vtk')
        self.assertEqual(mesh['hexes'], number(figure(r'`--target-hexes 1000` gave ([\d,]+)')))
        smallest = figure(r'smallest scaled Jacobian becomes (0\.\d+)')
        self.assertEqual(f"{mesh['min_scaled_jacobian']:.{len(smallest) - 2}f}", smallest)
        for file in re.findall(r'`(\w+\.(?:obj|k|bext))`', page):
            self.assertTrue((self.folder / file).exists(), file)
        modes = NUMBERS[figure(r'LS-DYNA computes (\w+) modes')]
        deck = (self.folder / 'angle_eigen.k').read_text()
        self.assertRegex(deck, rf'\*CONTROL_IMPLICIT_EIGENVALUE\n(?:\$.*\n)*\s*{modes}\b')
        self.assertIn('*SECTION_SOLID', deck)
        self.run_page(DATA.parent / 'README.md', printed_commands(page))

    def test_the_pages_of_the_stages(self):
        make_inputs(self.folder, self.run_program)
        count = 0
        for page in sorted(DOCS.glob('*.md')):
            # cli.md shows the sample runs of sample_runs_test.py.
            if page.name not in ('tutorial.md', 'cli.md'):
                # Other pages write over what this one reads.
                copy_parts(self.folder)
                copy_mesh(self.folder)
                if page.name == 'automatic.md':
                    # Thousands of cells are mended there: those of a cube need no time.
                    (self.folder / 'part.stl').write_text(cube())
                count += self.run_page(page)
        self.assertGreater(count, 25)

    def test_the_samples_of_the_command_line_page_are_those_of_the_help_text(self):
        shown = [words for words in printed_commands((DOCS / 'cli.md').read_text()) if words[1] in COMMANDS]
        self.assertGreater(len(shown), 20)
        for words in shown:
            self.assertIn(words, samples(self.run_program, words[1]))


if __name__ == '__main__':
    unittest.main()
