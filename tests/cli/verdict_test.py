#!/usr/bin/env python3
"""The metrics of `hexspline check` equal those of VTK's Verdict, element by element.

    verdict_test.py HEXSPLINE DATA [REFERENCE_DATA]

On tangled random meshes, and on every mesh of the published models when they are there.
"""
import json
import os
import random
import sys
import unittest
from pathlib import Path

REFERENCE = Path(sys.argv.pop()) if len(sys.argv) > 3 else None

try:
    import numpy as np
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as missing:
    print(f'skipped: {missing}')
    sys.exit(77)

from program import CommandTest

MEASURES = {'condition': 'Condition', 'diagonal': 'Diagonal', 'dimension': 'Dimension', 'distortion': 'Distortion',
            'edge_ratio': 'EdgeRatio', 'jacobian': 'Jacobian', 'max_aspect_frobenius': 'MaxAspectFrobenius',
            'max_edge_ratio': 'MaxEdgeRatios', 'med_aspect_frobenius': 'MedAspectFrobenius', 'oddy': 'Oddy',
            'relative_size_squared': 'RelativeSizeSquared', 'scaled_jacobian': 'ScaledJacobian', 'shape': 'Shape',
            'shape_and_size': 'ShapeAndSize', 'shear': 'Shear', 'shear_and_size': 'ShearAndSize', 'skew': 'Skew',
            'stretch': 'Stretch', 'taper': 'Taper', 'volume': 'Volume'}


class Verdict(CommandTest):
    def compare(self, mesh, without=(), nan_allowed=False):
        """Largest relative difference over all metrics and elements."""
        self.run_program('check', mesh, '--metric', 'all', '--min-scaled-jacobian', '-1', '--vtu', 'out.vtu', '--json', '-')
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.folder / 'out.vtu'))
        reader.Update()
        grid = reader.GetOutput()
        quality = vtk.vtkMeshQuality()
        quality.SaveCellQualityOn()
        largest = 0
        for name, measure in MEASURES.items():
            if name in without:
                continue
            ours = vtk_to_numpy(grid.GetCellData().GetArray(name))
            # Only the geometry: VTK would compute on top of our fields.
            bare = vtk.vtkUnstructuredGrid()
            bare.CopyStructure(grid)
            quality.SetInputData(bare)
            getattr(quality, f'SetHexQualityMeasureTo{measure}')()
            quality.Update()
            theirs = vtk_to_numpy(quality.GetOutput().GetCellData().GetArray('Quality'))
            difference = np.abs(ours - theirs) / np.maximum(np.abs(theirs), 1e-300)
            difference[ours == theirs] = 0
            if nan_allowed:
                difference[np.isnan(theirs) & ~np.isnan(ours)] = 0
            worst = int(difference.argmax())
            with self.subTest(mesh=str(mesh), metric=name, element=worst):
                self.assertLess(difference[worst], 1e-10, (ours[worst], theirs[worst]))
            largest = max(largest, difference[worst])
        return largest

    def write_mesh(self, path, points, cells):
        rows = ['# vtk DataFile Version 3.0', 'test', 'ASCII', 'DATASET UNSTRUCTURED_GRID', f'POINTS {len(points)} double']
        rows += [' '.join(map(repr, p)) for p in points]
        rows += [f'CELLS {len(cells)} {9 * len(cells)}'] + [' '.join(map(str, [8, *c])) for c in cells]
        rows += [f'CELL_TYPES {len(cells)}'] + ['12'] * len(cells)
        path.write_text('\n'.join(rows) + '\n')

    def test_tangled_random_meshes(self):
        n = 6
        at = lambda i, j, k: i + (n + 1) * (j + (n + 1) * k)
        cells = [[at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1), at(i + 1, j, k + 1),
                  at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)] for k in range(n) for j in range(n) for i in range(n)]
        for seed, amount, scale in ((1, 0.1, 1.0), (2, 0.4, 1e-3), (3, 0.8, 50.0)):
            shake = random.Random(seed)
            points = [tuple(scale * (x + shake.uniform(-amount, amount)) for x in (i, j, k))
                      for k in range(n + 1) for j in range(n + 1) for i in range(n + 1)]
            self.write_mesh(self.folder / 'random.vtk', points, cells)
            self.compare('random.vtk')

    def test_degenerate_hexahedra(self):
        """VTK gives the scaled Jacobian 1e30 where an edge or an axis has no length; we never call such an element good."""
        cube = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], float)
        moved = lambda corners, place: np.array([place if i in corners else p for i, p in enumerate(cube)])
        shapes = {'flat': cube * [1, 1, 0], 'line': cube * [1, 0, 0], 'point': cube * 0, 'one edge': moved({1}, cube[0]),
                  'pyramid': moved({4, 5, 6, 7}, (0.5, 0.5, 1)), 'wedge': cube[[0, 1, 1, 3, 4, 5, 5, 7]],
                  'crossed': cube[[0, 2, 1, 3, 4, 6, 5, 7]], 'twisted': cube[[0, 1, 2, 3, 6, 7, 4, 5]],
                  'corners together': moved({6}, cube[0]), 'flat corner': moved({2}, (0.5, 0.5, 0)), 'thin': cube * [1e-15, 1, 1], 'small': cube * 1e-30}
        expected = {'flat': 0, 'line': 0, 'point': 0, 'one edge': 0, 'pyramid': 0, 'wedge': 0, 'crossed': -0.5**0.5, 'twisted': 0,
                    'corners together': -0.5**0.5, 'flat corner': 0, 'thin': 1, 'small': 1}
        neighbours = [(1, 3, 4), (2, 0, 5), (3, 1, 6), (0, 2, 7), (7, 5, 0), (4, 6, 1), (5, 7, 2), (6, 4, 3)]
        for name, p in shapes.items():
            self.write_mesh(self.folder / 'one.vtk', [tuple(map(float, q)) for q in p], [range(8)])
            # The distortion is 0/0 in VTK where there is no volume.
            self.compare('one.vtk', without={'scaled_jacobian'}, nan_allowed=True)
            # The edges at each corner, and the axes at the centre.
            frames = [[p[j] - p[i] for j in around] for i, around in enumerate(neighbours)]
            frames.append([p[[1, 2, 5, 6]].sum(0) - p[[0, 3, 4, 7]].sum(0), p[[2, 3, 6, 7]].sum(0) - p[[0, 1, 4, 5]].sum(0),
                           p[[4, 5, 6, 7]].sum(0) - p[[0, 1, 2, 3]].sum(0)])
            squares = np.array([[v @ v for v in frame] for frame in frames])
            product = squares.prod(axis=1)
            ours = min(np.linalg.det(f) / s**0.5 if s > 0 else 0.0 for f, s in zip(frames, product))
            report = json.loads(self.run_program('check', 'one.vtk', '--min-scaled-jacobian', '-1', '--json', '-').stdout)
            with self.subTest(name):
                self.assertAlmostEqual(report['min_scaled_jacobian'], ours, 12)
                self.assertAlmostEqual(report['min_scaled_jacobian'], expected[name], 12)
                if (product == 0).any():
                    self.assertLessEqual(report['min_scaled_jacobian'], 0)
                    self.assertEqual(report['inverted'], 1)
                theirs = self.scaled_jacobian_of_vtk('one.vtk')
                if (squares <= 1e-30).any():
                    self.assertEqual(theirs, 1e30)
                else:
                    self.assertAlmostEqual(theirs, ours, 12)

    def scaled_jacobian_of_vtk(self, mesh):
        reader = vtk.vtkUnstructuredGridReader()
        reader.SetFileName(str(self.folder / mesh))
        reader.Update()
        quality = vtk.vtkMeshQuality()
        quality.SaveCellQualityOn()
        quality.SetHexQualityMeasureToScaledJacobian()
        quality.SetInputData(reader.GetOutput())
        quality.Update()
        return vtk_to_numpy(quality.GetOutput().GetCellData().GetArray('Quality'))[0]

    def test_published_meshes(self):
        if REFERENCE is None or not (REFERENCE / 'hex').is_dir():
            self.skipTest('no published models')
        meshes = sorted((REFERENCE / 'hex').glob('*.mesh'))
        self.assertGreater(len(meshes), 10)
        for mesh in meshes:
            largest = self.compare(mesh)
            if os.environ.get('HEXSPLINE_TELL'):
                print(f'{mesh.name}: {largest:.1e}')


if __name__ == '__main__':
    unittest.main()
