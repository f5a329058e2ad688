// SPDX-License-Identifier: Apache-2.0
#include "fusion/two_class_em.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace vdbfuse {
namespace {

constexpr double kUndecided = 0.5;
// A value of the second observation that few decided counts have leans on the share of all by this part of
// them.
constexpr double kLeaning = 0.01;

// One combination of values that occurs.
struct Cell {
  std::vector<std::size_t> values;
  double count, outlier;  // outlier: posterior
};

std::vector<Cell> cellsOf(const JointCounts& joint, const FirstOpinion& opinion) {
  std::vector<Cell> cells;
  for (std::size_t k = 0; k < joint.counts.size(); ++k) {
    if (joint.counts[k] == 0) continue;
    std::vector<std::size_t> values = joint.values(k);
    const double outlier = opinion.outlier[values[0]].value_or(kUndecided);
    cells.push_back({std::move(values), joint.counts[k], outlier});
  }
  return cells;
}

// Outlier share, for each value of the second observation, of the counts whose first value is decided.
std::vector<double> baseRates(const std::vector<Cell>& cells, const FirstOpinion& opinion, std::size_t size) {
  std::vector<double> bad(size), all(size);
  double bad_total = 0, all_total = 0, total = 0;
  for (const Cell& cell : cells) {
    total += cell.count;
    if (!opinion.outlier[cell.values[0]]) continue;
    bad[cell.values[1]] += cell.count * cell.outlier, all[cell.values[1]] += cell.count;
    bad_total += cell.count * cell.outlier, all_total += cell.count;
  }
  const double share = all_total > 0 ? bad_total / all_total : kUndecided, leaning = kLeaning * total;
  std::vector<double> rates(size, share);
  for (std::size_t v = 0; v < size; ++v) rates[v] = (bad[v] + share * leaning) / (all[v] + leaning);
  return rates;
}

void normalise(std::vector<double>& histogram) {
  const double sum = std::accumulate(histogram.begin(), histogram.end(), 0.0);
  for (double& value : histogram) value /= sum;
}

// Both classes from the posterior of each cell.
TwoClassModel maximise(const JointCounts& joint, const std::vector<Cell>& cells,
                       const FirstOpinion& opinion) {
  const std::vector<double> rates = baseRates(cells, opinion, joint.sizes[1]);
  std::vector<double> bad(joint.sizes[0]), all(joint.sizes[0]);
  TwoClassModel model;
  for (std::size_t i = 1; i < joint.sizes.size(); ++i) {
    model.inlier.emplace_back(joint.sizes[i], 1.0);
    model.outlier.emplace_back(joint.sizes[i], 1.0);
  }
  for (const Cell& cell : cells) {
    const std::size_t first = cell.values[0];
    const double held = opinion.outlier[first].value_or(rates[cell.values[1]]);
    bad[first] += cell.count * (cell.outlier + opinion.trust * held);
    all[first] += cell.count * (1 + opinion.trust);
    for (std::size_t i = 1; i < cell.values.size(); ++i) {
      model.outlier[i - 1][cell.values[i]] += cell.count * cell.outlier;
      model.inlier[i - 1][cell.values[i]] += cell.count * (1 - cell.outlier);
    }
  }
  for (std::size_t v = 0; v < bad.size(); ++v)
    model.first.push_back(all[v] > 0 ? bad[v] / all[v] : opinion.outlier[v].value_or(kUndecided));
  std::for_each(model.inlier.begin(), model.inlier.end(), normalise);
  std::for_each(model.outlier.begin(), model.outlier.end(), normalise);
  return model;
}

}  // namespace

JointCounts::JointCounts(std::vector<std::size_t> observation_sizes)
    : sizes(std::move(observation_sizes)),
      counts(std::accumulate(sizes.begin(), sizes.end(), std::size_t{1}, std::multiplies<>())) {}

std::size_t JointCounts::index(std::span<const std::size_t> values) const {
  std::size_t index = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) index = index * sizes[i] + values[i];
  return index;
}

std::vector<std::size_t> JointCounts::values(std::size_t index) const {
  std::vector<std::size_t> result(sizes.size());
  for (std::size_t i = sizes.size(); i-- > 0; index /= sizes[i]) result[i] = index % sizes[i];
  return result;
}

double TwoClassModel::outlierGiven(std::span<const std::size_t> values) const {
  double bad = first[values[0]], good = 1 - bad;
  for (std::size_t i = 1; i < values.size(); ++i) {
    bad *= outlier[i - 1][values[i]];
    good *= inlier[i - 1][values[i]];
  }
  return bad / (bad + good);
}

TwoClassModel fitTwoClasses(const JointCounts& joint, const FirstOpinion& opinion) {
  constexpr int kIterations = 200;
  constexpr double kConverged = 1e-4;
  std::vector<Cell> cells = cellsOf(joint, opinion);
  TwoClassModel model;
  for (int i = 0; i < kIterations; ++i) {
    model = maximise(joint, cells, opinion);
    double change = 0;
    for (Cell& cell : cells) {
      const double next = model.outlierGiven(cell.values);
      change = std::max(change, std::abs(next - cell.outlier));
      cell.outlier = next;
    }
    if (change < kConverged) break;
  }
  return model;
}

}  // namespace vdbfuse
