// SPDX-License-Identifier: Apache-2.0
// vdbfuse compare: what the meshes look like.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/measures.h"
#include "vdbfuse/report/viewer.h"

namespace vdbfuse::tool {

/// The same of all methods, and then of the reference where it is shown, too.
struct PictureSet {
  std::string caption;
  std::vector<PictureFile> files;
};

struct Drawing {
  std::string title;
  std::filesystem::path file;  ///< SVG
};

struct ComparePictures {
  ViewerCamera camera;  ///< of the front
  std::vector<PictureSet> shaded, support, distances;
  std::vector<PictureSet> missing;  ///< the reference by its distance from each method's mesh
  std::vector<Drawing> histograms;
};

/// Draws into folder/pictures and folder/histograms. Throws IoError.
ComparePictures drawPictures(const CompareRequest& request, const std::filesystem::path& folder,
                             const MeasuredMeshes& measured, const CompareRun& run, const Progress& progress);

/// The histograms alone.
std::vector<Drawing> drawHistogramFiles(const std::filesystem::path& folder, const MeasuredMeshes& measured);

}  // namespace vdbfuse::tool
