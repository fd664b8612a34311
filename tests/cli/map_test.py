#!/usr/bin/env python3
"""The subcommand map: files, report, messages and exit codes.

    map_test.py HEXSPLINE DATA
"""
import json
import unittest

from program import DATA, ROD, CommandTest
# Part: patches, blocks, hexahedra at level 2 (data/README.md).
PARTS = {'rod': (70, 26, 1664), 'bracket': (38, 10, 640), 'blob': (30, 37, 2368)}


class Commands(CommandTest):
    def test_own_parts_have_the_counts_of_their_description(self):
        for name, (patches, blocks, hexes) in PARTS.items():
            self.run_program('map', '-i', DATA / name / f'{name}_patches.k', '-p', DATA / name / f'{name}_blocks.k',
                             '-o', 'out.vtk', '--json', 'report.json')
            report = json.loads((self.folder / 'report.json').read_text())
            self.assertEqual((report['patches'], report['blocks'], report['hexes']), (patches, blocks, hexes))
            self.assertEqual(len(report['patch_maps']), patches)
            self.assertTrue(all(record['flipped'] == 0 for record in report['patch_maps']))
            self.assertEqual(report['largest_snap'], 0)
            self.assertIn(f'CELLS {hexes} ', (self.folder / 'out.vtk').read_text())

    def test_every_level_multiplies_by_eight(self):
        for level in range(4):
            self.run_program('map', ROD / 'rod_patches.k', '-p', ROD / 'rod_blocks.k', '-s', level, '-o', 'out.vtk',
                             '--json', 'report.json')
            report = json.loads((self.folder / 'report.json').read_text())
            self.assertEqual(report['hexes'], 26 * 8**level)

    def test_the_same_bytes_for_any_number_of_threads(self):
        for threads in (1, 2):
            self.run_program('map', DATA / 'blob' / 'blob_patches.k', '-p', DATA / 'blob' / 'blob_blocks.k', '-s', '3',
                             '-o', f'{threads}.vtk', '--json', f'{threads}.json', '--threads', threads)
        for kind in ('vtk', 'json'):
            self.assertEqual((self.folder / f'1.{kind}').read_bytes(), (self.folder / f'2.{kind}').read_bytes())

    def map_rod(self, *options, code=0):
        result = self.run_program('map', ROD / 'rod_patches.k', '-p', ROD / 'rod_blocks.k', '-o', 'out.vtk', '--json',
                                  'report.json', *options, code=code)
        return json.loads((self.folder / 'report.json').read_text()) if code == 0 else result

    def test_size_of_the_elements(self):
        for target in (500, 5000):
            report = self.map_rod('--target-hexes', target)
            self.assertAlmostEqual(report['hexes'] / target, 1, delta=0.1)
            again = self.map_rod('--edge-length', report['edge_length'])
            self.assertAlmostEqual(again['hexes'] / target, 1, delta=0.35)
            self.assertEqual(again['edge_length'], report['edge_length'])
            self.assertIsNone(again['level'])
        self.assertEqual(self.map_rod('--edge-length', 1e6)['hexes'], 26)
        self.assertEqual(self.map_rod('--target-hexes=1e3')['edge_length'] > 0, True)

    def test_interior(self):
        quality = {}
        for interior in ('linear', 'transfinite', 'harmonic'):
            report = self.map_rod('--interior', interior)
            self.assertEqual(report['interior'], interior)
            quality[interior] = report['min_scaled_jacobian']
        self.assertGreaterEqual(quality['harmonic'], min(0.3, quality['transfinite']))
        self.assertEqual(self.map_rod()['interior'], 'harmonic')

    def test_sizes_that_make_no_sense(self):
        for options in (('--edge-length', 0), ('--edge-length=-1',), ('--edge-length', 'nan'), ('--edge-length', 'inf'),
                        ('--target-hexes', 0), ('--target-hexes', 1e30), ('-s', 2, '--edge-length', 1),
                        ('--target-hexes', 10, '--edge-length', 1), ('--interior', 'none')):
            self.map_rod(*options, code=2)

    def test_run_takes_the_size_too(self):
        for options in (('--target-hexes', 800), ('--interior', 'linear', '-s', 1)):
            self.run_program('run', ROD / 'rod_tri.k', '--segmentation', ROD / 'rod_patches.k', '--blocks',
                             ROD / 'rod_blocks.k', '--from', 'polycube', '--to', 'map', '-o', 'out', *options)
            hexes = json.loads((self.folder / 'out' / 'report.json').read_text())['hexes']
            self.assertAlmostEqual(hexes / (208 if '-s' in options else 800), 1, delta=0.1)

    def test_quads_in_place_of_blocks(self):
        self.run_program('polycube', ROD / 'rod_patches.k', '-o', 'quads.k')
        message = self.run_program('map', ROD / 'rod_patches.k', '-p', 'quads.k', '-o', 'out.vtk', code=3).stderr
        self.assertIn('quads.k', message)
        self.assertIn('needs hexahedral blocks', message)
        self.assertIn('rod_polycube_structure_hex.k', message)
        self.assertFalse((self.folder / 'out.vtk').exists())

    def test_what_does_not_fit_is_named(self):
        raw = self.run_program('map', ROD / 'rod_tri.k', '-p', ROD / 'rod_blocks.k', '-o', 'out.vtk', code=3)
        self.assertIn('patch 0 (part 1', raw.stderr)
        self.assertIn('rod_tri.k', raw.stderr)
        other = self.run_program('map', ROD / 'rod_patches.k', '-p', DATA / 'bracket' / 'bracket_blocks.k', '-o', 'out.vtk',
                                 code=3)
        self.assertIn('bracket_blocks.k', other.stderr)
        self.assertRegex(other.stderr, r'block (vertices )?\d+')
        self.assertEqual(len(other.stderr.strip().splitlines()), 1)
        self.assertFalse((self.folder / 'out.vtk').exists())

    def test_wrong_usage(self):
        blocks = ('-p', ROD / 'rod_blocks.k')
        for level in ('-1', '8', 'two'):
            self.run_program('map', ROD / 'rod_patches.k', *blocks, f'--level={level}', '-o', 'out.vtk', code=2)
        self.run_program('map', ROD / 'rod_patches.k', '-o', 'out.vtk', code=2)
        unknown = self.run_program('map', ROD / 'rod_patches.k', *blocks, '--method', 'none', '-o', 'out.vtk', code=2)
        self.assertIn('patchwise', unknown.stderr)
        self.run_program('map', ROD / 'rod_patches.k', '-p', 'missing.k', '-o', 'out.vtk', code=3)


if __name__ == '__main__':
    unittest.main()
