#!/usr/bin/env python3
"""The sample parts of data/: regenerating them gives the same bytes, and they are what data/README.md says.

    sample_parts_test.py DATA_FOLDER
"""
import filecmp
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

DATA = sys.argv.pop(1)
PARTS = ('rod', 'bracket', 'blob')
FILES = ('{}.stl', '{}_tri.k', '{}_patches.k', '{}_blocks.k')
FACES = [(0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (4, 5, 6, 7)]
NEIGHBOURS = [(1, 3, 4), (2, 0, 5), (3, 1, 6), (0, 2, 7), (7, 5, 0), (4, 6, 1), (5, 7, 2), (6, 4, 3)]


def read_k(path):
    """Points, elements (vertex numbers), parts of a comma-separated .k file with node ids 1, 2, 3, ..."""
    section, points, elements, parts = None, [], [], []
    for line in Path(path).read_text().splitlines():
        if line[0] == '*':
            section = line.strip()
        elif line[0] != '$':
            fields = line.split(',')
            if section == '*NODE':
                points.append([float(x) for x in fields[1:4]])
            else:
                nodes = [int(x) - 1 for x in fields[2:]]
                elements.append(nodes[:3] if len(nodes) == 4 else nodes)
                parts.append(int(fields[1]))
    return np.array(points), elements, parts


class Made(unittest.TestCase):
    def test_making_the_parts_again_gives_the_same_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, os.path.join(DATA, 'make_parts.py'), folder], check=True, stdout=subprocess.DEVNULL)
            for part in PARTS:
                for name in FILES:
                    file = os.path.join(part, name.format(part))
                    self.assertTrue(filecmp.cmp(os.path.join(DATA, file), os.path.join(folder, file), shallow=False), file)

    def test_all_of_it_is_small(self):
        total = sum(os.path.getsize(os.path.join(path, f)) for path, _, files in os.walk(DATA) for f in files)
        self.assertLess(total, 4_000_000)


class Properties(unittest.TestCase):
    def each(self):
        for part in PARTS:
            with self.subTest(part=part):
                base = os.path.join(DATA, part, part)
                yield read_k(base + '_patches.k'), read_k(base + '_blocks.k')

    def test_surfaces_are_closed_manifold_and_oriented_outwards(self):
        for (points, triangles, _), _ in self.each():
            directed = [(t[i], t[(i + 1) % 3]) for t in triangles for i in range(3)]
            self.assertEqual(len(directed), len(set(directed)))
            self.assertEqual(set(directed), {(b, a) for a, b in directed})
            x = points[np.array(triangles)]
            self.assertGreater(np.einsum('ij,ij->', x[:, 0], np.cross(x[:, 1], x[:, 2])), 0)

    def test_patches_are_disks_with_four_corners_of_valence_3_to_6(self):
        for (points, triangles, parts), _ in self.each():
            around = [set() for _ in points]
            for t, part in zip(triangles, parts):
                for v in t:
                    around[v].add(part)
            self.assertLessEqual(max(map(len, around)), 6)
            for patch in set(parts):
                own = [t for t, part in zip(triangles, parts) if part == patch]
                vertices = {v for t in own for v in t}
                edges = {frozenset((t[i], t[(i + 1) % 3])) for t in own for i in range(3)}
                self.assertEqual(len(vertices) - len(edges) + len(own), 1, f'patch {patch} is no disk')
                self.assertEqual(sum(len(around[v]) >= 3 for v in vertices), 4, f'patch {patch}')

    def test_boundary_quads_and_patches_match_one_to_one_at_coinciding_corners(self):
        for (points, triangles, parts), (nodes, blocks, _) in self.each():
            place = {tuple(p): v for v, p in enumerate(points)}
            around = [set() for _ in points]
            for t, part in zip(triangles, parts):
                for v in t:
                    around[v].add(part)
            corners = {}
            for v, patches in enumerate(around):
                for patch in patches if len(patches) >= 3 else ():
                    corners.setdefault(patch, set()).add(v)
            faces = {}
            for block in blocks:
                for face in FACES:
                    faces.setdefault(frozenset(block[c] for c in face), []).append(block)
            outer = [face for face, owners in faces.items() if len(owners) == 1]
            quads = [frozenset(place[tuple(nodes[n])] for n in face) for face in outer]
            self.assertEqual(sorted(map(sorted, quads)), sorted(map(sorted, corners.values())))

    def test_corners_of_all_blocks_are_positive(self):
        for _, (nodes, blocks, _) in self.each():
            x = nodes[np.array(blocks)]
            for c in range(8):
                frames = np.stack([x[:, n] - x[:, c] for n in NEIGHBOURS[c]], axis=1)
                self.assertGreater(np.linalg.det(frames).min(), 0)

    def test_triangles_of_all_three_surface_files_are_the_same(self):
        for part in PARTS:
            base = os.path.join(DATA, part, part)
            points, triangles, _ = read_k(base + '_patches.k')
            raw_points, raw_triangles, raw_parts = read_k(base + '_tri.k')
            self.assertTrue(np.array_equal(points, raw_points))
            self.assertEqual(triangles, raw_triangles)
            self.assertEqual(set(raw_parts), {1})
            record = np.dtype([('normal', '<3f4'), ('x', '<9f4'), ('attribute', '<u2')])
            stl = np.frombuffer(Path(base + '.stl').read_bytes()[84:], dtype=record)
            self.assertTrue(np.array_equal(stl['x'].reshape(-1, 3, 3), points[np.array(triangles)].astype('<f4')))

    def test_the_table_of_the_readme_tells_the_truth(self):
        text = Path(DATA, 'README.md').read_text()
        for part in PARTS:
            base = os.path.join(DATA, part, part)
            _, triangles, parts = read_k(base + '_patches.k')
            blocks = read_k(base + '_blocks.k')[1]
            row = re.search(rf'\| `{part}` \|.*?\| (\d+) \| (\d+) \| (\d+) \| (\d+) \|', text)
            self.assertEqual([int(n) for n in row.groups()], [len(triangles), len(set(parts)), len(blocks), 64 * len(blocks)])


if __name__ == '__main__':
    unittest.main()
