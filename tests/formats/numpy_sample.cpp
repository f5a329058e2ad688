// SPDX-License-Identifier: Apache-2.0
#include "formats/numpy_sample.h"

#include <cmath>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"

namespace vdbfuse::test {
namespace {

std::string number(std::uint32_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 255);
  return text;
}

std::uint32_t checksum(const std::string& bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const unsigned char byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
  }
  return ~crc;
}

std::string deflated(const std::string& bytes) {
  std::string text;
  constexpr std::size_t kLongest = 65535;
  for (std::size_t at = 0; at < bytes.size(); at += kLongest) {
    const std::string block = bytes.substr(at, kLongest);
    const auto length = static_cast<std::uint32_t>(block.size());
    text += (at + kLongest >= bytes.size() ? '\1' : '\0') + number(length, 2) + number(~length, 2) + block;
  }
  return text;
}

std::string matrix(const Eigen::MatrixXd& m) {
  const Eigen::MatrixXd columns = m.transpose();
  return bytesOf<double>(std::vector<double>(columns.data(), columns.data() + columns.size()));
}

std::string intrinsics(const View& view) {
  const auto& camera = std::get<Pinhole>(view.projection);
  return bytesOf<double>(std::vector<double>{camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1});
}

}  // namespace

std::string npyText(const std::string& descr, const std::string& shape, const std::string& bytes,
                    bool fortran_order) {
  std::string header = "{'descr': '" + descr + "', 'fortran_order': " + (fortran_order ? "True" : "False") +
                       ", 'shape': " + shape + ", }";
  header.resize(118 - 1, ' ');
  return "\x93NUMPY" + number(1, 2) + number(118, 2) + header + "\n" + bytes;
}

std::string npzText(const std::vector<std::pair<std::string, std::string>>& arrays, Zip kind) {
  std::string file, directory;
  for (const auto& [array, bytes] : arrays) {
    const std::string name = array + ".npy", packed = kind == Zip::Stored ? bytes : deflated(bytes);
    // Version, flags, method, time, date, checksum, sizes, lengths of name and extra field.
    const std::string header = number(20, 2) + number(0, 2) + number(kind == Zip::Stored ? 0 : 8, 2) +
                               number(0, 2) + number(33, 2) + number(checksum(bytes), 4) +
                               number(static_cast<std::uint32_t>(packed.size()), 4) +
                               number(static_cast<std::uint32_t>(bytes.size()), 4) +
                               number(static_cast<std::uint32_t>(name.size()), 2) + number(0, 2);
    directory += "PK\1\2" + number(20, 2) + header + number(0, 2) + number(0, 2) + number(0, 2) +
                 number(0, 4) + number(static_cast<std::uint32_t>(file.size()), 4) + name;
    file += "PK\3\4" + header + name + packed;
  }
  const auto count = static_cast<std::uint32_t>(arrays.size());
  return file + directory + "PK\5\6" + number(0, 4) + number(count, 2) + number(count, 2) +
         number(static_cast<std::uint32_t>(directory.size()), 4) +
         number(static_cast<std::uint32_t>(file.size()), 4) + number(0, 2);
}

void writeVggtSample(const std::filesystem::path& folder) {
  std::string depth, extrinsic, intrinsic;
  for (const View& view : tinyViews()) {
    depth += bytesOf<float>(view.map.depth);
    extrinsic += matrix(view.world_from_camera.inverse().matrix().topRows(3));
    intrinsic += intrinsics(view);
  }
  writeText(folder / "predictions.npz", npzText({{"depth", npyText("<f4", "(1, 3, 18, 24, 1)", depth)},
                                                 {"extrinsic", npyText("<f8", "(3, 3, 4)", extrinsic)},
                                                 {"intrinsic", npyText("<f8", "(3, 3, 3)", intrinsic)}},
                                                Zip::Deflated));
}

void writeCut3rSample(const std::filesystem::path& folder) {
  for (const char* name : {"depth", "conf", "camera"}) std::filesystem::create_directory(folder / name);
  for (const View& view : tinyViews()) {
    const std::string file = "00000" + view.name;
    writeText(folder / "depth" / (file + ".npy"), npyText("<f4", "(18, 24)", bytesOf<float>(view.map.depth)));
    const std::vector<float> conf(view.map.depth.size(), 1.5F);
    writeText(folder / "conf" / (file + ".npy"), npyText("<f4", "(18, 24)", bytesOf<float>(conf)));
    writeText(folder / "camera" / (file + ".npz"),
              npzText({{"pose", npyText("<f8", "(4, 4)", matrix(view.world_from_camera.matrix()))},
                       {"intrinsics", npyText("<f8", "(3, 3)", intrinsics(view))}}));
  }
}

void writeFrameFilesSample(const std::filesystem::path& folder) {
  for (const View& view : tinyViews()) {
    writeText(folder / ("frame" + view.name + ".npz"),
              npzText({{"depth", npyText("<f4", "(18, 24)", bytesOf<float>(view.map.depth))},
                       {"K", npyText("<f8", "(3, 3)", intrinsics(view))},
                       {"cam2world", npyText("<f8", "(4, 4)", matrix(view.world_from_camera.matrix()))}},
                      Zip::Deflated));
  }
}

void writeArrayFilesSample(const std::filesystem::path& folder) {
  std::string depths;
  const std::vector<View> views = tinyViews();
  for (const View& view : views) {
    std::vector<double> steps;
    for (const float depth : view.map.depth) steps.push_back(std::round(1000 * depth));
    depths += bytesOf<std::uint16_t>(steps);
  }
  // In Fortran order the index of the frame runs fastest, then that of the row.
  std::vector<double> poses;
  for (Eigen::Index column = 0; column < 4; ++column) {
    for (Eigen::Index row = 0; row < 4; ++row) {
      for (const View& view : views) poses.push_back(view.world_from_camera.inverse().matrix()(row, column));
    }
  }
  writeText(folder / "depths.npy", npyText("<u2", "(3, 18, 24)", depths));
  writeText(folder / "K.npy", npyText("<f8", "(3, 3)", intrinsics(views.front())));
  writeText(folder / "w2c.npy", npyText("<f8", "(3, 4, 4)", bytesOf<double>(poses), true));
}

}  // namespace vdbfuse::test
