#!/usr/bin/env python3
"""Surfaces that are no boundary of a solid: one line with the place in every subcommand, and what --repair makes of them.

    broken_test.py HEXSPLINE DATA [REFERENCE_DATA]

On surfaces made here, and on published ones when they are there.
"""
import json
import sys
import unittest
from pathlib import Path

REFERENCE = Path(sys.argv.pop()) if len(sys.argv) > 3 else None

from program import ROD, CommandTest


def grid_box(n, leave_out=()):
    """A box of n^2 squares a side; the squares with the numbers left out are missing."""
    points, faces = {}, []

    def at(*p):
        return points.setdefault(p, len(points))

    for axis in range(3):
        for side in (0, n):
            for i in range(n):
                for j in range(n):
                    square = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        p = [0, 0, 0]
                        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, a, b
                        square.append(at(*p))
                    faces.append(square if side else square[::-1])
    faces = [face for number, face in enumerate(faces) if number not in leave_out]
    return list(points), faces


def off(points, faces):
    rows = ['OFF', f'{len(points)} {len(faces)} 0'] + [' '.join(map(str, p)) for p in points]
    return '\n'.join(rows + [' '.join(map(str, [len(face), *face])) for face in faces]) + '\n'


def edges_of(path):
    """How often each undirected edge of an OFF file occurs."""
    words = iter(path.read_text().split()[1:])
    counts = [int(next(words)) for _ in range(3)]
    for _ in range(3 * counts[0]):
        next(words)
    edges = {}
    for _ in range(counts[1]):
        face = [int(next(words)) for _ in range(int(next(words)))]
        for a, b in zip(face, face[1:] + face[:1]):
            edges[min(a, b), max(a, b)] = edges.get((min(a, b), max(a, b)), 0) + 1
    return edges


class Broken(CommandTest):
    def rejected_everywhere(self, file, place):
        """Every subcommand that reads a surface says in one line what is wrong, and writes nothing."""
        blocks = ROD / 'rod_blocks.k'
        for command in (['segment', file, '-o', 'out.k'], ['segment', file, '-o', 'out.k', '--from-patches'],
                        ['polycube', file, '-o', 'out.k'], ['map', file, '-p', blocks, '-o', 'out.k'],
                        ['run', file, '-o', 'folder'], ['improve', blocks, '-o', 'out.k', '--surface', file],
                        ['check', blocks, '--surface', file]):
            done = self.run_program(*command, code=3)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(Path(file).name, done.stderr)
            self.assertRegex(done.stderr, place)
            self.assertFalse((self.folder / 'out.k').exists())
            self.assertEqual(list(self.folder.glob('folder/*.k')), [])
        # These want hexahedra and say so.
        for command in (['check', file], ['improve', file, '-o', 'out.k'], ['spline', file, '-o', 'out.bext']):
            done = self.run_program(*command, code=3)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(Path(file).name, done.stderr)

    def repaired(self, file):
        """What `convert --repair` did, by code; the closed surface is in repaired.off."""
        done = self.run_program('convert', file, '-o', 'repaired.off', '--repair', '--json', 'report.json')
        findings = json.loads((self.folder / 'report.json').read_text())['repair']
        for finding in findings:
            self.assertIn(finding['message'], done.stderr)
        return {finding['code']: finding['message'] for finding in findings}

    def assert_closed(self):
        self.assertEqual(set(edges_of(self.folder / 'repaired.off').values()), {2})

    def test_an_open_surface(self):
        points, faces = grid_box(4, leave_out={5, 40, 41})
        (self.folder / 'open.off').write_text(off(points, faces))
        self.rejected_everywhere('open.off', r'open: 10 boundary edges, the first between vertices \d+ and \d+ \(polygon \d+\)')
        self.assertEqual(self.repaired('open.off'), {'repair-hole': '2 holes filled with 6 triangles'})
        self.assert_closed()
        done = self.run_program('segment', 'open.off', '-o', 'out.k', '--repair', '--labels', 'labels.txt')
        self.assertIn('open.off: repair: 2 holes filled with 6 triangles', done.stderr)
        self.assertEqual(set((self.folder / 'labels.txt').read_text().split()), set('012345'))
        done = self.run_program('run', 'open.off', '-o', 'chain', '--repair', '--to', 'segment', '--json', 'chain.json')
        self.assertIn('open.off: repair: 2 holes filled with 6 triangles', done.stderr)
        self.assertEqual([f['code'] for f in json.loads((self.folder / 'chain.json').read_text())['repair']], ['repair-hole'])

    def test_a_hole_that_is_too_large(self):
        points, faces = grid_box(4, leave_out=range(16))
        (self.folder / 'open.off').write_text(off(points, faces))
        self.rejected_everywhere('open.off', r'open: 16 boundary edges')
        self.assertEqual(list(self.repaired('open.off')), ['repair-unused', 'hole-left'])
        for command in (['segment', '-o', 'out.k'], ['run', '-o', 'chain']):
            done = self.run_program(*command, '-i', 'open.off', '--repair', code=3)
            self.assertRegex(done.stderr, 'open: 16 boundary edges')
            # Advice that would not help is not given.
            self.assertNotIn('--repair', self.run_program(*command, '-i', 'open.off', code=3).stderr)

    def test_an_edge_of_four_faces_and_faces_that_are_turned(self):
        points, faces = grid_box(2)
        shifted = [(x + 2, y + 2, z) for x, y, z in points]
        number = {p: i for i, p in enumerate(dict.fromkeys(points + shifted))}
        both = [[number[points[v]] for v in face] for face in faces] + [[number[shifted[v]] for v in face] for face in faces]
        (self.folder / 'edge.off').write_text(off(list(number), both))
        self.rejected_everywhere('edge.off', r'not manifold: 2 edges have more than two faces, the first between vertices \d+')
        self.assertIn('repair-manifold', self.repaired('edge.off'))
        self.assert_closed()
        (self.folder / 'turned.off').write_text(off(points, [faces[0][::-1]] + faces[1:]))
        self.rejected_everywhere('turned.off', r'not oriented alike along 4 edges, the first between vertices \d+')
        self.assertEqual(self.repaired('turned.off'), {'repair-orientation': '1 polygons turned'})
        self.assertIn('give --repair, which mends this surface',
                      self.run_program('segment', 'turned.off', '-o', 'out.k', code=3).stderr)
        self.assert_closed()

    def test_published_surfaces(self):
        if REFERENCE is None or not (REFERENCE / 'broken').is_dir():
            self.skipTest('no published models')
        files = sorted((REFERENCE / 'broken').iterdir())
        self.assertGreater(len(files), 3)
        closed = []
        for file in files:
            with self.subTest(file.name):
                self.rejected_everywhere(file, r'vertices \d+')
                done = self.repaired(file)
                self.assertNotEqual(done, {})
                if 'hole-left' not in done:
                    closed.append(file.name)
                    self.assert_closed()
                    # The first thing every stage does; what segment makes of it is not asked here.
                    done = self.run_program('map', 'repaired.off', '-p', ROD / 'rod_blocks.k', '-o', 'out.k', code=3)
                    self.assertNotRegex(done.stderr, 'manifold|open|oriented')
        self.assertEqual(closed, ['beast.obj', 'suzanne.obj'])


if __name__ == '__main__':
    unittest.main()
