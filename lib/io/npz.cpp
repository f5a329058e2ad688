// SPDX-License-Identifier: Apache-2.0
#include "io/npz.h"

#include <zip.h>

#include <algorithm>
#include <fstream>
#include <mutex>

#include "io/file_bytes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kSuffix = ".npy";
constexpr std::size_t kLongestHeader = 66 * 1024;
// No stream of deflate makes more of a byte.
constexpr std::uint64_t kMostBytesOfOne = 1032;

std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text;
}

using Archive = std::unique_ptr<zip_t, decltype(&zip_discard)>;

Archive openArchive(const fs::path& path) {
  fileSize(path);
  int code = 0;
  Archive archive(zip_open(path.c_str(), ZIP_RDONLY, &code), zip_discard);
  if (archive) return archive;
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  const std::string message = zip_error_strerror(&error);
  zip_error_fini(&error);
  throw IoError(path, "", "an archive of numpy arrays (.npz)", "a broken one (" + oneLine(message) + ")");
}

zip_stat_t statOf(const fs::path& path, const std::string& place, zip_t* archive, const std::string& name) {
  zip_stat_t stat;
  zip_stat_init(&stat);
  constexpr zip_uint64_t kNeeded =
      ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
  if (zip_stat(archive, (name + std::string(kSuffix)).c_str(), 0, &stat) != 0 ||
      (stat.valid & kNeeded) != kNeeded)
    throw IoError(path, place, "an array of that name", "none");
  return stat;
}

// Whether the entry is compressed. Its sizes are those of a header, which anyone can write.
bool checkEntry(const fs::path& path, const std::string& place, const zip_stat_t& stat) {
  if (stat.encryption_method != ZIP_EM_NONE) throw IoError(path, place, "an array", "an encrypted one");
  if (stat.comp_method != ZIP_CM_STORE && stat.comp_method != ZIP_CM_DEFLATE)
    throw IoError(path, place, "an array stored or deflated",
                  "compression method " + std::to_string(stat.comp_method));
  const bool is_compressed = stat.comp_method == ZIP_CM_DEFLATE;
  const std::uint64_t factor = is_compressed ? kMostBytesOfOne : 1;
  if (stat.comp_size > fileSize(path) || stat.size > factor * stat.comp_size)
    throw IoError(path, place, "an array that fits into the file",
                  std::to_string(stat.size) + " bytes made of " + std::to_string(stat.comp_size));
  return is_compressed;
}

class Entry {
 public:
  Entry(const fs::path& path, const std::string& place, const std::string& name)
      : path_(path), place_(place), archive_(openArchive(path)), file_(nullptr, zip_fclose) {
    file_.reset(zip_fopen(archive_.get(), (name + std::string(kSuffix)).c_str(), 0));
    if (!file_) fail(zip_strerror(archive_.get()));
  }

  void seek(std::uint64_t position) {
    if (zip_fseek(file_.get(), static_cast<zip_int64_t>(position), SEEK_SET) != 0)
      fail(zip_file_strerror(file_.get()));
  }

  // In steps, so that a size that is a lie takes no memory.
  std::string read(std::uint64_t count) {
    constexpr std::uint64_t kStep = 1 << 20;
    std::string bytes;
    while (bytes.size() < count) {
      const std::size_t begin = bytes.size();
      bytes.resize(begin + std::min<std::uint64_t>(kStep, count - begin));
      const zip_int64_t got = zip_fread(file_.get(), bytes.data() + begin, bytes.size() - begin);
      if (got < 0) fail(zip_file_strerror(file_.get()));
      bytes.resize(begin + static_cast<std::size_t>(got));
      if (got == 0) throw IoError(path_, place_, std::to_string(count) + " bytes", "the end of the array");
    }
    return bytes;
  }

 private:
  [[noreturn]] void fail(const char* message) const {
    throw IoError(path_, place_, "an array", "damaged bytes (" + oneLine(message) + ")");
  }

  const fs::path& path_;
  const std::string& place_;
  Archive archive_;
  std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file_;
};

std::string readPartOfFile(const fs::path& path, std::uint64_t first, std::uint64_t count) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(first));
  std::string bytes(static_cast<std::size_t>(count), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  if (static_cast<std::uint64_t>(file.gcount()) != count)
    throw IoError(path, "", "a file as long as before", "a shorter one");
  return bytes;
}

std::string inRowOrder(const std::string& bytes, const NpyHeader& header) {
  const std::size_t rank = header.shape.size(), width = static_cast<std::size_t>(header.bytes);
  std::vector<std::size_t> stride(rank, width), index(rank, 0);
  for (std::size_t i = 1; i < rank; ++i)
    stride[i] = stride[i - 1] * static_cast<std::size_t>(header.shape[i - 1]);
  std::string result;
  result.reserve(bytes.size());
  std::size_t at = 0;
  for (std::size_t done = header.count(); done > 0; --done) {
    result.append(bytes, at, width);
    for (std::size_t i = rank; i-- > 0;) {
      at += stride[i];
      if (++index[i] < static_cast<std::size_t>(header.shape[i])) break;
      at -= index[i] * stride[i];
      index[i] = 0;
    }
  }
  return result;
}

}  // namespace

struct StoredArray::Whole {
  std::mutex mutex;
  std::string bytes;
  bool is_read = false;
};

StoredArray::StoredArray(fs::path path)
    : path_(std::move(path)), size_(fileSize(path_)), whole_(std::make_shared<Whole>()) {
  header_ = parseNpyHeader(path_, place_, readFileStart(path_, kLongestHeader), size_);
}

StoredArray::StoredArray(fs::path path, std::string name)
    : path_(std::move(path)),
      name_(std::move(name)),
      place_("array '" + oneLine(name_.substr(0, 40)) + "'"),
      whole_(std::make_shared<Whole>()) {
  const zip_stat_t stat = statOf(path_, place_, openArchive(path_).get(), name_);
  is_compressed_ = checkEntry(path_, place_, stat);
  size_ = stat.size;
  const std::string start = Entry(path_, place_, name_).read(std::min<std::uint64_t>(size_, kLongestHeader));
  header_ = parseNpyHeader(path_, place_, start, size_);
}

std::string StoredArray::bytes(std::uint64_t first, std::uint64_t count) const {
  if (place_.empty()) return readPartOfFile(path_, first, count);
  Entry entry(path_, place_, name_);
  if (!is_compressed_) {
    entry.seek(first);
    return entry.read(count);
  }
  std::string all = entry.read(first + count);
  all.erase(0, static_cast<std::size_t>(first));
  return all;
}

std::string StoredArray::allInRowOrder() const {
  std::string all = bytes(header_.data_begin, header_.count() * static_cast<std::size_t>(header_.bytes));
  return header_.fortran_order ? inRowOrder(all, header_) : all;
}

NpyArray StoredArray::read(std::size_t first, std::size_t count) const {
  const auto width = static_cast<std::size_t>(header_.bytes);
  NpyArray part{header_, {}};
  part.header.shape = {static_cast<std::int64_t>(count)};
  part.header.fortran_order = false;
  if (!is_compressed_ && !header_.fortran_order) {
    part.bytes = bytes(header_.data_begin + first * width, count * width);
  } else if (count == header_.count()) {
    part.bytes = allInRowOrder();
  } else {
    const std::lock_guard lock(whole_->mutex);
    if (!whole_->is_read) whole_->bytes = allInRowOrder();
    whole_->is_read = true;
    part.bytes = whole_->bytes.substr(first * width, count * width);
  }
  return part;
}

bool isNpz(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && readFileStart(path, 4) == "PK\x03\x04";
}

std::vector<std::string> npzNames(const fs::path& path) {
  const Archive archive = openArchive(path);
  std::vector<std::string> names;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive.get(), 0); ++i) {
    const char* text = zip_get_name(archive.get(), static_cast<zip_uint64_t>(i), 0);
    std::string name = text == nullptr ? "" : text;
    if (!name.ends_with(kSuffix)) continue;
    name.resize(name.size() - kSuffix.size());
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace vdbfuse::io
