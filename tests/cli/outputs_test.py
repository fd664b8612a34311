#!/usr/bin/env python3
"""Which files commands write: never over an input that is not named as the output, never two into one; and what is too
large is refused before it is begun.

    outputs_test.py HEXSPLINE DATA
"""
import json
import os
import shutil
import subprocess
import unittest

from program import DATA, PROGRAM, ROD, CommandTest

BRACKET = DATA / 'bracket'


class Outputs(CommandTest):
    def refused(self, *arguments, code=2):
        """Runs, expects a refusal, and that no file has changed. Returns the message."""
        before = {path: path.read_bytes() for path in self.folder.rglob('*') if path.is_file()}
        message = self.run_program(*arguments, code=code).stderr
        after = {path: path.read_bytes() for path in self.folder.rglob('*') if path.is_file()}
        self.assertEqual(before, after)
        return message

    def copy(self, source, name):
        return shutil.copy(source, self.folder / name)

    def test_two_outputs_into_one_file_are_refused(self):
        self.copy(BRACKET / 'bracket.stl', 's.stl')
        message = self.refused('segment', 's.stl', '-o', 'out.k', '--labels', 'out.k')
        self.assertIn('--output and --labels', message)
        # By another name of the same place, too.
        self.refused('segment', 's.stl', '-o', 'out.k', '--json', self.folder / 'x' / '..' / 'out.k')
        (self.folder / 'out.k').touch()
        os.symlink(self.folder / 'out.k', self.folder / 'link.k')
        self.refused('convert', 's.stl', '-o', 'out.k', '--json', 'link.k')
        self.copy(BRACKET / 'bracket_blocks.k', 'b.k')
        self.refused('improve', 'b.k', '-o', 'out.vtk', '--features-out', 'out.vtk')
        self.refused('check', 'b.k', '--junit', 'r.xml', '--sarif', 'r.xml')
        # Devices are no files.
        self.run_program('check', 'b.k', '--junit', '/dev/null', '--sarif', '/dev/null')

    def test_through_a_link_the_file_it_names_is_written(self):
        os.mkdir(self.folder / 'far')
        os.symlink('far/away.off', self.folder / 'link.off')
        for _ in ('made', 'replaced'):
            self.run_program('convert', ROD / 'rod.stl', '-o', 'link.off')
            self.assertTrue((self.folder / 'link.off').is_symlink())
            self.assertTrue((self.folder / 'far/away.off').is_file())
        os.symlink('loop.off', self.folder / 'loop.off')
        self.assertIn('loop.off', self.run_program('convert', ROD / 'rod.stl', '-o', 'loop.off', code=5).stderr)

    def test_a_descriptor_is_written_to_and_not_replaced(self):
        log = self.folder / 'log.txt'
        for name in ('/dev/stdout', '/dev/fd/1', '/proc/self/fd/1'):
            with self.subTest(name=name):
                log.write_text('before\n')
                with open(log, 'a') as out:
                    subprocess.run([PROGRAM, 'check', BRACKET / 'bracket_blocks.k', '--markdown', name, '-q'], stdout=out, check=True)
                    out.write('after\n')
                lines = log.read_text().splitlines()
                self.assertEqual((lines[0], lines[-1]), ('before', 'after'))
                self.assertTrue(any(line.startswith('|') for line in lines))

    def test_results_of_an_earlier_run_do_not_outlive_what_they_were_made_of(self):
        blocks = ROD / 'rod_blocks.k'
        arguments = ('run', ROD / 'rod.stl', '--segmentation', ROD / 'rod_patches.k', '--blocks', blocks, '-o', 'out', '--improve', 'laplace')
        self.run_program(*arguments, '-s', 1)
        files = {path.name for path in (self.folder / 'out').iterdir()}
        self.assertLessEqual({'3-map.vtk', '4-improve.vtk', '5-spline.bext', '5-spline.vtu', 'report.json'}, files)
        self.run_program(*arguments, '-s', 0, '--to', 'map')
        files -= {'4-improve.vtk', '5-spline.bext', '5-spline.vtu'}
        self.assertEqual({path.name for path in (self.folder / 'out').iterdir()}, files)
        self.run_program('run', ROD / 'rod.stl', '-o', 'out', '--from', 'spline', code=3)

    def test_an_input_stays_unless_it_is_named_as_the_output(self):
        self.copy(BRACKET / 'bracket.stl', 's.stl')
        self.copy(BRACKET / 'bracket_blocks.k', 'b.k')
        self.assertIn('--json and --input', self.refused('check', 'b.k', '--json', 'b.k'))
        self.refused('check', 'b.k', '--surface', 's.stl', '--vtu', 's.stl')
        self.refused('improve', 'b.k', '--surface', 's.stl', '-o', 's.stl')
        # In place is what this asks for.
        self.run_program('convert', 'b.k', '-o', 'b.k')
        self.run_program('convert', 's.stl', '-o', 's_hmesh0_CM.k')
        self.copy(ROD / 'rod_blocks.k', 'mesh.k')
        self.run_program('convert', 'mesh.k', '-o', 'a_hmesh0_CM.vtk')
        message = self.refused('spline', 'a_hmesh0_CM.vtk', '-o', 'new.vtu', '--control-mesh', 'b', '--json',
                               'a_hmesh0_CM.vtk')
        self.assertIn('--json and --input', message)
        before = (self.folder / 'a_hmesh0_CM.vtk').read_bytes()
        message = self.run_program('spline', 'a_hmesh0_CM.vtk', '-o', 'o.bext', '--control-mesh', 'a', code=2).stderr
        self.assertIn('would be overwritten', message)
        self.assertEqual((self.folder / 'a_hmesh0_CM.vtk').read_bytes(), before)

    def test_run_leaves_what_a_person_gives_as_it_is(self):
        out = self.folder / 'out'
        out.mkdir()
        patches, blocks = out / '2-patches.k', out / '2-blocks.k'
        patches.write_text((BRACKET / 'bracket_patches.k').read_text() + '$ mine\n')
        self.copy(BRACKET / 'bracket_blocks.k', blocks)
        before = [path.read_text() for path in (patches, blocks)]
        self.run_program('run', BRACKET / 'bracket.stl', '--segmentation', patches, '--blocks', blocks, '-o', 'out', '-s', 1,
                         '--to', 'map')
        self.assertEqual([path.read_text() for path in (patches, blocks)], before)
        self.assertTrue((out / '3-map.vtk').exists())
        # A labelled surface would get other labels.
        message = self.refused('run', 'out/1-segment.k', '-o', 'out')
        self.assertIn('--from', message)

    def test_run_on_an_input_that_cannot_be_read_leaves_no_folder(self):
        (self.folder / 'bad.stl').write_text('solid of nothing\n')
        self.run_program('run', 'bad.stl', '-o', 'out', code=3)
        self.run_program('run', 'missing.stl', '-o', 'out', code=3)
        self.assertFalse((self.folder / 'out').exists())

    def test_every_output_that_cannot_be_written_is_named(self):
        rod, patches, blocks = ROD / 'rod_tri.k', ROD / 'rod_patches.k', ROD / 'rod_blocks.k'
        self.run_program('segment', rod, '-o', 'labelled.k')
        check = ('check', blocks, '--min-scaled-jacobian', -1)
        mapped = ('map', patches, '-p', blocks, '-s', 0)
        self.run_program(*mapped, '-o', 'mesh.vtk')
        improve = ('improve', 'mesh.vtk', '-m', 'smooth', '-n', 1)
        for *command, option in ((*('segment', rod), '-o'), (*('segment', rod, '-o', 'a.k'), '--labels'),
                                 (*('polycube', patches), '-o'), (*('polycube', 'labelled.k'), '--patches'),
                                 (*('polycube', 'labelled.k'), '--blocks'), (*mapped, '-o'), (*improve, '-o'),
                                 ('improve', 'mesh.vtk', '-o', 'b.vtk', '--features-out'), (*('spline', 'mesh.vtk'), '-o'),
                                 (*('spline', 'mesh.vtk', '-o', 'c.bext'), '--control-mesh'), (*('convert', rod), '-o'),
                                 (*check, '--json'), (*check, '--junit'), (*check, '--sarif'), (*check, '--markdown'),
                                 (*check, '--vtu'), (*mapped, '-o', 'd.vtk', '--json')):
            for bad in ('/dev/full', 'missing/folder/out', '/proc/out'):
                # The format follows the extension.
                ending = {'--control-mesh': '', '-o': '.vtk', '--vtu': '.vtu'}.get(option, '.k')
                if command[0] in ('segment', 'polycube', 'convert'):
                    ending = '.k'
                if command[0] == 'spline':
                    ending = ''
                if bad == '/dev/full':
                    if option == '--control-mesh':
                        continue
                    bad = f'full{ending}'
                    if not os.path.lexists(self.folder / bad):
                        os.symlink('/dev/full', self.folder / bad)
                else:
                    bad += ending
                with self.subTest(command=command[0], option=option, output=bad):
                    self.assertIn(bad, self.run_program(*command, option, bad, code=5).stderr)
        self.run_program('run', blocks.with_name('rod.stl'), '-o', '/proc/out', code=5)
        self.assertIn('--output', self.run_program('convert', rod, '-o', '', code=2).stderr)
        for name in ('surface', 'baseline', 'config'):
            self.assertIn(f'--{name} is empty', self.run_program('check', blocks, f'--{name}', '', code=2).stderr)

    def test_what_is_too_large_is_refused_before_it_is_begun(self):
        rod = ROD / 'rod.stl'
        self.assertIn('larger cells', self.refused('polycube', rod, '--method', 'voxel', '--unit', '1e-9', '--blocks', 'b.k',
                                                   code=3))
        self.refused('polycube', rod, '--method', 'voxel', '--unit', 'nan', '--blocks', 'b.k')
        self.assertIn('longer edges', self.refused('convert', DATA / 'angle' / 'angle.step', '-o', 'a.k', '--longest-edge',
                                                   '1e-9', code=3))
        self.assertIn('fewer layers', self.refused('improve', BRACKET / 'bracket_blocks.k', '-m', 'pillow', '-n', 1000000000,
                                                   '-o', 'o.vtk', code=3))


class Splines(CommandTest):
    """convert between files of splines."""

    def test_bext_to_every_format_and_back(self):
        self.run_program('spline', ROD / 'rod_blocks.k', '-o', 'a.bext', '--force')
        for name in ('a.bxt', 'a.vtu', 'a.json'):
            self.run_program('convert', 'a.bext', '-o', name)
            self.run_program('spline', ROD / 'rod_blocks.k', '-o', 'b' + name[1:], '--force')
        self.run_program('convert', 'a.bxt', '-o', 'again.bext')
        text = [(self.folder / name).read_text() for name in ('a.bext', 'again.bext')]
        self.assertEqual(text[0], text[1])
        self.assertEqual((self.folder / 'a.bxt').read_text(), (self.folder / 'b.bxt').read_text())
        one, two = [json.loads((self.folder / name).read_text()) for name in ('a.json', 'b.json')]
        self.assertEqual(one['control_points'], two['control_points'])
        self.assertEqual(len(one['elements']), len(two['elements']))
        report = json.loads(self.run_program('convert', 'a.bxt', '-o', 'c.vtu', '--json', '-').stdout)
        self.assertEqual((report['content'], report['bezier_elements']), ('spline', len(one['elements'])))

    def test_what_a_spline_cannot_be(self):
        self.run_program('spline', ROD / 'rod_blocks.k', '-o', 'a.bext', '--force')
        self.assertIn('.vtk', self.run_program('convert', 'a.bext', '-o', 'a.vtk', code=2).stderr)
        self.run_program('convert', 'a.bext', '-o', 'a.bxt', '--labels', 'x.txt', code=2)
        (self.folder / 'bad.bxt').write_text('B E X T 2.0\n1 2\n')
        self.assertIn('bad.bxt:', self.run_program('convert', 'bad.bxt', '-o', 'c.bext', code=3).stderr)


if __name__ == '__main__':
    unittest.main()
