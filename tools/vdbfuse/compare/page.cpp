// SPDX-License-Identifier: Apache-2.0
#include "compare/page.h"

#include <cstdio>
#include <fstream>
#include <iterator>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/version.h"
#include "vdbfuse/report/html.h"
#include "vdbfuse/report/page.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

constexpr double kSupported = 0.5;  // views; as render() colours it

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw IoError(path, "cannot be read");
  return bytes;
}

std::vector<std::string> namesOf(const CompareRun& run) {
  std::vector<std::string> names;
  for (const MethodRecord& method : run.methods) names.push_back(method.name);
  return names;
}

PictureRow rowOf(const fs::path& folder, const std::string& caption, const std::vector<PictureFile>& files,
                 const std::string& key) {
  PictureRow row{caption, {}, key};
  for (const PictureFile& file : files) row.pngs.push_back(file.empty() ? "" : bytesOf(folder / file));
  return row;
}

std::string gridOf(const fs::path& folder, const std::vector<std::string>& columns,
                   const std::vector<PictureSet>& sets, const std::string& key) {
  std::vector<PictureRow> rows;
  for (const PictureSet& set : sets) rows.push_back(rowOf(folder, set.caption, set.files, key));
  return pictureGrid(columns, rows);
}

Section pictures(const CompareRequest& request, const fs::path& folder, const CompareRun& run,
                 const ComparePictures& drawn) {
  std::vector<std::string> columns = namesOf(run);
  if (!request.reference.empty()) columns.emplace_back("reference");
  const std::string key =
      colorKey({{"rgb(208,202,190)", "outside"}, {"rgb(150,90,200)", "inner side: open here"}});
  return {"pictures", "Pictures", "The whole meshes from the same cameras, with the same light.",
          gridOf(folder, columns, drawn.shaded, key)};
}

Section support(const fs::path& folder, const CompareRun& run, const MeasuredMeshes& measured,
                const ComparePictures& drawn) {
  const std::string key =
      colorKey(
          {{"rgb(240,120,20)", "less than half a view: invented by the cut, hardly measured by the TSDF"}}) +
      colorBar("few views", lengthText(measured.largest_support) + " views or more");
  return {"support", "Support",
          "How many views agree with each part of the surface (for the TSDF: the sum of their weights).",
          gridOf(folder, namesOf(run), drawn.support, key)};
}

Section distances(const CompareRequest& request, const fs::path& folder, const CompareRun& run,
                  const MeasuredMeshes& measured, const ComparePictures& drawn) {
  const std::string key = colorBar("0", lengthText(measured.largest_distance) + " or more");
  std::string html = gridOf(folder, namesOf(run), drawn.distances, key);
  if (!drawn.missing.empty())
    html +=
        "<h3>What is missing</h3>\n<p>The reference, coloured by its distance from each method's "
        "surface.</p>\n" +
        gridOf(folder, namesOf(run), drawn.missing, key);
  const bool has_truth = !request.reference.empty();
  return {"distances", has_truth ? "Errors" : "Differences",
          has_truth
              ? "How far each point of the surface lies from the reference."
              : "How far each point of the surface lies from the other mesh; there is no reference to say "
                "which one is right.",
          html};
}

Section slices(const fs::path& folder, const CompareRun& run) {
  std::vector<PictureFile> distance, evidence, weight, cells;
  for (const MethodRecord& m : run.methods) {
    distance.push_back(m.distance_slice), evidence.push_back(m.evidence_slice);
    weight.push_back(m.weight_slice), cells.push_back(m.cell_slice);
  }
  const std::string key = colorKey({{"rgb(60,90,190)", "outside"},
                                    {"rgb(190,50,50)", "inside"},
                                    {"#000", "zero"},
                                    {"#808080", "unknown"}});
  const std::vector<PictureRow> rows = {
      rowOf(folder, "Signed distance, up to four voxels from the surface. The black line is the surface.",
            distance, key),
      rowOf(folder,
            "Evidence σ of the cut: what the views say of each place, visible or hidden. The black line is "
            "where it changes sides.",
            evidence, key),
      rowOf(folder,
            "Where measurements agree: the cost ρ of a surface, small where views agree; for the TSDF the "
            "weight of what was averaged, large where they do.",
            weight, colorBar("little", "much")),
      rowOf(folder, "Cells of the octree, coloured by σ: fine where measurements agree, coarse elsewhere.",
            cells, key)};
  return {"slices", "Slices", "The plane " + planeText(run.plane) + " through what each method decided by.",
          pictureGrid(namesOf(run), rows)};
}

Section histograms(const fs::path& folder, const ComparePictures& drawn) {
  std::string html = "<div class=\"drawings\">\n";
  for (const Drawing& drawing : drawn.histograms)
    html += "<figure>" + bytesOf(folder / drawing.file) + "<figcaption>" + escapeHtml(drawing.title) +
            ".</figcaption></figure>\n";
  return {"histograms", "Histograms", "", html + "</div>\n"};
}

Section viewer(const MeasuredMeshes& measured, const ComparePictures& drawn,
               const std::vector<EmbeddedMesh>& embedded) {
  std::vector<ViewerMesh> meshes;
  for (const EmbeddedMesh& each : embedded) meshes.push_back(each.viewer);
  const std::vector<ViewerColoring> colorings = {
      {"Support", kSupportAttribute, measured.largest_support, kSupported, "few views",
       lengthText(measured.largest_support) + " views or more; orange: less than half a view"},
      {"Distance", kDistanceAttribute, measured.largest_distance, 0, "0",
       lengthText(measured.largest_distance) + " or more from " + measured.measured_from},
      {"Photographs", "color", 1, 0, "", ""}};
  return {"viewer", "Viewer",
          "One camera for all. Large meshes are simplified here, and their smallest parts may be gone; the "
          "whole ones lie in meshes/ beside this page. Violet: inner side, the mesh is open there.",
          viewerHtml(meshes, colorings, drawn.camera)};
}

std::string memoryWords(const CompareRun& run) {
  if (run.methods.front().measured == PeakMemory::SinceTheStart)
    return "This system does not let a process restart the count of its peak memory, so that a method's peak "
           "is the largest up to its end.";
  return "Memory is the resident set. Its peak is counted anew for each method, after freed memory was given "
         "back; "
         "the judged views are in it, and the grids that the slices are drawn from.";
}

Section howItWasMade(const CompareRun& run, const Json& json) {
  const std::string html =
      "<p>Views are read and judged once; all methods have the same voxels, the same sensor model and the "
      "same "
      "extractor. The time of each method includes the shared steps, so that it can be compared with that of "
      "vdbfuse fuse.</p>\n<p>" +
      escapeHtml(memoryWords(run)) +
      "</p>\n<p>Beside this page: meshes/ (PLY, all triangles), viewer/ (glb, simplified), pictures/, "
      "slices/, "
      "histograms/, compare.json.</p>\n<details><summary>compare.json</summary><pre>" +
      escapeHtml(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "</pre></details>\n";
  return {"how", "How it was made", "", html};
}

std::string headline(const CompareRun& run) {
  char text[256];
  std::snprintf(text, sizeof text,
                "%zu views of %zu × %zu pixels (%s), voxel %.4g, noise %.3g at depth %.3g, outliers %.1f %%",
                run.views, run.width, run.height, run.format.c_str(), run.voxel, run.calibration.noise_scale,
                run.calibration.median_depth, 100 * run.calibration.outlier_share);
  return text;
}

std::string titleOf(const CompareRequest& request) {
  fs::path input = request.input.lexically_normal();
  if (!input.has_filename()) input = input.parent_path();
  std::string title;
  for (const std::string& method : request.methods) title += (title.empty() ? "" : ", ") + method;
  return input.filename().string() + ": " + title;
}

}  // namespace

std::string comparePage(const CompareRequest& request, const fs::path& folder, const CompareRun& run,
                        const MeasuredMeshes& measured, const ComparePictures& drawn,
                        const std::vector<EmbeddedMesh>& embedded) {
  Page page{titleOf(request), headline(run), {}, {}};
  page.sections.push_back(
      {"numbers", "Numbers",
       "The arrow says which way is better, green is the best. Lengths are in the unit of the "
       "poses.",
       numberTable(namesOf(run), numbersOf(run))});
  page.sections.push_back(viewer(measured, drawn, embedded));
  page.sections.push_back(pictures(request, folder, run, drawn));
  if (!drawn.distances.empty()) page.sections.push_back(distances(request, folder, run, measured, drawn));
  page.sections.push_back(support(folder, run, measured, drawn));
  page.sections.push_back(slices(folder, run));
  page.sections.push_back(histograms(folder, drawn));
  page.sections.push_back(howItWasMade(run, compareJson(request, run, embedded)));
  page.footer_html = "<p>Made by vdbfuse compare, version " VDBFUSE_VERSION ".";
  if (!viewerLicence().empty())
    page.footer_html +=
        " The viewer uses three.js.</p>\n<details><summary>Licence of three.js</summary><pre>" +
        escapeHtml(viewerLicence()) + "</pre></details>";
  page.footer_html += "\n";
  return formatPage(page);
}

}  // namespace vdbfuse::tool
