#!/usr/bin/env python3
"""The examples of docs/ci.md do what the page says: the step of the hosted build, both hooks, and the configuration file.

    ci_examples_test.py HEXSPLINE DATA
"""
import functools
import json
import os
import re
import shutil
import subprocess
import textwrap
import unittest
import xml.etree.ElementTree as xml

from printed_commands import code_block
from program import DATA, PROGRAM, ROD, CommandTest

block = functools.partial(code_block, (DATA.parent / 'docs/ci.md').read_text())


class Examples(CommandTest):
    def setUp(self):
        super().setUp()
        (self.folder / 'bin').mkdir()
        os.symlink(PROGRAM, self.folder / 'bin' / 'hexspline')
        self.environment = {**os.environ, 'PATH': f"{self.folder / 'bin'}:{os.environ['PATH']}", 'HOME': str(self.folder),
                            'GITHUB_STEP_SUMMARY': str(self.folder / 'summary.md'), 'GIT_CONFIG_NOSYSTEM': '1'}
        (self.folder / 'meshes').mkdir()
        self.run_program('map', ROD / 'rod_patches.k', '-p', ROD / 'rod_blocks.k', '-s', 1, '-o', 'rough.vtk')
        self.run_program('improve', 'rough.vtk', '-o', 'meshes/good.vtk')
        # One vertex pulled through its elements.
        lines = (self.folder / 'meshes' / 'good.vtk').read_text().splitlines()
        at = next(i for i, line in enumerate(lines) if line.startswith('POINTS'))
        lines[at + 1] = '100 100 100'
        self.bad = '\n'.join(lines) + '\n'
        shutil.copy(ROD / 'rod.stl', self.folder / 'part.stl')

    def bash(self, script, code=None, arguments=()):
        done = subprocess.run(['bash', '-e', '-c', script, 'bash', *arguments], cwd=self.folder, env=self.environment,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if code is not None:
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def configuration(self, **changes):
        (self.folder / 'check.json').write_text(json.dumps({'metrics': {'scaled_jacobian': {'min': 0.1}}, **changes}))

    def test_the_step_of_the_hosted_build(self):
        workflow = block('yaml', 'name: meshes')
        step = textwrap.dedent(re.search(r'- name: check\n\s+run: \|\n(.*?)^      - uses', workflow, re.M | re.S)[1])
        self.configuration()
        self.bash(step, 0)
        (self.folder / 'meshes' / 'bad.vtk').write_text(self.bad)
        self.bash(step, 1)
        out = self.folder / 'out'
        self.assertEqual(sorted(path.name for path in out.iterdir()),
                         [f'{name}.{kind}' for name in ('bad', 'good') for kind in ('json', 'md', 'sarif', 'vtu', 'xml')])
        self.assertEqual(xml.parse(out / 'good.xml').getroot().get('failures'), '0')
        self.assertNotEqual(xml.parse(out / 'bad.xml').getroot().get('failures'), '0')
        runs = [json.loads((out / f'{name}.sarif').read_text())['runs'][0] for name in ('bad', 'good')]
        self.assertGreater(len(runs[0]['results']), 0)
        self.assertEqual(runs[1]['results'], [])
        self.assertIn('bad.vtk', (self.folder / 'summary.md').read_text())

    def test_the_configuration_file(self):
        (self.folder / 'check.json').write_text(block('json', 'profile'))
        done = self.bash('hexspline check meshes/good.vtk --config check.json', None)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        for word in ('scaled_jacobian', 'aspect_ratio', 'skew', 'duplicate', 'surface'):
            self.assertIn(word, done.stdout)

    def test_the_entry_of_pre_commit(self):
        entry = re.search(r"entry: bash -c '(.*)' --$", block('yaml', 'repos:'), re.M)[1]
        self.configuration()
        self.bash(entry, 0, ['meshes/good.vtk'])
        (self.folder / 'meshes' / 'bad.vtk').write_text(self.bad)
        self.bash(entry, 1, ['meshes/good.vtk', 'meshes/bad.vtk'])

    def test_the_hook_of_git(self):
        self.repository()
        self.bash('git add meshes/good.vtk && git commit -q -m good', 0)
        (self.folder / 'meshes' / 'bad.vtk').write_text(self.bad)
        self.refused('git add meshes/bad.vtk')
        self.assertEqual(self.bash('git log --format=%s', 0).stdout, 'good\n')

    def test_the_hook_of_git_checks_what_is_committed(self):
        self.repository()
        mesh = self.folder / 'meshes' / 'good.vtk'
        good = mesh.read_text()
        self.bash('git add meshes/good.vtk', 0)
        mesh.write_text(self.bad)
        self.bash('git commit -q -m good', 0)
        self.bash('git add meshes/good.vtk', 0)
        mesh.write_text(good)
        self.refused('true')
        # The commit that takes the working folder.
        self.bash('git commit -q -a --allow-empty -m same', 0)
        mesh.write_text(self.bad)
        self.assertNotEqual(self.bash('git commit -q -a -m bad').returncode, 0)

    def test_the_hook_of_git_checks_renamed_and_copied_files_of_any_name(self):
        self.repository()
        good = (self.folder / 'meshes' / 'good.vtk').read_text()
        names = ['two words.vtk', "quo'te \"s\".vtk", 'line\nbreak.vtk', 'Gr\u00f6\u00dfe.vtk', '-dash.vtk', 'deep/er/$(false) *.vtk']
        (self.folder / 'meshes' / 'deep' / 'er').mkdir(parents=True)
        for name in names:
            (self.folder / 'meshes' / name).write_text(good)
        self.bash('git config diff.renames copies && git add meshes && git commit -q -m good', 0)
        for name in names:
            (self.folder / 'meshes' / name).write_text(self.bad)
            self.refused('git add meshes')
            (self.folder / 'meshes' / name).write_text(good)
            self.bash('git add meshes', 0)
        # One line of many is another one: git takes the file for a renamed one.
        self.bash('git mv meshes/good.vtk meshes/renamed.vtk', 0)
        (self.folder / 'meshes' / 'renamed.vtk').write_text(self.bad)
        self.bash('git add meshes', 0)
        self.assertIn('R', self.bash('git diff --cached --name-status -M', 0).stdout)
        self.refused('true')
        self.bash('git rm -q -f meshes/renamed.vtk && git commit -q -m removed', 0)

    def repository(self):
        """With the hook, and a folder for temporary files in which nothing is to be left."""
        self.bash('git init -q . && git config user.name a && git config user.email a@example.org', 0)
        (self.folder / 'temporary').mkdir()
        self.environment['TMPDIR'] = str(self.folder / 'temporary')
        hook = self.folder / '.git' / 'hooks' / 'pre-commit'
        hook.write_text(block('bash', 'git diff --cached'))
        hook.chmod(0o755)
        # The profile asks more than this mesh has; another one keeps to what the test wants to see.
        hook.write_text(hook.read_text().replace('--profile ls-dyna', '--min-scaled-jacobian 0.1'))

    def refused(self, script):
        """A commit after `script`, for the elements of a mesh."""
        self.bash(script, 0)
        commit = self.bash('git commit -q -m bad')
        self.assertEqual(commit.returncode, 1, commit.stderr)
        self.assertIn('scaled_jacobian', commit.stderr)
        self.assertEqual(list((self.folder / 'temporary').iterdir()), [])


if __name__ == '__main__':
    unittest.main()
