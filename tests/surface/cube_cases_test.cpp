// SPDX-License-Identifier: Apache-2.0
#include "surface/cube_cases.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace vdbfuse {
namespace {

bool isInside(int mask, int corner) { return (mask >> corner & 1) != 0; }
int upperCorner(const CubeEdge& e) { return e.base | 1 << e.axis; }

// Faces of the cube that an edge lies in: 2·axis + side.
std::set<int> facesOf(std::uint8_t edge) {
  std::set<int> faces;
  const CubeEdge& e = cubeEdges()[edge];
  for (int axis = 0; axis < 3; ++axis)
    if (axis != e.axis) faces.insert(2 * axis + (e.base >> axis & 1));
  return faces;
}

bool shareAFace(std::uint8_t a, std::uint8_t b) {
  const std::set<int> faces = facesOf(a), others = facesOf(b);
  return std::any_of(faces.begin(), faces.end(), [&](int f) { return others.contains(f); });
}

class EveryCase : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Cases, EveryCase, testing::Range(0, 256));

TEST_P(EveryCase, EachCrossedEdgeIsUsedOnceAndNoOther) {
  std::set<int> crossed, used;
  for (int e = 0; e < 12; ++e) {
    const CubeEdge& edge = cubeEdges()[static_cast<std::size_t>(e)];
    if (isInside(GetParam(), edge.base) != isInside(GetParam(), upperCorner(edge))) crossed.insert(e);
  }
  std::size_t count = 0;
  for (const CubePolygon& p : cubePolygons(static_cast<std::uint8_t>(GetParam()))) {
    EXPECT_GE(p.edges.size(), 3u);
    used.insert(p.edges.begin(), p.edges.end());
    count += p.edges.size();
  }
  EXPECT_EQ(used, crossed);
  EXPECT_EQ(count, crossed.size());
}

TEST_P(EveryCase, SidesOfPolygonsLieInFacesAndDiagonalsDoNot) {
  for (const CubePolygon& p : cubePolygons(static_cast<std::uint8_t>(GetParam()))) {
    std::set<std::pair<int, int>> sides;
    for (std::size_t k = 0; k < p.edges.size(); ++k) {
      const std::uint8_t a = p.edges[k], b = p.edges[(k + 1) % p.edges.size()];
      EXPECT_TRUE(shareAFace(a, b));
      sides.insert({a, b});
    }
    // Triangles: every side once in its direction, every diagonal once in each.
    std::map<std::pair<int, int>, int> runs;
    for (const auto& t : p.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++runs[{t[k], t[(k + 1) % 3]}];
    for (const auto& [run, count] : runs) {
      EXPECT_EQ(count, 1);
      if (sides.contains(run)) continue;
      EXPECT_TRUE(runs.contains({run.second, run.first}));
      if (run.first != kCentre && run.second != kCentre) {
        EXPECT_FALSE(shareAFace(static_cast<std::uint8_t>(run.first), static_cast<std::uint8_t>(run.second)));
      }
    }
    for (const auto& side : sides) EXPECT_TRUE(runs.contains(side));
    EXPECT_EQ(p.triangles.size(), p.has_centre ? p.edges.size() : p.edges.size() - 2);
  }
}

TEST_P(EveryCase, SeenFromOutsideEverySideHasTheInsideOnItsLeft) {
  // On a face the segment a → b, seen along the outward normal of the face, leaves the inside corner of a's
  // edge on the side that makes a closed surface counter-clockwise from outside. A single inside corner 0
  // tells which side that is; every other segment must agree with it.
  const auto turn = [](int mask, std::uint8_t a, std::uint8_t b) {
    const auto corner = [](int c) { return std::array<int, 3>{c & 1, c >> 1 & 1, c >> 2}; };
    const auto middle = [&](std::uint8_t e) {
      const CubeEdge& edge = cubeEdges()[e];
      std::array<int, 3> m{};
      for (std::size_t i = 0; i < 3; ++i) m[i] = corner(edge.base)[i] + corner(upperCorner(edge))[i];
      return m;
    };
    std::set<int> common;
    for (const int f : facesOf(a))
      if (facesOf(b).contains(f)) common.insert(f);
    const int face = *common.begin(), axis = face / 2, sign = face % 2 == 0 ? -1 : 1;
    const CubeEdge& edge = cubeEdges()[a];
    const int inner = isInside(mask, edge.base) ? edge.base : upperCorner(edge);
    const std::size_t u = static_cast<std::size_t>(axis + 1) % 3, v = static_cast<std::size_t>(axis + 2) % 3;
    const auto ma = middle(a), mb = middle(b), mi = corner(inner);
    const int du = mb[u] - ma[u], dv = mb[v] - ma[v], iu = 2 * mi[u] - ma[u], iv = 2 * mi[v] - ma[v];
    return sign * (du * iv - dv * iu) > 0;
  };
  const CubePolygon& reference = cubePolygons(1).front();
  const bool expected = turn(1, reference.edges[0], reference.edges[1]);
  for (const CubePolygon& p : cubePolygons(static_cast<std::uint8_t>(GetParam()))) {
    for (std::size_t k = 0; k < p.edges.size(); ++k)
      EXPECT_EQ(turn(GetParam(), p.edges[k], p.edges[(k + 1) % p.edges.size()]), expected);
  }
}

// Segments in one face, from both cubes that share it: they must cancel.
TEST(CubeCases, NeighboursAgreeOnTheirCommonFaceForEveryPairOfCases) {
  for (int axis = 0; axis < 3; ++axis) {
    // Corners with bit `axis` clear: the shared face of the upper cube.
    std::array<std::array<std::set<std::pair<int, int>>, 256>, 2> segments;
    const auto nameOf = [&](std::uint8_t e) {
      const CubeEdge& edge = cubeEdges()[e];
      return edge.axis * 8 + (edge.base & ~(1 << axis));
    };
    for (int mask = 0; mask < 256; ++mask) {
      for (const CubePolygon& p : cubePolygons(static_cast<std::uint8_t>(mask))) {
        for (std::size_t k = 0; k < p.edges.size(); ++k) {
          const std::uint8_t a = p.edges[k], b = p.edges[(k + 1) % p.edges.size()];
          for (int side = 0; side < 2; ++side)
            if (facesOf(a).contains(2 * axis + side) && facesOf(b).contains(2 * axis + side))
              segments[static_cast<std::size_t>(side)][static_cast<std::size_t>(mask)].insert(
                  {nameOf(a), nameOf(b)});
        }
      }
    }
    for (std::size_t low = 0; low < 256; ++low) {
      for (std::size_t high = 0; high < 256; ++high) {
        bool match = true;
        for (int c = 0; c < 8; ++c)
          if ((c >> axis & 1) == 0)
            match &= isInside(static_cast<int>(high), c) == isInside(static_cast<int>(low), c | 1 << axis);
        if (!match) continue;
        std::set<std::pair<int, int>> reversed;
        for (const auto& [a, b] : segments[1][low]) reversed.insert({b, a});
        ASSERT_EQ(segments[0][high], reversed) << axis << " " << low << " " << high;
      }
    }
  }
}

}  // namespace
}  // namespace vdbfuse
