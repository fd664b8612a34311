#!/usr/bin/env python3
"""The metrics of `hexspline check` equal those of VTK's Verdict, element by element.

    verdict_test.py HEXSPLINE DATA [REFERENCE_DATA]

On tangled random meshes, and on every mesh of the published models when they are there.
"""
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
    def compare(self, mesh):
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
