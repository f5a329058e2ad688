// SPDX-License-Identifier: Apache-2.0
// Keyword arguments by tables: a name, and what its value does to the request. None is as good as not given.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "python/binding.h"
#include "vdbfuse/geometry/box.h"

namespace vdbfuse::python {

/// The value of a keyword. What it is asked to be and is not: TypeError; a word that is none of the allowed
/// ones, or a number that is not finite: ValueError. Both name the keyword.
class OptionValue {
 public:
  OptionValue(const char* name, py::handle value) : name_(name), value_(value) {}

  py::handle object() const { return value_; }
  double number() const;  ///< not NaN
  double positive() const;
  int whole() const;
  std::size_t count() const;  ///< a whole number ≥ 0
  bool flag() const;
  std::string text() const;
  std::string path() const;  ///< str or os.PathLike
  std::vector<double> numbers(std::size_t count) const;
  std::vector<std::string> words() const;  ///< a list of str, or one of them with commas
  Box box() const;                         ///< x0, y0, z0, x1, y1, z1
  bool isText(const char* word) const;
  /// One of the words.
  template <class T>
  T choice(const std::vector<std::pair<const char*, T>>& allowed) const {
    const std::string word = text();
    std::string all;
    for (const auto& [name, value] : allowed) {
      if (word == name) return value;
      all += (all.empty() ? "'" : ", '") + std::string(name) + "'";
    }
    refuse("one of " + all);
  }
  /// ValueError: "NAME: expected EXPECTED, found VALUE".
  [[noreturn]] void refuse(const std::string& expected) const;

 private:
  [[noreturn]] void refuseType(const char* expected) const;

  const char* name_;
  py::handle value_;
};

template <class Request>
struct Option {
  const char* name;
  void (*set)(Request& request, const OptionValue& value);
};

/// TypeError: "fuse() has no option 'voxl'; did you mean 'voxel'?".
[[noreturn]] void refuseUnknownOption(const char* function, const std::string& name,
                                      const std::vector<std::string>& known);

/// Sets what the keywords say. `options`: all that `function` knows.
template <class Request>
void applyOptions(const char* function, const std::vector<Option<Request>>& options, const py::dict& keywords,
                  Request& request) {
  for (const auto& [key, value] : keywords) {
    const auto name = py::cast<std::string>(key);
    const Option<Request>* found = nullptr;
    for (const Option<Request>& option : options)
      if (name == option.name) found = &option;
    if (found == nullptr) {
      std::vector<std::string> known;
      for (const Option<Request>& option : options) known.emplace_back(option.name);
      refuseUnknownOption(function, name, known);
    }
    if (!value.is_none()) found->set(request, {found->name, value});
  }
}

/// Names of a table, for tests of the stubs.
template <class Request>
std::vector<std::string> namesOf(const std::vector<Option<Request>>& options) {
  std::vector<std::string> names;
  for (const Option<Request>& option : options) names.emplace_back(option.name);
  return names;
}

}  // namespace vdbfuse::python
