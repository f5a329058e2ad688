// SPDX-License-Identifier: Apache-2.0
#include "formats/e57_writer.h"

#include <cmath>
#include <cstring>
#include <iomanip>
#include <sstream>

namespace vdbfuse::test {
namespace {

constexpr std::size_t kPayload = 1020;

void put(std::string& bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
}

std::uint64_t physical(std::uint64_t logical) { return logical + logical / kPayload * 4; }

// Bit by bit, highest first, with every byte and the result mirrored: the definition of the checksum.
std::uint32_t checksum(const std::string& bytes) {
  std::uint32_t remainder = 0xFFFFFFFF;
  for (const char c : bytes) {
    for (int bit = 0; bit < 8; ++bit) {
      const bool in = (static_cast<unsigned char>(c) >> bit & 1) != 0;
      const bool out = (remainder >> 31 & 1) != 0;
      remainder = remainder << 1 ^ (in != out ? 0x1EDC6F41U : 0U);
    }
  }
  std::uint32_t mirrored = 0;
  for (int bit = 0; bit < 32; ++bit) mirrored |= (remainder >> bit & 1) << (31 - bit);
  return ~mirrored;
}

int bitsOf(const E57Column& column) {
  int bits = 0;
  for (std::uint64_t states = static_cast<std::uint64_t>(column.maximum - column.minimum); states > 0;
       states >>= 1)
    ++bits;
  return bits;
}

std::string packed(const E57Column& column) {
  std::string bytes;
  std::vector<bool> bits;
  for (const double value : column.values) {
    const auto single = static_cast<float>(value);
    std::uint32_t word = 0;
    std::uint64_t longword = 0;
    std::memcpy(&word, &single, 4), std::memcpy(&longword, &value, 8);
    if (column.type == E57Column::Type::Single) put(bytes, word, 4);
    if (column.type == E57Column::Type::Double) put(bytes, longword, 8);
    if (column.type == E57Column::Type::Text) bytes += "\x02x";
    if (column.type != E57Column::Type::Integer && column.type != E57Column::Type::Scaled) continue;
    const auto whole = static_cast<std::int64_t>(std::llround((value - column.offset) / column.scale));
    for (int i = 0; i < bitsOf(column); ++i)
      bits.push_back((static_cast<std::uint64_t>(whole - column.minimum) >> i & 1) != 0);
  }
  for (std::size_t i = 0; i < bits.size(); ++i) {
    if (i % 8 == 0) bytes += '\0';
    if (bits[i]) bytes.back() = static_cast<char>(bytes.back() | 1 << (i % 8));
  }
  return bytes;
}

std::string dataPacket(std::vector<std::string>& streams) {
  std::string lengths, data;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const std::string part = streams[i].substr(0, 301 + 37 * i);
    streams[i].erase(0, part.size());
    put(lengths, part.size(), 2);
    data += part;
  }
  std::string packet = {1, 0};
  const std::size_t length = (6 + lengths.size() + data.size() + 3) / 4 * 4;
  put(packet, length - 1, 2), put(packet, streams.size(), 2);
  packet += lengths + data;
  packet.resize(length);
  return packet;
}

std::string emptyPacket() { return std::string("\x02\0\x07\0\1\2\3\4", 8); }
std::string indexPacket() { return std::string("\0\0\x1F\0\1\0\0", 7) + std::string(25, '\0'); }

// `start` is where it will lie.
std::string section(const E57Part& part, std::uint64_t start) {
  std::vector<std::string> streams;
  for (const E57Column& column : part.columns) streams.push_back(packed(column));
  std::string packets = indexPacket();
  for (bool more = true; more;) {
    packets += dataPacket(streams) + emptyPacket();
    more = false;
    for (const std::string& stream : streams) more = more || !stream.empty();
  }
  std::string bytes(8, '\0');
  bytes[0] = 1;
  put(bytes, 32 + packets.size(), 8), put(bytes, physical(start + 32), 8),
      put(bytes, physical(start + 32), 8);
  return bytes + packets;
}

std::string columnXml(const E57Column& column) {
  std::ostringstream xml;
  xml << std::setprecision(17) << "<" << column.name << " type=\"";
  if (column.type == E57Column::Type::Single) xml << "Float\" precision=\"single\"/>";
  if (column.type == E57Column::Type::Double) xml << "Float\"/>";
  if (column.type == E57Column::Type::Text) xml << "String\"/>";
  const bool is_scaled = column.type == E57Column::Type::Scaled;
  if (!is_scaled && column.type != E57Column::Type::Integer) return xml.str() + "\n";
  xml << (is_scaled ? "ScaledInteger" : "Integer") << "\" minimum=\"" << column.minimum << "\" maximum=\""
      << column.maximum << "\"";
  if (is_scaled) xml << " scale=\"" << column.scale << "\" offset=\"" << column.offset << "\"";
  return xml.str() + "/>\n";
}

std::string numberXml(const char* name, double value) {
  std::ostringstream xml;
  xml << std::setprecision(17) << "<" << name << " type=\"Float\"";
  if (value == 0) xml << "/>";
  if (value != 0) xml << ">" << value << "</" << name << ">";
  return xml.str();
}

std::string poseXml(const RigidTransform& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  return "<pose type=\"Structure\"><rotation type=\"Structure\">" + numberXml("w", q.w()) +
         numberXml("x", q.x()) + numberXml("y", q.y()) + numberXml("z", q.z()) +
         "</rotation>\n<translation type=\"Structure\">" + numberXml("x", t.x()) + numberXml("y", t.y()) +
         numberXml("z", t.z()) + "</translation></pose>\n";
}

std::string partXml(const E57Part& part, std::uint64_t start) {
  std::string xml = "<vectorChild type=\"Structure\">\n<guid type=\"String\">{1}</guid>\n";
  if (!part.name.empty()) xml += "<name type=\"String\"><![CDATA[" + part.name + "]]></name>\n";
  if (part.pose) xml += poseXml(*part.pose);
  xml += "<points type=\"CompressedVector\" fileOffset=\"" + std::to_string(physical(start)) +
         "\" recordCount=\"" + std::to_string(part.columns.front().values.size()) +
         "\">\n<prototype type=\"Structure\">\n";
  for (const E57Column& column : part.columns) xml += columnXml(column);
  return xml + "</prototype>\n<codecs type=\"Vector\" allowHeterogeneousChildren=\"1\">" + part.codecs +
         "</codecs>\n</points>\n</vectorChild>\n";
}

// A scanner's x is our z, its y our -x, its z our -y.
Eigen::Vector3d scannerPoint(const View& view, int x, int y) {
  const Eigen::Vector3d p =
      unproject(view.projection, x, y, view.map.depth(x, y) > 0 ? view.map.depth(x, y) : 1);
  return {p.z(), -p.x(), -p.y()};
}

RigidTransform scannerPose(const View& view) {
  RigidTransform pose = view.world_from_camera;
  const Eigen::Matrix3d camera = view.world_from_camera.linear();
  pose.linear() << camera.col(2), -camera.col(0), -camera.col(1);
  return pose;
}

template <class Visit>
void forEachPixel(const View& view, const Visit& visit) {
  for (int x = 0; x < view.map.depth.width(); ++x) {
    for (int y = 0; y < view.map.depth.height(); ++y) visit(x, y, view.map.depth(x, y) != kInvalidDepth);
  }
}

}  // namespace

std::string e57Pages(std::string logical) {
  logical.resize((logical.size() + kPayload - 1) / kPayload * kPayload, '\0');
  std::string length;
  put(length, logical.size() / kPayload * 1024, 8);
  if (logical.size() >= 24) logical.replace(16, 8, length);
  std::string file;
  for (std::size_t i = 0; i < logical.size(); i += kPayload) {
    const std::string page = logical.substr(i, kPayload);
    const std::uint32_t sum = checksum(page);
    file += page;
    for (int byte = 3; byte >= 0; --byte) file += static_cast<char>(sum >> (8 * byte) & 0xFF);
  }
  return file;
}

std::string e57File(const std::vector<E57Part>& parts) {
  std::string body, scans;
  for (const E57Part& part : parts) {
    scans += partXml(part, 48 + body.size());
    body += section(part, 48 + body.size());
  }
  const std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\" "
      "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\">\n<formatName type=\"String\">ASTM E57 3D "
      "Imaging Data File</formatName>\n<data3D type=\"Vector\" allowHeterogeneousChildren=\"1\">\n" +
      scans + "</data3D>\n</e57Root>\n";
  std::string header = "ASTM-E57";
  put(header, 1, 4), put(header, 0, 4), put(header, 0, 8);
  put(header, physical(48 + body.size()), 8), put(header, xml.size(), 8), put(header, 1024, 8);
  return e57Pages(header + body + xml);
}

E57Part cartesianPart(const View& view) {
  using Type = E57Column::Type;
  E57Part part{"scan " + view.name, scannerPose(view), {}, ""};
  E57Column x{"cartesianX", Type::Single, 0, 0, 1, 0, {}}, y = x, z = x;
  y.name = "cartesianY", z.name = "cartesianZ";
  E57Column state{"cartesianInvalidState", Type::Integer, 0, 2, 1, 0, {}}, row = state, column = state,
                                                                           red = state;
  row.name = "rowIndex", row.maximum = 999, column.name = "columnIndex", column.maximum = 77;
  red.name = "colorRed", red.maximum = 255;
  forEachPixel(view, [&](int i, int j, bool valid) {
    const Eigen::Vector3d p = scannerPoint(view, i, j);
    x.values.push_back(p.x()), y.values.push_back(p.y()), z.values.push_back(p.z());
    state.values.push_back(valid ? 0 : 2);
    // Rows are counted from below, as many scanners do.
    column.values.push_back(i), row.values.push_back(view.map.depth.height() - 1 - j),
        red.values.push_back(200);
  });
  part.columns = {column, row, red, x, y, z, state};
  return part;
}

E57Part sphericalPart(const View& view) {
  using Type = E57Column::Type;
  E57Part part{"", scannerPose(view), {}, ""};
  E57Column range{"sphericalRange", Type::Scaled, -3, 1000000, 0.0001, 0.5, {}};
  E57Column azimuth{"sphericalAzimuth", Type::Scaled, -4000000, 4000000, 1e-6, 0, {}}, elevation = azimuth;
  elevation.name = "sphericalElevation";
  E57Column state{"sphericalInvalidState", Type::Integer, 0, 2, 1, 0, {}}, row = state, column = state;
  row.name = "rowIndex", row.maximum = 99, column.name = "columnIndex", column.minimum = -5,
  column.maximum = 77;
  E57Column constant{"returnCount", Type::Integer, 1, 1, 1, 0, {}};
  forEachPixel(view, [&](int i, int j, bool valid) {
    const Eigen::Vector3d p = scannerPoint(view, i, j);
    range.values.push_back(p.norm()), azimuth.values.push_back(std::atan2(p.y(), p.x()));
    elevation.values.push_back(std::asin(p.z() / p.norm()));
    state.values.push_back(valid ? 0 : 1), constant.values.push_back(1);
    column.values.push_back(i - 5), row.values.push_back(j);
  });
  part.columns = {range, azimuth, constant, elevation, state, row, column};
  return part;
}

E57Part loosePart(const View& view) {
  using Type = E57Column::Type;
  E57Part part{"loose " + view.name, scannerPose(view), {}, ""};
  E57Column x{"cartesianX", Type::Double, 0, 0, 1, 0, {}}, y = x, z = x, note = x;
  y.name = "cartesianY", z.name = "cartesianZ", note.name = "ext:note", note.type = Type::Text;
  forEachPixel(view, [&](int i, int j, bool valid) {
    if (!valid) return;
    const Eigen::Vector3d p = scannerPoint(view, i, j);
    x.values.push_back(p.x()), y.values.push_back(p.y()), z.values.push_back(p.z()), note.values.push_back(0);
  });
  part.columns = {note, x, y, z};
  part.codecs =
      "<vectorChild type=\"Structure\"><inputs type=\"Vector\"/><bitPackCodec "
      "type=\"Structure\"/></vectorChild>";
  return part;
}

}  // namespace vdbfuse::test
