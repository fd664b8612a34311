#!/usr/bin/env python3
"""The sample runs that `hexspline SUBCOMMAND --help` shows do what they promise.

    sample_runs_test.py HEXSPLINE DATA

They run as printed, in one folder with the sample rod under the names that they use, in the order of the chain.
"""
import shlex
import unittest

from printed_commands import PLUGIN, copy_parts, make_inputs, run_printed, samples
from program import CommandTest

ORDER = ('segment', 'polycube', 'map', 'improve', 'spline', 'check', 'run', 'convert', 'plugins')


class SampleRuns(CommandTest):
    def test_every_sample_run(self):
        make_inputs(self.folder, self.run_program)
        count = 0
        for command in ORDER:
            for words in samples(self.run_program, command):
                self.assertEqual(words[:2], ['hexspline', command])
                if PLUGIN.name in words and not PLUGIN.exists():
                    continue
                with self.subTest(sample=shlex.join(words)):
                    run_printed(self, words, self.folder)
                    count += 1
                # Earlier samples write over what later ones read.
                copy_parts(self.folder)
        self.assertGreater(count, 20)


if __name__ == '__main__':
    unittest.main()
