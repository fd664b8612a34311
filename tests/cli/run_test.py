#!/usr/bin/env python3
"""The subcommand run: the chain on the sample parts, resuming, messages and exit codes.

    run_test.py HEXSPLINE DATA
"""
import json
import shutil
import unittest

from program import DATA, CommandTest

FILES = ['1-labels.txt', '1-segment.k', '2-blocks.k', '2-patches.k', '2-polycube.k', '3-map.vtk', '4-improve.vtk',
         '5-spline.bext', '5-spline.vtu', 'report.json']
BRACKET = DATA / 'bracket'
GIVEN = ['--segmentation', BRACKET / 'bracket_patches.k', '--blocks', BRACKET / 'bracket_blocks.k']


class Run(CommandTest):
    def chain(self, *arguments, **options):
        return self.run_program('run', BRACKET / 'bracket.stl', *GIVEN, '-s', 1, *arguments, **options)

    def report(self, folder):
        return json.loads((self.folder / folder / 'report.json').read_text())

    def test_every_numbered_file_is_written_and_the_report_tells_the_result(self):
        self.chain('-o', 'out')
        self.assertEqual(sorted(path.name for path in (self.folder / 'out').iterdir()), FILES)
        report = self.report('out')
        self.assertEqual((report['route'], report['patches'], report['blocks'], report['hexes'], report['inverted']),
                         ('given', 38, 10, 80, 0))
        self.assertGreater(report['min_scaled_jacobian'], 0.3)
        self.assertEqual(list(report['seconds']), ['segment', 'polycube', 'map', 'improve', 'spline', 'total'])

    def test_the_same_bytes_for_any_number_of_threads(self):
        for threads in (1, 2):
            self.chain('-o', threads, '--threads', threads)
        for name in FILES[:-1]:
            with self.subTest(name):
                self.assertEqual((self.folder / '1' / name).read_bytes(), (self.folder / '2' / name).read_bytes())

    def test_stopping_and_going_on_gives_the_same_files_as_one_run(self):
        self.chain('-o', 'whole')
        self.chain('-o', 'parts', '--to', 'map')
        self.assertFalse((self.folder / 'parts' / '4-improve.vtk').exists())
        self.run_program('run', BRACKET / 'bracket.stl', '--from', 'improve', '-o', 'parts')
        for name in FILES[:-1]:
            with self.subTest(name):
                self.assertEqual((self.folder / 'whole' / name).read_bytes(),
                                 (self.folder / 'parts' / name).read_bytes())

    def test_a_mesh_edited_by_hand_is_what_the_next_stage_takes(self):
        self.chain('-o', 'out', '--to', 'improve')
        shutil.copy(self.folder / 'out' / '3-map.vtk', self.folder / 'out' / '4-improve.vtk')
        self.chain('-o', 'out', '--from', 'spline')
        self.chain('-o', 'plain', '--improve', 'none')
        self.assertEqual((self.folder / 'out' / '5-spline.bext').read_bytes(),
                         (self.folder / 'plain' / '5-spline.bext').read_bytes())

    def automatic(self, route, *arguments):
        self.run_program('run', BRACKET / 'bracket.stl', '-o', 'automatic', '--to', 'improve', *arguments)
        report = self.report('automatic')
        self.assertEqual((report['route'], report['inverted']), (route, 0))
        self.assertGreater(report['min_scaled_jacobian'], 0.2)
        self.assertLess(report['surface_distance_percent'], 1.6)
        return report

    def test_blocks_are_made_from_the_bare_surface_by_labelling(self):
        report = self.automatic('labelling')
        self.assertGreater(report['patches'], 6)
        self.assertNotIn('route_reason', report)
        # Going on after a stage keeps to the route.
        self.run_program('run', BRACKET / 'bracket.stl', '-o', 'automatic', '--from', 'map', '--to', 'map', '-s', 0)
        again = self.report('automatic')
        self.assertEqual((again['route'], again['hexes']), ('labelling', report['blocks']))

    def test_blocks_are_made_from_the_bare_surface_by_voxels(self):
        self.automatic('voxel', '--route', 'voxel', '--target-hexes', 1500)
        self.assertFalse((self.folder / 'automatic' / '2-patches.k').exists())

    def test_what_is_missing_is_named(self):
        surface = BRACKET / 'bracket.stl'
        message = self.run_program('run', surface, '--segmentation', GIVEN[1], '-o', 'out', code=2).stderr
        self.assertIn('--blocks', message)
        self.assertIn('labelling', self.run_program('run', surface, '-o', 'out', '--route', 'x', code=2).stderr)
        self.assertIn('--route', self.chain('-o', 'out', '--route', 'voxel', code=2).stderr)
        self.assertIn('4-improve.vtk', self.run_program('run', surface, '--from', 'spline', '-o', 'new', code=3).stderr)
        self.assertIn('--to', self.chain('-o', 'out', '--from', 'map', '--to', 'segment', code=2).stderr)
        self.assertIn('nowhere', self.chain('-o', 'out', '--from', 'nowhere', code=2).stderr)
        (self.folder / 'file').write_text('')
        self.chain('-o', 'file', code=5)


if __name__ == '__main__':
    unittest.main()
