#!/usr/bin/env python3
"""Every relative link of the installed pages names a file that is installed, and a heading that is there.

    links_test.py PREFIX
"""
import re
import sys
import unittest
from pathlib import Path

PREFIX = Path(sys.argv.pop(1)).resolve()
FOLDER = PREFIX / 'share/doc/hexspline'


def prose(page):
    """The text of a page without its code."""
    text = re.sub(r'^```.*?^```', '', page.read_text(), flags=re.M | re.S)
    return re.sub(r'`[^`\n]*`', 'code', text)


def links(page):
    text = prose(page)
    found = re.findall(r'\[[^\]]*\]\(([^()\s]+)[^()]*\)', text)
    found += re.findall(r'^\[[^\]]+\]:\s*(\S+)', text, re.M)
    found += re.findall(r'(?:src|href)="([^"]+)"', text)
    return [link for link in found if not re.match(r'[a-z]+:', link)]


def anchors(page):
    """What GitHub and its like call the headings of a page."""
    text = re.sub(r'^```.*?^```', '', page.read_text(), flags=re.M | re.S)
    return {re.sub(r'[^\w -]', '', title.strip().lower()).replace(' ', '-') for title in re.findall(r'^#+ (.*)$', text, re.M)}


def fault(page, link):
    """What is wrong with a link, or nothing."""
    path, _, anchor = link.partition('#')
    target = (page.parent / path).resolve() if path else page
    if not target.is_relative_to(PREFIX):
        return 'leads out of what is installed'
    if not target.is_file() or target.stat().st_size == 0:
        return 'names no file'
    if anchor and anchor not in anchors(target):
        return 'names no heading'
    return None


class Links(unittest.TestCase):
    def test_every_link_works(self):
        pages = sorted(FOLDER.rglob('*.md'))
        found = [(page, link) for page in pages for link in links(page)]
        # Links were found: as many as there are pages and more, pictures and headings among them.
        self.assertGreater(len(pages), 15)
        self.assertGreater(len(found), 2 * len(pages))
        self.assertTrue(any(link.endswith('.png') for _, link in found))
        self.assertTrue(any('#' in link for _, link in found))
        broken = [f'{page.relative_to(FOLDER)}: {link} {fault(page, link)}' for page, link in found if fault(page, link)]
        self.assertEqual(broken, [])

    def test_every_page_and_picture_is_found_from_the_first_page(self):
        reached, left = set(), [FOLDER / 'README.md']
        while left:
            page = left.pop()
            if page not in reached:
                reached.add(page)
                if page.suffix == '.md':
                    left += [(page.parent / link.partition('#')[0]).resolve() for link in links(page) if not link.startswith('#')]
        installed = {path for kind in ('*.md', '*.png', '*.schema.json') for path in FOLDER.rglob(kind)}
        self.assertEqual(sorted(str(path.relative_to(FOLDER)) for path in installed - reached), [])


if __name__ == '__main__':
    unittest.main()
