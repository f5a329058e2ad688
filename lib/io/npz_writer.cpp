// SPDX-License-Identifier: Apache-2.0
#include "io/npz_writer.h"

#include <zip.h>

#include <cerrno>
#include <memory>
#include <system_error>

#include "io/npy.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {

namespace fs = std::filesystem;

NpzWriter::NpzWriter(fs::path path, std::optional<std::int64_t> parts)
    : path_(std::move(path)), parts_(parts) {}

NpzWriter::~NpzWriter() {
  std::error_code ignored;
  for (auto& [name, array] : arrays_) {
    array.stream.close();
    fs::remove(array.file, ignored);
  }
}

void NpzWriter::append(const std::string& name, const std::string& descr,
                       const std::vector<std::int64_t>& shape, std::string_view bytes) {
  Array& array = arrays_[name];
  if (!array.stream.is_open()) {
    array.shape = shape;
    array.file = path_.parent_path() / ("." + path_.filename().string() + "." + name + ".npy");
    array.stream.open(array.file, std::ios::binary);
    std::vector<std::int64_t> all = shape;
    if (parts_) all.insert(all.begin(), *parts_);
    array.stream << formatNpyHeader(descr, all);
  }
  if (array.shape != shape) return;
  array.stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  ++array.parts;
  if (!array.stream)
    throw IoError(array.file, "cannot be written: " + std::generic_category().message(errno));
}

void NpzWriter::finish() {
  int code = 0;
  std::unique_ptr<zip_t, decltype(&zip_discard)> archive(
      zip_open(path_.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code), zip_discard);
  bool is_good = archive != nullptr;
  for (auto& [name, array] : arrays_) {
    array.stream.close();
    if (array.parts != parts_.value_or(1) || !is_good) continue;
    zip_source_t* source = zip_source_file(archive.get(), array.file.c_str(), 0, 0);
    const std::string entry = name + ".npy";
    const zip_int64_t index =
        array.stream ? zip_file_add(archive.get(), entry.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0) zip_source_free(source);
    constexpr zip_uint16_t kFirstOfJanuary1980 = (1 << 5) | 1;
    const auto at = static_cast<zip_uint64_t>(index);
    is_good = index >= 0 && zip_set_file_compression(archive.get(), at, ZIP_CM_STORE, 0) == 0 &&
              zip_file_set_dostime(archive.get(), at, 0, kFirstOfJanuary1980, 0) == 0;
  }
  if (!is_good || zip_close(archive.get()) != 0) throw IoError(path_, "cannot be written");
  // Closed: no longer ours to discard.
  static_cast<void>(archive.release());
}

}  // namespace vdbfuse::io
