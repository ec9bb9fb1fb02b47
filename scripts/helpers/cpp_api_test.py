#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Tests cpp_api.py: what it reads of a header, and that no change of a signature goes untold."""
import pathlib
import tempfile
import unittest

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


class Test(unittest.TestCase):
    def test_reads_what_is_public(self):
        self.assertEqual(READ, list(cpp_api.declarations(HEADER)))

    def test_names_what_no_changelog_tells(self):
        before = 'class A\n    void run(int a);\n    int size = 0;\nvoid free();\n'
        after = 'class A\n    void run(int a, int b);\n'
        with tempfile.TemporaryDirectory() as folder:
            cpp_api.ROOT = pathlib.Path(folder)
            changelog = cpp_api.ROOT / 'CHANGELOG.md'
            changelog.write_text('# Changelog\n\n## Unreleased\n- `free` is gone, and runs\n\n## 0.1\n- `run`, `size`\n')
            self.assertEqual(['void run(int a);', 'int size = 0;'], cpp_api.untold(before, after))
            self.assertEqual([], cpp_api.untold(before, before + 'void more();\n'))
            changelog.write_text('# Changelog\n\n## Unreleased\n- `run` takes b, no `size`; `free` is gone\n')
            self.assertEqual([], cpp_api.untold(before, after))


if __name__ == '__main__':
    unittest.main()
