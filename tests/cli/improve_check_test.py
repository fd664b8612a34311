#!/usr/bin/env python3
"""The subcommands improve and check: files, reports, messages and exit codes.

    improve_check_test.py HEXSPLINE DATA
"""
import json
import unittest

from hex_files import CUBE, write_vtk
from program import ROD, CommandTest


class Commands(CommandTest):
    def report(self, name='report.json'):
        return json.loads((self.folder / name).read_text())

    def make_rod(self):
        self.run_program('map', ROD / 'rod_patches.k', '-p', ROD / 'rod_blocks.k', '-s', '1', '-o', 'rod_hex.vtk')

    def test_the_command_lines_of_the_paper(self):
        self.make_rod()
        (self.folder / 'sharp.txt').write_text('0 0\n0 1\n')
        self.run_program('improve', '-i', 'rod_hex.vtk', '-Q', '-m', '1', '-n', '1', '-o', 'pillow.vtk', '--json', 'report.json')
        self.assertEqual(self.report()['method'], 'pillow')
        self.assertEqual(self.report()['after']['inverted'], 0)
        self.assertGreater(self.report()['after']['hexes'], self.report()['before']['hexes'])
        self.run_program('improve', '-I', 'pillow.vtk', '-Q', '-m', '2', '-p', '0.001', '-n', '50', '-s', '2', '-o', 'smooth.vtk',
                         '--json', 'report.json')
        self.assertEqual((self.report()['method'], len(self.report()['history'])), ('smooth', 50))
        self.run_program('improve', '-i', 'smooth.vtk', '-Q', '-m', '3', '-p', '0.001', '-n', '15', '-o', 'optimize.vtk',
                         '--json', 'report.json')
        self.assertEqual(self.report()['method'], 'optimize')
        self.assertGreater(self.report()['after']['min_scaled_jacobian'], self.report()['before']['min_scaled_jacobian'])

    def test_numbers_and_names_of_methods_are_the_same(self):
        self.make_rod()
        for number, name in enumerate(('laplace', 'pillow', 'smooth', 'optimize')):
            self.run_program('improve', 'rod_hex.vtk', '-m', number, '-n', 1, '-o', 'a.vtk')
            self.run_program('improve', 'rod_hex.vtk', '-m', name, '-n', 1, '-o', 'b.vtk')
            self.assertEqual((self.folder / 'a.vtk').read_bytes(), (self.folder / 'b.vtk').read_bytes(), name)

    def test_the_same_bytes_for_any_number_of_threads(self):
        self.make_rod()
        for method in ('pillow', 'smooth', 'optimize'):
            for threads in (1, 2):
                self.run_program('improve', 'rod_hex.vtk', '-m', method, '-n', 3, '-s', 1, '--surface', ROD / 'rod_patches.k',
                                 '-o', f'{threads}.vtk', '--json', f'{threads}.json', '--threads', threads)
            for kind in ('vtk', 'json'):
                self.assertEqual((self.folder / f'1.{kind}').read_bytes(), (self.folder / f'2.{kind}').read_bytes(), method)

    def test_sharp_vertices_come_from_the_file_beside_the_input_or_from_the_named_one(self):
        write_vtk(self.folder / 'cube.vtk', CUBE, [range(8)])
        (self.folder / 'sharp.txt').write_text('0\t0\n0\t1\n0\t2')
        self.run_program('improve', 'cube.vtk', '-m', 'smooth', '-s', 2, '-n', 1, '-o', 'out.vtk', '--json', 'report.json')
        self.assertEqual(self.report()['sharp_edges'], 2)
        (self.folder / 'two.txt').write_text('0\n1\n')
        self.run_program('improve', 'cube.vtk', '-m', 'smooth', '-s', 2, '--sharp-file', 'two.txt', '-n', 1, '-o', 'out.vtk', '--json', 'report.json')
        self.assertEqual(self.report()['sharp_edges'], 1)
        (self.folder / 'bad.txt').write_text('0\n8\n')
        message = self.run_program('improve', 'cube.vtk', '-s', 2, '--sharp-file', 'bad.txt', '-o', 'no.vtk', code=3).stderr
        self.assertIn('bad.txt', message)
        self.assertIn('8', message)
        self.run_program('improve', 'cube.vtk', '-s', 2, '--sharp-file', 'missing.txt', '-o', 'no.vtk', code=3)
        self.assertFalse((self.folder / 'no.vtk').exists())

    def test_wrong_usage_of_improve(self):
        write_vtk(self.folder / 'cube.vtk', CUBE, [range(8)])
        for wrong in (['-m', 'none-such'], ['-m', '4'], ['-n', '-1'], ['-p', '0'], ['-p', '1.5'], ['-s', '3'], ['-t', '2']):
            message = self.run_program('improve', 'cube.vtk', '-o', 'no.vtk', *wrong, code=2).stderr
            self.assertEqual(message.count('\n'), 1, message)
        self.assertFalse((self.folder / 'no.vtk').exists())

    def test_check_prints_a_table_and_passes_a_cube(self):
        write_vtk(self.folder / 'cube.vtk', CUBE, [range(8)])
        table = self.run_program('check', 'cube.vtk', '--min-scaled-jacobian', '1', '--json', 'report.json').stdout
        self.assertIn('hexahedra             1\n', table)
        report = self.report()
        self.assertEqual((report['vertices'], report['hexes'], report['inverted'], report['passed']), (8, 1, 0, True))
        self.assertEqual(report['min_scaled_jacobian'], 1)
        self.assertEqual(sum(report['histogram']), 1)

    def test_check_fails_below_the_threshold_and_for_inverted_elements(self):
        mirrored = [(x, y, -z) for x, y, z in CUBE]
        write_vtk(self.folder / 'inverted.vtk', mirrored, [range(8)])
        done = self.run_program('check', 'inverted.vtk', '--json', '-', code=1)
        report = json.loads(done.stdout)
        self.assertEqual((report['inverted'], report['inverted_ids'], report['passed']), (1, [0], False))
        self.assertIn('inverted.vtk', done.stderr)
        self.run_program('check', 'inverted.vtk', '--min-scaled-jacobian', '-1')
        sheared = [(x + z, y, z) for x, y, z in CUBE]  # 1 / sqrt 2
        write_vtk(self.folder / 'sheared.vtk', sheared, [range(8)])
        self.run_program('check', 'sheared.vtk')
        self.run_program('check', 'sheared.vtk', '--min-scaled-jacobian', '0.7')
        self.run_program('check', 'sheared.vtk', '--min-scaled-jacobian', '0.71', code=1)
        self.run_program('check', 'sheared.vtk', '--min-scaled-jacobian', '2', code=2)

    def test_check_tells_what_is_odd_about_the_topology(self):
        write_vtk(self.folder / 'loose.vtk', [*CUBE, (9, 9, 9)], [range(8)])
        done = self.run_program('check', 'loose.vtk', '--json', 'report.json')
        self.assertEqual(len(self.report()['diagnostics']), 1)
        self.assertIn(self.report()['diagnostics'][0]['message'], done.stdout)

    def test_inputs_that_are_no_hexahedral_mesh(self):
        (self.folder / 'empty.vtk').write_text('')
        for command in (['check'], ['improve', '-o', 'no.vtk']):
            for bad in ('missing.vtk', 'empty.vtk', '.', ROD / 'rod_patches.k'):
                message = self.run_program(*command, '-i', bad, code=3).stderr
                self.assertEqual(message.count('\n'), 1, message)
        self.assertFalse((self.folder / 'no.vtk').exists())


if __name__ == '__main__':
    unittest.main()
