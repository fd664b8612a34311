#!/usr/bin/env python3
"""CAD models, --repair and --from-patches with missing patches, through the program.

    cad_test.py HEXSPLINE DATA
"""
import json
import subprocess
import unittest

from program import DATA, PROGRAM, CommandTest

ANGLE = DATA / 'angle' / 'angle.step'
READS_CAD = subprocess.run([PROGRAM, 'convert', ANGLE, '-o', '/dev/null/none.k'], capture_output=True,
                           text=True).stderr.find('reads no CAD files') < 0
CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (2, 3, 7, 6), (1, 2, 6, 5), (0, 4, 7, 3)]


def obj_of(faces, apart=False):
    lines, corners = [], []
    points = [CUBE[v] for face in faces for v in face] if apart else CUBE
    lines += [f'v {x} {y} {z}' for x, y, z in points]
    first = 1
    for face in faces:
        lines.append('f ' + ' '.join(str(v) for v in (range(first, first + len(face)) if apart else [v + 1 for v in face])))
        first += len(face)
    return '\n'.join(lines) + '\n'


def vtk_of_bricks(n, size):
    """A box of n[0] x n[1] x n[2] hexahedra from the origin."""
    m = [k + 1 for k in n]
    points = [(i * size, j * size, k * size) for k in range(m[2]) for j in range(m[1]) for i in range(m[0])]
    cells = [[i + x + m[0] * (j + y + m[1] * (k + z)) for x, y, z in CUBE]
             for k in range(n[2]) for j in range(n[1]) for i in range(n[0])]
    return '\n'.join(['# vtk DataFile Version 2.0', 'bricks', 'ASCII', 'DATASET UNSTRUCTURED_GRID',
                      f'POINTS {len(points)} double', *(' '.join(map(str, p)) for p in points),
                      f'CELLS {len(cells)} {9 * len(cells)}', *('8 ' + ' '.join(map(str, c)) for c in cells),
                      f'CELL_TYPES {len(cells)}', *['12'] * len(cells)]) + '\n'


@unittest.skipUnless(READS_CAD, 'built without Open CASCADE')
class Models(CommandTest):
    def test_a_spline_takes_the_sharp_edges_of_the_model(self):
        # The first of two plates, 30 x 20 x 10: its twelve edges, whatever -t says of triangles.
        (self.folder / 'plate.vtk').write_text(vtk_of_bricks((6, 4, 2), 5))
        model = DATA / 'pair' / 'pair.step'
        self.run_program('spline', 'plate.vtk', '-s', 4, '-t', -1, '--surface', model, '-o', 'a', '--json', 'report.json')
        report = json.loads((self.folder / 'report.json').read_text())
        self.assertEqual(report['sharp_edges'], 4 * (6 + 4 + 2))
        self.assertEqual(report['corner_vertices'], 8)
        self.assertLess(report['fit']['distance']['to_surface_max'], 1e-9)

    def test_convert_writes_triangles_and_features(self):
        self.run_program('convert', ANGLE, '-o', 'angle.k', '--features-out', 'edges.obj', '--json', 'report.json')
        report = json.loads((self.folder / 'report.json').read_text())
        lines = (self.folder / 'edges.obj').read_text().splitlines()
        self.assertEqual(sum(line.startswith('l ') for line in lines), report['sharp_edges'])
        self.assertGreater(report['sharp_edges'], 100)
        fine = self.run_program('convert', ANGLE, '-o', 'fine.k', '--deflection', 0.002, '--longest-edge', 2, '--json', '-')
        self.assertGreater(json.loads(fine.stdout)['polygons'], 2 * report['polygons'])

    def test_segment_reads_step(self):
        self.run_program('segment', ANGLE, '-o', 'angle.k', '--labels', 'labels.txt', '--longest-edge', 6)
        labels = (self.folder / 'labels.txt').read_text().split()
        self.assertEqual(set(labels), set('012345'))

    def test_damaged_models_are_one_clear_line(self):
        text = ANGLE.read_bytes()
        for damaged in (b'garbage', text[:9000], text[:9000] + b'\nENDSEC;\nEND-ISO-10303-21;\n',
                        text.replace(b'CARTESIAN_POINT', b'CARTESIAN_PAINT'), text[:4000] + text[30000:]):
            (self.folder / 'bad.step').write_bytes(damaged)
            message = self.run_program('segment', 'bad.step', '-o', 'out.k', code=3).stderr
            self.assertEqual(len(message.strip().splitlines()), 1, message)
            self.assertIn('bad.step', message)
            self.assertFalse((self.folder / 'out.k').exists())

    def test_options_of_cad_need_a_cad_model(self):
        for options in (('--deflection', 1), ('--longest-edge', 1), ('--features-out', 'f.obj')):
            for command in ('segment', 'convert'):
                self.run_program(command, DATA / 'rod' / 'rod.stl', '-o', 'out.k', *options, code=2)
        self.run_program('convert', ANGLE, '-o', 'out.k', '--deflection', 0, code=2)
        self.run_program('convert', ANGLE, '-o', 'out.step', code=3)


class Repair(CommandTest):
    def repaired(self, text, *options, code=0):
        (self.folder / 'broken.obj').write_text(text)
        self.run_program('segment', 'broken.obj', '-o', 'out.k', code=3)
        done = self.run_program('segment', 'broken.obj', '-o', 'out.k', '--repair', '--json', 'report.json', *options, code=code)
        return done.stderr

    def test_points_orientation_and_copies(self):
        self.assertIn('16 points merged', self.repaired(obj_of(FACES, apart=True)))
        self.assertIn('1 polygons turned', self.repaired(obj_of([FACES[0][::-1]] + FACES[1:])))
        self.assertIn('1 duplicate polygons removed', self.repaired(obj_of(FACES + [FACES[2]])))
        report = json.loads((self.folder / 'report.json').read_text())
        self.assertEqual([finding['code'] for finding in report['repair']], ['repair-duplicate'])

    def test_a_large_hole_stays_an_error(self):
        self.assertIn('holes left', self.repaired(obj_of(FACES[1:]), code=3))

    def test_nothing_to_repair(self):
        self.run_program('convert', DATA / 'rod' / 'rod_tri.k', '-o', 'out.k', '--repair', '--json', 'report.json')
        self.assertEqual(json.loads((self.folder / 'report.json').read_text())['repair'], [])


class FromPatches(CommandTest):
    def test_missing_patches_are_made_and_the_others_kept(self):
        lines = (DATA / 'bracket' / 'bracket_patches.k').read_text().splitlines()
        section, before, missing = None, [], 0
        for i, line in enumerate(lines):
            if line.startswith('*'):
                section = line
            elif section == '*ELEMENT_SHELL' and not line.startswith('$'):
                fields = line.split(',')
                before.append(fields[1].strip())
                if before[-1] in ('3', '4'):
                    missing += 1
                    fields[1] = '0'
                    lines[i] = ','.join(fields)
        (self.folder / 'some.k').write_text('\n'.join(lines) + '\n')
        done = self.run_program('segment', 'some.k', '-o', 'all.k', '--from-patches', '--json', 'report.json')
        self.assertIn(f'{missing} triangles without a patch', done.stderr)
        completed = json.loads((self.folder / 'report.json').read_text())['completed']
        self.assertEqual(completed['triangles'], missing)
        self.assertGreaterEqual(len(completed['parts']), 2)
        after, section = [], None
        for line in (self.folder / 'all.k').read_text().splitlines():
            if line.startswith('*'):
                section = line
            elif section == '*ELEMENT_SHELL' and not line.startswith('$'):
                after.append(line.split(',')[1].strip())
        self.assertEqual(len(after), len(before))
        for old, new in zip(before, after):
            if old in ('3', '4'):
                self.assertIn(int(new), completed['parts'])
            else:
                self.assertEqual(old, new)


if __name__ == '__main__':
    unittest.main()
