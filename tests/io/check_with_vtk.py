#!/usr/bin/python3
"""Independent check of our readers and writers: VTK and meshio open what `hexspline convert` wrote, and it reads what they wrote.

    check_with_vtk.py HEXSPLINE FOLDER

Coordinates are compared to the last bit (to the last bit of a 32-bit float where VTK's own reader keeps no more). Exit code 77
(skipped) when VTK or meshio is not installed.
"""
import itertools
import os
import random
import re
import subprocess
import sys

try:
    import meshio
    import numpy as np
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

hexspline, folder = sys.argv[1:]
os.makedirs(folder, exist_ok=True)
os.chdir(folder)
random.seed(4)
failures = 0


def check(condition, what):
    global failures
    if not condition:
        failures += 1
        print("FAILED:", what)


def same(a, b, what):
    a, b = np.asarray(a), np.asarray(b)
    check(a.shape == b.shape and bool((a == b).all()), what)


def convert(source, target):
    done = subprocess.run([hexspline, "convert", "-i", source, "-o", target], capture_output=True, text=True)
    check(done.returncode == 0, f"convert {source} {target}: {done.stderr}")
    return target


def awkward(count):
    """Coordinates that need 17 digits, of very different size."""
    return np.array([[random.uniform(-1, 1) * 10.0 ** random.randint(-6, 6) for _ in range(3)] for _ in range(count)])


def write_k(name, keyword, points, cells, parts):
    with open(name, "w") as out:
        print("*KEYWORD\n*ELEMENT_" + keyword, file=out)
        for i, (cell, part) in enumerate(zip(cells, parts)):
            row = list(cell) + ([cell[-1]] if len(cell) == 3 else [])
            print(i + 1, part, *[v + 1 for v in row], sep=",", file=out)
        print("*NODE", file=out)
        for i, p in enumerate(points):
            print(i + 1, *[repr(float(x)) for x in p], sep=",", file=out)
        print("*END", file=out)


def read_k(name):
    blocks, block = {}, None
    for line in open(name):
        if line.startswith("*"):
            block = blocks.setdefault(line.strip(), [])
        elif not line.startswith("$"):
            block.append(line.strip().split(","))
    points = np.array([[float(x) for x in row[1:4]] for row in blocks["*NODE"]])
    rows = blocks.get("*ELEMENT_SOLID") or blocks.get("*ELEMENT_SHELL")
    return points, np.array([[int(v) - 1 for v in row[2:]] for row in rows]), np.array([int(row[1]) for row in rows])


def grid_cells(nx, ny, nz):
    at = lambda i, j, k: i + (nx + 1) * (j + (ny + 1) * k)
    return [[at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k),
             at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)]
            for k, j, i in itertools.product(range(nz), range(ny), range(nx))]


def vtk_read(reader, name):
    messages = []
    reader.AddObserver("ErrorEvent", lambda *_: messages.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: messages.append("warning"))
    reader.SetFileName(name)
    reader.Update()
    check(not messages, f"VTK complains about {name}")
    return reader.GetOutput()


def corners_of(cells):
    return vtk_to_numpy(cells.GetConnectivityArray())


# --- hexahedra: what we write ---
points = awkward(4 * 3 * 3)
cells = grid_cells(3, 2, 2)
parts = [1 + i % 4 for i in range(len(cells))]
write_k("hex.k", "SOLID", points, cells, parts)
for name, reader in (("hex.vtk", vtk.vtkUnstructuredGridReader()), ("hex.vtu", vtk.vtkXMLUnstructuredGridReader())):
    grid = vtk_read(reader, convert("hex.k", name))
    same(vtk_to_numpy(grid.GetPoints().GetData()), points, name + ": points")
    same(corners_of(grid.GetCells()), np.ravel(cells), name + ": corners")
    check(all(grid.GetCellType(c) == vtk.VTK_HEXAHEDRON for c in range(grid.GetNumberOfCells())), name + ": cell types")
    same(vtk_to_numpy(grid.GetCellData().GetArray("part_id")), parts, name + ": part ids")
mesh = meshio.read(convert("hex.k", "hex.mesh"))
same(mesh.points, points, "hex.mesh: points")
same(mesh.cells_dict["hexahedron"], cells, "hex.mesh: corners")
same(mesh.cell_data["medit:ref"][0], parts, "hex.mesh: references")

# --- hexahedra: what VTK and meshio write ---
written = []
for version, binary in itertools.product((42, 51), (False, True)):
    writer = vtk.vtkUnstructuredGridWriter()
    if hasattr(writer, "SetFileVersion"):
        writer.SetFileVersion(version)
    writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
    written.append((f"vtk_{version}_{'binary' if binary else 'ascii'}.vtk", writer, binary))
for mode, compressed, wide, encoded in itertools.product(("Ascii", "Binary", "Appended"), (False, True), (False, True), (False, True)):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    getattr(writer, f"SetDataModeTo{mode}")()
    writer.SetCompressorTypeToZLib() if compressed else writer.SetCompressorTypeToNone()
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    writer.SetEncodeAppendedData(encoded)
    # Small blocks, so that an array has several.
    writer.SetBlockSize(256)
    written.append((f"vtk_{mode}_{compressed:d}{wide:d}{encoded:d}.vtu", writer, mode != "Ascii"))
    if mode == "Appended":
        big = vtk.vtkXMLUnstructuredGridWriter()
        big.SetDataModeToAppended()
        big.SetByteOrderToBigEndian()
        written.append((f"vtk_big_{compressed:d}{wide:d}{encoded:d}.vtu", big, True))
for name, writer, exact in written:
    writer.SetInputData(grid)
    writer.SetFileName(name)
    writer.Write()
    back, corners, back_parts = read_k(convert(name, name + ".k"))
    same(corners, cells, name + ": corners")
    same(back_parts, parts, name + ": part ids")
    if exact:
        same(back, points, name + ": points")
    else:
        # VTK prints fewer digits than a double has.
        check(np.allclose(back, points, rtol=1e-4), name + ": points")
for name, options in (("meshio.vtk", {"binary": True}), ("meshio_ascii.vtk", {"binary": False}), ("meshio.vtu", {"binary": True, "compression": "zlib"}),
                      ("meshio_plain.vtu", {"binary": True, "compression": None}), ("meshio_ascii.vtu", {"binary": False}), ("meshio.mesh", {})):
    meshio.write(name, meshio.Mesh(points, [("hexahedron", np.array(cells))]), **options)
    back, corners, _ = read_k(convert(name, name + ".k"))
    same(corners, cells, name + ": corners")
    if "ascii" in name:
        check(np.allclose(back, points, rtol=1e-9), name + ": points")
    else:
        same(back, points, name + ": points")

# --- surfaces: what we write ---
points = awkward(20)
triangles = [random.sample(range(20), 3) for _ in range(30)]
triangles.append([0, 1, 2])
unused = sorted(set(range(20)) - set(np.ravel(triangles)))
triangles += [[v, 0, 1] for v in unused]
parts = [1 + i % 3 for i in range(len(triangles))]
write_k("surface.k", "SHELL", points, triangles, parts)
for name, reader in (("surface.vtk", vtk.vtkUnstructuredGridReader()), ("surface.vtu", vtk.vtkXMLUnstructuredGridReader())):
    grid = vtk_read(reader, convert("surface.k", name))
    same(vtk_to_numpy(grid.GetPoints().GetData()), points, name + ": points")
    same(corners_of(grid.GetCells()), np.ravel(triangles), name + ": corners")
    same(vtk_to_numpy(grid.GetCellData().GetArray("part_id")), parts, name + ": part ids")
single = points.astype(np.float32)
stl = vtk.vtkSTLReader()
stl.MergingOff()
poly = vtk_read(stl, convert("surface.k", "surface.stl"))
same(vtk_to_numpy(poly.GetPoints().GetData()), single[np.ravel(triangles)], "surface.stl: points")
for name, reader in (("surface.ply", vtk.vtkPLYReader()), ("surface.obj", vtk.vtkOBJReader())):
    poly = vtk_read(reader, convert("surface.k", name))
    same(vtk_to_numpy(poly.GetPoints().GetData()).astype(np.float32), single, name + ": points")
    same(corners_of(poly.GetPolys()), np.ravel(triangles), name + ": corners")
for name in ("surface.ply", "surface.obj", "surface.off", "surface.mesh"):
    mesh = meshio.read(convert("surface.k", name))
    exact = points if mesh.points.dtype == np.float64 else single
    same(mesh.points, exact, name + ": points (meshio)")
    same(mesh.cells_dict["triangle"], triangles, name + ": corners (meshio)")

# --- surfaces: what VTK writes ---
data = vtk.vtkPolyData()
vtk_points = vtk.vtkPoints()
vtk_points.SetDataTypeToFloat()
for p in single:
    vtk_points.InsertNextPoint(*[float(x) for x in p])
vtk_cells = vtk.vtkCellArray()
for t in triangles:
    vtk_cells.InsertNextCell(3, t)
data.SetPoints(vtk_points)
data.SetPolys(vtk_cells)
for name, writer in (("vtk_poly.vtk", vtk.vtkPolyDataWriter()), ("vtk.ply", vtk.vtkPLYWriter()), ("vtk.stl", vtk.vtkSTLWriter())):
    writer.SetInputData(data)
    writer.SetFileName(name)
    writer.SetFileTypeToBinary()
    writer.Write()
    back, corners, _ = read_k(convert(name, name + ".k"))
    same(back[corners[:, :3].ravel()], single[np.ravel(triangles)].astype(float), name + ": triangles")

print("failures:", failures)
sys.exit(1 if failures else 0)
