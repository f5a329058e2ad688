// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/scanner.h"

#include <gmock/gmock.h>

#include <atomic>
#include <map>
#include <thread>

#include "fusion/scenes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using testing::HasSubstr;

ScannerOptions options() {
  ScannerOptions o;
  o.preview.voxel = 0.03;
  o.when_full = WhenFull::Wait;
  return o;
}

std::vector<ViewId> pushAll(Scanner& scanner, const std::vector<View>& views) {
  std::vector<ViewId> ids;
  for (const View& view : views) ids.push_back(scanner.push(view).value());
  return ids;
}

void expectTheSame(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_TRUE(a.vertices == b.vertices);
  EXPECT_EQ(a.support, b.support);
  EXPECT_EQ(a.colors, b.colors);
}

void expectNearlyTheSame(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.triangles.size(), b.triangles.size());
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t v = 0; v < a.vertices.size(); ++v) ASSERT_LT((a.vertices[v] - b.vertices[v]).norm(), 1e-4);
}

FinishOptions coarse() {
  FinishOptions o;
  o.reconstruct.resolution = 32;
  return o;
}

RigidTransform aStepAside() {
  RigidTransform pose = RigidTransform::Identity();
  pose.translation().x() = 0.2;
  return pose;
}

TEST(Scanner, FinishGivesTheGlobalCutOfReconstruct) {
  const std::vector<View> views = test::sphereViews(20);
  Scanner scanner(options());
  pushAll(scanner, views);
  const Reconstruction live = scanner.finish(coarse());
  const Reconstruction whole = reconstruct(ViewSequence::fromViews(views), coarse().reconstruct);
  ASSERT_GT(whole.mesh.triangles.size(), 500u);
  expectTheSame(live.mesh, whole.mesh);
  EXPECT_TRUE(live.mesh.normals == whole.mesh.normals);
}

TEST(Scanner, FinishIsTheSameWhenViewsLieInAFile) {
  const std::vector<View> views = test::sphereViews(12);
  ScannerOptions in_file = options();
  in_file.memory = 0;
  Scanner file(in_file), memory(options());
  pushAll(file, views), pushAll(memory, views);
  expectTheSame(file.finish(coarse()).mesh, memory.finish(coarse()).mesh);
}

TEST(Scanner, ThePreviewIsThatOfTheIntegrator) {
  const std::vector<View> views = test::sphereViews(10);
  Scanner scanner(options());
  Integrator integrator(options().preview);
  pushAll(scanner, views);
  for (const View& view : views) integrator.integrate(view);
  scanner.wait();
  expectTheSame(scanner.mesh(), integrator.mesh());
}

// What a viewer has that replaces and drops the blocks it is told of.
class Viewer {
 public:
  void take(const ScannerPreview& preview) {
    for (const SurfaceBlock& block : preview.changed) blocks_[key(block.origin)] = block.mesh;
    for (const Index3& origin : preview.removed) EXPECT_EQ(blocks_.erase(key(origin)), 1u);
  }
  std::size_t triangles() const {
    std::size_t sum = 0;
    for (const auto& [origin, mesh] : blocks_) sum += mesh.triangles.size();
    return sum;
  }

 private:
  static std::array<int, 3> key(const Index3& origin) { return {origin.x(), origin.y(), origin.z()}; }
  std::map<std::array<int, 3>, TriangleMesh> blocks_;
};

TEST(Scanner, PreviewsAddUpToTheWholeMesh) {
  Scanner scanner(options());
  Viewer viewer;
  std::vector<ViewId> ids;
  for (const View& view : test::sphereViews(12)) {
    ids.push_back(scanner.push(view).value());
    viewer.take(scanner.preview());
  }
  scanner.wait();
  const ScannerPreview last = scanner.preview();
  EXPECT_EQ(last.newest, ids.back());
  viewer.take(last);
  EXPECT_EQ(viewer.triangles(), scanner.mesh().triangles.size());
  EXPECT_TRUE(scanner.preview().changed.empty());
  for (const ViewId id : ids) scanner.remove(id);
  scanner.wait();
  viewer.take(scanner.preview());
  EXPECT_EQ(viewer.triangles(), 0u);
}

TEST(Scanner, ACorrectedPoseIsAsIfItHadBeenRightAtOnce) {
  const std::vector<View> views = test::sphereViews(16);
  std::vector<View> drifted = views;
  for (std::size_t i = 8; i < drifted.size(); ++i)
    drifted[i].world_from_camera = aStepAside() * drifted[i].world_from_camera;
  Scanner scanner(options()), right(options());
  const std::vector<ViewId> ids = pushAll(scanner, drifted);
  scanner.wait();
  pushAll(right, views);
  right.wait();
  EXPECT_GT(scanner.mesh().triangles.size(), right.mesh().triangles.size() + 100);
  std::vector<PoseCorrection> corrections;
  for (std::size_t i = 8; i < views.size(); ++i) corrections.push_back({ids[i], views[i].world_from_camera});
  scanner.correctPoses(corrections);
  scanner.wait();
  expectNearlyTheSame(scanner.mesh(), right.mesh());
  expectTheSame(scanner.finish(coarse()).mesh, right.finish(coarse()).mesh);
}

TEST(Scanner, ACorrectionMovesTheCameraOfThePictureAlong) {
  View view = test::sphereViews(1)[0];
  RigidTransform beside = RigidTransform::Identity();
  beside.translation().y() = 0.05;
  view.color_sensor = ColorSensor{view.projection, view.world_from_camera * beside};
  view.map.color = Image<Rgb8>(64, 64);
  Scanner scanner(options());
  const ViewId id = scanner.push(view).value();
  const RigidTransform better = aStepAside() * view.world_from_camera;
  scanner.wait();
  scanner.correctPose(id, better);
  scanner.wait();
  const ViewHeader kept = scanner.views().header(0);
  EXPECT_TRUE(kept.world_from_camera.isApprox(better));
  EXPECT_TRUE(kept.color_sensor->world_from_camera.isApprox(better * beside));
}

TEST(Scanner, ARemovedViewIsNeitherInThePreviewNorInTheCut) {
  const std::vector<View> views = test::sphereViews(14);
  std::vector<View> with_a_wrong_one = views;
  with_a_wrong_one.push_back(views[0]);
  with_a_wrong_one.back().world_from_camera = aStepAside() * views[0].world_from_camera;
  Scanner scanner(options()), right(options());
  const std::vector<ViewId> ids = pushAll(scanner, with_a_wrong_one);
  pushAll(right, views);
  scanner.remove(ids.back());
  scanner.remove(ids.back());
  scanner.wait(), right.wait();
  expectNearlyTheSame(scanner.mesh(), right.mesh());
  EXPECT_EQ(scanner.status().kept, views.size());
  expectTheSame(scanner.finish(coarse()).mesh, right.finish(coarse()).mesh);
}

// Views that take so long that the queue fills.
std::vector<View> largeViews(int count) { return test::sphereViews(count, 512); }

TEST(Scanner, DropsTheOldestWhenTheQueueIsFull) {
  const std::vector<View> views = largeViews(12);
  ScannerOptions o = options();
  o.when_full = WhenFull::DropOldest, o.queue_capacity = 1, o.preview.voxel = 0.004;
  Scanner scanner(o);
  const std::vector<ViewId> ids = pushAll(scanner, views);
  scanner.wait();
  const ScannerStatus status = scanner.status();
  EXPECT_EQ(status.pushed, 12u);
  EXPECT_GT(status.dropped, 0u);
  EXPECT_EQ(status.integrated + status.dropped, 12u);
  EXPECT_EQ(scanner.preview().newest, ids.back());
  scanner.remove(ids[1]);  // dropped or not: no error
}

TEST(Scanner, DropsTheNewestWhenToldTo) {
  const std::vector<View> views = largeViews(12);
  ScannerOptions o = options();
  o.when_full = WhenFull::DropNewest, o.queue_capacity = 1, o.preview.voxel = 0.004;
  Scanner scanner(o);
  std::size_t refused = 0;
  for (const View& view : views) refused += !scanner.push(view);
  scanner.wait();
  EXPECT_GT(refused, 0u);
  EXPECT_EQ(scanner.status().dropped, refused);
  EXPECT_EQ(scanner.status().integrated, 12 - refused);
}

TEST(Scanner, ManyThreadsMayUseItAtOnce) {
  const std::vector<View> views = test::sphereViews(40);
  Scanner scanner(options());
  std::atomic<bool> done = false;
  Viewer viewer;
  std::thread looks([&] {
    while (!done) viewer.take(scanner.preview());
  });
  std::vector<std::thread> pushers;
  for (std::size_t first = 0; first < 2; ++first) {
    pushers.emplace_back([&, first] {
      for (std::size_t i = first; i < views.size(); i += 2) {
        const ViewId id = scanner.push(views[i]).value();
        if (i % 4 == 0) scanner.correctPose(id, aStepAside() * views[i].world_from_camera);
        scanner.correctPose(id, views[i].world_from_camera);
        EXPECT_LE(scanner.status().waiting, options().queue_capacity + 1);
      }
    });
  }
  for (std::thread& pusher : pushers) pusher.join();
  scanner.wait();
  done = true;
  looks.join();
  viewer.take(scanner.preview());
  Integrator alone(options().preview);
  for (const View& view : views) alone.integrate(view);
  EXPECT_EQ(viewer.triangles(), scanner.mesh().triangles.size());
  expectNearlyTheSame(scanner.mesh(), alone.mesh());
}

TEST(Scanner, LooksAtNothingBeyondNearAndFar) {
  ScannerOptions o = options();
  o.near = 1.4, o.far = 1.7;
  Scanner scanner(o);
  scanner.push(test::sphereViews(1)[0]);
  scanner.wait();
  std::size_t measured = 0;
  for (const float depth : scanner.views().load(0).map.depth) {
    if (depth == kInvalidDepth) continue;
    ++measured;
    EXPECT_GE(depth, 1.4f);
    EXPECT_LE(depth, 1.7f);
  }
  EXPECT_GT(measured, 100u);
}

TEST(Scanner, KeyViewsAreThoseOfASensorThatMoved) {
  std::vector<View> views;
  const View first = test::sphereViews(1)[0];
  for (int i = 0; i < 10; ++i) {
    views.push_back(first);
    views.back().world_from_camera.translation().x() += 0.01 * i;
  }
  Scanner scanner(options());
  pushAll(scanner, views);
  scanner.wait();
  EXPECT_EQ(scanner.views().size(), 10u);
  EXPECT_EQ(scanner.views({0.025, 1.0}).size(), 4u);  // 0, 3, 6, 9
  EXPECT_THROW(scanner.views({-1, 0}), InvalidArgument);
}

TEST(Scanner, FinishCanBeCancelledAndTheScanGoesOn) {
  Scanner scanner(options());
  pushAll(scanner, test::sphereViews(8));
  const Progress stop([](std::string_view, double) { return false; });
  EXPECT_THROW(scanner.finish(coarse(), stop), Cancelled);
  pushAll(scanner, test::sphereViews(8));
  EXPECT_GT(scanner.finish(coarse()).mesh.triangles.size(), 100u);
}

template <class Call>
void expectInvalid(const Call& call, const char* text) {
  try {
    call();
    FAIL() << "no error, expected: " << text;
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr(text));
  }
}

TEST(Scanner, SaysWhatIsWrong) {
  ScannerOptions bad;
  bad.preview.carving = IntegratorOptions::Carving::On;
  bad.near = 2, bad.far = 1, bad.queue_capacity = 0;
  EXPECT_THAT(validate(bad), testing::ElementsAre(HasSubstr("voxel must be positive"), HasSubstr("carving"),
                                                  HasSubstr("near"), HasSubstr("queue_capacity")));
  expectInvalid([&] { Scanner{bad}; }, "options");
  Scanner scanner(options());
  View view = test::sphereViews(1)[0];
  view.name = "frame 7", view.map.confidence = Image<float>(3, 3);
  expectInvalid([&] { scanner.push(view); }, "frame 7");
  expectInvalid([&] { scanner.remove(1); }, "there is none with number 1");
  const ViewId id = scanner.push(test::sphereViews(1)[0]).value();
  RigidTransform mirror = RigidTransform::Identity();
  mirror.linear()(0, 0) = -1;
  expectInvalid([&] { scanner.correctPose(id, mirror); }, "world_from_camera");
}

TEST(Scanner, WhatGoesWrongOnItsThreadIsThrownByTheNextCall) {
  ScannerOptions o = options();
  o.memory = 0;
  const char* const old = std::getenv("TMPDIR");
  const std::string kept = old == nullptr ? "" : old;
  setenv("TMPDIR", "/nowhere", 1);
  Scanner scanner(o);
  const std::vector<View> views = test::sphereViews(6);
  scanner.push(views[0]);
  EXPECT_THROW(scanner.wait(), IoError);
  old == nullptr ? unsetenv("TMPDIR") : setenv("TMPDIR", kept.c_str(), 1);
  EXPECT_TRUE(scanner.mesh().triangles.empty());
  scanner.push(views[1]);
  scanner.wait();
  EXPECT_EQ(scanner.status().kept, 1u);
}

}  // namespace
}  // namespace vdbfuse
