#!/usr/bin/env python3
"""Checks that all links of a site of HTML pages have a target: links_test.py FOLDER

Checks files and anchors below FOLDER, not addresses of other sites.
"""
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links, self.anchors = [], {''}
        self.feed(path.read_text(encoding='utf-8', errors='replace'))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ('href', 'src', 'poster') and value:
                self.links.append(value)
            elif name == 'id' or name == 'name' and tag == 'a':
                self.anchors.add(value)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1]).resolve()
    pages = {path: Page(path) for path in root.rglob('*.html')}
    dead = set()
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            anchor = urllib.parse.unquote(parts.fragment)
            if not target.exists() or target in pages and anchor not in pages[target].anchors:
                dead.add('%s: %s' % (path.relative_to(root), link))
    print('%d pages, %d links, %d dead' % (len(pages), sum(len(p.links) for p in pages.values()), len(dead)))
    sys.exit('\n'.join(sorted(dead)) or (0 if pages else 'there are no pages in %s' % root))


if __name__ == '__main__':
    main()
