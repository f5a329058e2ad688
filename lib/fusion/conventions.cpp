// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/conventions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fusion/convention_rating.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using Pose = Convention::Pose;

struct PoseName {
  Pose pose;
  const char* name;
  const char* words;
};

constexpr std::array<PoseName, 8> kPoses = {{
    {Pose::AsRead, "as-read", "poses as they were read"},
    {Pose::Inverse, "inverse", "poses are camera_from_world, not world_from_camera (or the other way round)"},
    {Pose::Transposed, "transposed", "rotations are transposed (quaternions conjugated)"},
    {Pose::InverseTransposed, "inverse-transposed", "the rotations of the inverse poses are transposed"},
    {Pose::ScalarFirst, "scalar-first", "quaternions are w x y z, not x y z w"},
    {Pose::ScalarLast, "scalar-last", "quaternions are x y z w, not w x y z"},
    {Pose::InverseScalarFirst, "inverse-scalar-first",
     "quaternions of the inverse poses are w x y z, not x y z w"},
    {Pose::InverseScalarLast, "inverse-scalar-last",
     "quaternions of the inverse poses are x y z w, not w x y z"},
}};
constexpr const char* kFlipped = "opengl";
constexpr const char* kRange = "range";
constexpr const char* kZ = "z";
constexpr const char* kFactor = "depth*";

// Units and scales that are mistaken for each other: millimetres, centimetres, and the 5000 of the TUM
// benchmark.
constexpr double kFactors[] = {1.0, 0.001, 1000.0, 0.01, 100.0, 0.1, 10.0, 0.2, 5.0, 0.25, 4.0, 0.5, 2.0};

std::string factorText(double factor) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", factor);
  return text;
}

RigidTransform transposed(RigidTransform pose) {
  pose.linear() = pose.linear().transpose().eval();
  return pose;
}

// The rotation whose quaternion has the same four numbers in another order.
RigidTransform reordered(RigidTransform pose, Pose order) {
  const Eigen::Quaterniond q(pose.linear());
  const bool scalar_first = order == Pose::ScalarFirst;
  const Eigen::Quaterniond p = scalar_first ? Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w())
                                            : Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y());
  pose.linear() = p.toRotationMatrix();
  return pose;
}

RigidTransform read(const RigidTransform& pose, Pose how) {
  switch (how) {
    case Pose::AsRead:
      return pose;
    case Pose::Inverse:
      return pose.inverse();
    case Pose::Transposed:
      return transposed(pose);
    case Pose::InverseTransposed:
      return transposed(pose.inverse()).inverse();
    case Pose::ScalarFirst:
    case Pose::ScalarLast:
      return reordered(pose, how);
    case Pose::InverseScalarFirst:
      return reordered(pose.inverse(), Pose::ScalarFirst).inverse();
    case Pose::InverseScalarLast:
      return reordered(pose.inverse(), Pose::ScalarLast).inverse();
  }
  return pose;
}

// One word of a name; false when there is none of that kind.
bool addWord(const std::string& word, Convention& convention) {
  for (const PoseName& p : kPoses) {
    if (word == p.name) return convention.pose = p.pose, true;
  }
  if (word == kFlipped) return convention.axes = Convention::Axes::Flipped, true;
  if (word == kRange) return convention.depth = Convention::Depth::Range, true;
  if (word == kZ) return convention.depth = Convention::Depth::Z, true;
  if (!word.starts_with(kFactor)) return false;
  char* end = nullptr;
  convention.depth_factor = std::strtod(word.c_str() + std::string(kFactor).size(), &end);
  return *end == '\0' && convention.depth_factor > 0 && std::isfinite(convention.depth_factor);
}

std::vector<Convention> candidates() {
  std::vector<Convention> result;
  for (const PoseName& p : kPoses) {
    for (const auto axes : {Convention::Axes::AsRead, Convention::Axes::Flipped}) {
      for (const double factor : kFactors)
        result.push_back({p.pose, axes, Convention::Depth::AsRead, factor});
    }
  }
  for (const auto depth : {Convention::Depth::Range, Convention::Depth::Z})
    result.push_back({Pose::AsRead, Convention::Axes::AsRead, depth, 1.0});
  return result;
}

int changes(const Convention& c) {
  const int pose = c.pose == Pose::AsRead                                            ? 0
                   : c.pose < Pose::ScalarFirst && c.pose != Pose::InverseTransposed ? 1
                                                                                     : 2;
  return pose + (c.axes != Convention::Axes::AsRead) + (c.depth != Convention::Depth::AsRead) +
         (c.depth_factor != 1);
}

// Of those that are nearly as good as the best, the one that changes least: round things agree under several.
const RatedConvention* plainestOfTheBest(const std::vector<RatedConvention>& rated) {
  constexpr double kNearly = 0.05;
  double best = 0;
  for (const RatedConvention& r : rated) best = std::max(best, r.agreement);
  const RatedConvention* found = nullptr;
  for (const RatedConvention& r : rated) {
    if (r.agreement < best - kNearly) continue;
    const int more = found == nullptr ? -1 : changes(r.convention) - changes(found->convention);
    if (more < 0 || (more == 0 && r.agreement > found->agreement)) found = &r;
  }
  return found;
}

bool isClearlyBetter(double candidate, double as_read) {
  constexpr double kShareOfTheMissing = 1.0 / 3, kLeastGain = 0.15, kTimes = 3, kLeast = 0.3;
  if (candidate < kLeast || candidate < as_read + kLeastGain) return false;
  return candidate > as_read + kShareOfTheMissing * (1 - as_read) || candidate > kTimes * as_read;
}

}  // namespace

std::string nameOf(const Convention& convention) {
  std::string name;
  const auto add = [&](const std::string& word) { name += (name.empty() ? "" : ",") + word; };
  if (convention.pose != Pose::AsRead) add(kPoses[static_cast<std::size_t>(convention.pose)].name);
  if (convention.axes == Convention::Axes::Flipped) add(kFlipped);
  if (convention.depth == Convention::Depth::Range) add(kRange);
  if (convention.depth == Convention::Depth::Z) add(kZ);
  if (convention.depth_factor != 1) add(kFactor + factorText(convention.depth_factor));
  return name.empty() ? kPoses[0].name : name;
}

std::optional<Convention> conventionNamed(const std::string& name) {
  Convention convention;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find(',', begin), name.size());
    if (!addWord(name.substr(begin, end - begin), convention)) return std::nullopt;
    begin = end + 1;
  }
  return convention;
}

std::string describe(const Convention& convention) {
  std::string words;
  const auto add = [&](const std::string& more) { words += (words.empty() ? "" : "; ") + more; };
  if (convention.pose != Pose::AsRead) add(kPoses[static_cast<std::size_t>(convention.pose)].words);
  if (convention.axes == Convention::Axes::Flipped)
    add("camera axes are those of OpenGL (x right, y up, z backward), not x right, y down, z forward (or the "
        "other way round)");
  if (convention.depth == Convention::Depth::Range) add("depth is the distance along the ray, not z");
  if (convention.depth == Convention::Depth::Z) add("depth is z, not the distance along the ray");
  if (convention.depth_factor != 1)
    add("depths are " + factorText(convention.depth_factor) + " times what was read");
  return words.empty() ? kPoses[0].words : words;
}

ViewSequence underConvention(const ViewSequence& views, const std::vector<RigidTransform>& stored_from_camera,
                             const Convention& convention) {
  std::vector<ViewHeader> headers;
  for (std::size_t i = 0; i < views.size(); ++i) {
    headers.push_back(views.header(i));
    ViewHeader& header = headers.back();
    const RigidTransform stored =
        stored_from_camera.empty() ? RigidTransform::Identity() : stored_from_camera[i];
    const RigidTransform before = header.world_from_camera;
    header.world_from_camera = poseUnder(before, stored, convention);
    if (header.color_sensor)
      header.color_sensor->world_from_camera =
          header.world_from_camera * before.inverse() * header.color_sensor->world_from_camera;
  }
  return ViewSequence(std::move(headers), [views, convention](std::size_t index) {
    View view = views.load(index);
    const DepthReader depth(view.projection, convention);
    for (int y = 0; y < view.map.depth.height(); ++y) {
      for (int x = 0; x < view.map.depth.width(); ++x)
        view.map.depth(x, y) = static_cast<float>(depth(x, y, view.map.depth(x, y)));
    }
    normaliseInvalid(view.map.depth);
    return std::move(view.map);
  });
}

RigidTransform poseUnder(const RigidTransform& world_from_camera, const RigidTransform& stored_from_camera,
                         const Convention& convention) {
  RigidTransform world_from_stored = read(world_from_camera * stored_from_camera.inverse(), convention.pose);
  if (convention.axes == Convention::Axes::Flipped) {
    RigidTransform flip = RigidTransform::Identity();
    flip.linear().diagonal() << 1, -1, -1;
    world_from_stored = world_from_stored * flip;
  }
  return world_from_stored * stored_from_camera;
}

ConventionCheck checkConvention(const ViewSequence& views,
                                const std::vector<RigidTransform>& stored_from_camera,
                                const ConventionOptions& options, const Progress& progress) {
  ConventionCheck check;
  const std::vector<SampledView> samples = sampleViews(views, stored_from_camera, options);
  if (samples.size() < 2) return check;
  const double tolerance = options.tolerance * typicalSize(samples);
  if (const double as_read = agreementUnder(samples, {}, tolerance); as_read >= options.enough) {
    check.agreement = as_read;
    return check;
  }
  std::vector<RatedConvention> rated;
  for (const Convention& candidate : candidates()) rated.push_back({candidate, 0});
  ProgressStep step(progress, "conventions", rated.size());
  parallelFor(rated.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      rated[i].agreement = agreementUnder(samples, rated[i].convention, tolerance);
    step.advance(end - begin);
  });
  const RatedConvention* best = plainestOfTheBest(rated);
  constexpr double kLeastToTell = 0.2;
  if (best->agreement < kLeastToTell) return check;
  check.agreement = rated.front().agreement;
  if (isClearlyBetter(best->agreement, rated.front().agreement)) check.better = *best;
  return check;
}

}  // namespace vdbfuse
