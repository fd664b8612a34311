#!/usr/bin/env python3
"""The example plug-in is found, loaded and used; what is no plug-in is refused.

    plugin_test.py HEXSPLINE PLUGIN DATA_FOLDER
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
PLUGIN = sys.argv.pop()
PROGRAM = sys.argv.pop()


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

    def test_it_cannot_be_loaded_twice(self):
        copy = self.folder / 'copy.so'
        shutil.copy(PLUGIN, copy)
        done = run('plugins', '--plugin', PLUGIN, '--plugin', copy)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("already has a method 'axis'", done.stderr)

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
