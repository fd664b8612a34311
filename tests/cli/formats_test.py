#!/usr/bin/env python3
"""convert between the formats of finite element programs; other programs read what we write.

    formats_test.py HEXSPLINE DATA
"""
import shutil
import subprocess
import unittest

from program import ROD, CommandTest

try:
    import meshio
    import numpy as np
except ImportError:
    meshio = None

HEX = ('.k', '.vtk', '.vtu', '.mesh', '.mfem', '.inp', '.msh', '.msh2', '.ovm')

ABAQUS = '''*HEADING
 two cubes
** a comment
*NODE, NSET=ALL
 10, 0., 0., 0.
 11, 1., 0., 0.
 12, 1., 1., 0.
 13, 0., 1., 0.
 20, 0., 0., 1.
 21, 1., 0., 1.
 22, 1., 1., 1.
 23, 0., 1., 1.
 30, 0., 0., 2.
 31, 1., 0., 2.
 32, 1., 1., 2.
 33, 0., 1., 2.
*ELEMENT, TYPE=C3D8R, ELSET=lower
 7, 10, 11, 12, 13, 20, 21,
 22, 23
*element, type=C3D8I
 9, 20, 21, 22, 23, 30, 31, 32, 33
*ELSET, ELSET=Upper, GENERATE
 9, 9, 1
*MATERIAL, NAME=steel
*ELASTIC
 210000., 0.3
'''


class Formats(CommandTest):
    def make_mesh(self):
        """A mesh with several part ids."""
        self.run_program('map', ROD / 'rod_patches.k', '-p', ROD / 'rod_blocks.k', '-s', '1', '-o', 'a.vtk')

    def vtk_text(self, name):
        return (self.folder / name).read_text()

    def test_every_format_gives_the_mesh_back(self):
        self.make_mesh()
        self.run_program('convert', 'a.vtk', '-o', 'chain.k')
        source = 'chain.k'
        for extension in (*(e for e in HEX if e != '.ovm'), '.vtk'):
            target = f'next{extension}'
            self.run_program('convert', source, '-o', target)
            source = target
        self.assertEqual(self.vtk_text('a.vtk'), self.vtk_text(source))
        # The corners of a cell may start elsewhere, but the mesh is as good as before.
        self.run_program('convert', source, '-o', 'b.ovm')
        self.run_program('convert', 'b.ovm', '-o', 'b.vtk')
        tables = [self.run_program('check', name, '--min-scaled-jacobian', '-1').stdout for name in ('a.vtk', 'b.vtk')]
        self.assertEqual(*(table.split('metric')[0] for table in tables))

    def test_names_of_parts_survive(self):
        (self.folder / 'part.inp').write_text(ABAQUS)
        self.run_program('convert', 'part.inp', '-o', 'part.msh')
        self.run_program('convert', 'part.msh', '-o', 'part.msh2')
        self.run_program('convert', 'part.msh2', '-o', 'again.inp')
        text = (self.folder / 'again.inp').read_text()
        self.assertIn('*ELSET, ELSET=lower\n1\n', text)
        self.assertIn('*ELSET, ELSET=Upper\n2\n', text)

    def test_names_of_parts_that_are_lost_are_counted(self):
        (self.folder / 'part.inp').write_text(ABAQUS)
        self.assertEqual(self.run_program('convert', 'part.inp', '-o', 'part.k').stderr, '')
        self.run_program('convert', 'part.k', '-o', 'again.inp')
        self.assertIn('*ELSET, ELSET=Upper\n2\n', (self.folder / 'again.inp').read_text())
        for name in ('part.vtk', 'part.vtu', 'part.mesh', 'part.mfem', 'part.ovm'):
            message, = self.run_program('convert', 'part.inp', '-o', name).stderr.splitlines()
            self.assertRegex(message, f'warning: {name}: .* no names of parts; those of 2 are lost')

    def write_shells(self, name, names):
        """A row of shells, parts 1, 2, ... with these titles in LS-DYNA's keywords, or as groups of Gmsh."""
        points = [(i % 2, i // 2, 0) for i in range(2 * len(names) + 2)]
        numbered = [*enumerate(names, 1)]
        rows = [(i, 2 * i - 1, 2 * i, 2 * i + 2, 2 * i + 1) for i, _ in numbered]
        if name.endswith('.k'):
            lines = ['*KEYWORD', *(f'*PART\n{title}\n{i},0,0' for i, title in numbered), '*NODE',
                     *(f'{i},{x},{y},{z}' for i, (x, y, z) in enumerate(points, 1)), '*ELEMENT_SHELL',
                     *(f'{i},{i},{a},{b},{c},{d}' for i, a, b, c, d in rows), '*END']
        else:
            lines = ['$MeshFormat', '2.2 0 8', '$EndMeshFormat', '$PhysicalNames', len(names),
                     *(f'2 {i} "{title}"' for i, title in numbered), '$EndPhysicalNames', '$Nodes', len(points),
                     *(f'{i} {x} {y} {z}' for i, (x, y, z) in enumerate(points, 1)), '$EndNodes', '$Elements', len(rows),
                     *(f'{i} 3 2 {i} {i} {a} {b} {c} {d}' for i, a, b, c, d in rows), '$EndElements']
        (self.folder / name).write_text('\n'.join(map(str, lines)) + '\n')

    def titles(self, name):
        lines = (self.folder / name).read_text().splitlines()
        return [lines[i + 1] for i, line in enumerate(lines) if line == '*PART']

    def test_names_that_are_no_titles_of_ls_dyna_are_altered_with_a_warning_and_stay_apart(self):
        long = 80 * 'n'
        names = ['*a', '$a', '_a', '_a', 'b*$', long, long + 'one', long + 'two', 79 * 'm' + '\u00e9', '  *c ']
        self.write_shells('named.msh2', names)
        told = self.run_program('convert', 'named.msh2', '-o', 'named.k').stderr
        self.assertIn("names of parts are written as LS-DYNA keyword can hold them: '*a' as '_a_1' (and 5 more)", told)
        titles = ['_a_1', '_a_2', '_a', '_a', 'b*$', long, 78 * 'n' + '_7', 78 * 'n' + '_8', 79 * 'm', '_c']
        self.assertEqual(self.titles('named.k'), titles)
        # The names are as they were written: nothing is left to tell.
        self.assertEqual(self.run_program('convert', 'named.k', '-o', 'again.k').stderr, '')
        self.assertEqual(self.titles('again.k'), titles)

    def test_names_are_no_longer_than_their_format_can_hold(self):
        base = 124 * 'n'
        names = [base + 'abc', base + 'abcd', base + 'ABCE', base[:80], base[:78] + '_3']
        self.write_shells('named.msh2', names)
        for name, longest, changed in (('named.inp', 80, 3), ('named.k', 80, 3), ('named.msh', 127, 2)):
            with self.subTest(name):
                told = self.run_program('convert', 'named.msh2', '-o', name).stderr
                self.assertIn(f'(and {changed - 1} more)', told)
                self.run_program('convert', name, '-o', 'back.msh2')
                back = [line.split('"')[1] for line in (self.folder / 'back.msh2').read_text().splitlines() if '"' in line]
                self.assertEqual((len(set(back)), max(map(len, back))), (5, longest))
                # Those that fit are as they were.
                self.assertLessEqual({title for title in names if len(title) <= longest}, set(back))
        self.write_shells('short.msh2', [title[:80] for title in names[3:]])
        for name in ('short.inp', 'short.k', 'short.msh'):
            self.assertEqual(self.run_program('convert', 'short.msh2', '-o', name).stderr, '')

    def test_names_that_abaqus_would_take_for_one_stay_apart(self):
        names = ['PART_2', None, 'a,b', 'a=b', 'Steel', 'STEEL', 'STEEL_6', 'last', 'PART_08']
        (self.folder / 'named.k').write_text('*KEYWORD\n' + ''.join(
            f'*PART\n{name}\n{number},0,0\n' for number, name in enumerate(names, 1) if name) + '*NODE\n' + ''.join(
            f'{i},{i % 2},{i // 2},0\n' for i in range(1, 21)) + '*ELEMENT_SHELL\n' + ''.join(
            f'{i},{i},{i},{i + 1},{i + 3},{i + 2}\n' for i in range(1, 10)) + '*END\n')
        self.run_program('convert', 'named.k', '-o', 'named.vtk')
        told = self.run_program('convert', 'named.k', '-o', 'named.inp').stderr
        self.assertIn("'PART_2' as 'PART_2_1' (and 4 more)", told)
        sets = [line.split('ELSET=')[1] for line in (self.folder / 'named.inp').read_text().splitlines() if line.startswith('*ELSET')]
        self.assertEqual(sets, ['PART_2_1', 'PART_2', 'a_b', 'a_b_4', 'Steel', 'STEEL_6_2', 'STEEL_6', 'last', 'PART_08_9'])
        self.run_program('convert', 'named.inp', '-o', 'back.vtk')
        rows = [self.vtk_text(name).split('LOOKUP_TABLE')[1].split()[1:] for name in ('named.vtk', 'back.vtk')]
        self.assertEqual([len(set(row)) for row in rows], [9, 9])
        told = self.run_program('convert', 'named.k', '-o', 'named.msh').stderr
        self.assertNotIn('written as', told)

    def test_part_0_is_no_physical_group_of_gmsh(self):
        self.make_mesh()
        lines = self.vtk_text('a.vtk').splitlines()
        start = next(i for i, line in enumerate(lines) if line.startswith('LOOKUP_TABLE')) + 1
        lines[start:start + 3] = ['0'] * 3
        (self.folder / 'zero.vtk').write_text('\n'.join(lines) + '\n')
        for name in ('zero.msh', 'zero.msh2'):
            self.run_program('convert', 'zero.vtk', '-o', name)
            self.run_program('convert', name, '-o', 'back.vtk')
            self.assertEqual(self.vtk_text('back.vtk'), self.vtk_text('zero.vtk'))
            if shutil.which('gmsh'):
                done = subprocess.run(['gmsh', name, '-save', '-save_all', '-format', 'msh41', '-o', 'theirs.msh'], cwd=self.folder,
                                      stdin=subprocess.DEVNULL, capture_output=True, text=True)
                self.assertNotIn('Error', done.stdout + done.stderr)
                self.run_program('convert', 'theirs.msh', '-o', 'theirs.vtu')
        message = self.run_program('convert', 'zero.vtk', '-o', 'zero.mfem', code=3).stderr
        self.assertRegex(message, r'hexahedra 0, 1, 2 have .*; .*write another format')

    def test_the_name_of_part_0_is_lost_in_gmsh_with_a_warning(self):
        (self.folder / 'part.k').write_text(
            '*KEYWORD\n*PART\nrest\n0,0,0\n*PART\nleft\n4,0,0\n*PART\nelsewhere\n8,0,0\n*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n'
            '*ELEMENT_SHELL\n1,0,1,2,3,3\n2,4,1,3,4,4\n*END\n')
        for name in ('part.msh', 'part.msh2'):
            message, = self.run_program('convert', 'part.k', '-o', name).stderr.splitlines()
            self.assertRegex(message, f"warning: {name}: Gmsh.* has no name for part 0; 'rest' is lost")
            self.run_program('convert', name, '-o', 'back.k')
            self.assertEqual(self.titles('back.k'), ['left'])
        self.assertEqual(self.run_program('convert', 'part.k', '-o', 'part.inp').stderr, '')

    def test_labels(self):
        self.run_program('convert', ROD / 'rod_patches.k', '-o', 'labels.txt')
        labels = (self.folder / 'labels.txt').read_text().split()
        self.run_program('convert', ROD / 'rod.stl', '--labels', 'labels.txt', '-o', 'no.k', code=3) if len(labels) == 3 else None
        self.run_program('convert', ROD / 'rod_patches.k', '-o', 'plain.off')
        self.run_program('convert', 'plain.off', '--labels', 'labels.txt', '-o', 'labelled.k')
        self.run_program('convert', 'labelled.k', '-o', 'again.txt')
        self.assertEqual(labels, (self.folder / 'again.txt').read_text().split())
        (self.folder / 'short.txt').write_text('1\n2\n')
        message = self.run_program('convert', 'plain.off', '--labels', 'short.txt', '-o', 'no.k', code=3).stderr
        self.assertIn('short.txt', message)
        self.assertFalse((self.folder / 'no.k').exists())

    @unittest.skipIf(meshio is None, 'no meshio')
    def test_meshio_reads_what_we_write(self):
        self.make_mesh()
        expected = meshio.read(self.folder / 'a.vtk')
        cells = expected.cells_dict['hexahedron']
        parts = np.ravel(expected.cell_data['part_id'][0])
        self.assertGreater(len(set(parts)), 1)
        for name in ('b.inp', 'b.msh', 'b.msh2'):
            self.run_program('convert', 'a.vtk', '-o', name)
            mesh = meshio.read(self.folder / name, file_format='abaqus' if name == 'b.inp' else 'gmsh')
            self.assertTrue((mesh.points == expected.points).all(), name)
            if name == 'b.inp':
                self.assertTrue((mesh.cells_dict['hexahedron'] == cells).all(), name)
                for part in set(parts):
                    members = mesh.cell_sets[f'PART_{part}'][0]
                    self.assertEqual(list(members), list(np.flatnonzero(parts == part)))
            else:
                # Part by part in version 4.1.
                order = np.argsort(parts, kind='stable') if name == 'b.msh' else np.arange(len(parts))
                found = np.concatenate([block.data for block in mesh.cells])
                self.assertTrue((found == cells[order]).all(), name)
                self.assertTrue((np.concatenate(mesh.cell_data['gmsh:physical']) == parts[order]).all(), name)

    @unittest.skipIf(meshio is None, 'no meshio')
    def test_we_read_what_meshio_writes(self):
        self.make_mesh()
        mesh = meshio.read(self.folder / 'a.vtk')
        bare = meshio.Mesh(mesh.points, [('hexahedron', mesh.cells_dict['hexahedron'])])
        meshio.write(self.folder / 'm.inp', bare, file_format='abaqus')
        meshio.write(self.folder / 'm2.msh', bare, file_format='gmsh22', binary=False)
        meshio.write(self.folder / 'm4.msh', bare, file_format='gmsh', binary=False)
        meshio.write(self.folder / 'b2.msh', bare, file_format='gmsh22', binary=True)
        meshio.write(self.folder / 'b4.msh', bare, file_format='gmsh', binary=True)
        for name in ('m.inp', 'm2.msh', 'm4.msh', 'b2.msh', 'b4.msh'):
            self.run_program('convert', name, '-o', 'back.vtu')
            back = meshio.read(self.folder / 'back.vtu')
            self.assertTrue((back.cells_dict['hexahedron'] == mesh.cells_dict['hexahedron']).all(), name)
            self.assertLess(abs(back.points - mesh.points).max(), 1e-12, name)

    @unittest.skipIf(shutil.which('gmsh') is None, 'no gmsh')
    def test_gmsh_reads_what_we_write_and_we_read_what_it_writes(self):
        (self.folder / 'part.inp').write_text(ABAQUS)
        self.run_program('convert', 'part.inp', '-o', 'part.vtk')
        for ours in ('part.msh', 'part.msh2'):
            self.run_program('convert', 'part.inp', '-o', ours)
            for version in ('msh22', 'msh41'):
                for encoding in ([], ['-bin']):
                    with self.subTest(file=ours, version=version, encoding=encoding):
                        theirs = self.folder / 'theirs.msh'
                        done = subprocess.run(['gmsh', ours, '-save', '-format', version, *encoding, '-o', theirs.name], cwd=self.folder,
                                              stdin=subprocess.DEVNULL, capture_output=True, text=True)
                        self.assertEqual(done.returncode, 0, done.stdout)
                        self.assertNotIn('Error', done.stdout + done.stderr)
                        self.assertIn(b'Upper', theirs.read_bytes())
                        self.run_program('convert', theirs.name, '-o', 'back.vtk')
                        self.assertEqual(self.vtk_text('part.vtk'), self.vtk_text('back.vtk'))
                        self.run_program('convert', theirs.name, '-o', 'back.inp')
                        self.assertIn('ELSET=lower', (self.folder / 'back.inp').read_text())
                        theirs.unlink()

    @unittest.skipIf(shutil.which('gmsh') is None, 'no gmsh')
    def test_part_ids_of_a_mesh_that_gmsh_cuts_into_partitions(self):
        self.make_mesh()
        self.run_program('convert', 'a.vtk', '-o', 'a.msh')
        for version in ('msh22', 'msh41'):
            for encoding in ([], ['-bin']):
                with self.subTest(version=version, encoding=encoding):
                    cut = self.folder / 'cut.msh'
                    cut.unlink(missing_ok=True)
                    # Its exit code is that of an earlier, empty step.
                    subprocess.run(['gmsh', 'a.msh', '-part', '2', '-save', '-format', version, *encoding, '-o', cut.name], cwd=self.folder,
                                   stdin=subprocess.DEVNULL, capture_output=True)
                    self.assertEqual(version == 'msh41', b'$PartitionedEntities' in cut.read_bytes())
                    told = self.run_program('convert', 'cut.msh', '-o', 'back.vtk').stderr
                    self.assertNotIn('renumbered', told)
                    # The order of the points is another.
                    parts = [self.vtk_text(name).split('CELL_DATA')[1] for name in ('a.vtk', 'back.vtk')]
                    self.assertEqual(*parts)

    def test_mfem_and_open_volume_mesh_say_what_their_formats_demand(self):
        (self.folder / 'part.inp').write_text(ABAQUS)
        self.run_program('convert', 'part.inp', '-o', 'part.mfem')
        words = (self.folder / 'part.mfem').read_text().split()
        at = words.index('elements')
        self.assertEqual(words[at + 1:at + 12], '2 1 5 0 1 2 3 4 5 6 7'.split())
        self.run_program('convert', 'part.mfem', '-o', 'part.mesh')
        (self.folder / 'other.mesh').write_text((self.folder / 'part.mfem').read_text())
        self.run_program('convert', 'other.mesh', '-o', 'other.vtk')
        self.run_program('convert', 'part.inp', '-o', 'part.ovm')
        lines = (self.folder / 'part.ovm').read_text().splitlines()
        section = lambda name: (lines.index(name) + 2, int(lines[lines.index(name) + 1]))
        start, count = section('Edges')
        edges = [tuple(map(int, line.split())) for line in lines[start:start + count]]
        self.assertEqual(len(set(edges)), 20)
        start, count = section('Faces')
        self.assertEqual(count, 11)
        for line in lines[start:start + count]:
            sides = [edges[int(h) // 2][::-1 if int(h) % 2 else 1] for h in line.split()[1:]]
            self.assertEqual([s[1] for s in sides], [s[0] for s in sides[1:] + sides[:1]], 'a closed loop')
        start, count = section('Polyhedra')
        used = [h for line in lines[start:start + count] for h in line.split()[1:]]
        self.assertEqual(len(used), len(set(used)), 'each half-face has one cell')


if __name__ == '__main__':
    unittest.main()
