#!/usr/bin/env python3
"""Makes the sample parts of this folder: a connecting rod, a bracket and a smooth body.

    data/make_parts.py [FOLDER]        writes FOLDER/rod/..., FOLDER/bracket/..., FOLDER/blob/... (default: this folder)

Each part is designed as a structure of hexahedral blocks. A block face that belongs to one block only is a patch of the
surface: it is sampled on a grid, and the samples of neighbouring patches share their vertices by construction. Of each
part we write

    NAME.stl          the triangles, binary
    NAME_tri.k        the triangles, all of part 1
    NAME_patches.k    the triangles, part = patch: four-sided disks whose corners are the corners of the block faces
    NAME_blocks.k     the blocks

Needs numpy. Coordinates are rounded to 1e-10, far below any tolerance and far above the differences between mathematical
libraries, so that the same bytes come out everywhere.
"""
import math
import os
import struct
import sys

import numpy as np

# Corner order of a hexahedron as in libhex/include/hex/volume/hexahedron.h.
FACES = [(0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (4, 5, 6, 7)]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]
PARALLEL_EDGES = [(0, 2, 8, 10), (1, 3, 9, 11), (4, 5, 6, 7)]


def boundary_faces(blocks):
    """The faces that belong to one block only, counter-clockwise seen from outside, in block order."""
    count = {}
    for block in blocks:
        for face in FACES:
            key = tuple(sorted(block[c] for c in face))
            count[key] = count.get(key, 0) + 1
    return [tuple(block[c] for c in face) for block in blocks for face in FACES
            if count[tuple(sorted(block[c] for c in face))] == 1]


class Surface:
    """Welded triangles with a patch number each."""

    def __init__(self, points, triangles, patches):
        self.points = np.round(np.array(points, dtype=float), 10) + 0.0  # + 0.0 turns -0.0 into 0.0
        self.triangles = triangles
        self.patches = patches

    def add_grid(self, grid, patch):
        """The quads of a grid of vertex numbers, each split along its shorter diagonal."""
        for j in range(len(grid) - 1):
            for i in range(len(grid[0]) - 1):
                a, b, c, d = grid[j][i], grid[j][i + 1], grid[j + 1][i + 1], grid[j + 1][i]
                x = self.points
                if np.linalg.norm(x[a] - x[c]) <= np.linalg.norm(x[b] - x[d]) * (1 + 1e-9):
                    self.triangles += [(a, b, c), (a, c, d)]
                else:
                    self.triangles += [(a, b, d), (b, c, d)]
                self.patches += [patch, patch]


class BlockPart:
    """Blocks with curved boundary edges; faces are Coons patches of their edges (exact for planes and cylinders)."""

    def __init__(self, counts):
        self.points = []        # block corners
        self.blocks = []
        self.curves = {}        # (a, b) with a < b -> function [0, 1] -> point, from a to b
        self.counts = counts    # samples along a block edge: function of its length and whether it is curved

    def corner(self, x, y, z):
        self.points.append((x, y, z))
        return len(self.points) - 1

    def curve(self, a, b, function):
        self.curves[min(a, b), max(a, b)] = function if a < b else lambda t: function(1 - t)

    def block(self, bottom, top):
        self.blocks.append(tuple(bottom) + tuple(top))

    def at(self, a, b, t):
        """Point at parameter t of the way from corner a to corner b."""
        if a > b:
            a, b, t = b, a, 1 - t
        if (a, b) in self.curves:
            return np.array(self.curves[a, b](t))
        return (1 - t) * np.array(self.points[a]) + t * np.array(self.points[b])

    def samples(self):
        """Number of intervals on each block edge: one number for all edges that face each other across blocks."""
        edges = sorted({tuple(sorted((b[i], b[j]))) for b in self.blocks for i, j in EDGES})
        group = {e: e for e in edges}

        def find(e):
            while group[e] != e:
                e = group[e]
            return e

        for block in self.blocks:
            for parallel in PARALLEL_EDGES:
                sides = [find(tuple(sorted(block[c] for c in EDGES[e]))) for e in parallel]
                for side in sides[1:]:
                    group[find(side)] = find(sides[0])
        wanted = {}
        for e in edges:
            chain = [self.at(*e, t / 16) for t in range(17)]
            length = sum(np.linalg.norm(q - p) for p, q in zip(chain, chain[1:]))
            wanted[find(e)] = max(wanted.get(find(e), 0), self.counts(length, e in self.curves))
        return {e: wanted[find(e)] for e in edges}

    def surface(self):
        intervals = self.samples()
        points = list(self.points)
        on_edge = {}

        def edge_vertices(a, b):
            key = (min(a, b), max(a, b))
            n = intervals[key]
            if key not in on_edge:
                inner = []
                for i in range(1, n):
                    points.append(tuple(self.at(*key, i / n)))
                    inner.append(len(points) - 1)
                on_edge[key] = inner
            inner = on_edge[key] if a < b else on_edge[key][::-1]
            return [a] + inner + [b]

        def coons(a, b, c, d, u, v):
            p = [np.array(self.points[k]) for k in (a, b, c, d)]
            return ((1 - v) * self.at(a, b, u) + v * self.at(d, c, u) + (1 - u) * self.at(a, d, v) + u * self.at(b, c, v)
                    - (1 - u) * (1 - v) * p[0] - u * (1 - v) * p[1] - u * v * p[2] - (1 - u) * v * p[3])

        grids = []
        for a, b, c, d in boundary_faces(self.blocks):
            lower, upper = edge_vertices(a, b), edge_vertices(d, c)
            left, right = edge_vertices(a, d), edge_vertices(b, c)
            grid = [lower]
            for j in range(1, len(left) - 1):
                row = [left[j]]
                for i in range(1, len(lower) - 1):
                    points.append(tuple(coons(a, b, c, d, i / (len(lower) - 1), j / (len(left) - 1))))
                    row.append(len(points) - 1)
                grid.append(row + [right[j]])
            grids.append(grid + [upper])
        # Vertices that lie on no patch (inner corners of the block structure) do not belong to the surface.
        used = sorted({v for grid in grids for row in grid for v in row})
        number = {v: i for i, v in enumerate(used)}
        surface = Surface([points[v] for v in used], [], [])
        for patch, grid in enumerate(grids, start=1):
            surface.add_grid([[number[v] for v in row] for row in grid], patch)
        return surface


def arc(centre, radius, start, end, place):
    """Circular arc from `start` to `end` degrees; `place(p, q)` puts the plane of the circle into space."""
    def function(t):
        angle = math.radians(start + t * (end - start))
        return place(centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle))
    return function


def make_rod():
    """A connecting rod: two eyes with bores along z, the big one at the origin, and a flat, thinner, waisted shank."""
    part = BlockPart(lambda length, curved: max(8 if curved else 3, min(10, round(length / 3.5))))
    shank = 6.0
    attach = 42.0  # the shank leaves an eye's outer circle at this angle from the axis

    def eye(x, bore, outer, half_height, angles):
        """Twelve blocks: four sectors on three floors. Returns corners[floor][sector] = (inner, outer)."""
        floors = [-half_height, -shank, shank, half_height]
        corners = []
        for z in floors:
            place = lambda p, q, z=z: (p, q, z)
            ring = []
            for sector, angle in enumerate(angles):
                inner_angle = 45 + 90 * sector
                ring.append(tuple(part.corner(x + r * math.cos(math.radians(a)), r * math.sin(math.radians(a)), z)
                                  for r, a in ((bore, inner_angle), (outer, angle))))
            corners.append(ring)
            for s in range(4):
                n = (s + 1) % 4
                part.curve(ring[s][0], ring[n][0], arc((x, 0), bore, 45 + 90 * s, 135 + 90 * s, place))
                end = angles[n] if n > 0 else angles[0] + 360
                part.curve(ring[s][1], ring[n][1], arc((x, 0), outer, angles[s], end, place))
        for f in range(3):
            for s in range(4):
                n = (s + 1) % 4
                part.block([corners[f][s][0], corners[f][s][1], corners[f][n][1], corners[f][n][0]],
                           [corners[f + 1][s][0], corners[f + 1][s][1], corners[f + 1][n][1], corners[f + 1][n][0]])
        return corners

    length, big, small = 110.0, 33.0, 18.0
    # Sectors start at these angles: the side of the big eye that faces +x is its sector 3, of the small eye -x is sector 1.
    big_eye = eye(0.0, 22.0, big, 14.0, [attach, 135.0, 225.0, 360.0 - attach])
    small_eye = eye(length, 11.0, small, 11.0, [45.0, 180.0 - attach, 180.0 + attach, 315.0])

    # The shank: two blocks with waisted sides y = +-width(x), straight bottom and top.
    c, s = math.cos(math.radians(attach)), math.sin(math.radians(attach))
    x0, x1, y0, y1 = big * c, length - small * c, big * s, small * s
    middle = 0.5

    def width(t):
        """Cubic from y0 to y1, parallel to the axis at both ends."""
        return y0 + (y1 - y0) * t * t * (3 - 2 * t)

    def side(sign, z, start, end):
        return lambda t: (x0 + (x1 - x0) * (start + t * (end - start)), sign * width(start + t * (end - start)), z)

    middles = []
    for z in (-shank, shank):
        middles.append([part.corner(*side(sign, z, 0, middle)(1)) for sign in (-1, 1)])
    for f, z in ((1, -shank), (2, shank)):
        lower, upper = middles[f - 1]
        part.curve(big_eye[f][3][1], lower, side(-1, z, 0, middle))
        part.curve(big_eye[f][0][1], upper, side(1, z, 0, middle))
        part.curve(lower, small_eye[f][2][1], side(-1, z, middle, 1))
        part.curve(upper, small_eye[f][1][1], side(1, z, middle, 1))
    part.block(*[[big_eye[f][3][1], middles[f - 1][0], middles[f - 1][1], big_eye[f][0][1]] for f in (1, 2)])
    part.block(*[[middles[f - 1][0], small_eye[f][2][1], small_eye[f][1][1], middles[f - 1][1]] for f in (1, 2)])
    return part.surface(), part.points, part.blocks


def make_bracket():
    """An L-bracket: a rectangular foot with a screw hole along z, a rounded lug with a hole along x, a fillet between."""
    part = BlockPart(lambda length, curved: max(8 if curved else 4, min(10, round(length / 3.5))))
    thick, fillet, half_width = 10.0, 10.0, 20.0
    start = thick + fillet          # where foot and lug end and the bend begins

    def ring(place, hole_centre, hole, outer, outer_curves):
        """Four blocks around a hole, through the thickness. `outer` are four corners in the plane, counter-clockwise,
        starting at the lower right one; place(p, q, w) puts them into space, w = 0 or thick. Returns the outer corners."""
        layers = []
        for w in (0.0, thick):
            flat = lambda p, q, w=w: place(p, q, w)
            inner_corners, outer_corners = [], []
            for s in range(4):
                a = math.radians(-45 + 90 * s)
                inner_corners.append(part.corner(*flat(hole_centre[0] + hole * math.cos(a), hole_centre[1] + hole * math.sin(a))))
                outer_corners.append(part.corner(*flat(*outer[s])))
            for s in range(4):
                n = (s + 1) % 4
                part.curve(inner_corners[s], inner_corners[n], arc(hole_centre, hole, -45 + 90 * s, 45 + 90 * s, flat))
                if outer_curves[s] is not None:
                    part.curve(outer_corners[s], outer_corners[n], lambda t, g=outer_curves[s], flat=flat: flat(*g(t)))
            layers.append((inner_corners, outer_corners))
        for s in range(4):
            n = (s + 1) % 4
            part.block(*[[i[s], o[s], o[n], i[n]] for i, o in layers])
        return [o for i, o in layers]

    # Foot in the plane (x, y), seen from above: w is z. The outer corners start at (far x, -y).
    foot_end = 64.0
    foot = ring(lambda p, q, w: (p, q, w), ((start + foot_end) / 2, 0.0), 9.0,
                [(foot_end, -half_width), (foot_end, half_width), (start, half_width), (start, -half_width)], [None] * 4)

    # Lug in the plane (y, z), seen from +x: w is x. A half disk on top of a rectangle; its sides run straight for 5/8 of
    # their parameter, then along the circle up to 45 degrees, so that a sample lies where one turns into the other.
    centre = 44.0
    diagonal = half_width * math.sqrt(0.5)

    def lug_side(t):
        if t <= 0.625:
            return (half_width, start + (centre - start) * t / 0.625)
        angle = math.radians(45 * (t - 0.625) / 0.375)
        return (half_width * math.cos(angle), centre + half_width * math.sin(angle))

    def lug_other_side(t):
        y, z = lug_side(1 - t)
        return (-y, z)

    def lug_top(t):
        angle = math.radians(45 + 90 * t)
        return (half_width * math.cos(angle), centre + half_width * math.sin(angle))

    lug = ring(lambda p, q, w: (w, p, q), (0.0, centre), 9.0,
               [(half_width, start), (diagonal, centre + diagonal), (-diagonal, centre + diagonal), (-half_width, start)],
               [lug_side, lug_top, lug_other_side, None])

    # The bend: two blocks between the outer edge (the y axis) and the middle of the fillet.
    quarter = fillet * math.sqrt(0.5)
    heel = [part.corner(0.0, y, 0.0) for y in (-half_width, half_width)]
    middle = [part.corner(start - quarter, y, start - quarter) for y in (-half_width, half_width)]
    below = [foot[0][3], foot[0][2]]    # of the foot's end: under, at -y and +y
    above = [foot[1][3], foot[1][2]]
    back = [lug[0][3], lug[0][0]]
    front = [lug[1][3], lug[1][0]]
    for k, y in enumerate((-half_width, half_width)):
        flat = lambda p, q, y=y: (p, y, q)
        part.curve(above[k], middle[k], arc((start, start), fillet, 270, 225, flat))
        part.curve(middle[k], front[k], arc((start, start), fillet, 225, 180, flat))
    part.block([heel[0], below[0], below[1], heel[1]], [middle[0], above[0], above[1], middle[1]])
    part.block([heel[0], middle[0], middle[1], heel[1]], [back[0], front[0], front[1], back[1]])
    return part.surface(), part.points, part.blocks


def catmull_clark(points, quads):
    """One step of Catmull-Clark on a closed quad mesh. Quad q becomes the four quads 4 q .. 4 q + 3, at its corners."""
    points = np.array(points)
    centres = points[np.array(quads)].mean(1)
    edges, faces_of = {}, {}
    for q, quad in enumerate(quads):
        for i in range(4):
            faces_of.setdefault(tuple(sorted((quad[i], quad[(i + 1) % 4]))), []).append(q)
    first_edge = len(points)
    middles = []
    for e, (key, faces) in enumerate(faces_of.items()):
        edges[key] = first_edge + e
        middles.append((points[key[0]] + points[key[1]] + centres[faces[0]] + centres[faces[1]]) / 4)
    first_centre = first_edge + len(middles)
    valence = np.zeros(len(points))
    ring = np.zeros_like(points)      # sum of edge neighbours
    cells = np.zeros_like(points)     # sum of face centres
    for a, b in faces_of:
        ring[a] += points[b]
        ring[b] += points[a]
        valence[a] += 1
        valence[b] += 1
    for q, quad in enumerate(quads):
        for v in quad:
            cells[v] += centres[q]
    n = valence[:, None]
    moved = (cells / n + ring / n + (n - 2) * points) / n
    fine = []
    for q, quad in enumerate(quads):
        for i in range(4):
            a, b, d = quad[i], quad[(i + 1) % 4], quad[i - 1]
            fine.append((a, edges[tuple(sorted((a, b)))], first_centre + q, edges[tuple(sorted((a, d)))]))
    return np.concatenate([moved, middles, centres]), fine


def limit_positions(points, quads):
    """The points of the Catmull-Clark limit surface that belong to the vertices (Halstead, Kass, DeRose 1993)."""
    points = np.array(points)
    ring, diagonal, valence = np.zeros_like(points), np.zeros_like(points), np.zeros((len(points), 1))
    for quad in quads:
        for i in range(4):
            valence[quad[i]] += 1
            ring[quad[i]] += points[quad[(i + 1) % 4]] / 2 + points[quad[i - 1]] / 2
            diagonal[quad[i]] += points[quad[(i + 2) % 4]]
    return (valence**2 * points + 4 * ring + diagonal) / (valence * (valence + 5))


def make_blob():
    """A smooth body with a trunk and five limbs: the Catmull-Clark limit surface of a bent polycube. The blocks are the cubes
    of the polycube, shrunk, and one shell block between each of their outer faces and the surface."""
    cubes = [(0, 0, 0), (1, 0, 0),                     # trunk
             (-1, 0, 0), (2, 0, 0),                    # tail, neck
             (1, 1, 0), (1, -1, 0), (1, 0, 1)]         # limbs
    corners = {}
    for i, j, k in cubes:
        for u, v, w in [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]:
            corners.setdefault((i + u, j + v, k + w), len(corners))
    core = [tuple(corners[i + u, j + v, k + w] for u, v, w in
                  [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]) for i, j, k in cubes]

    def stretched(x, middle, growth):
        """Limbs grow longer with the distance from the trunk."""
        x -= middle
        return x * (1 + growth * abs(x))

    def bend(i, j, k):
        x, y, z = stretched(i, 1.0, 0.06), stretched(j, 0.5, 0.08), stretched(k, 0.5, 0.08)
        return (20 * (x + 0.03 * y * y - 0.036 * z), 20 * (y + 0.03 * x * z + 0.024 * x * x),
                20 * (z + 0.042 * math.sin(1.3 * x) + 0.015 * x * y))

    control = np.array([bend(*grid) for grid in corners])
    quads = boundary_faces(core)
    points, fine = control, quads
    for _ in range(3):
        points, fine = catmull_clark(points, fine)
    points = limit_positions(points, fine)
    assert len({v for q in quads for v in q}) == len(control), "every corner of the polycube is on its boundary"

    surface = Surface(points, [], [])
    for q, quad in enumerate(fine):
        surface.add_grid([[quad[0], quad[1]], [quad[3], quad[2]]], q // 64 + 1)

    # Core corners: on the way from the surface to the mean centre of the cubes around.
    centres = np.array([control[list(c)].mean(0) for c in core])
    outer = surface.points[:len(control)]
    inner = []
    for v in range(len(control)):
        around = np.mean([centres[c] for c in range(len(core)) if v in core[c]], axis=0)
        inner.append(outer[v] + 0.65 * (around - outer[v]))
    shift = len(control)
    blocks = [tuple(shift + v for v in c) for c in core]
    blocks += [tuple(shift + v for v in quad) + tuple(quad) for quad in quads]
    return surface, [tuple(p) for p in outer] + [tuple(p) for p in inner], blocks


def number(x):
    """Shortest decimal that reads back to the same double; whole numbers without a fraction."""
    x = float(x)
    return str(int(x)) if x == int(x) else repr(x)


def write_k(path, title, kind, points, elements, parts):
    lines = ['$ ' + title, '*KEYWORD', '*ELEMENT_' + kind]
    for e, (element, part) in enumerate(zip(elements, parts), start=1):
        nodes = [v + 1 for v in element]
        if len(nodes) == 3:
            nodes.append(nodes[2])
        lines.append(','.join(map(str, [e, part] + nodes)))
    lines.append('*NODE')
    for v, p in enumerate(points, start=1):
        lines.append(','.join([str(v)] + [number(x) for x in p]))
    lines.append('*END')
    with open(path, 'w', newline='\n') as file:
        file.write('\n'.join(lines) + '\n')


def write_stl(path, title, surface):
    with open(path, 'wb') as file:
        file.write(title.encode('ascii').ljust(80)[:80] + struct.pack('<I', len(surface.triangles)))
        for triangle in surface.triangles:
            corners = np.array([surface.points[v] for v in triangle]).astype('<f4')
            # The normal is left zero, which STL allows: readers compute it from the corners.
            file.write(struct.pack('<3f', 0, 0, 0) + corners.tobytes() + b'\0\0')


def write_part(folder, name, made):
    surface, points, blocks = made
    points = np.round(np.array(points, dtype=float), 10) + 0.0
    folder = os.path.join(folder, name)
    os.makedirs(folder, exist_ok=True)
    base = os.path.join(folder, name)
    title = 'hexspline sample part ' + name + ': '
    write_stl(base + '.stl', 'hexspline sample part ' + name, surface)
    write_k(base + '_tri.k', title + 'triangles', 'SHELL', surface.points, surface.triangles, [1] * len(surface.triangles))
    write_k(base + '_patches.k', title + 'triangles, part = patch', 'SHELL', surface.points, surface.triangles, surface.patches)
    write_k(base + '_blocks.k', title + 'blocks', 'SOLID', points, blocks, [1] * len(blocks))
    return f'{name}: {len(surface.triangles)} triangles, {max(surface.patches)} patches, {len(blocks)} blocks'


def main(arguments):
    folder = arguments[0] if arguments else os.path.dirname(os.path.abspath(__file__))
    for name, make in (('rod', make_rod), ('bracket', make_bracket), ('blob', make_blob)):
        print(write_part(folder, name, make()))


if __name__ == '__main__':
    main(sys.argv[1:])
