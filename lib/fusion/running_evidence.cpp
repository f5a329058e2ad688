// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/running_evidence.h"

#include "fusion/testimony_sum.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kLeaf = ScalarGrid::kLeafSize;
static_assert(kLeaf <= PointBlock::kCapacity);

const EvidenceOptions& usable(const EvidenceOptions& options) {
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw InvalidArgument("options", problems.front());
  return options;
}

// In the order of ScalarGrid's leaves.
std::vector<Index3> sorted(std::vector<Index3> origins) {
  sortUniqueOrigins(origins);
  return origins;
}

}  // namespace

struct RunningEvidence::Impl {
  Impl(const SensorModel& sensor_model, const GridFrame& grid_frame, std::vector<Index3> leaf_origins,
       const RunningEvidenceOptions& options)
      : sensor(sensor_model),
        frame(grid_frame),
        origins(sorted(std::move(leaf_origins))),
        sum(sensor, options.miss_rate, usable(options.evidence), options.most_views),
        nodes(origins.size() * kLeaf * sum.nodeCount()),
        reports(origins.size() * kLeaf),
        heard(origins.size() * kLeaf),
        empties(origins.size() * kLeaf),
        masked(origins.size() * kLeaf) {}

  TestimonySums leaf(std::size_t index) { return sums().part(index * kLeaf, kLeaf); }
  TestimonySums sums() { return {nodes, reports, heard, empties, masked}; }

  void accumulate(const JudgedView& view, float weight) {
    const PreparedView prepared(view, sensor);
    parallelFor(origins.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::vector<Eigen::Vector3d> points;
        for (int k = 0; k < ScalarGrid::kLeafSize; ++k)
          points.push_back(frame.toWorld(Index3(origins[i] + leafOffset(k))));
        sum.add(prepared, PointBlock(points), weight, leaf(i));
      }
    });
  }

  SensorModel sensor;
  GridFrame frame;
  std::vector<Index3> origins;
  TestimonySum sum;
  std::vector<float> nodes, reports, heard, empties, masked;
};

RunningEvidence::RunningEvidence(const SensorModel& sensor, const GridFrame& frame,
                                 std::vector<Index3> leaf_origins, const RunningEvidenceOptions& options)
    : impl_(std::make_unique<Impl>(sensor, frame, std::move(leaf_origins), options)) {}
RunningEvidence::~RunningEvidence() = default;
RunningEvidence::RunningEvidence(RunningEvidence&&) noexcept = default;
RunningEvidence& RunningEvidence::operator=(RunningEvidence&&) noexcept = default;

void RunningEvidence::add(const JudgedView& view) {
  impl_->accumulate(view, static_cast<float>(view.weight));
}

void RunningEvidence::remove(const JudgedView& view) {
  impl_->accumulate(view, -static_cast<float>(view.weight));
}

ScalarGrid RunningEvidence::evidence() const {
  ScalarGrid grid("sigma", impl_->frame, 0.0f, impl_->origins);
  parallelFor(impl_->origins.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) impl_->sum.finish(impl_->leaf(i), grid.leaf(i).values.data());
  });
  grid.metadata()["about"] = "sigma(x): log-odds that x is outside (Hernandez et al. 2007, sec. 4)";
  return grid;
}

}  // namespace vdbfuse
