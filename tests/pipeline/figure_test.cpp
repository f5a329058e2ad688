// SPDX-License-Identifier: Apache-2.0
// The paper's Fig. 4 in small: with evidence of visibility the figure keeps its legs and its cavity, with
// constant ballooning one or the other is lost, whatever the weight.
#include <gtest/gtest.h>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/evaluation/evaluate.h"
#include "vdbfuse/pipeline/reconstruct.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace vdbfuse {
namespace {

struct ToEvaluated {
  RegionShape operator()(const Box& box) const { return box; }
  RegionShape operator()(const CylinderShape& c) const { return RegionCylinder{c.from, c.to, c.radius}; }
  RegionShape operator()(const SphereShape& s) const { return RegionSphere{s.center, s.radius}; }
};

std::vector<Region> regionsOf(const Scene& scene) {
  std::vector<Region> regions;
  for (const SceneRegion& r : scene.regions) {
    const Expectation expect = r.expect == RegionSide::Inside ? Expectation::Inside : Expectation::Outside;
    regions.push_back({r.name, expect, std::visit(ToEvaluated{}, r.shape)});
  }
  return regions;
}

class Figure : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    SynthOptions options;
    options.views = 24, options.arc = Arc::Ring, options.width = 160, options.height = 120,
    options.outliers = 0.1;
    const SyntheticScan scan(makeScene("figure", {1.0 / 100}), options);
    scene_ = new Scene(scan.scene());
    std::vector<View> views;
    for (std::size_t i = 0; i < scan.size(); ++i) views.push_back(scan.render(i).view);
    views_ = new ViewSequence(ViewSequence::fromViews(std::move(views)));
  }
  static void TearDownTestSuite() {
    delete scene_;
    delete views_;
  }

  static ReconstructOptions options() {
    ReconstructOptions options;
    options.resolution = 96;
    return options;
  }

  struct Shares {
    double cavity = 0, legs = 0, iou = 0;
    TopologyReport topology;
  };
  static Shares run(const ReconstructOptions& options) {
    Shares shares;
    TriangleMesh mesh;
    try {
      mesh = reconstruct(*views_, options).mesh;
    } catch (const Error&) {  // everything is outside
      shares.cavity = 1;
      return shares;
    }
    EvaluateOptions evaluate_options;
    evaluate_options.samples = 5000, evaluate_options.iou_resolution = 48,
    evaluate_options.region_samples = 1500;
    const Evaluation e = evaluate(mesh, scene_->truth, evaluate_options, regionsOf(*scene_));
    shares.iou = e.iou.value_or(0), shares.topology = e.topology, shares.legs = 1;
    for (const RegionShare& r : e.regions) {
      if (r.name == "cavity") shares.cavity = r.share.value_or(0);
      if (r.name.ends_with("leg")) shares.legs = std::min(shares.legs, r.share.value_or(0));
    }
    return shares;
  }

  static inline Scene* scene_ = nullptr;
  static inline ViewSequence* views_ = nullptr;
};

TEST_F(Figure, KeepsItsLegsAndItsCavityByDefault) {
  const Shares shares = run(options());
  EXPECT_GT(shares.cavity, 0.8);
  EXPECT_GT(shares.legs, 0.8);
  EXPECT_GT(shares.iou, 0.9);
  EXPECT_TRUE(isClosedManifold(shares.topology));
  EXPECT_EQ(shares.topology.components, 1u);
  std::printf("cavity %.3f legs %.3f iou %.3f\n", shares.cavity, shares.legs, shares.iou);
}

TEST_F(Figure, NeverKeepsBothUnderConstantBallooning) {
  ReconstructOptions o = options();
  o.evidence.rule = EvidenceRule::Constant;
  double best_cavity = 0, best_legs = 0;
  for (const double balloon : {0.01, 0.05, 0.1, 0.2, 0.4, 0.8, 2.0}) {
    o.evidence.balloon = balloon;
    const Shares shares = run(o);
    std::printf("balloon %.2f: cavity %.3f legs %.3f iou %.3f\n", balloon, shares.cavity, shares.legs,
                shares.iou);
    EXPECT_FALSE(shares.cavity >= 0.5 && shares.legs >= 0.5 && shares.iou >= 0.8) << balloon;
    best_cavity = std::max(best_cavity, shares.cavity), best_legs = std::max(best_legs, shares.legs);
  }
  // The weights bracket both failures.
  EXPECT_GE(best_cavity, 0.5);
  EXPECT_GE(best_legs, 0.5);
}

}  // namespace
}  // namespace vdbfuse
