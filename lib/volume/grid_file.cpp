// SPDX-License-Identifier: Apache-2.0
#include <openvdb/io/File.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <system_error>

#include "vdbfuse/base/errors.h"
#include "volume/scalar_grid_impl.h"

namespace vdbfuse {
namespace {

constexpr const char* kCreator = "vdbfuse";
// Metadata of a field whose inactive voxels are unknown; to tools that do not ask they are 0.
constexpr const char* kInactive = "inactive";
constexpr const char* kInactiveUnknown = "unknown";

using LeafNode = openvdb::FloatTree::LeafNodeType;

// Largest distance of a level set: the background that other tools expect, who know no unknown voxels.
float bandWidth(const ScalarGrid::Impl& impl) {
  float largest = 0;
  for (const LeafNode* leaf : impl.leaves) {
    for (openvdb::Index i = 0; i < LeafNode::SIZE; ++i) {
      const float value = std::abs(leaf->getValue(i));
      if (value > largest) largest = value;  // false for unknown ones
    }
  }
  return largest > 0 ? largest : static_cast<float>(impl.frame.voxel);
}

// A copy with active states set, fit for other tools.
openvdb::FloatGrid::Ptr forDisk(const ScalarGrid::Impl& impl) {
  const bool is_level_set = impl.kind == GridKind::LevelSet;
  const bool has_unknown = !is_level_set && std::isnan(impl.grid->background());
  const float background = is_level_set ? bandWidth(impl) : has_unknown ? 0.0f : impl.grid->background();
  const auto copy = openvdb::FloatGrid::create(background);
  copy->setTransform(impl.grid->transform().copy());
  for (const LeafNode* leaf : impl.leaves) {
    LeafNode* target = nullptr;
    for (openvdb::Index i = 0; i < LeafNode::SIZE; ++i) {
      const float value = leaf->getValue(i);
      if (std::isnan(value) || (!is_level_set && !has_unknown && value == background)) continue;
      if (target == nullptr) target = copy->tree().touchLeaf(leaf->origin());
      target->setValueOn(i, value);
    }
  }
  copy->setName(impl.name);
  copy->setCreator(kCreator);
  copy->setGridClass(is_level_set ? openvdb::GRID_LEVEL_SET : openvdb::GRID_UNKNOWN);
  if (has_unknown) copy->insertMeta(kInactive, openvdb::StringMetadata(kInactiveUnknown));
  for (const auto& [key, value] : impl.metadata) copy->insertMeta(key, openvdb::StringMetadata(value));
  return copy;
}

// Words that were written with a grid, without those that OpenVDB keeps itself.
std::map<std::string, std::string> wordsOf(const openvdb::FloatGrid& grid) {
  std::map<std::string, std::string> words;
  for (auto entry = grid.beginMeta(); entry != grid.endMeta(); ++entry) {
    const std::string& key = entry->first;
    if (key == "name" || key == "creator" || key == "class" || key == kInactive || key.starts_with("file_"))
      continue;
    words[key] = entry->second->str();
  }
  return words;
}

GridFrame frameOf(const std::filesystem::path& path, const openvdb::FloatGrid& grid) {
  if (!grid.transform().isLinear() || !grid.hasUniformVoxels()) {
    throw IoError(path, "", "a grid with uniform voxels", "a transform that stretches");
  }
  const openvdb::Vec3d origin = grid.indexToWorld(openvdb::Vec3d(0.0));
  return {grid.voxelSize()[0], {origin.x(), origin.y(), origin.z()}};
}

// Voxels that are off hold nothing.
void markUnknown(ScalarGrid::Impl& impl) {
  impl.grid->tree().root().setBackground(kUnknown, /*updateChildNodes=*/true);
  for (LeafNode* leaf : impl.leaves) {
    for (auto value = leaf->beginValueOff(); value; ++value) leaf->setValueOnly(value.pos(), kUnknown);
  }
}

// openvdb::io::File::write() does not notice a disk that is full.
class GridArchive : public openvdb::io::Archive {
 public:
  // Throws std::system_error.
  void writeFile(const std::filesystem::path& path, const openvdb::GridPtrVec& grids) const {
    std::ofstream stream(path, std::ios::binary);
    openvdb::io::Archive::write(stream, grids, /*seekable=*/true);
    stream.close();
    if (!stream) throw std::system_error(errno, std::generic_category());
  }
};

}  // namespace

void writeGrids(const std::filesystem::path& path, const std::vector<const ScalarGrid*>& grids) {
  initialiseOpenVdb();
  openvdb::GridPtrVec copies;
  for (const ScalarGrid* grid : grids) copies.push_back(forDisk(grid->impl()));
  std::filesystem::path temporary = path;
  temporary += ".part";
  try {
    GridArchive().writeFile(temporary, copies);
    std::filesystem::rename(temporary, path);
  } catch (const std::exception& error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw IoError(path, std::string("cannot be written: ") + error.what());
  }
}

std::vector<std::string> gridNames(const std::filesystem::path& path) {
  initialiseOpenVdb();
  std::vector<std::string> names;
  try {
    openvdb::io::File file(path.string());
    file.open();
    for (auto grid = file.beginName(); grid != file.endName(); ++grid) names.push_back(*grid);
  } catch (const std::exception& error) {
    throw IoError(path, std::string("cannot be read: ") + error.what());
  }
  return names;
}

ScalarGrid readGrid(const std::filesystem::path& path, const std::string& name) {
  initialiseOpenVdb();
  openvdb::GridBase::Ptr base;
  try {
    openvdb::io::File file(path.string());
    file.open();
    for (auto grid = file.beginName(); grid != file.endName() && !base; ++grid) {
      if (name.empty() || *grid == name) base = file.readGrid(*grid);
    }
  } catch (const std::exception& error) {
    throw IoError(path, std::string("cannot be read: ") + error.what());
  }
  const std::string wanted = name.empty() ? "a float grid" : "a float grid named '" + name + "'";
  const auto grid = base ? openvdb::gridPtrCast<openvdb::FloatGrid>(base) : nullptr;
  if (!grid) throw IoError(path, "", wanted, base ? "a grid of type " + base->valueType() : "none");
  ScalarGrid result(grid->getName(), frameOf(path, *grid), grid->background());
  result.impl().grid = grid;
  result.impl().listLeaves();
  result.metadata() = wordsOf(*grid);
  if (grid->getGridClass() == openvdb::GRID_LEVEL_SET) {
    result.setKind(GridKind::LevelSet);
    markUnknown(result.impl());
  } else if (const auto inactive = grid->getMetadata<openvdb::StringMetadata>(kInactive);
             inactive && inactive->value() == kInactiveUnknown) {
    markUnknown(result.impl());
  }
  return result;
}

}  // namespace vdbfuse
