#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Tests cpp_api.py: what it reads of a header, and that no change of a signature goes untold."""
import os
import pathlib
import shutil
import tempfile
import unittest
import unittest.mock

import cpp_api

HEADER = '''
#ifndef A
namespace cv {
/** class Comment { int no; }; */
class CV_EXPORTS_W A : public B  // of all
{
public:
    enum Kind { ONE, TWO = 2 };
    A(int first_ = 1) : first(first_) {}
    CV_WRAP_AS (other) virtual void run( InputArray a,
                                         OutputArray b = noArray() ) const = 0;
    struct Inner { int size = 0; };
private:
    int first;
};
class Later;
CV_EXPORTS void free(const std::vector<int>& of = std::vector<int>{}, const Later* later = nullptr);
}
#endif
'''
READ = [(0, 'class A : public B'), (1, 'enum Kind { ONE, TWO = 2 };'), (1, 'A(int first_ = 1);'),
        (1, 'virtual void run(InputArray a, OutputArray b = noArray()) const = 0;'), (1, 'struct Inner'), (2, 'int size = 0;'),
        (0, 'void free(const std::vector<int>& of = std::vector<int>{}, const Later* later = nullptr);')]
PAGE = """# Public names

## a.hpp
Stable: a word

```cpp
class A : public Base
    void run(int a);
    A& operator=(const A&);
    enum Mode { SLOW, FAST = 1 };
class B
    void run(int a);
void free(int first, int last = -1);
typedef std::function<Mat(Ptr)> Reader;
```

## b.hpp
May change: news

```cpp
bool find(int a, double scale = .25);
```
"""
PYTHON = """# Public names

## package
Stable: a word

```python
class P : tuple
    P(count)
    count
    run(self, a=1)
join(a, options=Options())
```

## program
Stable: a word

```text
command map : folder
    --map MAP
command update : folder
    --map MAP
```
"""
CHANGELOG = """# Changelog

## Unreleased

### Backward incompatible
- something
%s

### Added
%s

## 0.1.0
- `A::run`, `free`, `A`, `find`, `a.hpp`, `b.hpp`
"""


class Test(unittest.TestCase):
    def test_reads_what_is_public(self):
        self.assertEqual(READ, list(cpp_api.declarations(HEADER)))

    def untold(self, changelog, *changes, before=PAGE):
        after = before
        for old, new in changes:
            self.assertIn(old, after)
            after = after.replace(old, new)
        with tempfile.TemporaryDirectory() as folder:
            cpp_api.ROOT = pathlib.Path(folder)
            (cpp_api.ROOT / 'CHANGELOG.md').write_text(changelog)
            return [line.split(': ', 1)[-1] for line in cpp_api.untold(before, after)]

    def test_what_was_stable_is_told_as_incompatible(self):
        word = CHANGELOG % ('', '- `run`, `A::walk`, `Fast`, `a.hpp`, `free`, `new_name`')
        for change, gone, told in (
                (('A : public Base\n    void run(int a);', 'A : public Base'), 'A: void run(int a);', '`A::run`'),  # class B has the line, too
                (('class A : public Base', 'class A : public Other'), 'class A : public Base', '`A` is an `Other`, no `Base`'),
                (('## a.hpp\nStable', '## a.hpp\nMay change'), 'Stable', '`a.hpp`'),
                (('int last = -1', 'int last = 0'), 'void free(int first, int last = -1);', '`free`'),
                ((', int last = -1', ''), 'void free(int first, int last = -1);', '`free`'),
                (('FAST = 1', 'FAST = 2'), 'A: enum Mode { SLOW, FAST = 1 };', 'of `A`: `Mode`'),
                (('FAST = 1', 'FAST = 12'), 'A: enum Mode { SLOW, FAST = 1 };', 'of `A`: `Mode`'),
                (('Ptr)> Reader', 'Ptr*)> Reader'), 'typedef std::function<Mat(Ptr)> Reader;', '`Reader`'),
                (('    A& operator=(const A&);\n', ''), 'A: A& operator=(const A&);', '`A::operator=`')):
            for silent in (CHANGELOG % ('', ''), word, CHANGELOG % ('- `free_all`, free, run of `B`, `B::Mode`, A', ''),
                           CHANGELOG % ('', '') + '- ' + told, CHANGELOG % ('- `A` is a `Base`\n- `run`, `Mode`, `operator=`', '')):
                self.assertEqual([gone], self.untold(silent, change), silent)
            self.assertEqual([], self.untold(CHANGELOG % ('- ' + told, ''), change))

    def test_what_may_change_is_told_anywhere(self):
        change = 'double scale = .25', 'double scale = 0'
        self.assertEqual(['bool find(int a, double scale = .25);'], self.untold(CHANGELOG % ('', '- scale of find'), change))
        for told in (CHANGELOG % ('- `find`', ''), CHANGELOG % ('', '- `find`: `scale`')):
            self.assertEqual([], self.untold(told, change))

    def test_a_released_section_tells_nothing_of_what_came_after(self):
        section = (CHANGELOG % ('- `find`', '')).replace('Unreleased', '0.3.0 (2026-01-01)')
        for tag, gone in ('v0.2.0', []), ('v0.3.0', ['bool find(int a, double scale = .25);']):
            with unittest.mock.patch.object(cpp_api, 'last_tag', return_value=tag):
                self.assertEqual(gone, self.untold(section, ('double scale = .25', 'double scale = 0')))

    def test_additions_need_no_word(self):
        added = ('FAST = 1', 'FAST = 1, FASTEST'), ('class B', 'void more();\nclass B'), ('May change: news', 'Stable: news')
        self.assertEqual(['May change'], self.untold(CHANGELOG % ('', ''), *added))  # but a promise
        self.assertEqual([], self.untold(CHANGELOG % ('', '- `b.hpp` is stable'), *added))

    def test_python_and_commands(self):
        for change, gone, told in (
                (('run(self, a=1)', 'run(self, a=2)'), 'P: run(self, a=1)', '`P.run`'),
                (('    count\n', ''), 'P: count', '`P`: `count`'),
                (('join(a, options=Options())', 'join(a)'), 'join(a, options=Options())', '`join`'),
                (('update : folder\n    --map MAP\n', 'update : folder\n'), 'update: --map MAP', '`opencv-iib update --map`'),
                (('command update : folder', 'command update :'), 'command update : folder', '`update`')):
            for silent in '`run`, P', '`--map`\n- `update-all --map`', '`update-all`, `update_all --map-all`', '`joined`, count':
                self.assertEqual([gone], self.untold(CHANGELOG % ('- ' + silent, ''), change, before=PYTHON), silent)
            self.assertEqual([], self.untold(CHANGELOG % ('- ' + told, ''), change, before=PYTHON))

    @unittest.skipUnless(shutil.which('git'), 'there is no git')
    def test_what_was_released_is_the_tags_page_else_that_of_the_version_s_commit(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(cpp_api, 'ROOT', pathlib.Path(folder)), \
                unittest.mock.patch.dict(os.environ, {'GIT_CONFIG_GLOBAL': os.devnull}):
            page = cpp_api.ROOT / 'api.md'
            cpp_api.git('init', '-q')

            def commit(subject, text):
                page.write_text(text)
                cpp_api.git('add', '.')
                cpp_api.git('-c', 'user.name=test', '-c', 'user.email=test', 'commit', '-q', '-m', subject)

            page.write_text('not committed')
            self.assertEqual('not committed', cpp_api.released(page))
            commit('pages: names', 'older')
            page.write_text('changed')
            self.assertEqual('older', cpp_api.released(page))
            commit('release: 0.3.0', 'of the version')
            commit('release: what users have to change', 'later')
            self.assertEqual('of the version', cpp_api.released(page))
            cpp_api.git('tag', 'v0.3.0')
            commit('release: 0.4.0', 'newest')
            self.assertEqual('later', cpp_api.released(page))

    def test_the_pages_as_they_are_committed(self):
        for page in cpp_api.PAGE, cpp_api.PAGE.with_name('api_python.md'):
            for _, owner, line in cpp_api.promised(page.read_text()):
                self.assertRegex(cpp_api.name(line), r'^(~?\w+|operator=|May change|Stable|--[a-z-]+)$', line)
                self.assertRegex(owner, r'^\w*$')


if __name__ == '__main__':
    unittest.main()
