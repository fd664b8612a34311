#!/usr/bin/env python3
"""The sample runs that `hexspline SUBCOMMAND --help` shows do what they promise.

    sample_runs_test.py HEXSPLINE DATA

They run as printed, in one folder with the sample rod under the names that they use, in the order of the chain.
"""
import re
import shlex
import shutil
import subprocess
import unittest
from pathlib import Path

from program import DATA, PROGRAM, ROD, CommandTest

ORDER = ('segment', 'polycube', 'map', 'improve', 'spline', 'check', 'run', 'convert', 'plugins')
COPIES = {'rod.stl': ('part.stl', 'rod.stl'), 'rod_tri.k': ('rod_tri.k', 'part_tri.k'),
          'rod_patches.k': ('part_patches.k', 'rod_patches.k', 'rod_initial_read.k'),
          'rod_blocks.k': ('part_blocks.k', 'rod_blocks.k', 'rod_polycube_structure_hex.k')}
# Left out of a build without plug-ins.
PLUGIN = Path(PROGRAM).parent.parent / 'plugins' / 'axis_segmenter.so'


class SampleRuns(CommandTest):
    def samples(self, command):
        text = self.run_program(command, '--help').stdout
        block = re.search(r'^Sample runs:\n((?:  .*\n)+)', text, re.M)
        self.assertIsNotNone(block, f'{command} shows no sample runs')
        return [line.strip() for line in block[1].splitlines()]

    def restore(self):
        for source, names in COPIES.items():
            for name in names:
                shutil.copy(ROD / source, self.folder / name)
        shutil.copy(DATA / 'angle' / 'angle.step', self.folder / 'part.step')
        if PLUGIN.exists():
            shutil.copy(PLUGIN, self.folder)

    def test_every_sample_run(self):
        self.restore()
        self.run_program('convert', 'part.stl', '-o', 'labels.txt')
        (self.folder / 'rod_manual.txt').write_text('')
        (self.folder / 'sharp.txt').write_text('0 0\n0 1\n')
        (self.folder / 'lev_rfid.txt').write_text('0 0\n')
        # One triangle keeps the label it has anyway.
        self.run_program('segment', '-i', 'rod_tri.k', '-o', 'rod_initial_write.k', '--method', 'cvt', '--labels', 'now.txt')
        (self.folder / 'rod_manual.txt').write_text(f"0 {(self.folder / 'now.txt').read_text().split()[0]}\n")
        self.run_program('map', 'part_patches.k', '-p', 'part_blocks.k', '-s', '1', '-o', 'part.vtk')
        for name in ('part_hex.vtk', 'rod_hex.vtk'):
            shutil.copy(self.folder / 'part.vtk', self.folder / name)
        self.run_program('spline', 'part.vtk', '-o', 'part.bext')
        count = 0
        for command in ORDER:
            for sample in self.samples(command):
                program, *words = shlex.split(sample)
                self.assertEqual((program, words[0]), ('hexspline', command))
                if PLUGIN.name in words and not PLUGIN.exists():
                    continue
                with self.subTest(sample=sample):
                    self.run_sample(words)
                    count += 1
                # Earlier samples write over what later ones read.
                self.restore()
        self.assertGreater(count, 20)

    def run_sample(self, words):
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=900)
        # A mesh that is not good enough for a profile is a proper answer of check.
        self.assertIn(done.returncode, (0, 1) if words[0] == 'check' else (0,), done.stderr)


if __name__ == '__main__':
    unittest.main()
