// SPDX-License-Identifier: Apache-2.0
// vdbfuse compare: report.html and compare.json.
#pragma once

#include <cstddef>
#include <string>

#include "compare/methods.h"
#include "compare/pictures.h"
#include "vdbfuse/report/page.h"

namespace vdbfuse::tool {

/// Names of the viewer's values in the embedded meshes.
inline constexpr const char* kSupportAttribute = "_SUPPORT";
inline constexpr const char* kDistanceAttribute = "_DISTANCE";

/// "y = 0.25"
std::string planeText(const SlicePlane& plane);

/// A mesh in the page: simplified, with what the viewer colours it by.
struct EmbeddedMesh {
  ViewerMesh viewer;
  std::size_t triangles = 0, of = 0;  ///< shown, of so many
};

/// At most about `triangles` each.
std::vector<EmbeddedMesh> embedMeshes(const MeasuredMeshes& measured, std::size_t triangles,
                                      const Progress& progress);

/// Everything that is known, for other programs.
Json compareJson(const CompareRequest& request, const CompareRun& run,
                 const std::vector<EmbeddedMesh>& embedded);

/// The page. Pictures come from `folder`. Throws IoError.
std::string comparePage(const CompareRequest& request, const std::filesystem::path& folder,
                        const CompareRun& run, const MeasuredMeshes& measured,
                        const ComparePictures& pictures, const std::vector<EmbeddedMesh>& embedded);

/// The groups of the page's table, for the terminal, too.
std::vector<NumberGroup> numbersOf(const CompareRun& run);

}  // namespace vdbfuse::tool
