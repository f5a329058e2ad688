// SPDX-License-Identifier: Apache-2.0
#include "python/options.h"

#include <cmath>
#include <limits>

namespace vdbfuse::python {
namespace {

std::string shown(py::handle value) { return py::cast<std::string>(py::repr(value)); }

}  // namespace

void OptionValue::refuse(const std::string& expected) const {
  throw py::value_error(std::string(name_) + ": expected " + expected + ", found " + shown(value_));
}

void OptionValue::refuseType(const char* expected) const {
  throw py::type_error(std::string(name_) + ": expected " + expected + ", found " + shown(value_));
}

double OptionValue::number() const {
  if (PyBool_Check(value_.ptr()) || PyNumber_Check(value_.ptr()) == 0) refuseType("a number");
  const double number = PyFloat_AsDouble(value_.ptr());
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  if (std::isnan(number)) refuse("a number");
  return number;
}

double OptionValue::positive() const {
  const double value = number();
  if (!(value > 0)) refuse("a positive number");
  return value;
}

int OptionValue::whole() const {
  if (PyBool_Check(value_.ptr()) || PyIndex_Check(value_.ptr()) == 0) refuseType("a whole number");
  const py::ssize_t number = PyNumber_AsSsize_t(value_.ptr(), nullptr);
  if (number < std::numeric_limits<int>::min() || number > std::numeric_limits<int>::max())
    refuse("a whole number of 32 bits");
  return static_cast<int>(number);
}

std::size_t OptionValue::count() const {
  if (PyBool_Check(value_.ptr()) || PyIndex_Check(value_.ptr()) == 0) refuseType("a whole number");
  const py::ssize_t number = PyNumber_AsSsize_t(value_.ptr(), nullptr);
  if (number < 0) refuse("a whole number that is not negative");
  return static_cast<std::size_t>(number);
}

bool OptionValue::flag() const {
  if (!PyBool_Check(value_.ptr())) refuseType("True or False");
  return value_.ptr() == Py_True;
}

std::string OptionValue::text() const {
  if (!py::isinstance<py::str>(value_)) refuseType("a str");
  return py::cast<std::string>(value_);
}

std::string OptionValue::path() const {
  const py::object path = py::reinterpret_steal<py::object>(PyOS_FSPath(value_.ptr()));
  if (!path) {
    PyErr_Clear();
    refuseType("a path");
  }
  return py::cast<std::string>(path);
}

std::vector<double> OptionValue::numbers(std::size_t count) const {
  if (py::isinstance<py::str>(value_) || !py::isinstance<py::iterable>(value_))
    refuseType("a list of numbers");
  std::vector<double> numbers;
  for (const py::handle item : value_) numbers.push_back(OptionValue(name_, item).number());
  if (numbers.size() != count) refuse(std::to_string(count) + " numbers");
  return numbers;
}

std::vector<std::string> OptionValue::words() const {
  std::vector<std::string> words;
  if (!py::isinstance<py::str>(value_)) {
    if (!py::isinstance<py::sequence>(value_)) refuseType("a list of str");
    for (const py::handle item : value_) words.push_back(OptionValue(name_, item).text());
    return words;
  }
  const std::string all = text();
  for (std::size_t begin = 0; begin <= all.size();) {
    const std::size_t end = std::min(all.find(',', begin), all.size());
    words.push_back(all.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

Box OptionValue::box() const {
  const std::vector<double> v = numbers(6);
  const Box box(Eigen::Vector3d(v[0], v[1], v[2]), Eigen::Vector3d(v[3], v[4], v[5]));
  if (box.isEmpty()) refuse("x0, y0, z0, x1, y1, z1 with the lower corner first");
  return box;
}

bool OptionValue::isText(const char* word) const {
  return py::isinstance<py::str>(value_) && py::cast<std::string>(value_) == word;
}

void refuseUnknownOption(const char* function, const std::string& name,
                         const std::vector<std::string>& known) {
  const py::list close = py::module_::import("difflib").attr("get_close_matches")(name, known, 1);
  std::string text = std::string(function) + "() has no option '" + name + "'";
  if (!close.empty()) text += "; did you mean '" + py::cast<std::string>(close[0]) + "'?";
  throw py::type_error(text);
}

}  // namespace vdbfuse::python
