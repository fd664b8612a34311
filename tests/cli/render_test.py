#!/usr/bin/env python3
"""tools/render draws what we write, without a display.

    render_test.py RENDER DATA_FOLDER
"""
import os
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

DATA = Path(sys.argv.pop())
RENDER = sys.argv.pop()


def draw(source, *options):
    """Width, height and rows of pixels of the picture."""
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / 'picture.png'
        environment = {k: v for k, v in os.environ.items() if k != 'DISPLAY'}
        subprocess.run([sys.executable, RENDER, str(source), '-o', str(picture), '--size', '200x150', *options], check=True,
                       env=environment)
        data = picture.read_bytes()
    assert data.startswith(b'\x89PNG\r\n\x1a\n')
    width, height = struct.unpack('>II', data[16:24])
    length = struct.unpack('>I', data[33:37])[0]
    raw = zlib.decompress(data[41:41 + length])
    return width, height, [raw[y * (3 * width + 1) + 1:(y + 1) * (3 * width + 1)] for y in range(height)]


def share_drawn(rows):
    pixels = b''.join(rows)
    return sum(pixels[i:i + 3] != b'\xff\xff\xff' for i in range(0, len(pixels), 3)) / (len(pixels) / 3)


class Render(unittest.TestCase):
    def test_surfaces_blocks_and_stl_fill_a_good_part_of_the_picture(self):
        for name in ('rod/rod_patches.k', 'bracket/bracket_blocks.k', 'blob/blob.stl'):
            with self.subTest(name=name):
                width, height, rows = draw(DATA / name)
                self.assertEqual((width, height), (200, 150))
                self.assertGreater(share_drawn(rows), 0.15)
                self.assertLess(share_drawn(rows), 0.95)

    def test_a_hole_can_be_looked_through(self):
        _, _, rows = draw(DATA / 'bracket/bracket_tri.k', '--view=-90,90', '--no-edges')
        # Seen from above: the row through the middle of the screw hole goes part, hole, part.
        middle = rows[75]
        drawn = [middle[i:i + 3] != b'\xff\xff\xff' for i in range(0, len(middle), 3)]
        changes = sum(a != b for a, b in zip(drawn, drawn[1:]))
        self.assertEqual(changes, 4)

    def test_cut_takes_the_far_part_away(self):
        def proportion(*options):
            _, height, rows = draw(DATA / 'rod/rod_blocks.k', '--view=-90,90', *options)
            columns = {x // 3 for row in rows for x in range(0, len(row), 3) if row[x:x + 3] != b'\xff\xff\xff'}
            lines = [row for row in rows if set(row) != {255}]
            return len(columns) / len(lines)
        self.assertGreater(proportion(), 2)                       # the whole rod is long
        self.assertLess(proportion('--cut', '1,0,0,0.4'), 1.5)    # its big eye is round

    def test_the_same_picture_comes_out_twice(self):
        self.assertEqual(draw(DATA / 'rod/rod_blocks.k'), draw(DATA / 'rod/rod_blocks.k'))


if __name__ == '__main__':
    unittest.main()
