// SPDX-License-Identifier: Apache-2.0
#include "formats/numpy_layout.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "io/folder.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

std::string stemOf(const fs::path& path) { return path.stem().string(); }

bool means(const std::string& name, ArrayRole role) {
  const std::optional<ArrayMeaning> meaning = meaningOf(name);
  return meaning && meaning->role == role;
}

std::vector<fs::path> foldersIn(const fs::path& path) {
  std::vector<fs::path> folders;
  std::error_code error;
  fs::directory_iterator entry(path, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored)) folders.push_back(entry->path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

// What folders beside the depth maps hold for the frame of that name.
void addOwnFiles(NumpyLayout& layout, const std::vector<fs::path>& folders, const std::string& name) {
  std::vector<ArrayFile> files;
  fs::path picture;
  for (const fs::path& folder : folders) {
    for (const char* extension : {".npy", ".npz"}) {
      fs::path file = folder / (name + extension);
      if (isFile(file)) files.push_back({std::move(file), folder.filename().string()});
    }
    if (picture.empty() && means(folder.filename().string(), ArrayRole::Color))
      picture = findPicture(folder, name);
  }
  layout.names.push_back(name);
  layout.own.push_back(std::move(files));
  layout.pictures.push_back(std::move(picture));
}

NumpyLayout layoutOfFolder(const fs::path& path) {
  NumpyLayout layout;
  const std::vector<std::string> npy = filesEndingWith(path, ".npy"), npz = filesEndingWith(path, ".npz");
  for (const std::string& name : npy) layout.shared.push_back({path / name, stemOf(name)});
  if (std::any_of(npy.begin(), npy.end(), [](const auto& n) { return means(stemOf(n), ArrayRole::Depth); }))
    return layout;
  const std::vector<fs::path> folders = foldersIn(path);
  for (const fs::path& folder : folders) {
    if (!means(folder.filename().string(), ArrayRole::Depth) || !layout.names.empty()) continue;
    for (const std::string& file : filesEndingWith(folder, ".npy"))
      addOwnFiles(layout, folders, stemOf(file));
  }
  const bool is_one_a_frame = layout.names.empty() && npz.size() > 1;
  for (const std::string& file : npz) {
    if (!is_one_a_frame) layout.shared.push_back({path / file, ""});
    if (!is_one_a_frame) continue;
    layout.names.push_back(stemOf(file));
    layout.own.push_back({{path / file, ""}});
    layout.pictures.emplace_back();
  }
  return layout;
}

}  // namespace

NumpyLayout layoutOf(const fs::path& path) {
  if (fs::is_directory(path)) return layoutOfFolder(path);
  NumpyLayout layout;
  layout.shared.push_back({path, ""});
  return layout;
}

ArrayGroup groupOf(const std::vector<ArrayFile>& files) {
  ArrayGroup group;
  for (const ArrayFile& file : files) {
    if (file.path.extension() == ".npz") group.addNpz(file.path);
    if (file.path.extension() == ".npy") group.addNpy(file.path, file.name);
  }
  return group;
}

}  // namespace vdbfuse
