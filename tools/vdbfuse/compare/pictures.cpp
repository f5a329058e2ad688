// SPDX-License-Identifier: Apache-2.0
#include "compare/pictures.h"

#include "compare/cameras.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/report/render.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

// Draws meshes into files, all with the same light.
class Drawer {
 public:
  Drawer(const fs::path& folder, const Eigen::Vector3d& up, const Progress& progress)
      : folder_(folder), up_(up), progress_(progress) {}

  PictureFile shaded(const TriangleMesh& mesh, const std::string& name, const NamedCamera& camera) const {
    return draw(mesh, "shaded-" + camera.file + "-" + name, camera, {});
  }

  PictureFile support(const ShownMesh& shown, double high, const NamedCamera& camera) const {
    RenderOptions options;
    options.coloring = MeshColoring::Support, options.high = high;
    return draw(shown.mesh, "support-" + camera.file + "-" + shown.name, camera, options);
  }

  PictureFile values(const TriangleMesh& mesh, const std::vector<float>& values, double high,
                     const std::string& name, const NamedCamera& camera) const {
    if (values.empty()) return {};
    RenderOptions options;
    options.coloring = MeshColoring::Values, options.values = values, options.high = high;
    return draw(mesh, name, camera, options);
  }

 private:
  PictureFile draw(const TriangleMesh& mesh, const std::string& name, const NamedCamera& camera,
                   RenderOptions options) const {
    progress_.report("pictures", 0);
    options.up = up_;
    PictureFile file = fs::path("pictures") / (name + ".png");
    writePng(folder_ / file, render(mesh, camera.view, options));
    return file;
  }

  const fs::path& folder_;
  const Eigen::Vector3d up_;
  const Progress& progress_;
};

PictureSet shadedRow(const Drawer& drawer, const MeasuredMeshes& measured, const NamedCamera& camera) {
  PictureSet row{camera.words, {}};
  for (const ShownMesh& shown : measured.meshes)
    row.files.push_back(drawer.shaded(shown.mesh, shown.name, camera));
  if (!measured.reference.triangles.empty())
    row.files.push_back(drawer.shaded(measured.reference, "reference", camera));
  return row;
}

// Support and distances from one camera.
void addColoredRows(const Drawer& drawer, const MeasuredMeshes& measured, const NamedCamera& camera,
                    ComparePictures& pictures) {
  PictureSet support{camera.words, {}}, distances = support, missing = support;
  const double high = measured.largest_distance;
  for (const ShownMesh& shown : measured.meshes) {
    const std::string place = camera.file + "-" + shown.name;
    support.files.push_back(drawer.support(shown, measured.largest_support, camera));
    distances.files.push_back(drawer.values(shown.mesh, shown.distances, high, "distance-" + place, camera));
    missing.files.push_back(
        drawer.values(measured.reference, shown.missing, high, "missing-" + place, camera));
  }
  if (!distances.files.front().empty()) pictures.distances.push_back(std::move(distances));
  if (!missing.files.front().empty()) pictures.missing.push_back(std::move(missing));
  pictures.support.push_back(std::move(support));
}

}  // namespace

ComparePictures drawPictures(const CompareRequest& request, const fs::path& folder,
                             const MeasuredMeshes& measured, const CompareRun& run,
                             const Progress& progress) {
  fs::create_directory(folder / "pictures"), fs::create_directory(folder / "histograms");
  const Eigen::Vector3d up = chooseUp(request.up, run.cameras);
  const TriangleMesh& framed =
      measured.reference.triangles.empty() ? measured.meshes.front().mesh : measured.reference;
  const CameraList cameras = chooseCameras(framed, run.cameras, up);
  const Drawer drawer(folder, up, progress);
  ComparePictures pictures;
  const Eigen::Vector3d eye = cameras.front().view.world_from_camera.translation();
  pictures.camera = {eye, boundingBox(framed).center(), up};
  for (const NamedCamera& camera : cameras.all)
    pictures.shaded.push_back(shadedRow(drawer, measured, camera));
  for (const NamedCamera& camera : cameras.all)
    if (&camera == &cameras.front() || &camera == &cameras.other())
      addColoredRows(drawer, measured, camera, pictures);
  pictures.histograms = drawHistogramFiles(folder, measured);
  return pictures;
}

}  // namespace vdbfuse::tool
