#!/usr/bin/env python3
"""The plug-ins are found, loaded and used; what is no plug-in is refused, and one that fails says so in one line.

    plugin_test.py HEXSPLINE FAULTY_PLUGIN PLUGIN_FOLDER DATA_FOLDER
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

DATA = Path(sys.argv.pop())
FOLDER = Path(sys.argv.pop())
FAULTY = sys.argv.pop()
PROGRAM = sys.argv.pop()
PLUGIN = str(FOLDER / 'axis_segmenter.so')
GRAPH_CUT, CENTRE, NASTRAN = (FOLDER / f'{name}.so' for name in ('graph_cut_segmenter', 'centre_improver', 'nastran_reader'))


def run(*arguments, **environment):
    return subprocess.run([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          env={**os.environ, **environment})


def methods(*arguments, **environment):
    done = run('plugins', '--json', '-', *arguments, **environment)
    assert done.returncode == 0, done.stderr
    return {(m['stage'], m['method']): m['origin'] for m in json.loads(done.stdout)['methods']}


class Plugin(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_its_method_is_listed_with_its_origin_once_it_is_loaded(self):
        self.assertNotIn(('segment', 'axis'), methods())
        self.assertEqual(methods('--plugin', PLUGIN)['segment', 'axis'], PLUGIN)

    def test_it_is_found_in_the_folders_of_the_plugin_path(self):
        shutil.copy(PLUGIN, self.folder)
        self.assertIn(('segment', 'axis'), methods(HEXSPLINE_PLUGIN_PATH=str(self.folder)))

    def test_segment_uses_it(self):
        labels = self.folder / 'labels.txt'
        done = run('segment', '-i', DATA / 'rod/rod_tri.k', '-o', self.folder / 'out.k', '--labels', labels,
                   '--method', 'axis', '--plugin', PLUGIN)
        self.assertEqual(done.returncode, 0, done.stderr)
        points, triangles = self.surface(self.folder / 'out.k')
        for triangle, label in zip(triangles, labels.read_text().split(), strict=True):
            a, b, c = (points[v] for v in triangle)
            u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
            normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            along = [sign * x for x in normal for sign in (1, -1)]
            self.assertGreaterEqual(along[int(label)], max(along) - 1e-9 * max(along))

    def test_the_method_is_unknown_without_it(self):
        done = run('segment', '-i', DATA / 'rod/rod_tri.k', '-o', self.folder / 'out.k', '--method', 'axis')
        self.assertEqual(done.returncode, 2)
        self.assertIn("no method 'axis'", done.stderr)
        self.assertFalse((self.folder / 'out.k').exists())

    def test_what_is_no_plugin_is_refused_in_one_line(self):
        text = self.folder / 'text.so'
        text.write_text('no library')
        for file in (text, self.folder / 'missing.so', self.folder):
            done = run('plugins', '--plugin', file)
            self.assertEqual(done.returncode, 3)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(str(file), done.stderr)

    def test_what_the_loader_says_of_a_file_is_said_once(self):
        # A file name with the words that are looked for makes no difference.
        for name, bytes_, reason in (('short.so', b'\x7fELF', 'file too short'), ('text.so', b'no library' * 99, 'invalid ELF header'),
                                     ('a): dlerror system message: b): .so', b'', 'file too short')):
            with self.subTest(name=name):
                file = self.folder / name
                file.write_bytes(bytes_)
                done = run('plugins', '--plugin', file)
                self.assertEqual(done.returncode, 3)
                self.assertEqual(done.stderr, f'hexspline plugins: error: {file}: cannot be loaded as a plug-in: {reason}\n')

    @unittest.skipIf(shutil.which('c++') is None, 'no compiler')
    def test_plugins_with_faults_are_refused_in_one_line(self):
        head = ('struct Info { int version; const char* name; const char* text; void (*run)(); };\n'
                '#include <stdexcept>\n'
                'extern "C" __attribute__((visibility("default"))) const Info hexspline_plugin;\n')
        entry = 'extern "C" const Info hexspline_plugin = {VERSION, "faulty", "1.0", RUN};\n'
        version = 1
        for name, code, words in (
                ('version', entry.replace('VERSION', '999').replace('RUN', 'nullptr'), 'interface 999'),
                ('nothing', entry.replace('VERSION', str(version)).replace('RUN', 'nullptr'), 'registers nothing'),
                ('throws', 'static void run() { throw std::runtime_error("no luck"); }\n' +
                 entry.replace('VERSION', str(version)).replace('RUN', 'run'), 'no luck'),
                ('throws_a_number', 'static void run() { throw 42; }\n' + entry.replace('VERSION', str(version)).replace('RUN', 'run'),
                 'failed to register'),
                ('symbol', 'void elsewhere();\nstatic void run() { elsewhere(); }\n' +
                 entry.replace('VERSION', str(version)).replace('RUN', 'run'), 'elsewhere'),
                ('no_entry', 'int nothing = 0;\n', 'does not export')):
            source, library = self.folder / f'{name}.cpp', self.folder / f'{name}.so'
            source.write_text((head if name != 'no_entry' else '') + code)
            subprocess.run(['c++', '-shared', '-fPIC', '-o', library, source], check=True)
            with self.subTest(fault=name):
                done = run('plugins', '--plugin', library)
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(str(library), done.stderr)
                self.assertIn(words, done.stderr)

    @unittest.skipIf(shutil.which('c++') is None, 'no compiler')
    def test_plugins_that_crash_while_they_are_loaded_are_refused_in_one_line(self):
        entry = ('struct Info { int version; const char* name; const char* text; void (*run)(); };\n'
                 'extern "C" __attribute__((visibility("default"))) const Info hexspline_plugin;\n'
                 'extern "C" const Info hexspline_plugin = {1, "faulty", "1.0", run};\n')
        nothing = 'static void run() {}\n' + entry
        for name, code, words in (
                ('throws', '#include <stdexcept>\nstatic int x = (throw std::runtime_error("no luck"), 1);\n' + nothing, 'Aborted'),
                ('exits', '#include <cstdlib>\nstatic int x = (std::exit(0), 1);\n' + nothing, 'exit code 0'),
                ('exits_later', '#include <cstdlib>\nstatic void run() { std::exit(7); }\n' + entry, 'exit code 7'),
                ('wild', '#include <csignal>\nstatic void run() { std::raise(SIGSEGV); }\n' + entry, 'Segmentation fault'),
                ('byte', 'extern "C" { __attribute__((visibility("default"))) char hexspline_plugin = 1; }\n', ''),
                ('cut', nothing, ''), ('sound', nothing, None)):
            source, library = self.folder / f'{name}.cpp', self.folder / f'{name}.so'
            source.write_text(code)
            subprocess.run(['c++', '-shared', '-fPIC', '-o', library, source], check=True)
            if name == 'cut':
                library.write_bytes(library.read_bytes()[:5000])
            with self.subTest(fault=name):
                done = run('plugins', '--plugin', library)
                if words is None:
                    self.assertEqual((done.returncode, done.stderr), (0, ''))
                    continue
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertEqual(done.stdout, '')
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(str(library), done.stderr)
                self.assertIn(words, done.stderr)

    @unittest.skipIf(shutil.which('c++') is None, 'no compiler')
    def test_a_plugin_that_never_comes_back_is_refused(self):
        source, library = self.folder / 'waits.cpp', self.folder / 'waits.so'
        source.write_text('#include <unistd.h>\nstatic int x = pause();\n')
        subprocess.run(['c++', '-shared', '-fPIC', '-o', library, source], check=True)
        done = run('plugins', '--plugin', library)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn('10 seconds', done.stderr)

    def test_in_the_plugin_path_is_a_pipe(self):
        os.mkfifo(self.folder / 'pipe.so')
        done = run('plugins', HEXSPLINE_PLUGIN_PATH=str(self.folder))
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn('pipe.so', done.stderr)

    def test_it_cannot_be_loaded_twice(self):
        copy = self.folder / 'copy.so'
        shutil.copy(PLUGIN, copy)
        done = run('plugins', '--plugin', PLUGIN, '--plugin', copy)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("already has a method 'axis'", done.stderr)

    # --- the plug-ins that come along ---

    def segment(self, name, method, *options):
        labels = self.folder / f'{name}.txt'
        done = run('segment', '-i', DATA / 'bracket/bracket.stl', '-o', self.folder / f'{name}.k', '--labels', labels, '--method',
                   method, '--plugin', GRAPH_CUT, '--json', self.folder / f'{name}.json', *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return labels.read_text().split(), json.loads((self.folder / f'{name}.json').read_text())

    def test_the_graph_cut_makes_fewer_charts_the_heavier_boundaries_are(self):
        _, loose = self.segment('loose', 'graph-cut', '-l', 0)
        labels, tight = self.segment('tight', 'graph-cut', '-l', 0.5)
        again, _ = self.segment('again', 'graph-cut', '-l', 0.5, '--threads', 1)
        self.assertEqual(labels, again)
        self.assertGreaterEqual(tight['charts'], 6)
        self.assertLessEqual(tight['charts'], loose['charts'])

    def test_the_improver_straightens_a_grid_and_keeps_its_boundary(self):
        import meshio
        import numpy
        numpy.random.seed(3)
        n = 5
        points = numpy.array([(x, y, z) for z in range(n) for y in range(n) for x in range(n)], float)
        inside = ((points > 0) & (points < n - 1)).all(axis=1)
        points[inside] += 0.5 * numpy.random.random((inside.sum(), 3)) - 0.25
        first = [x + n * y + n * n * z for z in range(n - 1) for y in range(n - 1) for x in range(n - 1)]
        cells = [[v, v + 1, v + n + 1, v + n] + [u + n * n for u in (v, v + 1, v + n + 1, v + n)] for v in first]
        rough, better = self.folder / 'rough.vtk', self.folder / 'better.vtk'
        meshio.Mesh(points, [('hexahedron', cells)]).write(rough, file_format='vtk42', binary=False)
        done = run('improve', '-i', rough, '-o', better, '-m', 'centre', '--plugin', CENTRE, '--json', self.folder / 'report.json')
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads((self.folder / 'report.json').read_text())
        self.assertGreater(report['after']['min_scaled_jacobian'], report['before']['min_scaled_jacobian'] + 0.1)
        self.assertGreater(report['after']['mean_scaled_jacobian'], report['before']['mean_scaled_jacobian'] + 0.05)
        numpy.testing.assert_array_equal(meshio.read(better).points[~inside], points[~inside])

    def convert(self, file, out, expected=0):
        done = run('convert', '-i', file, '-o', out, '--plugin', NASTRAN)
        self.assertEqual(done.returncode, expected, done.stderr)
        return done.stderr

    def test_nastran_files_of_meshio_are_read(self):
        import meshio
        import numpy
        numpy.random.seed(5)
        points = numpy.random.randint(1, 99, (30, 3)) * [1e-4, 1, 1e5] - [0, 50.5, 0]
        corners = [numpy.random.permutation(30)[:3] for _ in range(12)]
        cube = numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]) / 4
        for points, cells in ((points, ('triangle', corners)), (cube, ('hexahedron', [range(8)]))):
            for layout in ('fixed-small', 'fixed-large'):
                with self.subTest(layout=layout, kind=cells[0]):
                    file, out = self.folder / 'mesh.bdf', self.folder / 'mesh.vtk'
                    meshio.Mesh(points, [cells]).write(file, file_format='nastran', point_format=layout,
                                                       cell_format=layout)
                    self.convert(file, out)
                    mesh = meshio.read(out)
                    numpy.testing.assert_allclose(mesh.points, points, rtol=1e-3 if layout == 'fixed-small' else 1e-12)
                    numpy.testing.assert_array_equal(mesh.cells_dict[cells[0]], cells[1])

    def test_nastran_parts_and_odd_numbers(self):
        file = self.folder / 'PART.BDF'
        file.write_text('SOL 101\nCEND\nTITLE = CTRIA3,9\nBEGIN BULK\n$ comment\r\nGRID,7,,1.5-3,1.D+1,-2.\n'
                        'grid*                  8                             0.0             0.0\n*       1.+0\n'
                        'GRID           9              0.      1.      0.\nCBAR,5,1,7,8\nCTRIA3,1,4,7,8,9\nENDDATA\nCTRIA3,2,4,7,8,77\n')
        message = self.convert(file, self.folder / 'part.obj')
        self.assertIn('1 elements of type CBAR are skipped', message)
        text = (self.folder / 'part.obj').read_text()
        self.assertIn('v 0.0015 10 -2\nv 0 0 1\nv 0 1 0\n', text)
        self.assertIn('part_4', text)

    def test_broken_nastran_files_are_refused_with_their_line(self):
        points = ''.join(f'GRID,{i},,{i}.,0.,1.\n' for i in range(1, 9))
        for text, line, words in (('hello\n', 1, 'no GRID'), (points + 'GRID,3,,0.,0.,0.\n', 9, 'a second time'),
                                  (points + 'CTRIA3,1,1,1,2,99\n', 9, 'point 99'), ('GRID,1,,x,0.,0.\n', 1, "not 'x'"),
                                  (points + 'CTRIA3,1,1,1,2\n', 9, 'positive integer'), ('GRID,1,5,0.,0.,0.\n', 1, 'system 5'),
                                  (points + 'CTETRA,1,1,1,2,3,4\n', 9, 'CTETRA'), ('GRID,1,,nan,0.,0.\n', 1, 'finite'),
                                  (points + 'CHEXA,1,1,1,2,3,4,5,6\n,7,8,1\n', 9, 'nodes on its edges')):
            with self.subTest(text=text[-30:]):
                file = self.folder / 'broken.nas'
                file.write_text(text)
                message = self.convert(file, self.folder / 'out.k', expected=3)
                self.assertIn(f'broken.nas:{line}: ', message)
                self.assertIn(words, message)
                self.assertEqual(len(message.splitlines()), 1, message)

    def test_formats_that_are_there_already_cannot_be_taken_and_others_are_named(self):
        file = self.folder / 'mesh.xyz'
        file.write_text('hello')
        message = self.convert(file, self.folder / 'out.k', expected=3)
        self.assertIn(".bdf .nas", message)
        self.assertEqual(methods('--plugin', NASTRAN)['read', '.bdf'], str(NASTRAN))

    # --- methods that fail ---

    def test_whatever_a_method_throws_is_one_line_and_an_exit_code(self):
        for how, code, words in (('error', 4, 'triangle 3: no luck; try again'), ('standard', 4, 'no luck'), ('number', 4, 'unknown kind'),
                                 ('silent', 4, 'an exception without a message'), ('silent-error', 4, 'an exception without a message'),
                                 ('colours', 4, 'failed: no [31m luck '), ('null', 4, 'gives no object'), ('rotation', 4, 'rotation'),
                                 ('memory', 5, 'memory'), ('lines', 4, 'no luck and no manners'), ('thread', 4, 'no luck'),
                                 ('factory', 4, 'no luck'), ('labels', 4, 'label 17'), ('few', 4, '0 labels')):
            with self.subTest(how=how):
                out = self.folder / 'out.k'
                done = run('segment', '-i', DATA / 'rod/rod_tri.k', '-o', out, '--method', f'faulty-{how}', '--plugin', FAULTY)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertTrue(done.stderr.startswith('hexspline segment: error: '), done.stderr)
                self.assertIn(words, done.stderr)
                # What the method says itself, and what is nobody's fault, is told as it is.
                if how not in ('error', 'memory', 'null'):
                    self.assertIn(f"method 'faulty-{how}' of stage 'segment' (plug-in {FAULTY})", done.stderr)
                self.assertFalse(out.exists())

    def test_a_method_that_throws_or_returns_nothing_to_go_on_with_is_named(self):
        patches, blocks = DATA / 'rod/rod_patches.k', DATA / 'rod/rod_blocks.k'
        thrown = (('number', 'an exception of unknown kind'), ('silent', 'an exception without a message'))
        not_finite = ('infinite', 'not finite')
        for stage, arguments, what, faults in (
                ('improve', ('-i', blocks, '-o', 'out.vtk', '-m'), 'mesh',
                 (('empty', 'no hexahedra'), not_finite, ('edges', 'sharp edge'))),
                ('map', ('-i', patches, '-p', blocks, '-o', 'out.vtk', '--method'), 'mesh',
                 (('empty', 'no hexahedra'), not_finite, ('parts', 'part 0'), ('unused', 'no hexahedron uses'))),
                ('polycube', ('-i', patches, '-o', 'out.k', '-c', '1', '--method'), 'polycube',
                 (('empty', 'no patches'), not_finite, ('triangles', 'triangles have a patch'), ('patch', 'in patch 1000'),
                  ('loops', 'vertex -7'), ('corner', 'is no vertex'), ('points', 'points'), ('quads', 'quads'),
                  ('quad', 'a quad has'), ('edge', 'an edge has'))),
                ('spline', ('-i', blocks, '-o', 'out.bext', '--method'), 'spline',
                 (('empty', 'no elements'), not_finite, ('weights', 'weights'), ('weight', 'not positive'), ('rows', 'rows'),
                  ('columns', 'control point that is not there'), ('values', 'coefficient'), ('points', 'an element has'),
                  ('lists', 'lists'), ('level', 'a level has')))):
            for how, words in (*thrown, *faults):
                with self.subTest(stage=stage, how=how):
                    done = subprocess.run([PROGRAM, stage, *map(str, arguments), f'faulty-{how}', '--plugin', FAULTY],
                                          cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
                    self.assertEqual(done.returncode, 4, done.stderr)
                    self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                    result = 'failed: ' if (how, words) in thrown else f'gives no {what}: '
                    self.assertIn(f"method 'faulty-{how}' of stage '{stage}' (plug-in {FAULTY}) {result}", done.stderr)
                    self.assertIn(words, done.stderr)
                    self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_reader_that_throws_or_returns_nonsense_is_one_line_and_an_exit_code(self):
        for first, code, words in (('e', 3, 'mesh.faulty:1: no luck'), ('s', 4, 'no luck'), ('4', 4, "method '.faulty' of stage 'read'"),
                                   ('0', 4, 'an exception without a message'), ('i', 3, 'a point that is not there'),
                                   ('n', 3, 'finite'), ('o', 3, 'do not fit'), ('p', 3, 'do not fit'),
                                   ('h', 3, 'a point that is not there'), ('.', 3, 'holds no polygons')):
            with self.subTest(first=first):
                file = self.folder / 'mesh.faulty'
                file.write_text(first)
                done = run('convert', '-i', file, '-o', self.folder / 'out.k', '--plugin', FAULTY)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(words, done.stderr)

    @staticmethod
    def surface(path):
        section, points, triangles = None, {}, []
        for line in path.read_text().splitlines():
            if line.startswith('*'):
                section = line.strip()
            elif not line.startswith('$'):
                fields = [f.strip() for f in (line.split(',') if ',' in line else line.split())]
                if section == '*NODE':
                    points[int(fields[0])] = [float(x) for x in fields[1:4]]
                elif section == '*ELEMENT_SHELL':
                    triangles.append([int(x) for x in fields[2:5]])
        return points, triangles


if __name__ == '__main__':
    unittest.main()
