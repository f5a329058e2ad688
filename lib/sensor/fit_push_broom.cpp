// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kFewestPoints = 16;
constexpr double kLargestErrorPx = 0.5;
// Rows that meet further away than this many times the spread of the points are as good as parallel.
constexpr double kFurthestCentre = 1000;

// One point and its pixel, or the mean or spread of many.
struct Sample {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double column = 0, row = 0;
};

std::vector<Sample> samplesOf(const PointImage& points) {
  std::vector<Sample> samples;
  for (int y = 0; y < points.height(); ++y) {
    for (int x = 0; x < points.width(); ++x) {
      const Eigen::Vector3d p = points(x, y).cast<double>();
      if (p.allFinite()) samples.push_back({p, static_cast<double>(x), static_cast<double>(y)});
    }
  }
  return samples;
}

Sample meanOf(const std::vector<Sample>& samples) {
  Sample mean;
  const auto count = static_cast<double>(samples.size());
  for (const Sample& s : samples) {
    mean.point += s.point / count;
    mean.column += s.column / count, mean.row += s.row / count;
  }
  return mean;
}

double spreadOf(const std::vector<Sample>& samples, const Sample& mean) {
  double sum = 0;
  for (const Sample& s : samples) sum += (s.point - mean.point).squaredNorm();
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

// Least squares of values that are sums of N unknowns times known factors.
template <int N>
class LinearFit {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  void add(const Vector& factors, double value) {
    products_ += factors * factors.transpose();
    sums_ += factors * value;
  }
  Vector solve() const { return products_.ldlt().solve(sums_); }

 private:
  Eigen::Matrix<double, N, N> products_ = Eigen::Matrix<double, N, N>::Zero();
  Vector sums_ = Vector::Zero();
};

// row = (a + f y + c z)/(1 + e z), with y, z and rows counted from their means in units of the spread:
// parallel rows are e = 0, so that all four unknowns are well determined however far the centre is.
struct RowModel {
  double a = 0, f = 0, c = 0, e = 0;
  double numerator(double y, double z) const { return a + f * y + c * z; }
  double row(double y, double z) const { return numerator(y, z) / (1 + e * z); }
};

RowModel fitRows(const std::vector<Sample>& samples, const Sample& mean, double spread) {
  constexpr int kSteps = 10;
  RowModel model;
  for (int step = 0; step <= kSteps; ++step) {
    // From all zero the first step solves row (1 + e z) = a + f y + c z.
    LinearFit<4> fit;
    for (const Sample& s : samples) {
      const double y = (s.point.y() - mean.point.y()) / spread, z = (s.point.z() - mean.point.z()) / spread;
      const double row = s.row - mean.row, scale = 1 + model.e * z;
      const double seen = step == 0 ? row : model.row(y, z);
      fit.add(Eigen::Vector4d(1, y, z, -seen * z) / scale, row - (step == 0 ? 0 : seen));
    }
    const Eigen::Vector4d change = fit.solve();
    model.a += change(0), model.f += change(1), model.c += change(2), model.e += change(3);
  }
  return model;
}

// Puts the origin where the rows meet.
void placeRows(const RowModel& model, const Sample& mean, double spread, FittedPushBroom& result) {
  if (!(model.e * kFurthestCentre > 1))
    throw InvalidArgument("points", "expected rows that converge at the sensor, found none that do");
  const double y = (model.c / model.e - model.a) / model.f;
  result.origin = {0, mean.point.y() + spread * y, mean.point.z() - spread / model.e};
  result.sensor.cy = mean.row + model.c / model.e;
  result.sensor.fy = model.f / model.e;
}

void fitColumns(const std::vector<Sample>& samples, const Sample& mean, double spread,
                FittedPushBroom& result) {
  LinearFit<2> fit;
  for (const Sample& s : samples) {
    fit.add({s.column - mean.column, (s.point.z() - mean.point.z()) / spread}, s.point.x() - mean.point.x());
  }
  const Eigen::Vector2d found = fit.solve();
  result.sensor.x_step = found(0);
  result.sensor.x_shear = found(1) / spread;
  result.sensor.x0 =
      mean.point.x() - found(0) * mean.column - result.sensor.x_shear * (mean.point.z() - result.origin.z());
}

double errorOf(const std::vector<Sample>& samples, const FittedPushBroom& found) {
  double sum = 0;
  for (const Sample& s : samples) {
    const auto seen = project(found.sensor, s.point - found.origin);
    if (!seen) return std::numeric_limits<double>::infinity();
    sum += std::pow(seen->x - s.column, 2) + std::pow(seen->y - s.row, 2);
  }
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

}  // namespace

FittedPushBroom fitPushBroom(const PointImage& points) {
  const std::vector<Sample> samples = samplesOf(points);
  if (samples.size() < kFewestPoints)
    throw InvalidArgument("points", "expected at least 16 points, found " + std::to_string(samples.size()));
  const Sample mean = meanOf(samples);
  const double spread = spreadOf(samples, mean);
  FittedPushBroom result;
  result.sensor.width = points.width(), result.sensor.height = points.height();
  placeRows(fitRows(samples, mean, spread), mean, spread, result);
  fitColumns(samples, mean, spread, result);
  result.error_px = errorOf(samples, result);
  if (!validate(Projection(result.sensor)).empty() || !(result.error_px <= kLargestErrorPx))
    throw InvalidArgument("points", "expected points of a sheet of light moved sideways, found them " +
                                        std::to_string(result.error_px) + " pixels off the best one");
  return result;
}

}  // namespace vdbfuse
