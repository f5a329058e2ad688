// SPDX-License-Identifier: Apache-2.0
// A scene of two bumps on a floor, seen by a few small sensors: what every format must give back.
#pragma once

#include <cstddef>
#include <vector>

#include "vdbfuse/sensor/view.h"
#include "vdbfuse/sensor/view_sequence.h"

namespace vdbfuse::test {

/// Pinhole views of 24×18 pixels of the floor z = 0 with bumps, from about 2 m above it, all distinct in pose
/// and with a rotation about every axis. Depth 1.4 to 3 m; pixel (0, 0) of every view is invalid. Names "0",
/// "1", …. Colours differ from pixel to pixel.
std::vector<View> tinyViews(std::size_t count = 3);

/// The same scene by scanners that turn about the world's z axis 1 m above the floor, 40×16 pixels over a
/// full turn in azimuth and from 5 to 50 degrees below the horizon. Names as above.
std::vector<View> tinySphericalViews(std::size_t count = 2);

/// The same scanners with a pixel every 0.4 degrees, 60×40 of them towards the bumps: for formats of points
/// that must be sorted into pixels.
std::vector<View> tinyDenseScans(std::size_t count = 2);

/// Fails unless the sequences have the same poses (1e-6), pinholes (1e-3 px) and depths (`tolerance`), valid
/// at the same pixels. Names are not compared.
void expectSameViews(const ViewSequence& found, const std::vector<View>& truth, double tolerance);

/// Fails unless nearly all of the found depths lie on the scene's surface within `tolerance`, and at least
/// `least_valid` of the pixels of each view have one: for formats that choose pixels of their own.
void expectOnSurface(const ViewSequence& found, double tolerance, double least_valid);

/// Height of the surface above the floor.
double tinyHeight(double x, double y);

}  // namespace vdbfuse::test
