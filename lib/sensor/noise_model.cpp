// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/noise_model.h"

#include <cmath>
#include <numbers>

namespace vdbfuse {

double noiseCdf(NoiseShape shape, double u) {
  switch (shape) {
    case NoiseShape::Gaussian:
      return 0.5 * std::erfc(-u / std::numbers::sqrt2);
    case NoiseShape::Logistic:
      return u >= 0 ? 1.0 / (1.0 + std::exp(-u)) : std::exp(u) / (1.0 + std::exp(u));
    case NoiseShape::Laplace:
      return u >= 0 ? 1.0 - 0.5 * std::exp(-u) : 0.5 * std::exp(u);
  }
  return 0.5;
}

std::vector<std::string> validate(const SensorModel& model) {
  std::vector<std::string> problems;
  if (!(model.near >= 0 && model.far > model.near))
    problems.emplace_back("[near, far] must be a range of depths");
  const NoiseLaw& law = model.noise;
  if (!(law.at(model.near) > 0 && law.at(model.far) > 0))
    problems.emplace_back("the noise scale must be positive");
  return problems;
}

}  // namespace vdbfuse
