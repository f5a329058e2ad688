// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/judgement_folder.h"

#include <fstream>
#include <set>

#include "pipeline/judgement_json.h"
#include "pipeline/pixel_codes.h"
#include "pipeline/steps.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/fusion/pixel_surface.h"
#include "vdbfuse/io/atomic_file.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJson = "judgement.json";
constexpr const char* kText = "judgement.txt";

fs::path codesPath(const fs::path& folder, const std::string& name) {
  return folder / "outliers" / (name + ".png");
}

void requireFileNames(const std::vector<JudgedView>& views) {
  std::set<std::string> names;
  for (const JudgedView& view : views) {
    if (view.name.empty() || view.name.find('/') != std::string::npos)
      throw InvalidArgument("views", "'" + view.name + "' cannot be the name of a file");
    if (!names.insert(view.name).second) throw InvalidArgument("views", "two are called '" + view.name + "'");
  }
}

void writeText(const fs::path& path, const std::string& text) {
  AtomicFile target(path);
  std::ofstream file(target.temporaryPath(), std::ios::binary);
  file << text;
  file.close();
  if (!file) throw IoError(path, "cannot be written");
  target.commit();
}

std::string sizeText(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

void requireSameViews(const fs::path& path, const std::vector<ReadView>& judged, const ViewSequence& views) {
  if (judged.size() != views.size()) {
    throw IoError(path, "", "a judgement of " + std::to_string(views.size()) + " views",
                  "one of " + std::to_string(judged.size()));
  }
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const ViewHeader& header = views.header(i);
    const std::string place = "'views[" + std::to_string(i) + "]'";
    if (judged[i].name != header.name)
      throw IoError(path, place, "view " + header.name, "view " + judged[i].name);
    const int width = imageWidth(header.projection), height = imageHeight(header.projection);
    if (judged[i].width != width || judged[i].height != height) {
      throw IoError(path, place, sizeText(width, height) + " pixels",
                    sizeText(judged[i].width, judged[i].height));
    }
  }
}

Image<std::uint16_t> readCodes(const fs::path& folder, const ReadView& view) {
  const fs::path path = codesPath(folder, view.name);
  if (!fs::exists(path))
    throw IoError(path, "", "the outlier probabilities of view " + view.name, "nothing of that name");
  Image<std::uint16_t> codes = readPngGrey16(path);
  if (codes.width() != view.width || codes.height() != view.height) {
    throw IoError(path, "", sizeText(view.width, view.height) + " pixels",
                  sizeText(codes.width(), codes.height()));
  }
  return codes;
}

}  // namespace

void writeJudgement(const fs::path& folder, const JudgedScan& scan, const JudgementOrigin& origin) {
  const std::vector<JudgedView>& views = scan.judgement.judged.views;
  requireFileNames(views);
  std::error_code error;
  fs::create_directory(folder / "outliers", error);
  if (error) throw IoError(folder / "outliers", "cannot be created: " + error.message());
  parallelFor(views.size(), 1, [&](std::size_t i, std::size_t) {
    writePng(folder / (views[i].name + ".png"), reliabilityImage(views[i]));
    writePng(codesPath(folder, views[i].name), encodePixels(views[i]));
    letGo(views[i]);
  });
  writeText(folder / kText, judgementText(scan));
  writeText(folder / kJson, judgementJson(scan, origin));
}

JudgedScan readJudgement(const fs::path& folder, const ViewSequence& sequence, const Progress& progress) {
  return readJudgement(folder, sequence, planJudging(sequence), progress);
}

JudgedScan readJudgement(const fs::path& folder, const ViewSequence& sequence, ScanPlan plan,
                         const Progress& progress) {
  ReadJudgement read = readJudgementJson(folder / kJson);
  requireSameViews(folder / kJson, read.views, sequence);
  JudgedScan scan;
  StepTimer timer;
  timer.start("load");
  scan.plan = std::move(plan);
  scan.steps = scan.plan.steps;
  scan.plan.reduction.assign(sequence.size(), 1);  // pixels were judged as they are
  std::vector<View> views = loadViews(sequence, scan, progress);

  timer.start("read judgement");
  std::vector<Image<float>> incidence(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    incidence[i] = Image<float>(analyseSurface(views[i], read.sensor.noise).incidence, views[i].memory());
    letGo(views[i]), letGo(incidence[i]);
  }
  JudgedViews& judged = scan.judgement.judged =
      believe(std::move(views), read.sensor, kMinOutlier, std::move(incidence));
  ProgressStep step(progress, "read judgement", judged.views.size());
  parallelFor(judged.views.size(), 1, [&](std::size_t i, std::size_t) {
    judged.views[i].weight = read.views[i].weight;
    decodePixels(readCodes(folder, read.views[i]), judged.views[i]);
    letGo(judged.views[i]);
    step.advance();
  });
  judged.miss_rate = read.calibration.miss_rate;
  scan.calibration = read.calibration;
  scan.judgement.model = std::move(read.model);
  scan.judgement.domain = read.domain;
  for (StepTime& timed : timer.finish()) scan.steps.push_back(std::move(timed));
  return scan;
}

}  // namespace vdbfuse
