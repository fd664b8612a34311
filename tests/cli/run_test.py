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

    def test_nothing_is_written_but_into_the_output_folder(self):
        for name in ('temporary', 'home'):
            (self.folder / name).mkdir()
        everywhere = {name: str(self.folder / 'temporary') for name in ('TMPDIR', 'TMP', 'TEMP', 'TEMPDIR')}
        self.chain('-o', 'out', HOME=str(self.folder / 'home'), **everywhere)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ['home', 'out', 'temporary'])
        for name in ('temporary', 'home'):
            self.assertEqual(list((self.folder / name).iterdir()), [])
        self.assertEqual(sorted(path.name for path in (self.folder / 'out').iterdir()), FILES)

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

    def test_going_on_with_another_part_is_refused(self):
        self.chain('-o', 'out', '--to', 'map')
        out = self.folder / 'out'
        before = {path.name: path.read_bytes() for path in out.iterdir()}
        for stage in ('polycube', 'map', 'improve'):
            with self.subTest(stage):
                message = self.run_program('run', DATA / 'rod' / 'rod.stl', '--from', stage, '-o', 'out', code=2).stderr
                self.assertRegex(message, r'error: \S*rod\.stl: .*results in out ')
                self.run_program('run', 'missing.stl', '--from', stage, '-o', 'out', code=3)
                self.assertEqual({path.name: path.read_bytes() for path in out.iterdir()}, before)
        # The same part under another name, and the folder's own surface.
        shutil.copy(BRACKET / 'bracket.stl', self.folder / 'other.stl')
        made_from = self.report('out')['input_file']
        for part in ('other.stl', 'out/1-segment.k', 'out/2-patches.k'):
            self.run_program('run', part, '--from', 'improve', '--to', 'improve', '-o', 'out')
            self.assertEqual(self.report('out')['input_file'], made_from)
        # Folders of earlier versions, and those made by hand, do not tell what they were made from.
        report = self.report('out')
        del report['input_file']
        for text in (json.dumps(report), '{"input_file": 7}', '[]', '{'):
            (out / 'report.json').write_text(text)
            self.run_program('run', DATA / 'rod' / 'rod.stl', '--from', 'improve', '--to', 'improve', '-o', 'out')
            self.assertNotIn('input_file', self.report('out'))

    def test_blocks_of_another_part_do_not_stay(self):
        out = self.folder / 'out'
        self.chain('-o', 'out', '--to', 'map')
        self.run_program('run', BRACKET / 'bracket.stl', '-o', 'out', '--to', 'segment')
        self.assertTrue((out / '2-blocks.k').exists() and (out / '2-patches.k').exists())
        self.run_program('run', DATA / 'rod' / 'rod.stl', '-o', 'out', '--to', 'segment')
        self.assertEqual(sorted(path.name for path in out.iterdir()), ['1-labels.txt', '1-segment.k', 'report.json'])
        self.run_program('run', DATA / 'rod' / 'rod.stl', '-o', 'out', '--from', 'map', code=3)
        # What a person gives stays, where it is.
        self.chain('-o', 'mine', '--to', 'map')
        shutil.copy(BRACKET / 'bracket.stl', self.folder / 'other.stl')
        with (self.folder / 'other.stl').open('r+b') as file:
            file.write(b'other')
        self.run_program('run', 'other.stl', '--segmentation', 'mine/2-patches.k', '--blocks', 'mine/2-blocks.k', '-s', 0, '--to', 'map', '-o', 'mine')
        self.assertTrue((self.folder / 'mine' / '3-map.vtk').exists())

    def test_going_on_without_what_comes_before_names_it_and_makes_no_folder(self):
        part, patches, blocks = BRACKET / 'bracket.stl', GIVEN[:2], GIVEN[2:]
        for stage, missing, *options in (('polycube', '1-segment.k'), ('map', '2-blocks.k'), ('map', '2-blocks.k', *patches),
                                         ('map', '2-patches.k', *blocks), ('improve', '3-map.vtk'), ('improve', '3-map.vtk', *GIVEN),
                                         ('polycube', '1-segment.k', *blocks), ('map', '2-blocks.k', '--route', 'voxel'),
                                         ('spline', '4-improve.vtk')):
            with self.subTest(stage=stage, options=options):
                message = self.run_program('run', part, '--from', stage, '-o', 'none', *options, code=3).stderr
                self.assertIn(f'error: none/{missing}: is missing, and --from {stage} goes on with it', message)
                self.assertFalse((self.folder / 'none').exists())
        (self.folder / 'empty').mkdir()
        self.assertIn('empty/2-blocks.k', self.run_program('run', part, '--from', 'map', '-o', 'empty', code=3).stderr)
        # What is given need not be there, and what cannot be read leaves no folder either.
        self.run_program('run', part, '--from', 'map', *GIVEN, '-s', 0, '--to', 'map', '-o', 'given')
        self.run_program('run', part, '--from', 'map', *patches, '--blocks', 'missing.k', '-o', 'none', code=3)
        self.run_program('run', part, '--from', 'polycube', *blocks, '--segmentation', 'missing.k', '-o', 'none', code=3)
        self.assertFalse((self.folder / 'none').exists())

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
        # The mesh kept is among those that were tried.
        self.assertIn(report['surface_distance_percent'], [t['surface_distance_percent'] for t in report['tries']])
        # Going on after a stage keeps to the route.
        self.run_program('run', BRACKET / 'bracket.stl', '-o', 'automatic', '--from', 'map', '--to', 'map', '-s', 0)
        again = self.report('automatic')
        self.assertEqual((again['route'], again['hexes']), ('labelling', report['blocks']))

    def test_blocks_are_made_from_the_bare_surface_by_voxels(self):
        self.automatic('voxel', '--route', 'voxel', '--target-hexes', 1500)
        self.assertFalse((self.folder / 'automatic' / '2-patches.k').exists())

    def bare(self, surface, folder, *arguments):
        """Runs from a bare surface to the improved mesh; the report."""
        self.run_program('run', surface, '-o', folder, '--to', 'improve', *arguments)
        report = self.report(folder)
        self.assertEqual(report['inverted'], 0)
        return report

    def test_a_bare_surface_gives_the_same_bytes_for_any_number_of_threads(self):
        for route, methods in (('labelling', 'auto'), ('voxel', 'snap,smooth')):
            for threads in (1, 2):
                report = self.bare(BRACKET / 'bracket.stl', f'{route}{threads}', '--route', route, '--improve', methods,
                                   '--threads', threads, '--target-hexes', 300)
                self.assertEqual(report['route'], route)
            one, two = self.folder / f'{route}1', self.folder / f'{route}2'
            self.assertEqual(sorted(path.name for path in one.iterdir()), sorted(path.name for path in two.iterdir()))
            for path in one.iterdir():
                if path.name == 'report.json':
                    continue  # tells times
                with self.subTest(route=route, file=path.name):
                    self.assertEqual(path.read_bytes(), (two / path.name).read_bytes())

    def boxes(self, name, *corners):
        """Boxes between two corners each; those whose corners are the wrong way round are voids."""
        points, triangles = [], []
        for low, high in corners:
            base = len(points)
            points += [[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)]
            for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
                triangles += [[base + 1 + i for i in t] for t in ((a, b, c), (a, c, d))]
        text = ''.join('v {} {} {}\n'.format(*p) for p in points) + ''.join('f {} {} {}\n'.format(*t) for t in triangles)
        (self.folder / name).write_text(text)
        return self.folder / name

    def test_voids_and_several_components_by_both_routes(self):
        shell = self.boxes('shell.obj', ((0, 0, 0), (3, 3, 3)), ((2, 2, 2), (1, 1, 1)))
        pair = self.boxes('pair.obj', ((0, 0, 0), (1, 1, 1)), ((2, 0.5, 0), (3, 2, 0.8)))
        # The same shell with a void that is not turned inwards, and two bodies through each other.
        unturned = self.boxes('unturned.obj', ((0, 0, 0), (3, 3, 3)), ((1, 1, 1), (2, 2, 2)))
        crossing = self.boxes('crossing.obj', ((0, 0, 0), (1, 1, 1)), ((0.5, 0.4, 0.3), (2, 1.4, 1.3)))
        for surface, volume in ((shell, 26.0), (pair, 2.2), (unturned, 26.0), (crossing, 2.5)):
            for route in ('labelling', 'voxel'):
                with self.subTest(surface=surface.name, route=route):
                    report = self.bare(surface, 'out', '--route', route, '--target-hexes', 1000)
                    self.assertEqual(report['route'], route)
                    self.assertGreater(report['min_scaled_jacobian'], 0.5)
                    self.assertLess(report['surface_distance_percent'], 0.01)
                    self.run_program('check', self.folder / 'out' / '4-improve.vtk', '--json', 'check.json')
                    facts = json.loads((self.folder / 'check.json').read_text())
                    self.assertTrue(facts['boundary']['watertight'])
                    # The void is left out, and both components are there. (Sharp edges are met within 0.01 % of the diagonal.)
                    self.assertAlmostEqual(facts['metrics']['volume']['mean'] * facts['hexes'], volume, delta=volume / 500)

    def test_what_is_missing_is_named(self):
        surface = BRACKET / 'bracket.stl'
        message = self.run_program('run', surface, '--segmentation', GIVEN[1], '-o', 'out', code=2).stderr
        self.assertIn('--blocks', message)
        self.run_program('run', surface, *GIVEN[:2], '--from', 'polycube', '-o', 'out', code=2)
        self.assertFalse((self.folder / 'out').exists())
        self.assertIn('labelling', self.run_program('run', surface, '-o', 'out', '--route', 'x', code=2).stderr)
        self.assertIn('--route', self.chain('-o', 'out', '--route', 'voxel', code=2).stderr)
        self.assertIn('4-improve.vtk', self.run_program('run', surface, '--from', 'spline', '-o', 'new', code=3).stderr)
        self.assertIn('--to', self.chain('-o', 'out', '--from', 'map', '--to', 'segment', code=2).stderr)
        self.assertIn('nowhere', self.chain('-o', 'out', '--from', 'nowhere', code=2).stderr)
        (self.folder / 'file').write_text('')
        self.chain('-o', 'file', code=5)


if __name__ == '__main__':
    unittest.main()
