// SPDX-License-Identifier: Apache-2.0
// What arrays of numpy mean by their names, and which part of an array belongs to a frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/npz.h"

namespace vdbfuse {

enum class ArrayRole { Depth, Confidence, Color, Intrinsics, WorldFromCamera, CameraFromWorld };

/// Networks and scripts write many names for one thing; empty when the name means nothing to us. `rank`
/// orders the names of one role, the plainest first.
struct ArrayMeaning {
  ArrayRole role = ArrayRole::Depth;
  std::size_t rank = 0;
};
std::optional<ArrayMeaning> meaningOf(std::string_view name);

/// The names of a role as a person may read them: "depth, depths, ...".
std::string namesOf(ArrayRole role);

/// The arrays of a set or of one frame, one a role: that of the plainest name. Others are not opened.
class ArrayGroup {
 public:
  /// Throws IoError.
  void addNpz(const std::filesystem::path& path);
  void addNpy(const std::filesystem::path& path, const std::string& name);
  /// Null when there is none.
  std::shared_ptr<const io::StoredArray> find(ArrayRole role) const;
  /// Those that another array of the same role was preferred to.
  const std::vector<std::string>& leftOut() const { return left_out_; }

 private:
  template <class Open>
  void add(const std::string& name, const Open& open);
  struct Member {
    std::string name;
    std::size_t rank;
    std::shared_ptr<const io::StoredArray> array;
  };
  std::map<ArrayRole, Member> members_;
  std::vector<std::string> left_out_;
};

/// What of an array belongs to one frame.
struct ArrayItem {
  std::shared_ptr<const io::StoredArray> array;
  std::size_t first = 0;            ///< number at which it begins
  std::vector<std::int64_t> shape;  ///< rows and columns; colour: three numbers

  std::size_t count() const;
  io::NpyArray read() const { return array->read(first, count()); }
};

/// The first dimension where it counts frames: in N×H×W, N×H×W×1, N×3×3, 1×N×H×W, ...; none in H×W. Throws
/// IoError when the array has not the dimensions of its role.
std::optional<std::size_t> frameCount(const io::StoredArray& array, ArrayRole role);

/// Frame `index` of `count`. Intrinsics without a dimension of frames, or with one frame, are those of all.
/// Throws IoError when the array holds another number of frames.
ArrayItem itemOf(std::shared_ptr<const io::StoredArray> array, ArrayRole role, std::size_t index,
                 std::size_t count);

}  // namespace vdbfuse
