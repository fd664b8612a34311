"""Hexahedral meshes of the tests, and .vtk files of them that the program did not write."""
CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]


def write_vtk(path, points, cells):
    """ASCII, legacy version 3.0."""
    rows = ['# vtk DataFile Version 3.0', 'test', 'ASCII', 'DATASET UNSTRUCTURED_GRID', f'POINTS {len(points)} double']
    rows += [' '.join(map(str, p)) for p in points]
    rows += [f'CELLS {len(cells)} {9 * len(cells)}'] + [' '.join(map(str, [8, *c])) for c in cells]
    rows += [f'CELL_TYPES {len(cells)}'] + ['12'] * len(cells)
    path.write_text('\n'.join(rows) + '\n')


def grid(nx, ny, nz):
    """Points and cells of nx * ny * nz unit cubes."""
    at = lambda i, j, k: i + (nx + 1) * (j + (ny + 1) * k)
    points = [(i, j, k) for k in range(nz + 1) for j in range(ny + 1) for i in range(nx + 1)]
    cells = [[at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1), at(i + 1, j, k + 1),
              at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)] for k in range(nz) for j in range(ny) for i in range(nx)]
    return points, cells
