#!/usr/bin/env python3
"""The subcommand spline: formats, refinement by place, decks, the report, messages and exit codes.

    spline_test.py HEXSPLINE DATA
"""
import json
import unittest

from program import ROD, CommandTest


class Spline(CommandTest):
    def setUp(self):
        super().setUp()
        self.run_program('map', ROD / 'rod_patches.k', '-p', ROD / 'rod_blocks.k', '-s', 1, '-o', 'rod.vtk')

    def spline(self, *arguments, code=0):
        """With the sharp edges of the part, where nothing folds, unless the arguments say -t."""
        tolerance = () if '-t' in arguments else ('-t', 0.5)
        return self.run_program('spline', 'rod.vtk', '-s', 1, *tolerance, *arguments, code=code)

    def report(self, *arguments):
        self.spline(*arguments, '--json', 'report.json')
        return json.loads((self.folder / 'report.json').read_text())

    def test_the_format_follows_the_extension(self):
        for name, start in (('a.BEXT', b'B E X T\ntype hex'), ('a.bxt', b'B E X T 2.0'), ('a.vtu', b'<?xml'),
                            ('a.json', b'{"format": "hexspline spline"'), ('plain', b'B E X T\ntype hex')):
            with self.subTest(name):
                self.spline('-o', name)
                self.assertTrue((self.folder / name).read_bytes().startswith(start))
        self.spline('-o', 'b.txt', '--format', 'bext2')
        self.assertEqual((self.folder / 'b.txt').read_bytes(), (self.folder / 'a.bxt').read_bytes())
        self.spline('-o', 'a.stl', code=2)
        self.spline('-o', 'a', '--format', 'step', code=2)

    def test_json_holds_the_spline(self):
        report = self.report('-o', 'a.json')
        spline = json.loads((self.folder / 'a.json').read_text())
        self.assertEqual(len(spline['control_points']), report['control_points'])
        self.assertEqual(len(spline['elements']), report['elements'])
        for functions, values in spline['bezier_points']:
            self.assertEqual(len(functions), len(values))
            self.assertAlmostEqual(sum(values), 1, 14)

    def test_every_element_is_judged(self):
        # With every edge of the coarse mesh sharp that is a little bent, many elements fold.
        report = self.report('-o', 'a', '-t', 0.8)
        jacobian = report['jacobian']
        self.assertEqual(jacobian['proved_positive'] + jacobian['proved_negative'] + jacobian['undecided'],
                         report['elements'])
        self.assertGreater(report['repair']['mended'], 0)
        self.assertEqual(report['repair']['unmended'], [])
        self.assertNotIn('repair', self.report('-o', 'a', '-t', 0.8, '--no-repair'))

    def test_refining_by_place(self):
        plain = self.report('-o', 'a')
        for where in ('worst:5%', 'sphere:0,0,0,1', 'box:-1,-1,-1,1,1,1'):
            with self.subTest(where):
                report = self.report('-o', 'a', '--refine', where)
                self.assertEqual(report['elements'], plain['elements'] + 7 * report['levels'][0]['refined'])
        self.spline('-o', 'a', '--refine', 'worst', code=2)
        self.assertIn('missing', self.spline('-o', 'a', '--refine', 'near:missing', code=3).stderr)

    def test_decks(self):
        self.spline('-o', 'a.bext', '--deck', 'eigen')
        deck = (self.folder / 'a_eigen.k').read_text()
        self.assertIn('*INCLUDE_TRANSFORM\na.bext\n', deck)
        self.assertIn('*CONTROL_IMPLICIT_EIGENVALUE', deck)
        self.spline('-o', 'a.bxt', '--deck', 'static')
        self.assertIn('*IGA_INCLUDE_BEZIER\na.bxt\n', (self.folder / 'a_static.k').read_text())
        self.spline('-o', 'a.vtu', '--deck', 'eigen', code=2)
        self.spline('-o', 'a', '--deck', 'modal', code=2)

    def test_the_distance_from_the_part_is_told_and_fit_needs_the_part(self):
        report = self.report('-o', 'a', '--surface', ROD / 'rod_tri.k')
        self.assertGreater(report['fit']['distance']['to_surface_max'], 0)
        self.spline('-o', 'a', '--fit', code=2)

    def test_fitting_takes_the_sharp_edges_of_the_part(self):
        def report(*arguments):
            self.run_program('spline', 'rod.vtk', '-o', 'a', '--surface', ROD / 'rod_patches.k',
                             '--json', 'report.json', *arguments)
            return json.loads((self.folder / 'report.json').read_text())
        unfitted, fitted = report(), report('--fit')
        self.assertEqual(unfitted['sharp_edges'], 0)
        self.assertGreater(fitted['sharp_edges'], 0)
        self.assertEqual(report('-s', 0, '--fit')['sharp_edges'], 0)
        for direction in ('to_surface', 'from_surface'):
            before, after = fitted['fit']['before'], fitted['fit']['after']
            self.assertEqual(before, unfitted['fit']['distance'])
            self.assertLess(5 * after[direction + '_rms'], before[direction + '_rms'])
            self.assertLess(2 * after[direction + '_max'], before[direction + '_max'])
        self.assertEqual(fitted['jacobian']['proved_positive'], fitted['elements'])

    def test_what_the_part_decides_needs_the_part(self):
        part = ('--surface', ROD / 'rod_patches.k')
        plain = self.report('-o', 'a')
        report = self.report('-o', 'a', '--refine', 'worst-fit:5%', *part)
        self.assertEqual(report['elements'], plain['elements'] + 7 * report['levels'][0]['refined'])
        self.spline('-o', 'a', '--refine', 'worst-fit:5%', code=2)
        sharp = {}
        for source in (0, 3, 4):
            self.run_program('spline', 'rod.vtk', '-s', source, '-o', 'a', *part, '--json', 'report.json')
            sharp[source] = json.loads((self.folder / 'report.json').read_text())['sharp_edges']
        self.assertEqual(sharp[0], 0)
        self.assertGreater(sharp[3], sharp[4], 'some borders of patches are no sharp edges')
        self.assertGreater(sharp[4], 0)
        self.run_program('spline', 'rod.vtk', '-s', 4, '-o', 'a', code=2)
        self.run_program('spline', 'rod.vtk', '-s', 5, '-o', 'a', code=2)

    def test_the_same_bytes_for_any_number_of_threads(self):
        part = ROD / 'rod_tri.k'
        for name, *options in (('a.bext', '--refine', 'worst:5%'), ('a.bxt', '--refine', 'worst:5%'),
                               ('a.vtu', '--refine', 'worst:5%'), ('a.json', '--refine', 'worst:5%'),
                               ('mended.bext', '-t', 0.8), ('fitted.bext', '--surface', part, '--fit')):
            written = []
            for threads in (1, 2):
                self.spline('-o', name, '--threads', threads, *options)
                written.append((self.folder / name).read_bytes())
            with self.subTest(name):
                self.assertEqual(*written)


if __name__ == '__main__':
    unittest.main()
