// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/conventions.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "formats/tiny_scene.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

ViewSequence scan() { return ViewSequence::fromViews(test::tinyViews(6)); }

Convention named(const std::string& name) { return *conventionNamed(name); }

struct Mistake {
  const char* made;
  const char* undone_by;
};

class ConventionMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(ConventionMistakes, AreNamed) {
  const ViewSequence wrong = underConvention(scan(), {}, named(GetParam().made));
  const ConventionCheck check = checkConvention(wrong);
  ASSERT_TRUE(check.better);
  EXPECT_EQ(nameOf(check.better->convention), GetParam().undone_by);
  EXPECT_GT(check.better->agreement, 0.8);
  EXPECT_LT(*check.agreement, 0.7);
}

TEST_P(ConventionMistakes, AreUndoneByWhatIsNamed) {
  const ViewSequence wrong = underConvention(scan(), {}, named(GetParam().made));
  const ViewSequence again = underConvention(wrong, {}, named(GetParam().undone_by));
  for (std::size_t i = 0; i < again.size(); ++i) {
    const View truth = scan().load(i), view = again.load(i);
    EXPECT_TRUE(view.world_from_camera.isApprox(truth.world_from_camera, 1e-9));
    for (std::size_t k = 0; k < view.map.depth.size(); ++k)
      ASSERT_NEAR(view.map.depth.data()[k], truth.map.depth.data()[k], 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ConventionMistakes,
    testing::Values(Mistake{"inverse", "inverse"}, Mistake{"transposed", "transposed"},
                    Mistake{"inverse-transposed", "inverse-transposed"},
                    Mistake{"scalar-first", "scalar-last"}, Mistake{"scalar-last", "scalar-first"},
                    Mistake{"inverse-scalar-first", "inverse-scalar-last"}, Mistake{"opengl", "opengl"},
                    Mistake{"depth*1000", "depth*0.001"}, Mistake{"depth*0.001", "depth*1000"},
                    Mistake{"depth*0.2", "depth*5"}, Mistake{"inverse,depth*1000", "inverse,depth*0.001"}),
    [](const auto& test) {
      std::string name = test.param.made;
      for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
      return name;
    });

TEST(Conventions, OpenGlViewMatricesTakenForPosesAreNamed) {
  std::vector<View> views = test::tinyViews(6);
  RigidTransform flip = RigidTransform::Identity();
  flip.linear().diagonal() << 1, -1, -1;
  for (View& view : views) view.world_from_camera = flip * view.world_from_camera.inverse();
  const ConventionCheck check = checkConvention(ViewSequence::fromViews(views));
  ASSERT_TRUE(check.better);
  EXPECT_EQ(nameOf(check.better->convention), "inverse,opengl");
}

TEST(Conventions, RightViewsAgreeAndNoOtherReadingIsProposed) {
  const ConventionCheck check = checkConvention(scan());
  ASSERT_TRUE(check.agreement);
  EXPECT_GT(*check.agreement, 0.8);
  EXPECT_FALSE(check.better);
  const ConventionCheck scanners = checkConvention(ViewSequence::fromViews(test::tinySphericalViews(4)));
  EXPECT_FALSE(scanners.better);
}

TEST(Conventions, PosesOfAFrameOfTheirOwnAreReadInThatFrame) {
  // The file speaks of a frame that is turned and moved against the camera's, and its rotation was
  // transposed.
  RigidTransform stored_from_camera = RigidTransform::Identity();
  stored_from_camera.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  stored_from_camera.translation() = Eigen::Vector3d(0.1, -0.2, 0.9);
  const std::vector<RigidTransform> stored(6, stored_from_camera);
  const ViewSequence wrong = underConvention(scan(), stored, named("transposed"));
  const ConventionCheck check = checkConvention(wrong, stored);
  ASSERT_TRUE(check.better);
  EXPECT_EQ(nameOf(check.better->convention), "transposed");
  const ViewSequence again = underConvention(wrong, stored, check.better->convention);
  EXPECT_TRUE(again.header(2).world_from_camera.isApprox(scan().header(2).world_from_camera, 1e-9));
}

TEST(Conventions, ColourSensorsMoveWithTheirViews) {
  std::vector<View> views = test::tinyViews(1);
  RigidTransform depth_from_color = RigidTransform::Identity();
  depth_from_color.translation().x() = 0.05;
  views[0].color_sensor = ColorSensor{views[0].projection, views[0].world_from_camera * depth_from_color};
  const ViewHeader header =
      underConvention(ViewSequence::fromViews(views), {}, named("inverse,opengl")).header(0);
  EXPECT_TRUE((header.world_from_camera.inverse() * header.color_sensor->world_from_camera)
                  .isApprox(depth_from_color, 1e-9));
}

TEST(Conventions, NothingIsSaidOfSensorsInOnePlace) {
  std::vector<View> views = test::tinyViews(1);
  views.push_back(views[0]);
  EXPECT_FALSE(checkConvention(ViewSequence::fromViews(views)).agreement);
}

TEST(Conventions, NothingIsSaidOfViewsThatDoNotOverlap) {
  std::vector<View> views = test::tinyViews(2);
  views[1].world_from_camera.translation() += Eigen::Vector3d(1e6, 0, 0);
  views[1].world_from_camera.linear() = Eigen::Matrix3d::Identity();
  EXPECT_FALSE(checkConvention(ViewSequence::fromViews(views)).agreement);
  EXPECT_FALSE(checkConvention(ViewSequence::fromViews({views[0]})).agreement);
}

TEST(Conventions, AreTheSameForAnyNumberOfThreads) {
  const ViewSequence wrong = underConvention(scan(), {}, named("inverse"));
  const ThreadLimit one(1);
  const double alone = *checkConvention(wrong).agreement;
  const ThreadLimit many(4);
  EXPECT_EQ(alone, *checkConvention(wrong).agreement);
}

TEST(Conventions, NamesAreReadAsTheyAreWritten) {
  for (const char* name : {"as-read", "inverse", "scalar-last,opengl,range,depth*0.001", "z"})
    EXPECT_EQ(nameOf(named(name)), name);
  for (const char* name : {"", "inverted", "depth*", "depth*-1", "depth*nan", "inverse,,opengl"})
    EXPECT_FALSE(conventionNamed(name)) << name;
}

}  // namespace
}  // namespace vdbfuse
