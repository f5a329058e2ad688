// SPDX-License-Identifier: Apache-2.0
// conventions_benchmark DATASET...: reads each data set under each of many wrong conventions, and prints what
// checkConvention() says: how often it warns of a right set, and how often it names what would undo a wrong
// one.
#include <cstdio>
#include <string>
#include <vector>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/fusion/conventions.h"

namespace {

using vdbfuse::Convention;

struct Mistake {
  const char* made;
  const char* undone_by;
};

constexpr Mistake kMistakes[] = {{"inverse", "inverse"},
                                 {"transposed", "transposed"},
                                 {"inverse-transposed", "inverse-transposed"},
                                 {"scalar-first", "scalar-last"},
                                 {"scalar-last", "scalar-first"},
                                 {"inverse-scalar-first", "inverse-scalar-last"},
                                 {"inverse-scalar-last", "inverse-scalar-first"},
                                 {"opengl", "opengl"},
                                 {"depth*1000", "depth*0.001"},
                                 {"depth*0.001", "depth*1000"},
                                 {"depth*5", "depth*0.2"},
                                 {"depth*0.2", "depth*5"},
                                 {"range", ""}};

std::string found(const vdbfuse::ConventionCheck& check) {
  if (!check.agreement) return "cannot tell";
  char text[160];
  std::snprintf(text, sizeof text, "%.3f", *check.agreement);
  if (!check.better) return text;
  std::snprintf(text, sizeof text, "%.3f, %s would %.3f", *check.agreement,
                vdbfuse::nameOf(check.better->convention).c_str(), check.better->agreement);
  return text;
}

void measure(const std::string& path, int& false_alarms, int& undone, int& mistakes) {
  const vdbfuse::DepthSet set = vdbfuse::readDepthSet(path);
  const auto right = vdbfuse::checkConvention(set.views, set.stored_from_camera);
  false_alarms += right.better ? 1 : 0;
  std::printf("%s\n  %-22s %s%s\n", path.c_str(), "as read", found(right).c_str(),
              right.better ? "  FALSE ALARM" : "");
  for (const Mistake& mistake : kMistakes) {
    const auto wrong =
        vdbfuse::underConvention(set.views, set.stored_from_camera, *vdbfuse::conventionNamed(mistake.made));
    const auto check = vdbfuse::checkConvention(wrong, set.stored_from_camera);
    const bool is_right = check.better && nameOf(check.better->convention) == mistake.undone_by;
    const bool counts = mistake.undone_by[0] != '\0';
    undone += is_right ? 1 : 0, mistakes += counts ? 1 : 0;
    std::printf("  %-22s %s%s\n", mistake.made, found(check).c_str(), is_right || !counts ? "" : "  MISSED");
  }
}

}  // namespace

int main(int argc, char** argv) {
  int false_alarms = 0, undone = 0, mistakes = 0;
  try {
    for (int i = 1; i < argc; ++i) measure(argv[i], false_alarms, undone, mistakes);
  } catch (const vdbfuse::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  std::printf("%d data sets: %d false alarms, %d of %d mistakes named\n", argc - 1, false_alarms, undone,
              mistakes);
}
