// SPDX-License-Identifier: Apache-2.0
// A noise model of your own is its cumulative distribution: here Student's with two degrees of freedom, whose
// tails are heavier than those of the models that come with the library.
//   example_03_own_noise_model
#include <cmath>
#include <cstdio>
#include <exception>

#include "vdbfuse/pipeline/reconstruct.h"
#include "vdbfuse/synth/synthetic_scan.h"

int main() try {
  const auto student =
      vdbfuse::NoiseShape::fromCdf("student2", [](double u) { return 0.5 + u / (2 * std::sqrt(2 + u * u)); });

  vdbfuse::SynthOptions scanner;
  scanner.views = 16;
  scanner.width = 120, scanner.height = 90;
  const vdbfuse::SyntheticScan scan(vdbfuse::makeScene("torus"), scanner);
  vdbfuse::ReconstructOptions options;
  options.resolution = 40;
  options.noise_shape = student;
  const vdbfuse::Reconstruction result = reconstruct(scan.views(), options);
  std::printf("%s noise: %zu triangles\n", options.noise_shape.name.c_str(), result.mesh.triangles.size());
  return result.mesh.triangles.empty() ? 1 : 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
