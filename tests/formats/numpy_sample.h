// SPDX-License-Identifier: Apache-2.0
// Arrays of numpy spelt out byte by byte, as numpy itself writes them.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace vdbfuse::test {

/// A .npy file; `shape` as Python prints it: "(3, 4)".
std::string npyText(const std::string& descr, const std::string& shape, const std::string& bytes,
                    bool fortran_order = false);

enum class Zip { Stored, Deflated };
/// A zip file of NAME.npy entries. Deflated: as blocks of stored bytes, which any inflater takes.
std::string npzText(const std::vector<std::pair<std::string, std::string>>& arrays, Zip kind = Zip::Stored);

template <class T, class Numbers>
std::string bytesOf(const Numbers& numbers) {
  std::string bytes;
  for (const auto& number : numbers) {
    const T value = static_cast<T>(number);
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
  }
  return bytes;
}

/// One deflated file with the names and shapes of VGGT: 1×N×H×W×1 depth, N×3×4 extrinsic, N×3×3 intrinsic.
void writeVggtSample(const std::filesystem::path& folder);
/// CUT3R's folders: depth/NAME.npy, conf/NAME.npy, camera/NAME.npz.
void writeCut3rSample(const std::filesystem::path& folder);
/// NAME.npz with depth, K and cam2world for every frame.
void writeFrameFilesSample(const std::filesystem::path& folder);
/// depths.npy (millimetres in 16 bits), K.npy, w2c.npy in Fortran order.
void writeArrayFilesSample(const std::filesystem::path& folder);

}  // namespace vdbfuse::test
