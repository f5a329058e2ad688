// SPDX-License-Identifier: Apache-2.0
#include "formats/numpy_arrays.h"

#include <utility>

#include "io/folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

struct RoleNames {
  ArrayRole role;
  std::vector<std::string_view> names;
};

const std::vector<RoleNames>& roleNames() {
  static const std::vector<RoleNames> all = {
      {ArrayRole::Depth,
       {"depth", "depths", "depth_map", "depth_maps", "depthmap", "depthmaps", "pred_depth", "pred_depths",
        "depth_pred"}},
      {ArrayRole::Confidence,
       {"confidence", "confidences", "conf", "confs", "depth_conf", "depth_confidence", "depths_conf"}},
      {ArrayRole::Color,
       {"color", "colors", "colour", "rgb", "rgbs", "image", "images", "img", "imgs", "rgb_img"}},
      {ArrayRole::Intrinsics,
       {"intrinsics", "intrinsic", "K", "Ks", "camera_intrinsics", "intrinsic_matrix", "cam_K"}},
      {ArrayRole::WorldFromCamera,
       {"world_from_camera", "world_from_cam", "cam2world", "c2w", "camera_to_world", "cam_to_world", "pose",
        "poses", "camera_pose", "camera_poses", "cam_poses"}},
      {ArrayRole::CameraFromWorld,
       {"camera_from_world", "cam_from_world", "world2cam", "w2c", "world_to_camera", "world_to_cam",
        "extrinsics", "extrinsic", "camera_extrinsics"}},
  };
  return all;
}

bool isImage(ArrayRole role) { return role == ArrayRole::Depth || role == ArrayRole::Confidence; }

struct Sides {
  std::optional<std::size_t> frames;
  std::vector<std::int64_t> item;
};

Sides sidesOf(const io::StoredArray& array, ArrayRole role) {
  const std::size_t rank = role == ArrayRole::Color ? 3 : 2;
  std::vector<std::int64_t> sides = array.header().shape;
  if (isImage(role) && sides.size() > 2 && sides.back() == 1) sides.pop_back();
  while (sides.size() > rank + 1 && sides.front() == 1) sides.erase(sides.begin());
  if (sides.size() != rank && sides.size() != rank + 1) {
    const char* expected = isImage(role)              ? "(frames, rows, columns)"
                           : role == ArrayRole::Color ? "(frames, rows, columns, 3)"
                                                      : "(frames, rows, columns) of matrices";
    throw IoError(array.path(), array.place(), expected, "shape " + array.header().shapeText());
  }
  if (sides.size() == rank) return {std::nullopt, sides};
  const auto frames = static_cast<std::size_t>(sides.front());
  sides.erase(sides.begin());
  return {frames, sides};
}

}  // namespace

std::optional<ArrayMeaning> meaningOf(std::string_view name) {
  for (const RoleNames& role : roleNames()) {
    for (std::size_t rank = 0; rank < role.names.size(); ++rank) {
      if (role.names[rank] == name) return ArrayMeaning{role.role, rank};
    }
  }
  return std::nullopt;
}

std::string namesOf(ArrayRole wanted) {
  std::string text;
  for (const RoleNames& role : roleNames()) {
    for (std::size_t i = 0; role.role == wanted && i < 4; ++i) text += std::string(role.names[i]) + ", ";
  }
  return text + "...";
}

template <class Open>
void ArrayGroup::add(const std::string& name, const Open& open) {
  const std::optional<ArrayMeaning> meaning = meaningOf(name);
  if (!meaning) return;
  const auto found = members_.find(meaning->role);
  if (found != members_.end() && found->second.rank <= meaning->rank) {
    left_out_.push_back(name);
    return;
  }
  if (found != members_.end()) left_out_.push_back(found->second.name);
  members_.insert_or_assign(meaning->role,
                            Member{name, meaning->rank, std::make_shared<const io::StoredArray>(open())});
}

void ArrayGroup::addNpz(const std::filesystem::path& path) {
  for (const std::string& name : io::npzNames(path)) add(name, [&] { return io::StoredArray(path, name); });
}

void ArrayGroup::addNpy(const std::filesystem::path& path, const std::string& name) {
  add(name, [&] { return io::StoredArray(path); });
}

std::shared_ptr<const io::StoredArray> ArrayGroup::find(ArrayRole role) const {
  const auto found = members_.find(role);
  return found == members_.end() ? nullptr : found->second.array;
}

std::size_t ArrayItem::count() const {
  std::size_t product = 1;
  for (const std::int64_t side : shape) product *= static_cast<std::size_t>(side);
  return product;
}

std::optional<std::size_t> frameCount(const io::StoredArray& array, ArrayRole role) {
  return sidesOf(array, role).frames;
}

ArrayItem itemOf(std::shared_ptr<const io::StoredArray> array, ArrayRole role, std::size_t index,
                 std::size_t count) {
  Sides sides = sidesOf(*array, role);
  const bool is_of_all = role == ArrayRole::Intrinsics && sides.frames.value_or(1) == 1;
  if (sides.frames.value_or(1) != count && !is_of_all)
    throw IoError(array->path(), array->place(), counted(count, "frame") + " as there are depth maps",
                  "shape " + array->header().shapeText());
  ArrayItem item{std::move(array), 0, std::move(sides.item)};
  if (sides.frames && !is_of_all) item.first = index * item.count();
  return item;
}

}  // namespace vdbfuse
