#!/usr/bin/env python3
"""What --json writes follows the schemas in docs/.

    reports_test.py HEXSPLINE DATA
"""
import json
import unittest

import jsonschema

from program import DATA, ROD, CommandTest

SCHEMA = json.loads((DATA.parent / 'docs/reports.schema.json').read_text())
PATCHES, BLOCKS = ROD / 'rod_patches.k', ROD / 'rod_blocks.k'


class Reports(CommandTest):
    def report(self, *arguments):
        """The report of a command, which conforms, and would not with a key more or less."""
        report = json.loads(self.run_program(*arguments, '--json', '-').stdout)
        jsonschema.validate(report, SCHEMA)
        own = next(key for key in report if key not in ('command', 'version', 'input'))
        for other in ({**report, 'surprise': 1}, {key: value for key, value in report.items() if key != own}):
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.validate(other, SCHEMA)
        return report

    def test_schema_itself(self):
        jsonschema.Draft202012Validator.check_schema(SCHEMA)

    def test_surfaces(self):
        self.report('segment', ROD / 'rod.stl', '-o', 'labelled.k')
        self.report('segment', ROD / 'rod.stl', '-o', 'other.k', '--method', 'hbecvt', '--repair')
        self.report('segment', PATCHES, '-o', 'patches.k', '--from-patches')
        self.report('polycube', PATCHES, '-o', 'polycube.k')
        report = self.report('polycube', 'labelled.k', '--patches', 'p.k', '--blocks', 'b.k')
        self.assertGreater(report['block_structure']['blocks'], 1)
        self.report('polycube', 'labelled.k', '--method', 'voxel', '--blocks', 'v.k')

    def test_volumes_and_splines(self):
        self.report('map', PATCHES, '-p', BLOCKS, '-s', 1, '-o', 'm.vtk')
        self.report('map', PATCHES, '-p', BLOCKS, '--target-hexes', 300, '-o', 'n.vtk')
        self.report('improve', 'm.vtk', '-o', 'i.vtk', '--surface', ROD / 'rod.stl')
        self.report('improve', 'm.vtk', '-m', 'smooth', '-n', 2, '-o', 'i.vtk')
        self.report('improve', 'm.vtk', '-m', 'pillow', '-o', 'i.vtk')
        report = self.report('spline', 'm.vtk', '-o', 's.bext', '--surface', ROD / 'rod.stl', '--fit', '--deck', 'eigen',
                             '--control-mesh', 'cm', '--refine', 'worst:5%')
        self.assertGreater(len(report['levels']), 1)
        self.report('spline', 'm.vtk', '-o', 's.bext', '--surface', ROD / 'rod.stl', '--no-repair')
        self.report('convert', 's.bext', '-o', 's.bxt')

    def test_chains_and_lists(self):
        report = self.report('run', ROD / 'rod.stl', '--segmentation', PATCHES, '--blocks', BLOCKS, '-s', 1, '-o', 'given')
        written = json.loads((self.folder / 'given' / 'report.json').read_text())
        self.assertEqual(written, {key: value for key, value in report.items() if key not in ('command', 'version', 'input')})
        self.report('run', DATA / 'bracket' / 'bracket.stl', '--to', 'improve', '-o', 'labelling')
        self.report('run', ROD / 'rod.stl', '--route', 'voxel', '--to', 'map', '-o', 'voxel')
        self.report('convert', ROD / 'rod.stl', '-o', 'rod.off', '--repair')
        self.report('convert', BLOCKS, '-o', 'rod.vtu')
        self.report('convert', PATCHES, '-o', 'rod.txt')
        self.assertGreater(len(self.report('plugins')['methods']), 10)


if __name__ == '__main__':
    unittest.main()
