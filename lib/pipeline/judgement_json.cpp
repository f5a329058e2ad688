// SPDX-License-Identifier: Apache-2.0
#include "pipeline/judgement_json.h"

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/pipeline/judgement_folder.h"

namespace vdbfuse {
namespace {

using Json = nlohmann::ordered_json;

template <class T, std::size_t N>
using Names = std::array<std::pair<const char*, T>, N>;
using ShapeOf = const NoiseShape& (*)();
constexpr Names<ShapeOf, 3> kShapes = {
    {{"gaussian", gaussianNoise}, {"logistic", logisticNoise}, {"laplace", laplaceNoise}}};
constexpr Names<ConfidenceDirection, 4> kDirections = {
    {{"none", ConfidenceDirection::None},
     {"high is good", ConfidenceDirection::HighIsGood},
     {"high is bad", ConfidenceDirection::HighIsBad},
     {"uninformative", ConfidenceDirection::Uninformative}}};
constexpr Names<int, 4> kLaws = {{{"given", -1}, {"constant", 0}, {"linear", 1}, {"quadratic", 2}}};

template <class T, std::size_t N>
const char* nameIn(const Names<T, N>& names, T value) {
  for (const auto& [name, candidate] : names) {
    if (candidate == value) return name;
  }
  return "";
}

Json calibrationJson(const CalibrationReport& c) {
  return {{"noise_scale", c.noise_scale},
          {"noise_law", nameOfLaw(c.noise_exponent)},
          {"median_depth", c.median_depth},
          {"point_spacing", c.point_spacing},
          {"near", c.near},
          {"far", c.far},
          {"miss_rate", c.miss_rate},
          {"outlier_share", c.outlier_share},
          {"confidence_direction", nameOf(c.confidence)}};
}

Json sensorJson(const SensorModel& s) {
  return {{"noise", s.shape.name},
          {"noise_constant", s.noise.constant},
          {"noise_linear", s.noise.linear},
          {"noise_quadratic", s.noise.quadratic},
          {"near", s.near},
          {"far", s.far}};
}

Json curveJson(const ReliabilityModel& model) {
  Json curve = Json::array();
  if (model.confidence_bins.empty()) return curve;
  for (std::size_t bin = 0; bin < ReliabilityModel::kConfidences; ++bin) {
    const bool last = bin == model.confidence_bins.size();
    curve.push_back({{"confidence_below", last ? Json(nullptr) : Json(model.confidence_bins[bin])},
                     {"outlier_share", model.outlier_by_confidence[bin]}});
  }
  return curve;
}

Json viewJson(const JudgedView& view) {
  const ViewStatistics s = statistics(view);
  return {{"name", view.name},
          {"width", view.depth.width()},
          {"height", view.depth.height()},
          {"weight", view.weight},
          {"outlier_share", s.outlier_share},
          {"no_returns_trusted", s.no_returns_trusted},
          {"outside_mask", s.outside_mask}};
}

// A value of the file with its name, so that what is wrong with it can be said.
class Member {
 public:
  Member(const std::filesystem::path& path, const Json& json, std::string name)
      : path_(path), json_(json), name_(std::move(name)) {}

  Member operator[](const char* key) const {
    if (!json_.is_object()) expected("an object");
    const auto found = json_.find(key);
    const std::string name = name_.empty() ? key : name_ + "." + key;
    if (found == json_.end()) throw IoError(path_, "", "'" + name + "'", "none");
    return {path_, *found, name};
  }
  std::vector<Member> list() const {
    if (!json_.is_array()) expected("a list");
    std::vector<Member> items;
    for (const Json& item : json_)
      items.emplace_back(path_, item, name_ + "[" + std::to_string(items.size()) + "]");
    return items;
  }
  bool isNull() const { return json_.is_null(); }
  double number() const {
    if (!json_.is_number()) expected("a number");
    return json_.get<double>();
  }
  double share() const {
    if (!json_.is_number() || !(number() >= 0 && number() <= 1)) expected("a number in [0, 1]");
    return number();
  }
  int positive() const {
    if (!json_.is_number_integer() || json_.get<double>() < 1 || json_.get<double>() > 1e9)
      expected("a positive whole number");
    return json_.get<int>();
  }
  std::string text() const {
    if (!json_.is_string()) expected("a text");
    return json_.get<std::string>();
  }
  template <class T, std::size_t N>
  T choice(const Names<T, N>& names) const {
    std::string all;
    for (const auto& [name, value] : names) {
      if (json_.is_string() && json_.get<std::string>() == name) return value;
      all += (all.empty() ? "'" : ", '") + std::string(name) + "'";
    }
    expected("one of " + all);
  }
  [[noreturn]] void expected(const std::string& what) const {
    constexpr std::size_t kLongest = 60;
    std::string found = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (found.size() > kLongest) found = found.substr(0, kLongest) + "...";
    throw IoError(path_, name_.empty() ? "" : "'" + name_ + "'", what, found);
  }

 private:
  const std::filesystem::path& path_;
  const Json& json_;
  std::string name_;
};

CalibrationReport readCalibration(const Member& c) {
  CalibrationReport report;
  report.noise_scale = c["noise_scale"].number();
  report.noise_exponent = c["noise_law"].choice(kLaws);
  report.median_depth = c["median_depth"].number();
  report.point_spacing = c["point_spacing"].number();
  report.near = c["near"].number(), report.far = c["far"].number();
  report.miss_rate = c["miss_rate"].share();
  report.outlier_share = c["outlier_share"].share();
  report.confidence = c["confidence_direction"].choice(kDirections);
  return report;
}

SensorModel readSensor(const std::filesystem::path& path, const Member& s) {
  SensorModel sensor;
  sensor.shape = s["noise"].choice(kShapes)();
  sensor.noise = {s["noise_constant"].number(), s["noise_linear"].number(), s["noise_quadratic"].number()};
  sensor.near = s["near"].number(), sensor.far = s["far"].number();
  const std::vector<std::string> problems = validate(sensor);
  if (!problems.empty()) throw IoError(path, "'sensor'", "a possible sensor", problems.front());
  return sensor;
}

Box readDomain(const Member& member) {
  const std::vector<Member> numbers = member.list();
  if (numbers.size() != 6) member.expected("six numbers");
  Box box;
  for (int a = 0; a < 3; ++a) {
    box.min()[a] = numbers[static_cast<std::size_t>(a)].number();
    box.max()[a] = numbers[static_cast<std::size_t>(a + 3)].number();
  }
  if (box.isEmpty()) member.expected("the lower corner first");
  return box;
}

ReliabilityModel readModel(const Member& curve, double outlier_share) {
  ReliabilityModel model;
  model.outlier_share = outlier_share;
  model.outlier_by_confidence.fill(outlier_share);
  const std::vector<Member> bins = curve.list();
  if (bins.empty()) return model;
  if (bins.size() != ReliabilityModel::kConfidences) curve.expected("20 bins or none");
  for (std::size_t k = 0; k < bins.size(); ++k) {
    model.outlier_by_confidence[k] = bins[k]["outlier_share"].share();
    if (k + 1 < bins.size())
      model.confidence_bins.push_back(static_cast<float>(bins[k]["confidence_below"].number()));
  }
  return model;
}

ReadView readView(const Member& v) {
  ReadView view{v["name"].text(), v["width"].positive(), v["height"].positive(), v["weight"].share()};
  if (!(view.weight > 0)) v["weight"].expected("a weight above 0");
  return view;
}

Json parse(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw IoError(path, "", "a judgement", "nothing of that name");
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) throw IoError(path, "cannot be read");
  try {
    return Json::parse(file);
  } catch (const Json::parse_error& error) {
    throw IoError(path, "byte " + std::to_string(error.byte), "JSON", "something else");
  }
}

}  // namespace

const char* nameOf(ConfidenceDirection direction) { return nameIn(kDirections, direction); }
const char* nameOfLaw(int exponent) { return nameIn(kLaws, exponent); }

ViewStatistics statistics(const JudgedView& view) {
  std::size_t measured = 0, empty = 0, outside = 0;
  double outliers = 0;
  for (std::size_t p = 0; p < view.depth.size(); ++p) {
    if (view.look.data()[p] == Look::Outside) {
      ++outside;
    } else if (view.depth.data()[p] != kInvalidDepth) {
      ++measured, outliers += view.outlier.data()[p];
    } else {
      empty += view.look.data()[p] == Look::Empty;
    }
  }
  const auto share = [](double part, std::size_t all) {
    return all > 0 ? part / static_cast<double>(all) : 0.0;
  };
  const std::size_t missing = view.depth.size() - measured - outside;
  return {share(outliers, measured), share(static_cast<double>(empty), missing),
          share(static_cast<double>(outside), view.depth.size())};
}

std::string judgementJson(const JudgedScan& scan, const JudgementOrigin& origin) {
  const Box& box = scan.judgement.domain;
  Json json;
  json["version"] = origin.version;
  json["command"] = "judge";
  json["input"] = {{"path", origin.input},
                   {"views", scan.judgement.judged.views.size()},
                   {"width", scan.width},
                   {"height", scan.height},
                   {"format", origin.format}};
  json["calibration"] = calibrationJson(scan.calibration);
  json["sensor"] = sensorJson(scan.judgement.judged.sensor);
  json["domain"] = {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()};
  json["confidence_curve"] = curveJson(scan.judgement.model);
  json["views"] = Json::array();
  for (const JudgedView& view : scan.judgement.judged.views) json["views"].push_back(viewJson(view));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ReadJudgement readJudgementJson(const std::filesystem::path& path) {
  const Json json = parse(path);
  const Member file(path, json, "");
  ReadJudgement read;
  read.calibration = readCalibration(file["calibration"]);
  read.sensor = readSensor(path, file["sensor"]);
  read.domain = readDomain(file["domain"]);
  read.model = readModel(file["confidence_curve"], read.calibration.outlier_share);
  for (const Member& view : file["views"].list()) read.views.push_back(readView(view));
  return read;
}

}  // namespace vdbfuse
