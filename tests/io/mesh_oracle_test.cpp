// SPDX-License-Identifier: Apache-2.0
// Another library (assimp) reads what we write.
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>

#include "io/temporary_folder.h"
#include "mesh/shapes.h"
#include "vdbfuse/io/mesh_file.h"

namespace vdbfuse {
namespace {

TriangleMesh decoratedTorus() {
  TriangleMesh mesh = test::torus();
  mesh.normals = vertexNormals(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    mesh.colors.push_back({static_cast<std::uint8_t>(v), 255, 0});
    mesh.support.push_back(static_cast<float>(v % 7));
    mesh.confidence.push_back(static_cast<float>(v % 7) / 7);
  }
  mesh.comments = {"made for a test"};
  return mesh;
}

class MeshOracle : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Formats, MeshOracle, testing::Values("ply", "obj", "stl", "glb"),
                         [](const auto& format) { return format.param; });

TEST_P(MeshOracle, AnotherLibraryReadsTheSameTriangles) {
  const TriangleMesh mesh = decoratedTorus();
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder / ("torus." + GetParam());
  writeMesh(path, mesh);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_PreTransformVertices);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1u);
  const aiMesh& read = *scene->mMeshes[0];
  ASSERT_EQ(read.mNumFaces, mesh.triangles.size());
  const bool is_turned = GetParam() == "glb";  // up is y there
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    ASSERT_EQ(read.mFaces[i].mNumIndices, 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      const aiVector3D& p = read.mVertices[read.mFaces[i].mIndices[k]];
      const Eigen::Vector3f found =
          is_turned ? Eigen::Vector3f(p.x, -p.z, p.y) : Eigen::Vector3f(p.x, p.y, p.z);
      ASSERT_LT((found - mesh.vertices[mesh.triangles[i][k]]).norm(), 1e-6f);
    }
  }
}

TEST(GlbOracle, AnotherLibraryFindsNormalsAndColours) {
  const TriangleMesh mesh = decoratedTorus();
  const test::TemporaryFolder folder;
  writeMesh(folder / "torus.glb", mesh);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile((folder / "torus.glb").string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  const aiMesh& read = *scene->mMeshes[0];
  ASSERT_EQ(read.mNumVertices, mesh.vertices.size());
  ASSERT_TRUE(read.HasNormals());
  ASSERT_TRUE(read.HasVertexColors(0));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    ASSERT_NEAR(read.mNormals[v].y, mesh.normals[v].z(), 1e-6);
    ASSERT_NEAR(read.mColors[0][v].g, 1, 1e-6);
    ASSERT_NEAR(read.mColors[0][v].b, 0, 1e-6);
    const double level = mesh.colors[v][0] / 255.0;  // sRGB to linear
    ASSERT_NEAR(read.mColors[0][v].r,
                level <= 0.04045 ? level / 12.92 : std::pow((level + 0.055) / 1.055, 2.4), 1e-5);
  }
}

}  // namespace
}  // namespace vdbfuse
