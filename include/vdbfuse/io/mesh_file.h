// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

/// Writes `mesh` in the format of the path's extension (any case), complete or not at all:
///   .ply  binary little endian: x y z as float; where the mesh has them nx ny nz as float, red green blue as
///   uchar,
///         support as the float property `quality`, confidence as `confidence`; mesh.comments as comments
///   .obj  positions and normals; comments
///   .stl  binary, positions only; comments in the header as far as they fit
///   .glb  glTF 2.0: positions, normals, colours (COLOR_0, linear as the format asks), support and confidence
///         (_SUPPORT, _CONFIDENCE); +z of the world becomes +y, which is up in glTF; comments in asset.extras
/// The same mesh gives the same bytes. IoError when the extension is another one or the file cannot be
/// written; InvalidArgument when an attribute has not one value a vertex or a triangle names a vertex that
/// does not exist.
void writeMesh(const std::filesystem::path& path, const TriangleMesh& mesh);

/// IoError when writeMesh() would not know the extension: to be told before the work begins.
void requireMeshFormat(const std::filesystem::path& path);

/// Reads a mesh by extension:
///   .ply  ascii, binary of either byte order; faces of more than three vertices become fans; normals,
///   colours
///         (uchar), `quality` and `confidence` are kept, whatever else there is, is skipped; without faces,
///         points
///   .obj  `v` and `f` lines
///   .stl  ascii or binary; vertices with equal coordinates become one
/// A .glb is written only.
/// Every index of the result is in range. IoError when the file does not say what its format promises:
/// nothing is allocated on the word of a header that the size of the file contradicts.
TriangleMesh readMesh(const std::filesystem::path& path);

}  // namespace vdbfuse
