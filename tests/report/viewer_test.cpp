// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/viewer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/assets.h"

namespace vdbfuse {
namespace {

using testing::HasSubstr;
using testing::Not;

const ViewerCamera kCamera{{0, -3, 1}, {0, 0, 1}, {0, 0, 1}};

std::string html() {
  return viewerHtml({{"cut <1>", "foo", "12 triangles"}},
                    {{"Support", "_SUPPORT", 8, 0.5, "few", "8 or more"}}, kCamera);
}

class Viewer : public testing::Test {
 protected:
  void SetUp() override {
    if (viewerScriptState() == ViewerScript::Missing) GTEST_SKIP() << "built without three.js";
  }
};

TEST_F(Viewer, HoldsTheMeshesAndTheirNames) {
  EXPECT_THAT(html(), HasSubstr("id=\"glb-0\">Zm9v</script>"));
  EXPECT_THAT(html(), HasSubstr("<strong>cut &lt;1&gt;</strong><small>12 triangles</small>"));
}

TEST_F(Viewer, SpeaksTheAxesOfGltf) {
  EXPECT_THAT(html(), HasSubstr("\"eye\":[0.0,1.0,3.0]"));
  EXPECT_THAT(html(), HasSubstr("\"up\":[0.0,1.0,-0.0]"));
}

TEST_F(Viewer, CarriesThreeJsWithItsLicence) {
  EXPECT_THAT(viewerLicence(), HasSubstr("Permission is hereby granted, free of charge"));
  EXPECT_THAT(html(), HasSubstr(viewerLicence()));
  for (const char* name : {"WebGLRenderer", "GLTFLoader", "OrbitControls"})
    EXPECT_THAT(std::string(threeScript()), HasSubstr(name));
}

TEST_F(Viewer, NothingInTheScriptsEndsThem) {
  for (const std::string_view script : {threeScript(), viewerScript(), threeLicenceText()}) {
    for (const char* end : {"</script", "</SCRIPT", "<!--"})
      EXPECT_THAT(std::string(script), Not(HasSubstr(end)));
    EXPECT_EQ(script.find('\0'), std::string_view::npos);
  }
  EXPECT_THAT(std::string(threeLicenceText()), Not(HasSubstr("*/")));
}

TEST(ViewerWithoutThreeJs, SaysSo) {
  if (viewerScriptState() == ViewerScript::Included) GTEST_SKIP() << "built with three.js";
  EXPECT_THAT(html(), HasSubstr("built without three.js"));
  EXPECT_EQ(viewerLicence(), "");
}

}  // namespace
}  // namespace vdbfuse
