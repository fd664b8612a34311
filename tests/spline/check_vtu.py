#!/usr/bin/python3
"""VTK opens a .vtu of Bezier hexahedra and evaluates it to the points of the BEXT file of the same spline.

    check_vtu.py FILE.vtu FILE.bext

Both files are of one spline, elements in the same order. Exits 1 with a message when they differ.
"""
import sys

import numpy as np
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

TOLERANCE = 1e-12


def read_bext(path):
    words = iter(open(path).read().split())
    nodes, elements = [], []
    for word in words:
        if word == "gnode":
            nodes.append([float(next(words)) for _ in range(4)])
        elif word == "belem":
            count = int(next(words))
            for _ in range(3):
                assert next(words) == "3"
            ids = [int(next(words)) for _ in range(count)]
            rows = np.zeros((count, 64))
            for row in rows:
                if next(words) == "d":
                    row[:] = [float(next(words)) for _ in range(64)]
                else:
                    for _ in range(int(next(words))):
                        column = int(next(words))
                        row[column] = float(next(words))
            elements.append((ids, rows))
    return np.array(nodes), elements


def bernstein(t):
    s = 1 - t
    return np.array([s**3, 3 * s * s * t, 3 * s * t * t, t**3])


def main(vtu, bext):
    errors = []
    reader = vtkXMLUnstructuredGridReader()
    reader.AddObserver("ErrorEvent", lambda *_: errors.append("reader error"))
    reader.SetFileName(vtu)
    reader.Update()
    grid = reader.GetOutput()
    nodes, elements = read_bext(bext)
    if errors or grid.GetNumberOfCells() != len(elements) or not elements:
        sys.exit(f"{vtu}: {grid.GetNumberOfCells()} cells, {len(elements)} elements in {bext}, {errors}")
    scale = np.linalg.norm(np.ptp(nodes[:, :3], axis=0))
    samples = np.array([(u, v, w) for u in (0, 0.3, 1) for v in (0.1, 0.7, 1) for w in (0, 0.45, 0.9)])
    basis = np.array(
        [np.einsum("k,j,i->kji", bernstein(w), bernstein(v), bernstein(u)).ravel() for u, v, w in samples]
    )
    largest = 0.0
    for cell_id, (ids, rows) in enumerate(elements):
        if grid.GetCellType(cell_id) != 79:
            sys.exit(f"{vtu}: cell {cell_id} has type {grid.GetCellType(cell_id)}, not 79")
        cell = grid.GetCell(cell_id)
        weight = nodes[ids, 3]
        homogeneous = rows.T @ np.column_stack([nodes[ids, :3] * weight[:, None], weight])
        ours = basis @ homogeneous
        ours = ours[:, :3] / ours[:, 3:]
        for sample, point in zip(samples, ours):
            theirs, weights = [0.0] * 3, [0.0] * 64
            cell.EvaluateLocation(mutable(0), list(sample), theirs, weights)
            largest = max(largest, np.linalg.norm(np.array(theirs) - point) / scale)
    print(f"{vtu}: {len(elements)} cells, largest difference {largest:.3g} of the diagonal")
    if not largest <= TOLERANCE:
        sys.exit(f"{vtu}: differs by {largest} of the diagonal")


main(*sys.argv[1:])
