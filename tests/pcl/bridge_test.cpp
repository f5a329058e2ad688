// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pcl/bridge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include "io/temporary_folder.h"
#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {
namespace {

View testView() {
  View view;
  view.projection = Pinhole{6, 5, 8, 8, 2.5, 2, {}};
  view.world_from_camera = RigidTransform(Eigen::Translation3d(1, 2, 3)) *
                           Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  view.map.depth = Image<float>(6, 5);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) view.map.depth(x, y) = 1.0f + 0.25f * static_cast<float>(x + y % 2);
  }
  view.map.depth(1, 1) = kInvalidDepth;
  return view;
}

void expectSame(const View& found, const View& truth) {
  EXPECT_TRUE(found.world_from_camera.isApprox(truth.world_from_camera, 1e-6));
  ASSERT_TRUE(found.map.depth.sameSize(truth.map.depth));
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) EXPECT_NEAR(found.map.depth(x, y), truth.map.depth(x, y), 1e-5);
  }
}

TEST(PclBridge, ViewThereAndBackIsTheSame) {
  expectSame(toView(toPointCloud(testView())), testView());
  expectSame(toView(toPointCloud(testView()), testView().projection), testView());
}

TEST(PclBridge, InvalidDepthIsNotANumberInTheCloud) {
  const pcl::PointCloud<pcl::PointXYZ> cloud = toPointCloud(testView());
  EXPECT_FALSE(cloud.is_dense);
  EXPECT_TRUE(std::isnan(cloud(1, 1).z));
  EXPECT_TRUE(std::isfinite(cloud(2, 1).z));
  View full = testView();
  full.map.depth(1, 1) = 1.0f;
  EXPECT_TRUE(toPointCloud(full).is_dense);
}

TEST(PclBridge, WorldPointsAreThoseOfPclsOwnTransform) {
  const View view = testView();
  const pcl::PointCloud<pcl::PointXYZ> cloud = toPointCloud(view);
  const Eigen::Vector3f by_pcl =
      cloud.sensor_orientation_ * cloud(4, 3).getVector3fMap() + cloud.sensor_origin_.head<3>();
  EXPECT_LT((by_pcl.cast<double>() - worldPoint(view, 4, 3)).norm(), 1e-5);
}

TEST(PclBridge, CloudWithoutRowsIsRefused) {
  EXPECT_THROW(toView(pcl::PointCloud<pcl::PointXYZ>(30, 1)), InvalidArgument);
  pcl::PointCloud<pcl::PointXYZ> turned = toPointCloud(testView());
  turned.sensor_orientation_.coeffs() *= 2;
  EXPECT_THROW(toView(turned), InvalidArgument);
}

TEST(PclBridge, MeshThereAndBackIsTheSame) {
  TriangleMesh mesh = test::sphere(1.0, 1);
  const auto expectRoundTrip = [&] {
    const TriangleMesh back = toTriangleMesh(toPolygonMesh(mesh));
    EXPECT_EQ(back.vertices, mesh.vertices);
    EXPECT_EQ(back.triangles, mesh.triangles);
    EXPECT_EQ(back.normals, mesh.normals);
    EXPECT_EQ(back.colors, mesh.colors);
  };
  expectRoundTrip();
  mesh.normals = vertexNormals(mesh);
  expectRoundTrip();
  mesh.colors.assign(mesh.vertices.size(), Rgb8{10, 20, 30});
  expectRoundTrip();
  mesh.normals.clear();
  expectRoundTrip();
}

TEST(PclBridge, PolygonsBecomeFans) {
  pcl::PolygonMesh mesh = toPolygonMesh(test::octahedron());
  mesh.polygons.resize(1);
  mesh.polygons[0].vertices = {0, 2, 4, 3};
  EXPECT_THAT(toTriangleMesh(mesh).triangles, testing::ElementsAre(Triangle{0, 2, 4}, Triangle{0, 4, 3}));
  mesh.polygons[0].vertices = {0, 1, 6};
  EXPECT_THROW(toTriangleMesh(mesh), InvalidArgument);
  mesh.polygons[0].vertices = {0, 1};
  EXPECT_THROW(toTriangleMesh(mesh), InvalidArgument);
  EXPECT_THROW(toTriangleMesh(pcl::PolygonMesh()), InvalidArgument);
}

TEST(PclBridge, EveryKindOfPcdFileThatPclWritesIsRead) {
  const test::TemporaryFolder folder;
  const pcl::PointCloud<pcl::PointXYZ> cloud = toPointCloud(testView());
  pcl::PCDWriter writer;
  ASSERT_EQ(writer.writeASCII((folder / "ascii.pcd").string(), cloud), 0);
  ASSERT_EQ(writer.writeBinary((folder / "binary.pcd").string(), cloud), 0);
  ASSERT_EQ(writer.writeBinaryCompressed((folder / "compressed.pcd").string(), cloud), 0);
  const DepthSet set = readDepthSet(folder.path());
  ASSERT_EQ(set.views.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) expectSame(set.views.load(i), testView());
}

}  // namespace
}  // namespace vdbfuse
