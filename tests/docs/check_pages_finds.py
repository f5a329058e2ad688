#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_pages.py finds what it looks for: run on a tree in which everything is wrong once, and once mended."""
import pathlib
import tempfile

from check_pages import problems

HEADER = """
struct Sweep {
  /// A comment; with a semicolon, and a comma.
  double voxel = 0.0;  ///< length
  int width = 640, height = 480;
  enum class Mode { Fast, Slow } mode = Mode::Fast;
  enum class Unused { A, B };
  std::array<double, 5> distortion{};
  std::optional<std::array<double, 4>> intrinsics;
  Inner inner;
  double at(double depth) const;
  bool operator==(const Sweep&) const = default;
  Sweep operator*(double factor) const { return {voxel * factor}; }
};
"""
BAD = """# Title
[one](missing.md), [two](page.md#nothing), `[three](not-a-link.md)`, [four](https://example.org/x)
<!-- options: Sweep Nobody -->
`voxel` `width` mode
"""
GOOD = """# Title
## A heading, with marks
[two](page.md#a-heading-with-marks)
<!-- options: Sweep -->
`voxel` `width`, `height` `mode` `distortion` `intrinsics` `inner.x`
"""


def found(page):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "include").mkdir()
        (root / "include" / "sweep.h").write_text(HEADER)
        (root / "page.md").write_text(page)
        return list(problems(root))


def main():
    bad = found(BAD)
    expected = ["missing.md: there is no such file", "page.md#nothing: there is no such heading", "Sweep::height",
                "Sweep::mode", "Sweep::distortion", "Sweep::intrinsics", "Sweep::inner", "options of Nobody"]
    for part in expected:
        assert any(part in problem for problem in bad), (part, bad)
    assert len(bad) == len(expected), bad
    assert found(GOOD) == [], found(GOOD)


main()
