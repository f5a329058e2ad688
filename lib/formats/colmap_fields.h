// SPDX-License-Identifier: Apache-2.0
// The files of a COLMAP model, which hold the same fields in the same order as text and as binary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace vdbfuse {

/// Walks through the records of a file. Everything throws IoError, at "line N" or "byte N", when the file
/// ends or holds something else.
class ColmapFields {
 public:
  virtual ~ColmapFields() = default;
  /// To the next record; false when there is none.
  virtual bool next() = 0;
  virtual std::uint32_t id() = 0;      ///< of a camera, rig, frame, sensor; a number of things
  virtual std::uint64_t longId() = 0;  ///< of a measurement; a width or height
  virtual double number() = 0;         ///< finite
  virtual bool flag() = 0;
  virtual bool isCamera() = 0;      ///< a kind of sensor
  virtual std::string model() = 0;  ///< name of a camera model, "number N" when it is unknown
  virtual std::string name() = 0;   ///< of an image
  virtual void skipPoints() = 0;    ///< what an image sees
  virtual void skipColor() = 0;     ///< of a point, and its error
  /// The images that see a point, the rest of its record.
  virtual std::vector<std::uint32_t> track() = 0;
  [[noreturn]] virtual void fail(const std::string& expected, const std::string& found) const = 0;

  const std::filesystem::path& path() const { return path_; }

 protected:
  explicit ColmapFields(std::filesystem::path path) : path_(std::move(path)) {}

 private:
  std::filesystem::path path_;
};

/// `folder`/`stem`.bin, else .txt, as COLMAP prefers; null when there is neither.
std::unique_ptr<ColmapFields> openColmapFile(const std::filesystem::path& folder, const std::string& stem);

}  // namespace vdbfuse
