// SPDX-License-Identifier: Apache-2.0
// What writers of data sets have in common.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/sensor/view_sequence.h"

namespace vdbfuse {

/// Loads one view after the other. `name` is the view's own where all names of the set can be file names and
/// differ, else its number in eight digits.
void forEachView(const ViewSequence& views, const Progress& progress,
                 const std::function<void(const View& view, const std::string& name)>& write);

/// The names as they are, where all can be file names and differ, else their numbers in eight digits.
std::vector<std::string> fileNames(std::vector<std::string> names);

/// The names that forEachView() gives.
std::vector<std::string> fileNames(const ViewSequence& views);

/// "00000007" for digits = 8.
std::string numberedName(std::size_t index, int digits);

/// The one camera of all views. Throws InvalidArgument when they have several, when it is no pinhole or is
/// distorted; `format` names what cannot hold it.
Pinhole commonPinhole(const ViewSequence& views, const std::string& format);

/// The view's camera. Throws InvalidArgument when it is no pinhole or is distorted.
Pinhole plainPinhole(const ViewHeader& header, const std::string& format);

/// Rows of numbers that read back as the same.
std::string matrixText(const Eigen::MatrixXd& matrix);

/// Shortest text that reads back as the same number.
std::string exactText(double value);

/// The numbers, each with a blank before it.
std::string numbersText(std::initializer_list<double> numbers);

/// Depth as whole numbers of `scale`, rounded, 0 where it is invalid. Throws InvalidArgument when one is
/// above 65534 or rounds to 0.
void writeDepthPng(const std::filesystem::path& path, const View& view, double scale);

/// Does nothing when the view has no picture, or one of a sensor of its own.
void writeColor(const std::filesystem::path& path, const View& view);

/// Throws IoError.
void createFolder(const std::filesystem::path& folder);

}  // namespace vdbfuse
