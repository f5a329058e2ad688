// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/judgement_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "fusion/scenes.h"
#include "io/temporary_folder.h"
#include "pipeline/pixel_codes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/evaluation/evaluate.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;
using testing::HasSubstr;
using Json = nlohmann::ordered_json;

// A noisy sphere with wrong depths, some of which a confidence betrays; view 3 has a mask.
std::vector<View> scanViews() {
  std::vector<View> views = test::sphereViews(16, 48);
  test::addNoise(views, {0.004, 0, 0}, 6);
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].name = "v" + std::to_string(i);
    Random random(7, i);
    views[i].map.confidence = Image<float>(48, 48);
    for (std::size_t p = 0; p < views[i].map.depth.size(); ++p) {
      float& d = views[i].map.depth.data()[p];
      const bool wrong = d != kInvalidDepth && random.uniform() < 0.1;
      if (wrong) d = static_cast<float>(random.uniform(1.5, 2.5));
      views[i].map.confidence.data()[p] = static_cast<float>((wrong ? -1 : 1) + random.normal());
    }
  }
  DepthMap& masked = views[3].map;
  masked.mask = Image<std::uint8_t>(48, 48);
  std::transform(masked.depth.begin(), masked.depth.end(), masked.mask.begin(),
                 [](float d) -> std::uint8_t { return d != kInvalidDepth; });
  return views;
}

class JudgementFolder : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    views_ = new ViewSequence(ViewSequence::fromViews(scanViews()));
    ReconstructOptions options;
    options.judge.no_return = JudgeOptions::NoReturn::Free;
    scan_ = new JudgedScan(judgeScan(*views_, options));
  }
  static void TearDownTestSuite() {
    delete views_;
    delete scan_;
  }

  void SetUp() override { writeJudgement(folder.path(), *scan_, {"1.2.3", "scan", "mvsnet"}); }

  JudgedScan read() const { return readJudgement(folder.path(), *views_); }

  // What is said of the folder, without its name.
  std::string complaint(const ViewSequence& views) const {
    const std::string message = messageOf<IoError>([&] { readJudgement(folder.path(), views); });
    EXPECT_EQ(message.find(folder.path().string() + "/"), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message.substr(folder.path().string().size() + 1);
  }
  std::string complaint() const { return complaint(*views_); }

  // Reads the file, changes it, writes it, and returns what is said of it then.
  std::string complaintAfter(const std::function<void(Json&)>& change) const {
    Json json = Json::parse(judgementJson(*scan_, {}));
    change(json);
    writeText(folder / "judgement.json", json.dump());
    return complaint();
  }

  TemporaryFolder folder;
  static inline ViewSequence* views_ = nullptr;
  static inline JudgedScan* scan_ = nullptr;
};

TEST_F(JudgementFolder, ComesBackAsItWas) {
  const JudgedScan found = read();
  const JudgedViews &a = scan_->judgement.judged, &b = found.judgement.judged;
  EXPECT_EQ(a.sensor.noise, b.sensor.noise);
  EXPECT_EQ(a.sensor.near, b.sensor.near);
  EXPECT_EQ(a.sensor.far, b.sensor.far);
  EXPECT_EQ(a.miss_rate, b.miss_rate);
  EXPECT_EQ(found.judgement.domain.min(), scan_->judgement.domain.min());
  EXPECT_EQ(found.judgement.domain.max(), scan_->judgement.domain.max());
  EXPECT_EQ(found.judgement.model.confidence_bins, scan_->judgement.model.confidence_bins);
  EXPECT_EQ(found.judgement.model.outlier_by_confidence, scan_->judgement.model.outlier_by_confidence);
  EXPECT_EQ(found.calibration.noise_scale, scan_->calibration.noise_scale);
  EXPECT_EQ(found.calibration.confidence, ConfidenceDirection::HighIsGood);
  ASSERT_EQ(b.views.size(), a.views.size());
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    EXPECT_EQ(b.views[i].weight, a.views[i].weight);
    EXPECT_EQ(b.views[i].depth, a.views[i].depth);
    EXPECT_EQ(b.views[i].incidence, a.views[i].incidence);
    for (std::size_t p = 0; p < a.views[i].depth.size(); ++p) {
      const bool measured = a.views[i].depth.data()[p] != kInvalidDepth;
      const double outlier = a.views[i].outlier.data()[p];
      ASSERT_EQ(b.views[i].look.data()[p], measured ? Look::Nothing : a.views[i].look.data()[p]);
      if (!measured) continue;
      ASSERT_NEAR(b.views[i].outlier.data()[p], outlier, 3e-4 * std::min(outlier, 1 - outlier));
    }
  }
}

TEST_F(JudgementFolder, GivesTheSameSurfaceAsWithoutTheDetour) {
  ReconstructOptions options;
  options.resolution = 40;
  const TriangleMesh direct = reconstruct(*scan_, options).mesh, handed = reconstruct(read(), options).mesh;
  EvaluateOptions evaluate_options;
  evaluate_options.samples = 2000, evaluate_options.iou_resolution = 64;
  EXPECT_GT(evaluate(handed, direct, evaluate_options).iou.value_or(0), 0.999);
}

TEST_F(JudgementFolder, ADomainThatIsGivenReplacesTheJudgements) {
  ReconstructOptions options;
  options.voxel = 0.05;
  options.domain = Box(Eigen::Vector3d(-0.7, -0.7, 0), Eigen::Vector3d(0.7, 0.7, 0.7));
  const Reconstruction half = reconstruct(read(), options);
  EXPECT_EQ(half.grid.domain.min().z(), 0);
  EXPECT_EQ(half.steps.front().name, "load");
  EXPECT_EQ(half.steps.back().name, "surface");
}

TEST_F(JudgementFolder, HoldsAPictureOfEachViewAndATable) {
  const Image<std::uint8_t> picture = readPngGrey8(folder / "v5.png");
  const JudgedView& view = scan_->judgement.judged.views[5];
  for (std::size_t p = 0; p < picture.size(); ++p) {
    const bool measured = view.depth.data()[p] != kInvalidDepth;
    ASSERT_EQ(picture.data()[p], measured ? std::lround(255 * (1 - view.outlier.data()[p])) : 0);
  }
  const std::string text = readText(folder / "judgement.txt");
  EXPECT_THAT(text, HasSubstr("confidence     high is good"));
  EXPECT_THAT(text, HasSubstr("confidence below  outliers"));
  EXPECT_THAT(text, HasSubstr("  v15\n"));
  const Json json = Json::parse(readText(folder / "judgement.json"));
  EXPECT_EQ(json.begin().key(), "version");
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["command"], "judge");
  EXPECT_EQ(json["input"]["format"], "mvsnet");
  EXPECT_EQ(json["input"]["views"], 16);
  EXPECT_EQ(json["confidence_curve"].size(), 20u);
  EXPECT_GT(json["confidence_curve"][0]["outlier_share"], json["confidence_curve"][19]["outlier_share"]);
  EXPECT_EQ(json["confidence_curve"][19]["confidence_below"], nullptr);
  EXPECT_EQ(json["views"][4]["name"], "v4");
  EXPECT_EQ(json["views"][4]["outside_mask"], 0.0);
  EXPECT_GT(json["views"][3]["outside_mask"], 0.1);
  EXPECT_GT(json["views"][4]["no_returns_trusted"], 0.3);
  EXPECT_EQ(json["views"][3]["no_returns_trusted"], 0.0);
}

TEST_F(JudgementFolder, OfOtherViewsIsRefused) {
  std::vector<View> views = scanViews();
  std::swap(views[1].name, views[2].name);
  EXPECT_EQ(complaint(ViewSequence::fromViews(views)),
            "judgement.json: 'views[1]': expected view v2, found view v1");
  EXPECT_EQ(complaint(views_->first(15)),
            "judgement.json: expected a judgement of 15 views, found one of 16");
  views = test::sphereViews(16, 40);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].name = "v" + std::to_string(i);
  EXPECT_EQ(complaint(ViewSequence::fromViews(views)),
            "judgement.json: 'views[0]': expected 40x40 pixels, found 48x48");
}

TEST_F(JudgementFolder, WithAMissingFileIsRefused) {
  std::filesystem::remove(folder / "outliers/v7.png");
  EXPECT_EQ(complaint(),
            "outliers/v7.png: expected the outlier probabilities of view v7, found nothing of that name");
  std::filesystem::remove(folder / "judgement.json");
  EXPECT_EQ(complaint(), "judgement.json: expected a judgement, found nothing of that name");
  std::filesystem::create_directory(folder / "judgement.json");
  EXPECT_EQ(complaint(), "judgement.json: cannot be read");
}

TEST_F(JudgementFolder, WithADamagedPictureIsRefused) {
  const std::string whole = readText(folder / "outliers/v7.png");
  writeText(folder / "outliers/v7.png", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(complaint(), HasSubstr("outliers/v7.png: byte"));
  writePng(folder / "outliers/v7.png", Image<std::uint8_t>(48, 48));
  EXPECT_EQ(complaint(), "outliers/v7.png: expected a 16-bit grey PNG, found 8-bit grey");
  writePng(folder / "outliers/v7.png", Image<std::uint16_t>(48, 47));
  EXPECT_EQ(complaint(), "outliers/v7.png: expected 48x48 pixels, found 48x47");
}

TEST_F(JudgementFolder, WithADamagedJsonIsRefused) {
  writeText(folder / "judgement.json", "{\"version\": 1,");
  EXPECT_EQ(complaint(), "judgement.json: byte 15: expected JSON, found something else");
  EXPECT_EQ(complaintAfter([](Json& j) { j = 3; }), "judgement.json: expected an object, found 3");
  EXPECT_EQ(complaintAfter([](Json& j) { j["sensor"].erase("near"); }),
            "judgement.json: expected 'sensor.near', found none");
  EXPECT_EQ(complaintAfter([](Json& j) { j["sensor"]["near"] = "x"; }),
            "judgement.json: 'sensor.near': expected a number, found \"x\"");
  EXPECT_EQ(
      complaintAfter([](Json& j) { j["sensor"]["noise"] = "pink"; }),
      "judgement.json: 'sensor.noise': expected one of 'gaussian', 'logistic', 'laplace', found \"pink\"");
  EXPECT_THAT(complaintAfter([](Json& j) { j["sensor"]["far"] = 0; }),
              HasSubstr("judgement.json: 'sensor': expected a possible sensor, found "));
  EXPECT_EQ(complaintAfter([](Json& j) { j["calibration"]["miss_rate"] = 2; }),
            "judgement.json: 'calibration.miss_rate': expected a number in [0, 1], found 2");
  EXPECT_EQ(complaintAfter([](Json& j) {
              j["domain"] = {1, 2};
            }),
            "judgement.json: 'domain': expected six numbers, found [1,2]");
  EXPECT_EQ(complaintAfter([](Json& j) { j["domain"] = {1, 2, 3, 0, 5, 6}; }),
            "judgement.json: 'domain': expected the lower corner first, found [1,2,3,0,5,6]");
  EXPECT_EQ(complaintAfter([](Json& j) { j["confidence_curve"] = 1; }),
            "judgement.json: 'confidence_curve': expected a list, found 1");
  EXPECT_THAT(complaintAfter([](Json& j) { j["confidence_curve"].erase(19); }),
              HasSubstr("judgement.json: 'confidence_curve': expected 20 bins or none, found [{"));
  EXPECT_EQ(complaintAfter([](Json& j) { j["views"][2]["weight"] = 0; }),
            "judgement.json: 'views[2].weight': expected a weight above 0, found 0");
  EXPECT_EQ(complaintAfter([](Json& j) { j["views"][2]["width"] = 1.5; }),
            "judgement.json: 'views[2].width': expected a positive whole number, found 1.5");
  EXPECT_EQ(complaintAfter([](Json& j) { j["views"][2]["name"] = 7; }),
            "judgement.json: 'views[2].name': expected a text, found 7");
}

TEST_F(JudgementFolder, NeedsViewsThatCanBeNamesOfFiles) {
  const auto message = [&](std::size_t index, const std::string& name) {
    JudgedScan renamed = *scan_;
    renamed.judgement.judged.views[index].name = name;
    const TemporaryFolder other;
    return messageOf<InvalidArgument>([&] { writeJudgement(other.path(), renamed, {}); });
  };
  EXPECT_EQ(message(0, "a/b"), "views: 'a/b' cannot be the name of a file");
  EXPECT_EQ(message(0, ""), "views: '' cannot be the name of a file");
  EXPECT_EQ(message(1, "v0"), "views: two are called 'v0'");
  EXPECT_THROW(writeJudgement(folder / "missing/deep", *scan_, {}), IoError);
}

TEST(PixelCodes, KeepWhatCountsOfTheSmallestAndTheLargestProbability) {
  JudgedView view;
  const std::vector<float> outliers = {1e-6f, kMinOutlier, 0.5f, kMaxOutlier, 0.0f, 1.0f};
  const int count = static_cast<int>(outliers.size());
  view.depth = Image<float>(count, 1, 1.0f);
  view.look = Image<Look>(count, 1, Look::Nothing);
  view.outlier = Image<float>(count, 1);
  std::copy(outliers.begin(), outliers.end(), view.outlier.begin());
  const Image<std::uint16_t> codes = encodePixels(view);
  decodePixels(codes, view);
  for (int x = 0; x < 4; ++x) {
    const double rest = 1 - outliers[static_cast<std::size_t>(x)];
    EXPECT_NEAR(view.outlier(x, 0) / outliers[static_cast<std::size_t>(x)], 1, 2.5e-4);
    EXPECT_NEAR((1 - view.outlier(x, 0)) / rest, 1, 2.5e-4);
  }
  EXPECT_EQ(view.outlier(2, 0), 0.5f);
  EXPECT_LT(view.outlier(4, 0), 2e-7f);
  EXPECT_GT(view.outlier(5, 0), 1 - 2e-7f);
}

}  // namespace
}  // namespace vdbfuse
