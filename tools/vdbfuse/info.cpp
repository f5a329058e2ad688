// SPDX-License-Identifier: Apache-2.0
// vdbfuse info: what is in a data set, of depth maps or of photographs.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "commands.h"
#include "json_file.h"
#include "read_options.h"
#include "run_options.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/fusion/conventions.h"
#include "vdbfuse/sensor/summary.h"

namespace vdbfuse::tool {
namespace {

struct InfoOptions : RunArguments {
  std::filesystem::path input;
  ReadArguments read;
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

std::string sizesOf(const std::set<std::pair<int, int>>& sizes) {
  const auto text = [](const std::pair<int, int>& size) {
    return std::to_string(size.first) + "x" + std::to_string(size.second);
  };
  if (sizes.size() == 1) return text(*sizes.begin());
  return text(*sizes.begin()) + " to " + text(*sizes.rbegin()) + ", " + std::to_string(sizes.size()) +
         " sizes";
}

std::string sizesOf(const ViewSequence& views) {
  std::set<std::pair<int, int>> sizes;
  for (std::size_t i = 0; i < views.size(); ++i)
    sizes.emplace(imageWidth(views.header(i).projection), imageHeight(views.header(i).projection));
  return sizesOf(sizes);
}

std::string text(const std::optional<Spread>& spread) {
  if (!spread) return "none";
  return number(spread->low) + " to " + number(spread->high) + ", median " + number(spread->median) +
         " (smallest " + number(spread->smallest) + ", largest " + number(spread->largest) + ")";
}

std::string text(const Box& box) {
  if (box.isEmpty()) return "none";
  const auto point = [](const Eigen::Vector3d& p) {
    return number(p.x()) + "," + number(p.y()) + "," + number(p.z());
  };
  return point(box.min()) + " to " + point(box.max());
}

void print(const DepthSet& set, const ViewsSummary& summary, const ConventionCheck& check) {
  std::printf("format      %s\n", set.format.c_str());
  std::printf("views       %zu, %s pixels\n", set.views.size(), sizesOf(set.views).c_str());
  std::printf("stored      %s\n", depthText(set.reading).c_str());
  std::printf("poses       %s\n", set.reading.pose.c_str());
  std::printf("coverage    %.1f %% of the pixels have a depth\n", 100.0 * summary.coverage());
  std::printf("depth       %s\n", text(summary.depth).c_str());
  std::printf("confidence  %s\n", text(summary.confidence).c_str());
  std::printf("colour      %zu views\n", summary.views_with_color);
  std::printf("points      %s\n", text(summary.points).c_str());
  std::printf("cameras     %s\n", text(summary.cameras).c_str());
  if (check.agreement)
    std::printf("agreement   %.0f %% of the points lie where other views see a surface\n",
                100 * *check.agreement);
  for (const std::string& note : set.notes) std::printf("note        %s\n", note.c_str());
}

Json jsonOf(const std::optional<Spread>& spread) {
  if (!spread) return nullptr;
  return {{"smallest", spread->smallest},
          {"low", spread->low},
          {"median", spread->median},
          {"high", spread->high},
          {"largest", spread->largest}};
}

Json jsonOf(const Box& box) {
  if (box.isEmpty()) return nullptr;
  const auto point = [](const Eigen::Vector3d& p) { return Json{p.x(), p.y(), p.z()}; };
  return {{"min", point(box.min())}, {"max", point(box.max())}};
}

Json jsonOf(const InfoOptions& options) {
  Json json = jsonOf(options.read);
  json["input"] = options.input.string();
  return json;
}

Json jsonOf(const DepthReading& reading) {
  return {{"stored", reading.stored},
          {"kind", reading.kind ? Json(nameOf(*reading.kind)) : Json("points")},
          {"scale", reading.scale},
          {"invalid", reading.invalid},
          {"pose", reading.pose}};
}

Json jsonOf(const ConventionCheck& check) {
  Json json;
  json["agreement"] = check.agreement ? Json(*check.agreement) : Json(nullptr);
  json["better"] = nullptr;
  if (check.better) {
    json["better"] = {{"convention", nameOf(check.better->convention)},
                      {"meaning", describe(check.better->convention)},
                      {"agreement", check.better->agreement}};
  }
  return json;
}

Json jsonOf(const InfoOptions& options, const DepthSet& set, const ViewsSummary& summary,
            const ConventionCheck& check) {
  Json json = tool::jsonOf("info");
  json["options"] = jsonOf(options);
  const Projection& first = set.views.header(0).projection;
  json["input"] = {{"views", set.views.size()},
                   {"width", imageWidth(first)},
                   {"height", imageHeight(first)},
                   {"format", set.format}};
  json["reading"] = jsonOf(set.reading);
  json["conventions"] = jsonOf(check);
  json["coverage"] = summary.coverage();
  json["depth"] = jsonOf(summary.depth);
  json["confidence"] = jsonOf(summary.confidence);
  json["views_with_confidence"] = summary.views_with_confidence;
  json["views_with_color"] = summary.views_with_color;
  json["points"] = jsonOf(summary.points);
  json["cameras"] = jsonOf(summary.cameras);
  json["notes"] = set.notes;
  return json;
}

// What is known of photographs without looking at them.
struct PhotographsSummary {
  std::set<std::pair<int, int>> sizes;
  Box cameras;
  std::size_t with_depths = 0;
  DepthInterval depths{std::numeric_limits<double>::infinity(), 0};

  explicit PhotographsSummary(const PhotographSequence& photographs) {
    for (std::size_t i = 0; i < photographs.size(); ++i) {
      const PhotographHeader& header = photographs.header(i);
      sizes.emplace(header.camera.width, header.camera.height);
      cameras.extend(header.world_from_camera.translation());
      if (!header.depth) continue;
      ++with_depths;
      depths.near = std::min(depths.near, header.depth->near);
      depths.far = std::max(depths.far, header.depth->far);
    }
  }
};

void print(const ImageSet& set, const PhotographsSummary& summary) {
  std::printf("format      %s\n", set.format.c_str());
  std::printf("photographs %zu, %s pixels\n", set.photographs.size(), sizesOf(summary.sizes).c_str());
  std::printf("poses       %s\n", set.pose.c_str());
  if (summary.with_depths == 0) std::printf("depths      not stated\n");
  if (summary.with_depths > 0)
    std::printf("depths      %s to %s, stated of %zu photographs\n", number(summary.depths.near).c_str(),
                number(summary.depths.far).c_str(), summary.with_depths);
  std::printf("cameras     %s\n", text(summary.cameras).c_str());
  for (const std::string& note : set.notes) std::printf("note        %s\n", note.c_str());
}

Json jsonOf(const InfoOptions& options, const ImageSet& set, const PhotographsSummary& summary) {
  Json json = tool::jsonOf("info");
  json["options"] = jsonOf(options);
  const Pinhole& first = set.photographs.header(0).camera;
  json["input"] = {{"photographs", set.photographs.size()},
                   {"width", first.width},
                   {"height", first.height},
                   {"format", set.format}};
  json["pose"] = set.pose;
  json["photographs"] = Json::array();
  for (std::size_t i = 0; i < set.photographs.size(); ++i) {
    const PhotographHeader& header = set.photographs.header(i);
    Json one = {{"name", header.name}, {"near", nullptr}, {"far", nullptr}};
    if (header.depth) one["near"] = header.depth->near, one["far"] = header.depth->far;
    json["photographs"].push_back(std::move(one));
  }
  json["cameras"] = jsonOf(summary.cameras);
  json["notes"] = set.notes;
  return json;
}

void runOnPhotographs(const InfoOptions& options) {
  const ImageSet set = readImageSet(options.input, {options.read.format, options.read.masks});
  const PhotographsSummary summary(set.photographs);
  JsonReport(options, jsonOf(options, set, summary)).commit();
  if (speaks(options)) print(set, summary);
}

void run(const InfoOptions& options) {
  const ThreadLimit threads(options.threads);
  refuseExistingJson(options);
  if (kindOf(options.input, options.read.format) == InputKind::Photographs) {
    runOnPhotographs(options);
    return;
  }
  const DepthSet set = readInput(options.input, options.read);
  const ViewsSummary summary = summarise(set.views);
  if (summary.valid_pixels == 0)
    throw IoError(options.input, "", "depth maps that hold depths", "none valid in any of them");
  const ConventionCheck check = checkConvention(set.views, set.stored_from_camera);
  JsonReport(options, jsonOf(options, set, summary, check)).commit();
  if (speaks(options)) print(set, summary, check);
  if (!options.quiet) warnOf(check);
}

}  // namespace

void addInfo(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand(
      "info",
      "Say what is in a data set of depth maps, or of photographs with cameras\n\n"
      "Ranges and boxes leave out the 0.2 % at each end, so that a few wild depths do not count. A few views "
      "are "
      "compared with each other; where another reading of poses or depths would agree much better, a warning "
      "names it.");
  sub.footer("vdbfuse info scan/\nvdbfuse info scan/ --json - --quiet");
  const auto options = std::make_shared<InfoOptions>();
  sub.add_option("INPUT,--input", options->input, "Data set")->type_name("PATH")->required();
  addReadOptions(sub, options->read);
  addJsonOption(sub, options->json, "Write the same as JSON");
  addRunOptions(sub, *options);
  sub.callback([&action, options] { action = [options] { run(*options); }; });
}

}  // namespace vdbfuse::tool
