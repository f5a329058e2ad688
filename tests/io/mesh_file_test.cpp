// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/mesh_file.h"

#include <gmock/gmock.h>

#include <bit>
#include <cstdlib>
#include <cstring>

#include "io/temporary_folder.h"
#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/glb.h"
#include "vdbfuse/mesh/topology.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

TriangleMesh withAttributes() {
  TriangleMesh mesh = test::sphere(0.7, 2, {1, 2, 3});
  mesh.normals = vertexNormals(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.colors.push_back({static_cast<std::uint8_t>(i), 7, 255});
    mesh.support.push_back(static_cast<float>(i % 5));
    mesh.confidence.push_back(static_cast<float>(i % 5) / 5);
  }
  return mesh;
}

// Reads `text` as if it were the file `name`.
TriangleMesh parse(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  writeText(folder / name, text);
  return readMesh(folder / name);
}

// What readMesh says about such a file, without its folder.
std::string complaint(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  writeText(folder / name, text);
  return messageOf<IoError>([&] { readMesh(folder / name); }).substr(folder.path().string().size() + 1);
}

const std::string kAsciiHeader =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property double z\nproperty uchar shine\nelement face 2\nproperty int material\n"
    "property list uchar int vertex_indices\nelement extra 2\nproperty list uchar int numbers\nend_header\n";
const std::string kAsciiVertices = "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 -1e0 9\n";

std::string bigEndian(std::uint32_t bits) {
  return {static_cast<char>(bits >> 24), static_cast<char>(bits >> 16), static_cast<char>(bits >> 8),
          static_cast<char>(bits)};
}

TEST(MeshFile, PlyKeepsEveryBitOfAMeshAndItsAttributes) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = withAttributes();
  writeMesh(folder / "mesh.ply", mesh);
  const TriangleMesh back = readMesh(folder / "mesh.ply");
  EXPECT_EQ(back.vertices, mesh.vertices);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(back.normals, mesh.normals);
  EXPECT_EQ(back.colors, mesh.colors);
  EXPECT_EQ(back.support, mesh.support);
  EXPECT_EQ(back.confidence, mesh.confidence);
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(MeshFile, ObjKeepsPositionsAndTriangles) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = withAttributes();
  writeMesh(folder / "mesh.OBJ", mesh);
  const TriangleMesh back = readMesh(folder / "mesh.OBJ");
  EXPECT_EQ(back.vertices, mesh.vertices);
  EXPECT_EQ(back.triangles, mesh.triangles);
}

TEST(MeshFile, StlKeepsTheTrianglesAndWeldsThemAgain) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = test::sphere(0.7, 3);
  writeMesh(folder / "mesh.stl", mesh);
  EXPECT_EQ(std::filesystem::file_size(folder / "mesh.stl"), 84 + 50 * mesh.triangles.size());
  const TriangleMesh back = readMesh(folder / "mesh.stl");
  ASSERT_EQ(back.vertices.size(), mesh.vertices.size());
  EXPECT_TRUE(isClosedManifold(topology(back)));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(back.vertices[back.triangles[i][k]], mesh.vertices[mesh.triangles[i][k]]);
    }
  }
}

TEST(MeshFile, AnEmptyMeshComesBackEmpty) {
  const TemporaryFolder folder;
  for (const char* name : {"a.ply", "a.obj", "a.stl"}) {
    writeMesh(folder / name, {});
    EXPECT_TRUE(readMesh(folder / name).vertices.empty()) << name;
  }
}

TEST(MeshFile, AsciiPlyPolygonsBecomeFansAndTheRestIsSkipped) {
  const TriangleMesh mesh =
      parse("a.ply", kAsciiHeader + kAsciiVertices + "5 4 0 1 2 3\n5 3 0 2 3\n0\n2 1 1\n");
  EXPECT_EQ(mesh.vertices[3], Eigen::Vector3f(0, 1, -1));
  EXPECT_THAT(mesh.triangles, testing::ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 2, 3}));
  EXPECT_TRUE(mesh.colors.empty());
}

TEST(MeshFile, BigEndianPlyIsSwapped) {
  std::string text =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "element face 1\nproperty list int uint vertex_index\nend_header\n";
  for (const float x : {0.f, 0.f, 0.f, 1.5f, 0.f, 0.f, 0.f, -2.f, 0.f})
    text += bigEndian(std::bit_cast<std::uint32_t>(x));
  for (const std::uint32_t i : {3, 0, 1, 2}) text += bigEndian(i);
  const TriangleMesh mesh = parse("a.ply", text);
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3f(1.5f, 0, 0));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(0, -2, 0));
  EXPECT_THAT(mesh.triangles, testing::ElementsAre(Triangle{0, 1, 2}));
}

TEST(MeshFile, ObjUnderstandsSlashesPolygonsAndNumbersFromTheEnd) {
  const TriangleMesh mesh =
      parse("a.obj",
            "# a comment\nmtllib x.mtl\nv 0 0 0 1 1 1\r\nv 1 0 0\nv 1 1 0\nv 0 +1 0\nvt 0 0\n"
            "f 1/1 2/1/1 3//1 4\r\nf -4 -3 -2\n");
  EXPECT_EQ(mesh.vertices[3], Eigen::Vector3f(0, 1, 0));
  EXPECT_THAT(mesh.triangles, testing::ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 1, 2}));
}

TEST(MeshFile, AsciiStlIsReadEvenIfItsNameSaysVertex) {
  const TriangleMesh mesh =
      parse("a.stl",
            "solid a vertex cover\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
            "vertex 0 1e0 -0\nendloop\nendfacet\nendsolid a vertex cover\n");
  EXPECT_EQ(mesh.vertices.size(), 3u);
  EXPECT_THAT(mesh.triangles, testing::ElementsAre(Triangle{0, 1, 2}));
}

TEST(MeshFile, ABinaryStlThatBeginsWithSolidIsStillBinary) {
  const TemporaryFolder folder;
  writeMesh(folder / "a.stl", test::octahedron());
  std::string bytes = readText(folder / "a.stl");
  std::memcpy(bytes.data(), "solid", 5);
  EXPECT_EQ(parse("b.stl", bytes).triangles.size(), 8u);
}

TEST(MeshFile, AHeaderThatPromisesBillionsOfVerticesIsRefusedBeforeAllocation) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  EXPECT_EQ(complaint("a.ply", header + std::string(25, '\0')),
            "a.ply: byte 124: expected 4000000000 elements 'vertex', found room for 2");
  EXPECT_THAT(complaint("a.ply",
                        "ply\nformat ascii 1.0\nelement vertex 9000000000000000000\nproperty float x\n"
                        "property float y\nproperty float z\nend_header\n0 0 0"),
              testing::HasSubstr("line 8: expected 9000000000000000000 elements 'vertex', found room for 1"));
}

TEST(MeshFile, APlyCutAnywhereIsAnErrorAndNeverMore) {
  const TemporaryFolder folder;
  writeMesh(folder / "a.ply", test::octahedron());
  const std::string bytes = readText(folder / "a.ply");
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    writeText(folder / "cut.ply", bytes.substr(0, size));
    EXPECT_THROW(readMesh(folder / "cut.ply"), IoError) << size;
  }
}

TEST(MeshFile, AnAsciiPlyCutBeforeItsLastValueIsAnError) {
  EXPECT_EQ(complaint("a.ply", kAsciiHeader + kAsciiVertices + "5 4 0 1 2 3\n5 3 0 2\n"),
            "a.ply: line 21: expected a number, found the end of the file");
}

TEST(MeshFile, PlyMessagesNameTheLineAndWhatWasFound) {
  EXPECT_EQ(complaint("a.ply", "plain text"), "a.ply: line 1: expected 'ply', found 'plain'");
  EXPECT_EQ(complaint("a.ply", "ply\nformat cuneiform 1.0\n"),
            "a.ply: line 2: expected ascii, binary_little_endian or binary_big_endian, found 'cuneiform'");
  EXPECT_EQ(complaint("a.ply", "ply\nformat ascii 1.0\nelement vertex -3\n"),
            "a.ply: line 3: expected the number of elements, found '-3'");
  EXPECT_EQ(complaint("a.ply", "ply\nproperty float x\n"),
            "a.ply: line 2: expected an element before its properties, found 'property'");
  EXPECT_EQ(complaint("a.ply", "ply\nelement vertex 1\nproperty real x\n"),
            "a.ply: line 3: expected a PLY type, found 'real'");
  EXPECT_EQ(complaint("a.ply", "ply\nelement face 1\nproperty list float int vertex_indices\n"),
            "a.ply: line 3: expected an integer type for the length of a list, found 'float'");
  EXPECT_EQ(complaint("a.ply", "ply\nelement vertex 1\nproperty float\n"),
            "a.ply: line 3: expected the name of a property, found the end of the line");
  EXPECT_EQ(complaint("a.ply", "ply\nformat ascii 1.0\nend"),
            "a.ply: line 3: expected a line of a PLY header, found 'end'");
  EXPECT_EQ(complaint("a.ply", "ply\nend_header\n"),
            "a.ply: line 2: expected a format line before the end of the header, found 'end_header'");
  EXPECT_EQ(complaint("a.ply",
                      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                      "end_header\n0 0\n"),
            "a.ply: expected vertices with x, y and z, found none of the name z");
}

TEST(MeshFile, PlyMessagesAboutFaces) {
  const std::string start = kAsciiHeader + kAsciiVertices;
  EXPECT_EQ(complaint("a.ply", start + "5 2 0 1\n5 3 0 1 2\n0\n0\n"),
            "a.ply: line 19: expected a face of three or more vertices, found 2");
  EXPECT_EQ(complaint("a.ply", start + "5 3 0 1 -2\n5 3 0 1 2\n0\n0\n"),
            "a.ply: line 19: expected the index of a vertex, found -2");
  EXPECT_EQ(complaint("a.ply", start + "5 3 0 1 4\n5 3 0 1 2\n0\n0\n"),
            "a.ply: expected faces of the 4 vertices in the file, found one with vertex 4");
  EXPECT_EQ(complaint("a.ply", start + "5 200 0 1 4\n5 3 0 1 2\n0\n0\n"),
            "a.ply: line 19: expected a list that fits the file, found 200 values");
}

TEST(MeshFile, ObjMessagesNameTheLine) {
  EXPECT_EQ(complaint("a.obj", "v 0 0\nv 1 0 0\n"),
            "a.obj: line 1: expected a number, found the end of the line");
  EXPECT_EQ(complaint("a.obj", "v 0 0 zero\n"), "a.obj: line 1: expected a number, found 'zero'");
  EXPECT_EQ(complaint("a.obj", "v 0 0 0\nf 1 1 0\n"),
            "a.obj: line 2: expected the number of a vertex, found '0'");
  EXPECT_EQ(complaint("a.obj", "v 0 0 0\nf 1 1 -2\n"),
            "a.obj: line 2: expected the number of a vertex, found '-2'");
  EXPECT_EQ(complaint("a.obj", "v 0 0 0\nf 1 1\n"),
            "a.obj: line 2: expected three or more vertices of a face, found the end of the line");
  EXPECT_EQ(complaint("a.obj", "v 0 0 0\nf 1 1 2\n"),
            "a.obj: expected faces of the 1 vertices in the file, found one with vertex 1");
}

TEST(MeshFile, StlMessagesNameThePlace) {
  EXPECT_EQ(complaint("a.stl", std::string(80, ' ') + std::string("\2\0\0\0", 4) + std::string(99, ' ')),
            "a.stl: byte 183: expected 'solid' at the start, or a binary file of 184 bytes, found the end");
  EXPECT_EQ(complaint("a.stl", ""),
            "a.stl: byte 0: expected 'solid' at the start, or a binary file of 84 bytes, found the end");
  EXPECT_EQ(complaint("a.stl", "solid\nfacet\nvertex 0 0 0\nendfacet\n"),
            "a.stl: line 4: expected three vertices before the end of a facet, found 1");
  EXPECT_EQ(complaint("a.stl", "solid\nfacet\nvertex 0 0 0\n"),
            "a.stl: line 4: expected endfacet, found the end of the file");
}

TEST(MeshFile, WhatIsNoFileIsSaidToBeNone) {
  const TemporaryFolder folder;
  EXPECT_EQ(messageOf<IoError>([&] { readMesh(folder / "no.ply"); }),
            (folder / "no.ply").string() + ": expected a file to read, found none");
  std::filesystem::create_directory(folder / "folder.ply");
  EXPECT_EQ(messageOf<IoError>([&] { readMesh(folder / "folder.ply"); }),
            (folder / "folder.ply").string() + ": expected a file to read, found a folder");
}

TEST(MeshFile, AnUnknownExtensionIsRefusedBothWays) {
  EXPECT_EQ(messageOf<IoError>([] { readMesh("a.off"); }),
            "a.off: expected the extension .ply, .obj, .stl or .glb, found .off");
  EXPECT_EQ(messageOf<IoError>([] { writeMesh("mesh", {}); }),
            "mesh: expected the extension .ply, .obj, .stl or .glb, found none");
}

TEST(MeshFile, AMeshThatContradictsItselfIsNotWritten) {
  const TemporaryFolder folder;
  TriangleMesh mesh = test::octahedron();
  mesh.support.resize(3);
  EXPECT_EQ(messageOf<InvalidArgument>([&] { writeMesh(folder / "a.ply", mesh); }),
            "mesh: normals, colors, support and confidence need one value a vertex or none at all");
  mesh.support.clear();
  mesh.triangles[0][1] = 6;
  EXPECT_EQ(messageOf<InvalidArgument>([&] { writeMesh(folder / "a.ply", mesh); }),
            "mesh: a triangle names vertex 6 of 6");
  EXPECT_EQ(folder.entryCount(), 0u);
}

TEST(MeshFile, RealMeshesAreRead) {
  const char* given = std::getenv("VDBFUSE_DATA");
  const std::filesystem::path data = given ? given : VDBFUSE_SHARED_DATA;
  if (!std::filesystem::exists(data / "meshes")) GTEST_SKIP() << "no real data in " << data;
  const TriangleMesh anchor = readMesh(data / "meshes/anchor.ply");
  EXPECT_TRUE(isClosedManifold(topology(anchor)));
  EXPECT_EQ(topology(anchor).euler_number, 2 - 2 * 4);
  EXPECT_EQ(readMesh(data / "bunny-scans/bun000.ply").vertices.size(), 40256u);
}

TEST(MeshFile, CommentsStandInTheHeaderOfEveryFormat) {
  TriangleMesh mesh = test::sphere(1.0, 1);
  mesh.comments = {"closed surface", "1.5 % of the area invented"};
  const TemporaryFolder folder;
  for (const std::string name : {"a.ply", "a.obj", "a.stl", "a.glb"}) {
    writeMesh(folder / name, mesh);
    for (const std::string& comment : mesh.comments)
      EXPECT_NE(readText(folder / name).find(comment), std::string::npos) << name;
    if (name == "a.glb") continue;
    EXPECT_EQ(readMesh(folder / name).triangles.size(), mesh.triangles.size()) << name;
  }
}

TEST(MeshFile, AGlbIsWrittenAndNotRead) {
  const TemporaryFolder folder;
  writeMesh(folder / "a.glb", test::sphere(1.0, 1));
  EXPECT_THAT(messageOf<IoError>([&] { readMesh(folder / "a.glb"); }),
              testing::HasSubstr("expected a mesh to read: .ply, .obj or .stl, found .glb"));
}

TEST(Glb, CarriesValuesOfOnesOwn) {
  const TriangleMesh mesh = test::sphere(1.0, 1);
  const std::string bytes = glbBytes(mesh, {{"_DISTANCE", std::vector<float>(mesh.vertices.size(), 2.0f)}});
  EXPECT_NE(bytes.find("\"_DISTANCE\":"), std::string::npos);
  EXPECT_EQ(bytes.size() % 4, 0u);
  EXPECT_EQ(messageOf<InvalidArgument>([&] {
              glbBytes(mesh, {{"_DISTANCE", {1, 2}}});
            }),
            "_DISTANCE: 2 values for " + std::to_string(mesh.vertices.size()) + " vertices");
}

TEST(Glb, IsWhatTheFileHolds) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = test::sphere(1.0, 1);
  writeMesh(folder / "a.glb", mesh);
  EXPECT_EQ(readText(folder / "a.glb"), glbBytes(mesh));
}

}  // namespace
}  // namespace vdbfuse
