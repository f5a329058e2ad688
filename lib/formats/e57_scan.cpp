// SPDX-License-Identifier: Apache-2.0
#include "formats/e57_scan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <pugixml.hpp>

#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using pugi::xml_node;

constexpr double kQuaternionTolerance = 1e-3;
constexpr std::uint64_t kSmallestRecord = 3;  // bytes; a byte a coordinate
constexpr std::array kCoordinates = {"cartesianX",     "cartesianY",       "cartesianZ",
                                     "sphericalRange", "sphericalAzimuth", "sphericalElevation"};

// What the errors of one scan have in common.
struct Context {
  const fs::path& path;
  std::string place;

  [[noreturn]] void fail(const std::string& key, const std::string& expected,
                         const std::string& found) const {
    throw IoError(path, place + "/" + key, expected, found);
  }
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == text.npos) return {};
  text = text.substr(begin, text.find_last_not_of(kBlank) + 1 - begin);
  return text.size() > 1 && text.front() == '+' ? text.substr(1) : text;
}

// Of any text, what fits into a line of a message.
std::string oneLine(std::string_view text, std::size_t longest) {
  std::string line(text.substr(0, longest));
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return line;
}

template <class Number>
Number parsed(const Context& context, const std::string& key, std::string_view text, Number none) {
  const std::string_view word = trimmed(text);
  if (word.empty()) return none;
  Number value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool is_finite = std::isfinite(static_cast<double>(value));
  if (error != std::errc() || stop != word.data() + word.size() || !is_finite)
    context.fail(key, std::is_integral_v<Number> ? "a whole number" : "a finite number",
                 "'" + oneLine(word, 40) + "'");
  return value;
}

double number(const Context& context, const xml_node& parent, const char* name) {
  return parsed(context, name, parent.child_value(name), 0.0);
}

std::optional<RigidTransform> poseOf(const Context& context, const xml_node& scan) {
  const xml_node pose = scan.child("pose");
  if (!pose) return std::nullopt;
  RigidTransform result = RigidTransform::Identity();
  // No comma initialiser: it asserts when an exception leaves it half filled.
  if (const xml_node t = pose.child("translation"))
    result.translation() =
        Eigen::Vector3d(number(context, t, "x"), number(context, t, "y"), number(context, t, "z"));
  const xml_node r = pose.child("rotation");
  if (!r) return result;
  const Eigen::Quaterniond turn(number(context, r, "w"), number(context, r, "x"), number(context, r, "y"),
                                number(context, r, "z"));
  if (!(std::abs(turn.norm() - 1) < kQuaternionTolerance))
    context.fail("pose/rotation", "a quaternion w x y z of length 1", "length " + numberText(turn.norm()));
  result.linear() = turn.normalized().toRotationMatrix();
  return result;
}

void readInteger(const Context& context, const xml_node& node, E57Field& field) {
  field.type = E57Field::Type::Integer;
  constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min(),
                         kHighest = std::numeric_limits<std::int64_t>::max();
  field.minimum = parsed(context, field.name, node.attribute("minimum").value(), kLowest);
  const std::int64_t maximum = parsed(context, field.name, node.attribute("maximum").value(), kHighest);
  if (maximum < field.minimum)
    context.fail(field.name, "a maximum that is not below the minimum", std::to_string(maximum));
  field.bits =
      std::bit_width(static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(field.minimum));
}

E57Field fieldOf(const Context& context, const xml_node& node) {
  E57Field field;
  field.name = node.name();
  const std::string type = node.attribute("type").value();
  if (type == "Structure" || type == "Vector" || type == "CompressedVector")
    context.fail("prototype/" + field.name, "a field that is one number", "a " + type);
  if (type == "Float") {
    const bool is_single = std::string_view(node.attribute("precision").value()) == "single";
    field.type = is_single ? E57Field::Type::Single : E57Field::Type::Double;
    field.bits = is_single ? 32 : 64;
  }
  if (type == "Integer" || type == "ScaledInteger") readInteger(context, node, field);
  if (type == "ScaledInteger") {
    field.scale = parsed(context, field.name, node.attribute("scale").value(), 1.0);
    field.offset = parsed(context, field.name, node.attribute("offset").value(), 0.0);
  }
  return field;
}

void checkCodecs(const Context& context, const xml_node& points) {
  for (const xml_node& entry : points.child("codecs").children()) {
    for (const xml_node& codec : entry.children()) {
      const std::string_view name = codec.name();
      if (name != "inputs" && name != "bitPackCodec")
        context.fail("points/codecs", "the bitpack codec", "'" + oneLine(name, 40) + "'");
    }
  }
}

// Records that say nothing about where their point lies take no bytes: then any number of them would fit.
void checkRecords(const Context& context, const E57Scan& scan) {
  const bool is_stored = std::any_of(kCoordinates.begin(), kCoordinates.end(), [&](const char* name) {
    const auto index = scan.find(name);
    return index && scan.fields[*index].bits > 0;
  });
  if (!is_stored && scan.record_count > 0)
    context.fail("points/prototype", "cartesianX, Y, Z or sphericalRange, Azimuth, Elevation",
                 "no coordinate that takes a bit");
}

E57Scan scanOf(const Context& context, const xml_node& node) {
  E57Scan scan;
  scan.place = context.place;
  scan.name = oneLine(trimmed(node.child_value("name")), 200);
  scan.world_from_scanner = poseOf(context, node);
  const xml_node points = node.child("points");
  if (!points) context.fail("points", "a CompressedVector", "none");
  checkCodecs(context, points);
  constexpr std::uint64_t kNone = 0;
  scan.section = parsed(context, "points/fileOffset", points.attribute("fileOffset").value(), kNone);
  scan.record_count = parsed(context, "points/recordCount", points.attribute("recordCount").value(), kNone);
  for (const xml_node& field : points.child("prototype").children()) {
    if (field.type() == pugi::node_element) scan.fields.push_back(fieldOf(context, field));
  }
  checkRecords(context, scan);
  return scan;
}

}  // namespace

std::optional<std::size_t> E57Scan::find(const std::string& field) const {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].name == field) return i;
  }
  return std::nullopt;
}

std::vector<E57Scan> parseE57(const fs::path& path, const std::string& xml, std::uint64_t file_bytes) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(xml.data(), xml.size());
  if (!result)
    throw IoError(path, "the XML section", "sound XML",
                  std::string(result.description()) + " at its byte " + std::to_string(result.offset));
  const xml_node root = document.child("e57Root");
  if (!root) throw IoError(path, "the XML section", "e57Root", "none");
  // Of all scans together: several that claim the same bytes are none.
  std::uint64_t room = file_bytes / kSmallestRecord;
  std::vector<E57Scan> scans;
  for (const xml_node& node : root.child("data3D").children("vectorChild")) {
    const Context context{path, "data3D[" + std::to_string(scans.size()) + "]"};
    scans.push_back(scanOf(context, node));
    if (scans.back().record_count > room)
      context.fail("points", "no more records than the file has room for",
                   std::to_string(scans.back().record_count) + " records");
    room -= scans.back().record_count;
  }
  if (scans.empty()) throw IoError(path, "data3D", "a scan", "none");
  return scans;
}

}  // namespace vdbfuse
