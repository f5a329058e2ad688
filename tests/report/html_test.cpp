// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/html.h"

#include <gtest/gtest.h>

namespace vdbfuse {
namespace {

TEST(Html, TextIsEscapedForElementsAndAttributes) {
  EXPECT_EQ(escapeHtml("a<b>&\"c\"'d'"), "a&lt;b&gt;&amp;&quot;c&quot;&#39;d&#39;");
  EXPECT_EQ(escapeHtml("größer ≥ 1"), "größer ≥ 1");
}

// The examples of RFC 4648, section 10.
TEST(Html, Base64IsThatOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Html, Base64TakesEveryByte) {
  EXPECT_EQ(base64(std::string("\0\xff\x80", 3)), "AP+A");
  EXPECT_EQ(base64("\xff\xff\xfe"), "///+");
}

TEST(Html, ADataUriNamesItsMediaType) { EXPECT_EQ(dataUri("image/png", "f"), "data:image/png;base64,Zg=="); }

TEST(Html, NothingInJsonEndsAScript) {
  EXPECT_EQ(jsonInScript(R"({"a":"</script><!--"})"), R"({"a":"\u003c/script>\u003c!--"})");
}

}  // namespace
}  // namespace vdbfuse
