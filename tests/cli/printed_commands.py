"""What the tests of printed commands share: how they are found in a text, the parts of data/ under the names that they use, and how one runs.
"""
import re
import shlex
import shutil
import subprocess
from pathlib import Path

from program import DATA, PROGRAM, ROD

COPIES = {'rod.stl': ('part.stl', 'rod.stl'), 'rod_tri.k': ('rod_tri.k', 'part_tri.k'),
          'rod_patches.k': ('part_patches.k', 'rod_patches.k', 'rod_initial_read.k'),
          'rod_blocks.k': ('part_blocks.k', 'rod_blocks.k', 'rod_polycube_structure_hex.k')}
# Left out of a build without plug-ins.
PLUGIN = Path(PROGRAM).parent.parent / 'plugins' / 'axis_segmenter.so'


def code_block(page, language, beginning):
    """The fenced block of a page that holds a text."""
    found = [text for text in re.findall(rf'^```{language}\n(.*?)^```$', page, re.M | re.S) if beginning in text]
    assert len(found) == 1, (language, beginning, len(found))
    return found[0]


def samples(run_program, command):
    """What `hexspline COMMAND --help` shows as sample runs, each as its words."""
    text = run_program(command, '--help').stdout
    block = re.search(r'^Sample runs:\n((?:  .*\n)+)', text, re.M)
    assert block is not None, f'{command} shows no sample runs'
    return [words_of(line) for line in block[1].splitlines()]


def words_of(line):
    """The words of a command without its comment, the program first."""
    return shlex.split(line, comments=True)


def printed_commands(page):
    """The calls of the program in the code of a page, indented or fenced, each as its words."""
    shell = re.sub(r'^```(?:bash|sh|console)\n(.*?)^```$', lambda block: re.sub('^', ' ' * 4, block[1], flags=re.M), page,
                   flags=re.M | re.S)
    return [words_of(line) for line in re.findall(r'^ {4}(?:\$ )?(hexspline [a-z]+(?: .*)?)$', shell, re.M)]


def copy_parts(folder):
    """The sample rod and a STEP file under the names that the commands use."""
    for source, names in COPIES.items():
        for name in names:
            shutil.copy(ROD / source, folder / name)
    shutil.copy(DATA / 'angle' / 'angle.step', folder / 'part.step')
    if PLUGIN.exists():
        shutil.copy(PLUGIN, folder)


def copy_mesh(folder):
    """The small mesh of make_inputs() under its other names."""
    for name in ('part_hex.vtk', 'rod_hex.vtk', 'rod.vtk'):
        shutil.copy(folder / 'part.vtk', folder / name)


def make_inputs(folder, run_program):
    """copy_parts(), and what commands read that others write."""
    copy_parts(folder)
    (folder / 'sharp.txt').write_text('0 0\n0 1\n')
    (folder / 'lev_rfid.txt').write_text('0 0\n')
    # One triangle keeps the label it has anyway.
    run_program('segment', '-i', 'rod_tri.k', '-o', 'rod_initial_write.k', '--method', 'cvt', '--labels', 'now.txt')
    (folder / 'rod_manual.txt').write_text(f"0 {(folder / 'now.txt').read_text().split()[0]}\n")
    run_program('segment', '-i', 'part.stl', '-o', 'part_segment.k')
    run_program('convert', 'part.stl', '-o', 'labels.txt')
    run_program('map', 'part_patches.k', '-p', 'part_blocks.k', '-s', '1', '-o', 'part.vtk')
    copy_mesh(folder)
    run_program('spline', 'part.vtk', '-o', 'part.bext')


def run_printed(test, words, folder):
    """Runs a command as printed. A mesh that is not good enough for a profile is a proper answer of check."""
    done = subprocess.run([PROGRAM, *words[1:]], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=900)
    test.assertIn(done.returncode, (0, 1) if words[1] == 'check' else (0,), f'{shlex.join(words)}\n{done.stderr}')
    return done
