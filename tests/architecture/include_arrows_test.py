#!/usr/bin/env python3
"""An include arrow only ever points down the floors of docs/architecture.md.

    include_arrows_test.py SOURCE_FOLDER
"""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1))
HEAVY = re.compile(r'<(CGAL/|OpenMesh/Tools/)')

FLOORS = [{'base'}, {'surface', 'volume'}, {'io', 'quality', 'feature'}, {'segment', 'polycube', 'map', 'improve'},
          {'hexahedralize'}, {'spline'}, {'tools', 'plugins'}]
FLOOR = {module: number for number, floor in enumerate(FLOORS) for module in floor}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"][^>"]+[>"])')


def module_of_file(path):
    parts = path.relative_to(ROOT).parts
    if parts[0] == 'libhex':
        return parts[3] if parts[1] == 'include' else parts[2]
    return {'libspline': 'spline', 'tools': 'tools', 'plugins': 'plugins'}[parts[0]]


def sources():
    for folder in ('libhex', 'libspline', 'tools', 'plugins'):
        for path in sorted((ROOT / folder).rglob('*')):
            if path.suffix in ('.h', '.cpp'):
                yield path


def includes(path):
    for number, line in enumerate(path.read_text().splitlines(), start=1):
        match = INCLUDE.match(line)
        if match:
            yield number, match[1]


def arrows():
    """(place, module, included module, through a private header) of every include of a header of ours."""
    for path in sources():
        own = module_of_file(path)
        for number, target in includes(path):
            place = f'{path.relative_to(ROOT)}:{number}'
            name = target[1:-1]
            if name.startswith('hex/'):
                yield place, own, name.split('/')[1], False
            elif name.startswith('spline/') and target[0] == '<':
                yield place, own, 'spline', False
            elif target[0] == '"' and name.startswith('hexspline/'):
                yield place, own, 'tools', True
            elif target[0] == '"':
                # Private headers are named from their library's src folder.
                yield place, own, 'spline' if own == 'spline' else name.split('/')[0], True


class Arrows(unittest.TestCase):
    def test_every_module_has_a_floor(self):
        self.assertEqual({module_of_file(path) for path in sources()} - FLOOR.keys(), set())

    def test_there_are_arrows_to_look_at(self):
        self.assertGreater(len(list(arrows())), 50)

    def test_no_arrow_points_up(self):
        self.assertEqual([f'{place} includes {to}' for place, own, to, _ in arrows() if FLOOR[to] > FLOOR[own]], [])

    def test_private_headers_are_used_in_their_module_and_from_above_only(self):
        self.assertEqual([f'{place} includes a private header of {to}' for place, own, to, private in arrows()
                          if private and own != to and FLOOR[to] >= FLOOR[own]], [])

    def test_plugins_use_public_headers_only(self):
        self.assertEqual([place for place, own, to, private in arrows() if own == 'plugins' and private], [])

    def test_surfaces_and_volumes_do_not_know_each_other(self):
        self.assertEqual([f'{place} includes {to}' for place, own, to, _ in arrows()
                          if own != to and {own, to} == FLOORS[1]], [])

    def test_modules_form_no_circle(self):
        edges = {}
        for _, own, to, _ in arrows():
            if own != to:
                edges.setdefault(own, set()).add(to)
        done, path = set(), []

        def visit(module):
            self.assertNotIn(module, path, ' -> '.join(path + [module]))
            if module not in done:
                path.append(module)
                for to in sorted(edges.get(module, ())):
                    visit(to)
                path.pop()
                done.add(module)

        for module in sorted(edges):
            visit(module)

    def test_public_headers_are_light(self):
        found = [f'{path.relative_to(ROOT)}:{number} {target}' for path in sources() if 'include' in path.parts
                 for number, target in includes(path) if HEAVY.match(target)]
        # The bridge to CGAL is the one header whose users want CGAL.
        self.assertEqual([f for f in found if not f.startswith('libhex/include/hex/surface/cgal_bridge.h')], [])


if __name__ == '__main__':
    unittest.main()
