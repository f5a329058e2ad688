// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vdbfuse {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(Page, TheBestOfARowIsTheLowestOrTheHighestAsItSays) {
  NumberRow row{"Time", "", Better::Lower, {3.0, 1.0, 2.0}, {"3 s", "1 s", "2 s"}};
  EXPECT_THAT(bestOf(row), ElementsAre(1));
  row.better = Better::Higher;
  EXPECT_THAT(bestOf(row), ElementsAre(0));
  row.better = Better::Neither;
  EXPECT_THAT(bestOf(row), IsEmpty());
}

TEST(Page, ColumnsThatReadTheSameAreBestTogether) {
  const NumberRow row{"Time", "", Better::Lower, {1.01, 1.02, 2.0}, {"1.0 s", "1.0 s", "2.0 s"}};
  EXPECT_THAT(bestOf(row), ElementsAre(0, 1));
}

TEST(Page, NoneIsBestWhereAllAreAlikeOrOnlyOneHasAValue) {
  EXPECT_THAT(bestOf({"", "", Better::Lower, {1.0, 1.0}, {"1", "1"}}), IsEmpty());
  EXPECT_THAT(bestOf({"", "", Better::Lower, {1.0, std::nullopt}, {"1", "–"}}), IsEmpty());
}

TEST(Page, ATableMarksTheBestAndSaysWhichWayIsBetter) {
  const std::string html =
      numberTable({"a", "b"}, {{"Cost", {{"Time", "all steps", Better::Lower, {1.0, 2.0}, {"1 s", "2 s"}}}}});
  EXPECT_THAT(html, HasSubstr("<td class=\"best\">1 s</td><td>2 s</td>"));
  EXPECT_THAT(html, HasSubstr("title=\"lower is better\">↓"));
  EXPECT_THAT(html, HasSubstr("<small>all steps</small>"));
}

TEST(Page, PicturesAreInThePage) {
  const std::string html = pictureGrid({"a", "b"}, {{"A view", {"foo", ""}, ""}});
  EXPECT_THAT(html, HasSubstr("src=\"data:image/png;base64,Zm9v\""));
  EXPECT_THAT(html, HasSubstr("alt=\"a: A view\""));
  EXPECT_THAT(html, HasSubstr("does not apply"));
}

TEST(Page, TextsAreEscapedAndHtmlIsNot) {
  const std::string html =
      formatPage({"<scan>", "a & b", {{"s", "1 < 2", "\"x\"", "<b>bold</b>"}}, "<i>end</i>"});
  for (const char* part : {"<title>&lt;scan&gt;</title>", "a &amp; b", "<h2>1 &lt; 2</h2>", "&quot;x&quot;",
                           "<b>bold</b>", "<i>end</i>", "<a href=\"#s\">1 &lt; 2</a>"})
    EXPECT_THAT(html, HasSubstr(part));
}

TEST(Page, NamesNoOtherFile) {
  const std::string html = formatPage({"t", "", {}, ""});
  for (const char* part : {"http:", "https:", "url(", "@import", "src=\"/"})
    EXPECT_THAT(html, Not(HasSubstr(part)));
}

}  // namespace
}  // namespace vdbfuse
