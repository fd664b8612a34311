#!/usr/bin/env python3
"""The subcommands segment and polycube: files, reports, messages and exit codes.

    segment_polycube_test.py HEXSPLINE DATA
"""
import json
import unittest

from program import DATA, ROD, CommandTest


def shell_parts(path):
    lines = path.read_text().splitlines()
    start = lines.index('*ELEMENT_SHELL') + 1
    end = next(i for i in range(start, len(lines)) if lines[i].startswith('*'))
    return [int(line.split(',')[1]) for line in lines[start:end]]


class Commands(CommandTest):
    def test_segment_writes_parts_labels_and_report_that_agree(self):
        # A weight alone means the published method.
        self.run_program('segment', '-i', ROD / 'rod_tri.k', '-o', 'out.k', '-l', '0.1', '--labels', 'labels.txt',
                         '--json', 'report.json')
        labels = [int(line) for line in (self.folder / 'labels.txt').read_text().split()]
        self.assertEqual([label + 1 for label in labels], shell_parts(self.folder / 'out.k'))
        report = json.loads((self.folder / 'report.json').read_text())
        self.assertEqual(list(report['label_counts'].values()), [labels.count(k) for k in range(6)])
        self.assertEqual([s['phase'] for s in report['sweeps']], sorted(s['phase'] for s in report['sweeps']))
        self.assertGreater(report['charts'], 6)
        self.assertEqual(report['method'], 'hbecvt')

    def test_the_automatic_method_repairs_and_tells_it(self):
        for threads in (1, 2):
            self.run_program('segment', DATA / 'blob' / 'blob_tri.k', '-o', 'out.k', '--json', f'{threads}.json',
                             '--labels', f'{threads}.txt', '--threads', threads)
        self.assertEqual((self.folder / '1.txt').read_bytes(), (self.folder / '2.txt').read_bytes())
        report = json.loads((self.folder / '1.json').read_text())
        self.assertEqual(report['method'], 'auto')
        self.assertEqual([v for v in report['violations'] if v['severity'] == 'error'], [])
        for repair in report['repairs']:
            self.assertEqual(list(repair), ['repair', 'reason', 'triangle', 'triangles', 'cost'])

    def test_segment_writes_the_same_bytes_for_any_number_of_threads(self):
        for threads in (1, 2):
            self.run_program('segment', DATA / 'blob' / 'blob_tri.k', '-o', f'{threads}.k', '--json', f'{threads}.json',
                             '--threads', threads)
        for kind in ('k', 'json'):
            self.assertEqual((self.folder / f'1.{kind}').read_bytes(), (self.folder / f'2.{kind}').read_bytes())

    def test_cells_of_a_grid_need_no_labels(self):
        blob = DATA / 'blob' / 'blob_tri.k'
        self.run_program('polycube', '-i', blob, '--method', 'voxel', '--blocks', 'cells.vtk', '--json', 'voxel.json')
        report = json.loads((self.folder / 'voxel.json').read_text())
        self.assertEqual(report['euler_characteristic'], 2)
        self.assertEqual(report['surfaces'], 1)
        self.run_program('improve', 'cells.vtk', '-m', 'snap', '--surface', blob, '-o', 'hex.vtk', '--json', 'snap.json')
        after = json.loads((self.folder / 'snap.json').read_text())['after']
        self.assertEqual(after['inverted'], 0)
        self.assertGreater(after['hexes'], report['cells'])
        self.run_program('polycube', '-i', blob, '--method', 'voxel', '-o', 'quads.k', code=2)

    def test_manual_labels_count_from_0_or_1_and_are_checked(self):
        for base, text in ((0, '0 3\n1 3\n'), (1, '1 4\n2 4\n')):
            (self.folder / 'manual.txt').write_text(text)
            self.run_program('segment', ROD / 'rod_tri.k', '-o', 'out.k', '-m', 'manual.txt', '--manual-base', base)
            self.assertEqual(shell_parts(self.folder / 'out.k')[:2], [4, 4])
        for text in ('0 3\n999999 3\n', '0 3\n1 6\n', '0 3\n-1 0\n', '0 3\nzero 1\n'):
            (self.folder / 'manual.txt').write_text(text)
            done = self.run_program('segment', ROD / 'rod_tri.k', '-o', 'no.k', '-m', 'manual.txt', code=3)
            self.assertIn('manual.txt:2', done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1)
            self.assertFalse((self.folder / 'no.k').exists())

    def test_violations_are_warnings_unless_required(self):
        done = self.run_program('segment', ROD / 'rod_tri.k', '-o', 'out.k')
        self.assertIn('warning: chart-not-a-disk', done.stderr)
        self.run_program('segment', ROD / 'rod_tri.k', '-o', 'required.k', '--require', code=1)
        self.assertEqual((self.folder / 'out.k').read_bytes(), (self.folder / 'required.k').read_bytes())

    def test_patches_made_by_hand_are_kept_and_checked(self):
        self.run_program('segment', ROD / 'rod_patches.k', '-o', 'out.k', '--from-patches', '--require')
        self.assertEqual(shell_parts(self.folder / 'out.k'), shell_parts(ROD / 'rod_patches.k'))
        self.run_program('segment', ROD / 'rod_tri.k', '-o', 'out.k', '--from-patches', '--require', code=1)
        self.run_program('segment', ROD / 'rod_patches.k', '-o', 'out.k', '--from-patches', '-l', '0.2', code=2)

    def test_polycube_writes_quads_and_lists(self):
        self.run_program('polycube', '-i', ROD / 'rod_patches.k', '-o', 'cube.k', '-c', '1', '--json', 'report.json')
        report = json.loads((self.folder / 'report.json').read_text())
        self.assertEqual(len(shell_parts(self.folder / 'cube.k')), report['patches'])
        lines = {what: (self.folder / f'cube_{what}.txt').read_text().splitlines()
                 for what in ('corner', 'edge', 'face')}
        self.assertEqual(len(lines['corner']), report['corners'])
        self.assertEqual(len(lines['face']), report['patches'])
        self.assertEqual(len(lines['edge']), 4 * report['patches'])
        for edge in set(lines['edge']):
            self.assertEqual(lines['edge'].count(edge), 2)
        self.run_program('polycube', ROD / 'rod_patches.k', '-o', 'plain.k', '-c', '0')
        self.assertFalse((self.folder / 'plain_corner.txt').exists())

    def test_polycube_names_every_bad_patch_and_writes_nothing(self):
        self.run_program('segment', ROD / 'rod_tri.k', '-o', 'labels.k')
        done = self.run_program('polycube', 'labels.k', '-o', 'cube.k', '-c', '1', '--json', 'report.json', code=4)
        report = json.loads((self.folder / 'report.json').read_text())
        self.assertGreater(len(report['violations']), 0)
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), len(report['violations']) + 1)
        for line, violation in zip(lines, report['violations']):
            self.assertIn(violation['message'], line)
            self.assertIn('vert', line)
        self.assertEqual(list(self.folder.glob('cube*')), [])

    def test_labels_become_patches_and_blocks_that_map_takes(self):
        blob = ROD.parent / 'blob' / 'blob_patches.k'
        self.run_program('polycube', blob, '--patches', 'patches.k', '--blocks', 'blocks.k', '-o', 'quads.k',
                         '--json', 'report.json')
        report = json.loads((self.folder / 'report.json').read_text())
        self.assertEqual(report['violations'], [])
        self.assertEqual(report['block_structure']['violations'], [])
        self.assertEqual(len(shell_parts(self.folder / 'quads.k')), report['patches'])
        self.assertEqual(len(set(shell_parts(self.folder / 'patches.k'))), report['patches'])
        self.run_program('map', 'patches.k', '-p', 'blocks.k', '-o', 'mesh.vtk', '-s', '1', '--json', 'map.json')
        mapped = json.loads((self.folder / 'map.json').read_text())
        self.assertEqual(mapped['hexes'], 8 * report['block_structure']['blocks'])
        self.assertEqual(mapped['largest_snap'], 0)
        self.run_program('polycube', blob, '--patches', 'again.k', '--blocks', 'again_blocks.k', '--threads', '1')
        for one, other in (('patches.k', 'again.k'), ('blocks.k', 'again_blocks.k')):
            self.assertEqual((self.folder / one).read_bytes(), (self.folder / other).read_bytes())

    def test_polycube_without_anything_to_write_is_wrong_usage(self):
        self.run_program('polycube', ROD / 'rod_patches.k', code=2)
        self.run_program('polycube', ROD / 'rod_patches.k', '--blocks', 'b.k', '-c', '1', code=2)


if __name__ == '__main__':
    unittest.main()
