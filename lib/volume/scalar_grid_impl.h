// SPDX-License-Identifier: Apache-2.0
// The one place where ScalarGrid meets OpenVDB.
#pragma once

#include <openvdb/openvdb.h>

#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

struct ScalarGrid::Impl {
  GridFrame frame;
  openvdb::FloatGrid::Ptr grid;
  std::string name;
  std::map<std::string, std::string> metadata;
  GridKind kind = GridKind::Field;
  std::vector<openvdb::FloatTree::LeafNodeType*> leaves;  ///< sorted by origin

  /// Fills `leaves` from the tree.
  void listLeaves();
};

/// Registers OpenVDB's types, once.
void initialiseOpenVdb();

}  // namespace vdbfuse
