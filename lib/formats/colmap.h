// SPDX-License-Identifier: Apache-2.0
// A dense workspace of COLMAP, as its image_undistorter and patch_match_stereo leave it:
//
//   sparse/ or sparse/0/                        cameras, images (and since COLMAP 3.12 rigs, frames), each
//   .bin
//                                               or .txt; poses are camera_from_world, pixel centres at .5.
//                                               Where there are frames, their poses count, as in COLMAP
//   stereo/depth_maps/NAME.geometric.bin        z; "width&height&1&", then floats; 0 and negative are
//   invalid;
//                                               may be smaller than the camera's images. NAME has the image's
//                                               extension, and may have folders
//   stereo/depth_maps/NAME.photometric.bin      in its place, where that is missing
//   images/NAME                                 optional
//
//   sparse/points3D.bin or .txt                 for photographs: where depths lie
//
// Photographs need no stereo/, and the model may also lie beside images/ or in any folder next to it.
//
// A pixel's depth is that of its centre, at .5 like everything that the cameras were calibrated with.
// COLMAP's stereo_fusion takes it at the pixel's corner: its points lie half a pixel off ours.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/formats/image_set.h"

namespace vdbfuse {

/// Images without a depth map are left out. Throws IoError, also for camera models that are no pinhole with
/// the distortion of OpenCV's five coefficients, and for names that lead out of the workspace.
DepthSet readColmap(const std::filesystem::path& path, const ReadOptions& options);

/// Writes a workspace on which stereo_fusion, model_converter and other tools of COLMAP run: the model as
/// text with sparse points that several views see, depth maps, normal maps made from them, and configurations
/// of all images. Views without a picture get a grey one, for stereo_fusion needs one. Loads every view
/// twice.
void writeColmap(const std::filesystem::path& folder, const ViewSequence& views, const WriteOptions& options,
                 const Progress& progress);

DepthSetFormat colmapFormat();

/// `path` is the workspace, or the folder of the model with images/ beside it or up to two folders above.
/// Distortion is taken out; points give each photograph its depths. Throws IoError.
ImageSet readColmapImages(const std::filesystem::path& path, const ImageReadOptions& options);

/// images/ and sparse/, without points.
void writeColmapImages(const std::filesystem::path& folder, const PhotographSequence& photographs,
                       const ImageWriteOptions& options, const Progress& progress);

ImageSetFormat colmapImageFormat();

}  // namespace vdbfuse
