#!/usr/bin/env python3
"""The subcommand check: limits, profiles, configuration, baseline, and the reports for build servers.

    check_test.py HEXSPLINE DATA
"""
import json
import os
import re
import subprocess
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

import jsonschema

from hex_files import CUBE, grid, write_vtk
from program import DATA, PROGRAM, ROD, CommandTest

SCHEMA = json.loads((DATA.parent / 'docs/check.schema.json').read_text())


class Check(CommandTest):
    def setUp(self):
        super().setUp()
        # 10 cubes in a row; the sixth is sheared: scaled Jacobian 0.89 there and in the fifth.
        points, cells = grid(10, 1, 1)
        points = [(x + 0.5, y, z) if (x, z) == (6, 1) else (x, y, z) for x, y, z in points]
        write_vtk(self.folder / 'row.vtk', points, cells)

    def check(self, *arguments, code=0):
        done = self.run_program('check', *arguments, '--json', 'report.json', code=code)
        report = json.loads((self.folder / 'report.json').read_text())
        jsonschema.validate(report, SCHEMA)
        self.assertEqual(report['passed'], code == 0)
        return report, done

    def test_limits_of_a_metric(self):
        report, _ = self.check('row.vtk', '--metric', 'scaled_jacobian:0.3', '--metric', 'ScaledJacobian')
        self.assertAlmostEqual(report['metrics']['scaled_jacobian']['min'], report['min_scaled_jacobian'])
        report, done = self.check('row.vtk', '--metric', 'scaled_jacobian:0.99', code=1)
        gate, = report['gates']
        self.assertEqual((gate['name'], gate['bad'], sorted(gate['elements'])), ('scaled_jacobian', 2, [5, 6]))
        self.assertRegex(done.stderr, r'row.vtk.*scaled_jacobian.*0\.99')
        self.check('row.vtk', '--metric', 'aspect_ratio::1.1', code=1)
        self.check('row.vtk', '--metric', 'volume:0.1:2')
        self.check('row.vtk', '--metric', 'volume:0.1:0.9', code=1)

    def test_share_of_bad_elements(self):
        self.check('row.vtk', '--metric', 'scaled_jacobian:0.99', '--bad-share', '0.2')
        self.check('row.vtk', '--metric', 'scaled_jacobian:0.99', '--bad-share', '0.19', code=1)

    def bars(self, name, count):
        """Boxes of 1 x 1 x 1, 2 x 1 x 1, ...: the aspect ratio of the i-th is i."""
        points = [(x * (i + 1), y, z + 2 * i) for i in range(count) for x, y, z in CUBE]
        write_vtk(self.folder / name, points, [range(8 * i, 8 * i + 8) for i in range(count)])

    def test_exactly_the_share_may_be_bad(self):
        for count in (37, 100, 1000):
            self.bars('bars.vtk', count)
            # Those where the product of share and count is off the number (0.29 * 100 < 29), and some others.
            off = [k for k in range(count) if k / count * count != k]
            for bad in (1, count // 2, count - 1, *off[:5]):
                limit = ['--metric', f'aspect_ratio::{count - bad}', '--bad-share']
                self.run_program('check', 'bars.vtk', *limit, repr(bad / count))
            self.run_program('check', 'bars.vtk', *limit, repr((bad - 0.001) / count), code=1)

    def test_a_percentile_is_that_of_the_nearest_rank(self):
        self.bars('bars.vtk', 100)
        self.run_program('check', 'bars.vtk', '--percentile', 'aspect_ratio:7:7:7')
        self.run_program('check', 'bars.vtk', '--percentile', 'aspect_ratio:7.01:8:8')

    def test_only_a_minimum_of_the_scaled_jacobian_replaces_the_demand_that_nothing_is_inverted(self):
        points, cells = grid(3, 1, 1)
        write_vtk(self.folder / 'inverted.vtk', [(1.5, 0.5, 0.5) if p == (3, 1, 1) else p for p in points], cells)
        (self.folder / 'most.json').write_text('{"metrics": {"scaled_jacobian": {"max": 2}}}')
        for limit in (['--metric', 'scaled_jacobian::2'], ['--percentile', 'scaled_jacobian:99:0'], ['--config', 'most.json']):
            report, _ = self.check('inverted.vtk', *limit, code=1)
            self.assertEqual([gate['name'] for gate in report['gates'] if not gate['passed']], ['inverted'])
        self.check('inverted.vtk', '--metric', 'scaled_jacobian:-1:2')

    def test_percentiles(self):
        self.check('row.vtk', '--percentile', 'scaled_jacobian:50:0.99')
        self.check('row.vtk', '--percentile', 'scaled_jacobian:20:0.99', code=1)
        self.check('row.vtk', '--percentile', 'aspect_ratio:80::1.01')

    def test_profiles(self):
        for name in ('ls-dyna', 'abaqus', 'iga'):
            report, _ = self.check('row.vtk', '--profile', name)
            self.assertGreater(len(report['gates']), 3)
        # A limit from an option replaces that of the profile.
        self.check('row.vtk', '--profile', 'iga', '--metric', 'scaled_jacobian:0.99', code=1)
        self.run_program('check', 'row.vtk', '--profile', 'none', code=2)

    def test_configuration_file(self):
        (self.folder / 'ok.json').write_text(json.dumps({
            'profile': 'iga', 'bad_share': 0.3, 'forbid': ['several-components'],
            'metrics': {'scaled_jacobian': {'min': 0.99}, 'skew': {'max': 0.9, 'bad_share': 0}}}))
        report, _ = self.check('row.vtk', '--config', 'ok.json')
        self.assertIn('several-components', [gate['name'] for gate in report['gates']])
        for text in ('{', '[]', '{"metrics": {"no": {}}}', '{"metrics": {"skew": {"min": "a"}}}', '{"metrics": {"skew": {"least": 1}}}',
                     '{"bad_share": 2}', '{"other": 1}', '{"profile": "no"}', '{"forbid": ["no"]}', '{"forbid": "no"}', '{"surface": 3}',
                     '{"metrics": {"skew": {"min": 2, "max": 1}}}', '{"metrics": {"skew": {"percentile": 95}}}', '{"metrics": {"all": {"min": 2}}}',
                     '{"metrics": {"skew": {"bad_share": 0.1}}}'):
            (self.folder / 'bad.json').write_text(text)
            message = self.run_program('check', 'row.vtk', '--config', 'bad.json', code=3).stderr
            self.assertIn('bad.json', message, text)
        self.run_program('check', 'row.vtk', '--config', 'missing.json', code=3)
        self.run_program('check', 'row.vtk', '--config', '.', code=3)

    def test_wrong_usage(self):
        for wrong in (['--metric', 'none'], ['--metric', 'skew:a'], ['--metric', 'skew:1:2:3'], ['--metric', 'skew:2:1'],
                      ['--metric', 'all:1'], ['--percentile', 'skew:101:1'], ['--percentile', 'skew:1'], ['--bad-share', '2'],
                      ['--forbid', 'none'], ['--max-surface-distance', '1'], ['--profile', 'iga', '--config', 'x.json'],
                      ['--worst', '-1'], ['--vtu', 'row.vtk'], ['--junit', 'a.xml', '--sarif', './a.xml']):
            self.run_program('check', 'row.vtk', *wrong, code=2)

    def test_a_baseline_fails_what_is_worse(self):
        write_vtk(self.folder / 'good.vtk', *grid(10, 1, 1))
        self.check('row.vtk')
        (self.folder / 'report.json').rename(self.folder / 'old.json')
        self.check('row.vtk', '--baseline', 'old.json')
        self.check('good.vtk', '--baseline', 'old.json')
        (self.folder / 'report.json').rename(self.folder / 'good.json')
        report, _ = self.check('row.vtk', '--baseline', 'good.json', code=1)
        failed = [gate['name'] for gate in report['gates'] if not gate['passed']]
        self.assertIn('baseline-scaled_jacobian-min', failed)
        self.assertIn('baseline-aspect_ratio-max', failed)
        # What was 0 has no relative change.
        report, _ = self.check('row.vtk', '--baseline', 'good.json', '--baseline-tolerance', '3', code=1)
        failed = {gate['name'] for gate in report['gates'] if not gate['passed']}
        self.assertEqual(failed, {'baseline-skew-max', 'baseline-skew-mean'})
        self.check('good.vtk', '--baseline', 'good.json', '--baseline-tolerance', '0')
        (self.folder / 'bad.json').write_text('{"min_scaled_jacobian": "x"}')
        for bad in ('bad.json', 'row.vtk', 'missing.json'):
            self.run_program('check', 'row.vtk', '--baseline', bad, code=3)
        for text in ('{"command": "improve", "min_scaled_jacobian": 0.1}', '{"min_scaled_jacobian": 0.1, "metrics": {}}',
                     '{"command": "check", "min_scaled_jacobian": 0.1}', '{"command": "check", "metrics": {}}', '[]'):
            (self.folder / 'bad.json').write_text(text)
            self.assertIn('is not a report of hexspline check', self.run_program('check', 'row.vtk', '--baseline', 'bad.json', code=3).stderr)

    def failed_against(self, baseline, mesh, *arguments):
        report, _ = self.check(mesh, '--baseline', baseline, *arguments, code=1)
        return [gate['name'] for gate in report['gates'] if not gate['passed']]

    def baseline_of(self, mesh, *arguments):
        self.check(mesh, *arguments)
        (self.folder / 'report.json').rename(self.folder / 'old.json')

    def test_the_tolerance_of_a_baseline_is_relative(self):
        def cube(name, edge, lean):
            write_vtk(self.folder / name, [(edge * (x + lean * z), edge * y, edge * z) for x, y, z in CUBE], [range(8)])
        cube('straight.vtk', 1, 0)
        cube('leaning.vtk', 1, 1e-10)
        self.baseline_of('straight.vtk')
        self.assertEqual(self.failed_against('old.json', 'leaning.vtk'), ['baseline-skew-max', 'baseline-skew-mean'])
        # A mesh so small that its volumes are far below the tolerance.
        cube('small.vtk', 1e-5, 0)
        write_vtk(self.folder / 'inside_out.vtk', [(1e-5 * x, 1e-5 * y, -1e-5 * z) for x, y, z in CUBE], [range(8)])
        self.baseline_of('small.vtk', '--metric', 'jacobian')
        self.assertIn('baseline-jacobian-min', self.failed_against('old.json', 'inside_out.vtk', '--min-scaled-jacobian', '-1'))

    def test_the_order_of_the_corners_is_no_change_against_a_baseline(self):
        points, cells = grid(3, 3, 3)
        for name, move in (('boxes', lambda x, y, z: (0.1 * x, 0.7 * y, 0.3 * z)),
                           ('bent', lambda x, y, z: (x + 0.07 * y * z, y + 0.1 * x * x, z + 0.13 * x - 0.02 * y * y))):
            moved = [move(*p) for p in points]
            write_vtk(self.folder / f'{name}.vtk', moved, cells)
            turned = [[c[i] for i in ((1, 2, 3, 0, 5, 6, 7, 4), (0, 3, 7, 4, 1, 2, 6, 5))[n % 2]] for n, c in enumerate(cells)]
            write_vtk(self.folder / f'{name}_turned.vtk', moved, turned[::-1])
            # VTK's edge ratio looks at six of the edges, and depends on the order by more than round-off.
            asked = [f'--metric={m}' for m in self.check(f'{name}.vtk', '--metric', 'all')[0]['metrics'] if m != 'edge_ratio']
            self.baseline_of(f'{name}.vtk', *asked)
            self.check(f'{name}_turned.vtk', '--baseline', 'old.json')

    def test_everything_in_a_baseline_is_measured(self):
        write_vtk(self.folder / 'good.vtk', *grid(10, 1, 1))
        self.baseline_of('good.vtk', '--metric', 'oddy')
        self.assertIn('baseline-oddy-max', self.failed_against('old.json', 'row.vtk'))
        # What cannot be measured is told.
        old = json.loads((self.folder / 'old.json').read_text())
        old['surface_distance'] = {'max_percent': 0.1, 'diagonal': 1}
        old['metrics']['later'] = old['metrics']['oddy']
        (self.folder / 'old.json').write_text(json.dumps(old))
        _, done = self.check('good.vtk', '--baseline', 'old.json')
        self.assertRegex(done.stderr, r'old\.json is not compared: .*--surface.*later')
        self.assertEqual(len(done.stderr.splitlines()), 1)

    def test_options_replace_all_that_a_file_demands_of_the_same_metric(self):
        (self.folder / 'file.json').write_text(
            '{"profile": "iga", "metrics": {"skew": {"max": 0.8, "percentile": 95}, "shape": {"min": 0.3}, "aspect_ratio": {"max": 9, "percentile": 50}}}')
        def demands(*options):
            report, _ = self.check('row.vtk', '--config', 'file.json', *options)
            return {gate['name']: gate['demand'] for gate in report['gates']}
        alone = demands()
        self.assertEqual({name: alone.get(name) for name in ('skew-percentile-95', 'shape', 'aspect_ratio', 'aspect_ratio-percentile-50')},
                         {'skew-percentile-95': 'at most 0.8', 'shape': 'at least 0.3', 'aspect_ratio': 'at most 20',
                          'aspect_ratio-percentile-50': 'at most 9'})
        for gone, come, option in ((['skew-percentile-95'], {'skew': 'at most 0.9'}, ['--metric', 'skew::0.9']),
                                   (['skew-percentile-95'], {'skew-percentile-50': 'at most 0.9'}, ['--percentile', 'skew:50::0.9']),
                                   ([], {'skew-percentile-95': 'at most 0.9'}, ['--percentile', 'skew:95::0.9']),
                                   ([], {'shape-percentile-5': 'at least 0.2'}, ['--percentile', 'shape:5:0.2']),
                                   (['aspect_ratio-percentile-50'], {'aspect_ratio': 'at most 7'}, ['--metric', 'aspect_ratio::7']),
                                   ([], {}, ['--metric', 'skew', '--metric', 'all'])):
            with self.subTest(option):
                expected = {**alone, **come}
                self.assertEqual(demands(*option), {name: demand for name, demand in expected.items() if name not in gone})

    def test_no_demand_is_lost(self):
        report, _ = self.check('row.vtk', '--metric', 'aspect_ratio:0.5', '--metric', 'aspect_ratio::1.1', '--metric', 'aspect_ratio',
                               '--percentile', 'skew:50:0', '--percentile', 'skew:50::1', '--metric', 'AspectRatio:0.5', code=1)
        self.assertEqual([gate['demand'] for gate in report['gates'][1:]], ['from 0.5 to 1.1', 'from 0 to 1'])
        for wrong in (['--metric', 'skew::1', '--metric', 'Skew::0.5'], ['--metric', 'skew::1', '--metric', 'skew:2'],
                      ['--min-scaled-jacobian', '0.1', '--metric', 'scaled_jacobian:0.2'],
                      ['--percentile', 'skew:50:0', '--percentile', 'skew:50.0:0.1']):
            self.assertRegex(self.run_program('check', 'row.vtk', *wrong, code=2).stderr, 'different|larger')
        for text, told in (('{"metrics": {"aspect_ratio": {"max": 2, "percentile": 50, "bad_share": 0.01}}}', 'aspect_ratio'),
                           ('{"metrics": {"skew": {"max": 0.1}, "skew": {"max": 2}}}', "'skew' is there twice"),
                           ('{"metrics": {"skew": {"max": 0.1, "max": 2}}}', "'max' is there twice"),
                           ('{"bad_share": 0, "bad_share": 1}', "'bad_share' is there twice"),
                           ('{"metrics": {"skew": {"max": 0.1}, "Skew": {"max": 2}}}', 'skew'),
                           ('{"surface": ""}', "'surface'"), ('{"baseline": ""}', "'baseline'")):
            (self.folder / 'c.json').write_text(text)
            message = self.run_program('check', 'row.vtk', '--config', 'c.json', code=3).stderr
            self.assertIn('c.json', message)
            self.assertIn(told, message)
        # The same key in two objects is no second one.
        (self.folder / 'c.json').write_text('{"metrics": {"skew": {"max": 1}, "aspect_ratio": {"max": 3}}}')
        self.check('row.vtk', '--config', 'c.json')

    def test_a_failure_can_be_seen_in_its_numbers(self):
        write_vtk(self.folder / 'long.vtk', [(10.0000004 * x, y, z) for x, y, z in CUBE], [range(8)])
        report, done = self.check('long.vtk', '--metric', 'aspect_ratio::10', code=1)
        self.assertIn('FAILED  aspect_ratio: at most 10; found: smallest 10.0000004, largest 10.0000004', done.stdout)
        self.assertEqual(report['metrics']['aspect_ratio']['max'], 10.0000004)
        _, done = self.check('long.vtk', '--metric', 'aspect_ratio::10.00000038', '--metric', 'volume:11.23456789:20', code=1)
        self.assertIn('at most 10.00000038; found: smallest 10.0000004,', done.stdout)
        self.assertIn('from 11.23456789 to 20; found: smallest 10,', done.stdout)
        _, done = self.check('long.vtk', '--percentile', 'aspect_ratio:99.95::10', code=1)
        self.assertIn('aspect_ratio-percentile-99.95: at most 10; found: 10.0000004', done.stdout)

    def test_inverted_elements_come_with_ids_and_centres(self):
        points, cells = grid(3, 1, 1)
        points = [(1.5, 0.5, 0.5) if p == (3, 1, 1) else p for p in points]
        write_vtk(self.folder / 'bad.vtk', points, cells)
        report, done = self.check('bad.vtk', code=1)
        self.assertEqual(report['inverted_ids'], [2])
        element, = report['inverted_elements']
        self.assertEqual(element['id'], 2)
        corners = [points[v] for v in cells[2]]
        for axis in range(3):
            self.assertAlmostEqual(element['centre'][axis], sum(p[axis] for p in corners) / 8)
        self.assertIn('hexahedron 2 at (', done.stdout)

    def test_duplicate_and_unused_nodes_and_cracks(self):
        # Two cubes side by side that do not share their nodes, and a node for nothing.
        points = CUBE + [(x + 1, y, z) for x, y, z in CUBE] + [(5, 5, 5)]
        write_vtk(self.folder / 'crack.vtk', points, [range(8), range(8, 16)])
        report, _ = self.check('crack.vtk')
        self.assertEqual(report['nodes']['duplicate_ids'], [[8, 1], [11, 2], [12, 5], [15, 6]])
        self.assertEqual(report['nodes']['unused_ids'], [16])
        self.assertEqual(report['boundary']['crack_elements'], [[0, 1]])
        self.assertFalse(report['boundary']['watertight'])
        for kind in ('duplicate-nodes', 'unused-nodes', 'open-boundary', 'several-components'):
            report, done = self.check('crack.vtk', '--forbid', kind, code=1)
            self.assertIn(kind, done.stderr)
        self.check('crack.vtk', '--forbid', 'pinched-nodes')
        # Nearly the same place.
        points[8] = (1 + 1e-6, 0, 0)
        write_vtk(self.folder / 'crack.vtk', points, [range(8), range(8, 16)])
        self.assertEqual(self.check('crack.vtk')[0]['nodes']['duplicate'], 3)
        self.assertEqual(self.check('crack.vtk', '--duplicate-tolerance', '1e-5')[0]['nodes']['duplicate'], 4)

    def test_surface_distance(self):
        # The unit cube against the box [0, 1.1] x [0, 1] x [0, 1].
        write_vtk(self.folder / 'cube.vtk', CUBE, [range(8)])
        corners = [(1.1 * x, y, z) for x, y, z in CUBE]
        quads = [(0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (4, 5, 6, 7)]
        (self.folder / 'box.off').write_text('OFF\n8 6 0\n' + ''.join(f'{x} {y} {z}\n' for x, y, z in corners) +
                                             ''.join('4 ' + ' '.join(map(str, q)) + '\n' for q in quads))
        report, _ = self.check('cube.vtk', '--surface', 'box.off', '--max-surface-distance', '6')
        distance, diagonal = report['surface_distance'], (1.21 + 1 + 1) ** 0.5
        self.assertAlmostEqual(distance['diagonal'], diagonal)
        # Only the centre of the face x = 1 is inside of the box.
        self.assertAlmostEqual(distance['to_surface_max_percent'], 100 * 0.1 / diagonal)
        self.assertAlmostEqual(distance['from_surface_max_percent'], 100 * 0.1 / diagonal)
        self.assertAlmostEqual(distance['vertex_max_percent'], 0)
        self.check('cube.vtk', '--surface', 'box.off', '--max-surface-distance', '5', code=1)

    def test_a_spline_is_proved_not_to_fold(self):
        write_vtk(self.folder / 'good.vtk', *grid(3, 3, 3))
        self.run_program('spline', 'good.vtk', '-o', 'good.bext')
        report, done = self.check('good.bext')
        self.assertEqual(report['bezier']['elements'], report['bezier']['proved_positive'])
        self.assertGreater(report['bezier']['elements'], 0)
        self.assertEqual([gate['name'] for gate in report['gates']], ['bezier-validity'])
        # Mirrored: every element is negative.
        text = (self.folder / 'good.bext').read_text().split('\n')
        for i, row in enumerate(text):
            if row.startswith('gnode'):
                keyword, x, y, z, w = row.split()
                text[i] = f'{keyword} {x} {y} {-float(z)} {w}'
        (self.folder / 'bad.bext').write_text('\n'.join(text))
        report, done = self.check('bad.bext', '--junit', 'bad.xml', '--sarif', 'bad.sarif', code=1)
        self.assertEqual(report['bezier']['negative'], report['bezier']['elements'])
        self.assertIn('bezier-validity', done.stderr)

    def test_reports_for_build_servers(self):
        _, done = self.check('row.vtk', '--metric', 'scaled_jacobian:0.99', '--metric', 'volume:0:2', '--junit', 'out.xml', '--sarif',
                             'out.sarif', '--markdown', 'out.md', '--vtu', 'out.vtu', '--worst', '1', code=1)
        suite = xml.parse(self.folder / 'out.xml').getroot()
        self.assertEqual((suite.get('tests'), suite.get('failures')), ('2', '1'))
        failed, = suite.findall('.//failure/..')
        self.assertEqual((failed.get('name'), failed.get('classname')), ('scaled_jacobian', 'row.vtk'))
        sarif = json.loads((self.folder / 'out.sarif').read_text())
        self.assertEqual(sarif['version'], '2.1.0')
        run, = sarif['runs']
        self.assertEqual(len(run['tool']['driver']['rules']), 2)
        result, = run['results']
        self.assertEqual(result['locations'][0]['physicalLocation']['artifactLocation']['uri'], 'row.vtk')
        self.assertRegex(result['locations'][0]['logicalLocations'][0]['name'], r'hexahedron [56]$')
        summary = (self.folder / 'out.md').read_text()
        self.assertIn('**FAILED**', summary)
        rows = [line for line in summary.splitlines() if line.startswith('|')]
        for row in rows:
            self.assertIn(len(re.findall(r'(?<!\\)\|', row)), (5, 6), row)
        self.assertIn('FAILED  scaled_jacobian', done.stdout)
        self.assertIn('Name="scaled_jacobian"', (self.folder / 'out.vtu').read_bytes()[:4000].decode('latin1'))

    def test_reports_of_files_with_any_name(self):
        mesh = (self.folder / 'row.vtk').read_bytes()
        for name in (b'latin1\xe4\xff.vtk', b'nonchar\xef\xbf\xbe.vtk', b'bell\x07esc\x1b[31m.vtk', b'cut\xf0\x9f.vtk', b'half\xed\xa0\x80.vtk',
                     'Gr\u00f6\u00dfe \U0001f600.vtk'.encode()):
            path = os.path.join(os.fsencode(self.folder), name)
            with open(path, 'wb') as file:
                file.write(mesh)
            done = subprocess.run([PROGRAM, 'check', '-i', name, '--metric', 'skew::0', '--junit', 'r.xml', '--sarif', 'r.sarif', '--markdown', 'r.md'],
                                  cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True)
            self.assertEqual(done.returncode, 1, done.stderr)
            suite = xml.fromstring((self.folder / 'r.xml').read_bytes())
            self.assertEqual(len(suite.findall('.//failure')), 1)
            json.loads((self.folder / 'r.sarif').read_bytes().decode())
            self.assertIn('FAILED', (self.folder / 'r.md').read_bytes().decode())
            if b'Gr' in name:
                self.assertIn('Gr\u00f6\u00dfe \U0001f600', (self.folder / 'r.xml').read_text())
                self.assertIn('Gr\u00f6\u00dfe \U0001f600', (self.folder / 'r.md').read_text())

    def test_sarif_has_what_build_servers_demand(self):
        self.check('row.vtk', '--metric', 'scaled_jacobian:0.99', '--forbid', 'unused-nodes', '--sarif', 'out.sarif', code=1)
        run, = json.loads((self.folder / 'out.sarif').read_text())['runs']
        self.assertEqual(run['automationDetails']['id'], 'hexspline-check/row.vtk/')
        self.assertEqual(len(run['results']), 2)
        for result in run['results']:
            self.assertEqual(result['locations'][0]['physicalLocation']['region'], {'startLine': 1})

    def test_one_report_may_go_to_stdout(self):
        for name, read in (('json', json.loads), ('junit', xml.fromstring), ('sarif', json.loads)):
            read(self.run_program('check', 'row.vtk', f'--{name}', '-').stdout)
        self.assertRegex(self.run_program('check', 'row.vtk', '--markdown', '-').stdout, '^## hexspline check: row.vtk\n')
        self.assertFalse((self.folder / '-').exists())
        for one, other in (('--junit', '--sarif'), ('--json', '--markdown')):
            self.run_program('check', 'row.vtk', one, '-', other, '-', code=2)

    def test_no_report_is_written_over_a_file_that_is_read(self):
        self.check('row.vtk')
        (self.folder / 'report.json').rename(self.folder / 'old.json')
        (self.folder / 'c.json').write_text('{"baseline": "old.json"}')
        (self.folder / 'box.off').write_text('OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n')
        for arguments, target in ((['--baseline', 'old.json', '--json', './old.json'], 'old.json'), (['--config', 'c.json', '--sarif', 'c.json'], 'c.json'),
                                  (['--config', 'c.json', '--junit', 'old.json'], 'old.json'),
                                  (['--surface', 'box.off', '--markdown', 'box.off'], 'box.off')):
            before = (self.folder / target).read_bytes()
            self.assertIn('the same file', self.run_program('check', 'row.vtk', *arguments, code=2).stderr)
            self.assertEqual((self.folder / target).read_bytes(), before)

    def test_all_is_no_metric_with_a_limit(self):
        for arguments in (['--percentile', 'all:5:0.1'], ['--metric', 'none']):
            message = self.run_program('check', 'row.vtk', *arguments, code=2).stderr
            self.assertNotIn('known metrics: all', message)
            self.assertNotIn("no metric 'all'", message)

    def test_all_metrics_and_the_worst_elements(self):
        report, _ = self.check('row.vtk', '--metric', 'all', '--worst', '3')
        self.assertGreaterEqual(len(report['metrics']), 20)
        for name, metric in report['metrics'].items():
            self.assertEqual(len(metric['worst']), 3, name)
            self.assertLessEqual(metric['min'], metric['median'])
            self.assertLessEqual(metric['median'], metric['max'])
        values = [element['value'] for element in report['metrics']['scaled_jacobian']['worst']]
        self.assertEqual(values, sorted(values))
        self.assertEqual(values[0], report['metrics']['scaled_jacobian']['min'])

    def test_the_same_bytes_for_any_number_of_threads(self):
        self.run_program('map', ROD / 'rod_patches.k', '-p', ROD / 'rod_blocks.k', '-s', '1', '-o', 'rod.vtk')
        texts = []
        for threads in (1, 2):
            self.run_program('check', 'rod.vtk', '--metric', 'all', '--surface', ROD / 'rod_tri.k', '--min-scaled-jacobian', -1,
                             '--threads', threads, '--json', 'out.json')
            texts.append((self.folder / 'out.json').read_bytes())
        self.assertEqual(texts[0], texts[1])

    def test_the_workflow_example_is_about_options_that_exist(self):
        text = (DATA.parent / 'docs/ci.md').read_text()
        options = self.run_program('check', '--help').stdout
        used = set(re.findall(r'hexspline check[^\n`]*', text))
        self.assertGreater(len(used), 2)
        for command in used:
            for option in re.findall(r'--[a-z-]+', command):
                self.assertIn(option, options, command)


if __name__ == '__main__':
    unittest.main()
