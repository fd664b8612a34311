#!/usr/bin/env python3
"""The program against everything around it: odd files, full disks, little memory, being stopped.

    robustness_test.py HEXSPLINE DATA
"""
import os
import resource
import signal
import subprocess
import time
import unittest
from pathlib import Path

from hex_files import grid, write_vtk
from program import DATA, PROGRAM, ROD, CommandTest


class Robustness(CommandTest):
    def one_line(self, *arguments, code, **options):
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=60, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(': error: ', done.stderr)
        return done.stderr

    def locale(self, name):
        """The environment of a locale; one with a decimal comma is made here, for no machine need have it."""
        environment = {'LC_ALL': name, 'LC_NUMERIC': name}
        if name == 'de_DE.UTF-8':
            folder = self.folder / 'locales'
            folder.mkdir()
            subprocess.run(['localedef', '-i', 'de_DE', '-f', 'UTF-8', folder / name], check=True, capture_output=True)
            environment['LOCPATH'] = str(folder)
            comma = subprocess.run(['/usr/bin/printf', '%.1f', '1,5'], env=environment, capture_output=True, text=True)
            self.assertEqual(comma.stdout, '1,5')
        return environment

    def left_over(self):
        return [path.name for path in self.folder.rglob('*') if '.part-' in path.name]

    def test_what_is_no_file_as_input(self):
        os.mkfifo(self.folder / 'pipe.vtk')
        for odd in ('pipe.vtk', '.', 'missing.vtk', '/dev/null', '/dev/zero'):
            for command in (['check'], ['convert', '-o', 'out.vtk'], ['improve', '-o', 'out.vtk'], ['segment', '-o', 'out.k']):
                self.one_line(*command, '-i', odd, code=3)
        self.assertFalse((self.folder / 'out.vtk').exists())

    def test_what_is_no_file_as_a_second_input(self):
        os.mkfifo(self.folder / 'pipe.txt')
        os.symlink('loop', self.folder / 'loop')
        (self.folder / 'empty.txt').touch()
        blocks = ROD / 'rod_blocks.k'
        commands = {'features': ['improve', blocks, '-o', 'out.vtk', '-n', '1', '--features'],
                    'near': ['spline', blocks, '-o', 'out.bext', '--refine'], 'baseline': ['check', blocks, '--baseline'],
                    'config': ['check', blocks, '--config'], 'plugin': ['plugins', '--plugin']}
        for name, command in commands.items():
            for odd in ('pipe.txt', '.', 'missing', 'loop', 'n' * 300, 'empty.txt', '/dev/null', '/dev/zero', '/proc/self/mem'):
                with self.subTest(option=name, file=odd[:20]):
                    self.one_line(*command, 'near:' + odd if name == 'near' else odd, code=3)
        self.assertFalse((self.folder / 'out.vtk').exists() or (self.folder / 'out.bext').exists())

    def test_a_spline_file_that_is_no_file(self):
        os.mkfifo(self.folder / 'pipe.bext')
        os.symlink('/dev/zero', self.folder / 'zero.bext')
        for odd in ('pipe.bext', 'zero.bext'):
            self.one_line('check', odd, code=3)

    def test_the_report_of_an_earlier_run_that_is_no_file(self):
        (self.folder / 'out').mkdir()
        os.mkfifo(self.folder / 'out/report.json')
        self.assertIn('report.json', self.one_line('run', ROD / 'rod.stl', '-o', 'out', '--from', 'polycube', code=3))

    def test_lists_of_other_systems_are_read(self):
        write_vtk(self.folder / 'cube.vtk', *grid(2, 2, 2))
        improve, spline = ['improve', 'cube.vtk', '-o', 'out.vtk', '--features'], ['spline', 'cube.vtk', '-o', 'out.bext', '--refine']
        for head, end in (('', '\n'), ('\xef\xbb\xbf', '\r\n')):
            for text, command, prefix in ((f'0 1{end}1 2{end}', improve, ''), (f'0.2 0.2 0.2{end}', spline, 'near:'), (f'0{end}{end}', spline, 'near:')):
                (self.folder / 'list.txt').write_bytes((head + text).encode('latin-1'))
                self.run_program(*command, prefix + 'list.txt')

    def test_values_in_lists_that_do_not_fit(self):
        write_vtk(self.folder / 'cube.vtk', *grid(2, 2, 2))
        improve, spline = ['improve', 'cube.vtk', '-o', 'out.vtk', '--features'], ['spline', 'cube.vtk', '-o', 'out.bext', '--refine']
        for text, command, place, words in (
                ('0\n4294967296\n', spline, 'list.txt:2: ', '4294967296'), ('0\n\n7\n', spline, 'list.txt:3: ', 'no patch 7'),
                ('0 0 nan\n', spline, 'list.txt:1: ', 'nan'), ('0 1\n1\n', improve, 'list.txt:2: ', 'two vertices'),
                ('0 1 2\n', improve, 'list.txt:1: ', 'two vertices'), ('0 -1\n', improve, 'list.txt:1: ', 'negative'),
                ('0 4294967297\n', improve, 'list.txt: ', '4294967297'), ('# none\n\n', improve, 'list.txt: ', 'lists no edge')):
            with self.subTest(text=text):
                (self.folder / 'list.txt').write_text(text)
                message = self.one_line(*command, 'near:list.txt' if command is spline else 'list.txt', code=3)
                self.assertIn(place, message)
                self.assertIn(words, message)

    def test_outputs_that_cannot_be_written(self):
        self.one_line('convert', ROD / 'rod_tri.k', '-o', 'missing/folder/out.stl', code=5)
        (self.folder / 'folder.off').mkdir()
        self.one_line('convert', ROD / 'rod_tri.k', '-o', 'folder.off', code=5)
        os.symlink('/dev/full', self.folder / 'full.off')
        self.one_line('convert', ROD / 'rod_tri.k', '-o', 'full.off', code=5)
        message = self.one_line('check', ROD / 'rod_blocks.k', '--min-scaled-jacobian', '-1', '--json', '/dev/full', code=5)
        self.assertIn('/dev/full', message)
        self.one_line('map', ROD / 'rod_patches.k', '-p', ROD / 'rod_blocks.k', '-o', 'full.off', '-s', '0', code=3)

    def test_results_that_cannot_be_printed(self):
        with open('/dev/full', 'w') as full:
            done = subprocess.run([PROGRAM, 'plugins', '--json', '-'], stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 5, done.stderr)

    @unittest.skipUnless(os.path.isdir('/proc/self'), 'no file system in which not even root may write')
    def test_a_file_system_that_is_read_only(self):
        for command in (['convert', ROD / 'rod_tri.k', '-o', '/proc/out.off'], ['segment', ROD / 'rod_tri.k', '-o', '/proc/out.k'],
                        ['check', ROD / 'rod_blocks.k', '--min-scaled-jacobian', '-1', '--vtu', '/proc/out.vtu'],
                        ['run', ROD / 'rod_tri.k', '-o', '/proc/out']):
            self.assertIn('/proc/out', self.one_line(*command, code=5))

    @unittest.skipIf(os.geteuid() == 0, 'root may write everywhere')
    def test_a_folder_that_is_read_only(self):
        (self.folder / 'locked').mkdir()
        (self.folder / 'locked').chmod(0o500)
        self.one_line('convert', ROD / 'rod_tri.k', '-o', 'locked/out.off', code=5)

    def test_a_disk_that_is_full_keeps_the_old_file(self):
        (self.folder / 'out.off').write_text('the old one')

        self.one_line('convert', ROD / 'rod_tri.k', '-o', 'out.off', code=5,
                      preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)))
        self.assertEqual((self.folder / 'out.off').read_text(), 'the old one')
        self.assertEqual(self.left_over(), [])

    def test_a_small_disk_of_its_own_that_fills_up(self):
        """A real file system with room for an old file and not for a new one."""
        in_namespace = ['unshare', '--mount', '--map-root-user', 'sh', '-euc']
        mount = 'mount -t tmpfs -o size=64k tmpfs disk'
        (self.folder / 'disk').mkdir()
        if subprocess.run([*in_namespace, mount], cwd=self.folder, capture_output=True).returncode != 0:
            self.skipTest('no file system may be mounted here')
        script = mount + """
            echo 'the old one' > disk/out.off
            code=0
            "$1" convert "$2" -o disk/out.off || code=$?
            [ "$(cat disk/out.off)" = 'the old one' ]
            [ "$(ls -A disk)" = out.off ]
            exit $code"""
        done = subprocess.run([*in_namespace, script, 'sh', PROGRAM, ROD / 'rod_tri.k'], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn('No space left on device', done.stderr)

    def test_too_little_memory_is_said_to_be_so(self):
        write_vtk(self.folder / 'grid.vtk', *grid(40, 40, 40))
        codes = []
        # From what the loader of the libraries needs on; without --threads the threads of oneTBB want memory, too.
        for megabytes, *threads in [[m] for m in range(80, 116, 3)] + [[m, '--threads', '1'] for m in range(80, 260, 10)]:
            limit = megabytes << 20
            done = subprocess.run([PROGRAM, 'check', 'grid.vtk', *threads], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True,
                                  text=True, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            if done.returncode == 127:  # the loader's
                continue
            codes.append(done.returncode)
            with self.subTest(megabytes=megabytes, threads=threads):
                self.assertIn(done.returncode, (0, 5), done.stderr)
                if done.returncode == 5:
                    self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                    self.assertIn('memory', done.stderr)
        self.assertGreater(len(codes), 0)

    def test_no_thread_can_be_started(self):
        def as_nobody():
            if os.geteuid() == 0:  # whom no limit of processes holds
                os.setgroups([])
                os.setgid(65534)
                os.setuid(65534)

        def without_threads():
            as_nobody()
            resource.setrlimit(resource.RLIMIT_NPROC, (0, 0))

        try:
            subprocess.run([PROGRAM, '--version'], stdout=subprocess.DEVNULL, preexec_fn=as_nobody, check=True)
        except OSError:
            self.skipTest('nobody may run the program')
        for command in (['check', ROD / 'rod_blocks.k'], ['plugins'], ['--version']):
            self.assertIn('threads', self.one_line(*command, code=5, preexec_fn=without_threads))

    def test_killed_while_writing_the_old_file_stays_whole(self):
        write_vtk(self.folder / 'grid.vtk', *grid(60, 60, 60))
        self.run_program('convert', 'grid.vtk', '-o', 'out.k')
        whole = (self.folder / 'out.k').read_bytes()
        unfinished = 0
        for delay in (0.0, 0.01, 0.02, 0.05):
            process = subprocess.Popen([PROGRAM, 'convert', 'grid.vtk', '-o', 'out.k'], cwd=self.folder)
            while not self.left_over() and process.poll() is None:
                time.sleep(0.001)
            time.sleep(delay)  # since it began to write
            process.kill()
            process.wait()
            self.assertEqual((self.folder / 'out.k').read_bytes(), whole)
            for name in self.left_over():
                unfinished += 0 < (self.folder / name).stat().st_size < len(whole)
                (self.folder / name).unlink()
        self.assertGreater(unfinished, 0)  # it was killed while writing

    def interrupt(self, arguments, after):
        """The message of a program that is interrupted after so many seconds, and how long it took to stop."""
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        time.sleep(after)
        process.send_signal(signal.SIGINT)
        began = time.monotonic()
        _, message = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, message)
        self.assertRegex(message, r'error: (.*: )?interrupted')
        return time.monotonic() - began

    def test_interrupted_it_stops_within_a_second_and_leaves_nothing(self):
        self.run_program('map', ROD / 'rod_patches.k', '-p', ROD / 'rod_blocks.k', '-s', '4', '-o', 'rod.vtk')
        for after, *command in ((1, 'improve', '-m', 'optimize', '-n', '1000000'), (0.6, 'spline', '-g', '1'),
                                (2, 'spline', '-g', '1'), (4, 'spline', '-g', '1', '--format', 'bext2')):
            output = 'out.bext' if command[0] == 'spline' else 'out.vtu'
            with self.subTest(command=command, after=after):
                taken = self.interrupt([*command, '-i', 'rod.vtk', '-o', output], after)
                # A busy machine has other things to do.
                busy = os.getloadavg()[0] / os.cpu_count()
                self.assertLess(taken, max(1.0, 2 * busy))
                self.assertFalse((self.folder / output).exists())
                self.assertEqual(self.left_over(), [])

    def test_interrupted_while_it_writes_it_says_so(self):
        write_vtk(self.folder / 'grid.vtk', *grid(60, 60, 60))
        process = subprocess.Popen([PROGRAM, 'convert', 'grid.vtk', '-o', 'out.vtk'], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not self.left_over():
            pass
        process.send_signal(signal.SIGINT)
        _, message = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, message)
        self.assertEqual(message, 'hexspline convert: error: interrupted\n')
        self.assertEqual(self.left_over(), [])
        if (self.folder / 'out.vtk').exists():
            self.run_program('check', 'out.vtk')

    def test_interrupted_auto_writes_the_best_mesh_until_then(self):
        self.run_program('map', ROD / 'rod_patches.k', '-p', ROD / 'rod_blocks.k', '-s', '3', '-o', 'rod.vtk')
        process = subprocess.Popen([PROGRAM, 'improve', 'rod.vtk', '-o', 'out.vtk'], cwd=self.folder,
                                   stderr=subprocess.PIPE, text=True)
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        _, message = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, message)
        self.assertIn('the best mesh found until then was written', message)
        self.assertEqual(self.left_over(), [])
        self.run_program('check', 'out.vtk')

    def test_names_with_blanks_and_umlauts_and_other_locales(self):
        odd = self.folder / 'Größe der Näbe, 1'
        odd.mkdir()
        source, target = odd / 'ein Würfel.off', odd / "it's done.inp"
        self.run_program('convert', ROD / 'rod_tri.k', '-o', source)
        plain = source.read_text()
        self.run_program('convert', DATA / 'angle' / 'angle.step', '-o', 'angle.off')
        for locale in ('C', 'C.UTF-8', 'de_DE.UTF-8', 'no_such'):
            environment = {**os.environ, **self.locale(locale)}
            for name in (source, DATA / 'angle' / 'angle.step'):
                done = subprocess.run([PROGRAM, 'convert', name, '-o', target], env=environment, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.run_program('convert', target, '-o', odd / 'again.off')
                expected = plain if name == source else (self.folder / 'angle.off').read_text()
                self.assertEqual((odd / 'again.off').read_text(), expected)
        long_name = odd / ('n' * 251 + '.off')
        self.run_program('convert', source, '-o', long_name)
        self.assertEqual(long_name.read_text(), plain)

    def test_line_ends_and_byte_order_marks_of_other_systems(self):
        for name in ('a.off', 'a.k', 'a.vtk', 'a.inp', 'a.msh', 'a.obj', 'a.mesh', 'a.mfem', 'a.ovm', 'a.ply', 'a.stl'):
            self.run_program('convert', ROD / 'rod_tri.k', '-o', name)
            self.run_program('convert', name, '-o', 'expected.off')
            data = (self.folder / name).read_bytes()
            (self.folder / name).write_bytes(b'\xef\xbb\xbf' + data.replace(b'\n', b'\r\n'))
            self.run_program('convert', name, '-o', 'found.off')
            self.assertEqual((self.folder / 'found.off').read_text(), (self.folder / 'expected.off').read_text(), name)

    def test_counts_that_no_file_can_hold(self):
        head = '# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n'
        for name, text in {'points.vtk': head + 'POINTS 999999999999 double\n0 0 0\n',
                           'cells.vtk': head + 'POINTS 1 double\n0 0 0\nCELLS 9223372036854775807 9223372036854775807\n',
                           'overflow.vtk': head + 'POINTS 99999999999999999999999 double\n0 0 0\n',
                           'nan.off': 'OFF\n3 1 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n',
                           'nodes.msh': '$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4000000000 1 1\n3 1 0 4000000000\n1\n0 0 0\n',
                           'cubes.mfem': 'MFEM mesh v1.0\ndimension\n3\nelements\n4000000000\n',
                           'edges.ovm': 'OVM ASCII\nVertices\n1\n0 0 0\nEdges\n4000000000\n'}.items():
            (self.folder / name).write_text(text)
            message = self.one_line('convert', name, '-o', 'out.k', code=3,
                                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30)))
            self.assertRegex(message, name + r':\d+: ')


if __name__ == '__main__':
    unittest.main()
