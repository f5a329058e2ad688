// SPDX-License-Identifier: Apache-2.0
#include <openvdb/io/File.h>
#include <openvdb/tools/Prune.h>

#include <cmath>
#include <system_error>

#include "vdbfuse/base/errors.h"
#include "volume/scalar_grid_impl.h"

namespace vdbfuse {
namespace {

constexpr const char* kCreator = "vdbfuse";

// A copy with active states set, fit for other tools.
openvdb::FloatGrid::Ptr forDisk(const ScalarGrid::Impl& impl) {
  openvdb::FloatGrid::Ptr copy = impl.grid->deepCopy();
  const float background = copy->background();
  std::vector<openvdb::FloatTree::LeafNodeType*> leaves;
  copy->tree().getNodes(leaves);
  for (auto* leaf : leaves) {
    for (openvdb::Index i = 0; i < openvdb::FloatTree::LeafNodeType::SIZE; ++i) {
      const float value = leaf->getValue(i);
      if (std::isnan(value) || value == background) {
        leaf->setValueOff(i, background);
      } else {
        leaf->setValueOn(i, value);
      }
    }
  }
  openvdb::tools::pruneInactive(copy->tree());
  copy->setName(impl.name);
  copy->setCreator(kCreator);
  copy->setGridClass(impl.kind == GridKind::LevelSet ? openvdb::GRID_LEVEL_SET : openvdb::GRID_UNKNOWN);
  for (const auto& [key, value] : impl.metadata) copy->insertMeta(key, openvdb::StringMetadata(value));
  return copy;
}

GridFrame frameOf(const std::filesystem::path& path, const openvdb::FloatGrid& grid) {
  if (!grid.transform().isLinear() || !grid.hasUniformVoxels()) {
    throw IoError(path, "", "a grid with uniform voxels", "a transform that stretches");
  }
  const openvdb::Vec3d origin = grid.indexToWorld(openvdb::Vec3d(0.0));
  return {grid.voxelSize()[0], {origin.x(), origin.y(), origin.z()}};
}

// Voxels of a level set that are off hold no distance.
void markUnknown(openvdb::FloatTree::LeafNodeType& leaf) {
  for (auto value = leaf.beginValueOff(); value; ++value) leaf.setValueOnly(value.pos(), kUnknown);
}

}  // namespace

void writeGrids(const std::filesystem::path& path, const std::vector<const ScalarGrid*>& grids) {
  initialiseOpenVdb();
  openvdb::GridPtrVec copies;
  for (const ScalarGrid* grid : grids) copies.push_back(forDisk(grid->impl()));
  std::filesystem::path temporary = path;
  temporary += ".part";
  std::error_code ignored;
  try {
    openvdb::io::File file(temporary.string());
    file.write(copies);
    file.close();
    std::filesystem::rename(temporary, path);
  } catch (const std::exception& error) {
    std::filesystem::remove(temporary, ignored);
    throw IoError(path, std::string("cannot be written: ") + error.what());
  }
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
  if (grid->getGridClass() == openvdb::GRID_LEVEL_SET) {
    result.setKind(GridKind::LevelSet);
    for (auto* leaf : result.impl().leaves) markUnknown(*leaf);
  }
  return result;
}

}  // namespace vdbfuse
