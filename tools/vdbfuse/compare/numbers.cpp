// SPDX-License-Identifier: Apache-2.0
// The numbers that vdbfuse compare puts side by side.
#include <cmath>
#include <cstdio>
#include <functional>

#include "compare/page.h"
#include "evaluation_json.h"

namespace vdbfuse::tool {
namespace {

using Value = std::function<std::optional<double>(const MethodRecord&)>;
using Words = std::string (*)(double);

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string seconds(double value) { return formatted("%.1f s", value); }
std::string bytes(double value) { return sizeText(static_cast<std::size_t>(value)); }
std::string percent(double value) { return formatted("%.2f %%", 100 * value); }
std::string share(double value) { return formatted("%.4f", value); }
std::string decimal(double value) { return formatted("%.2f", value); }
std::string length(double value) { return std::isfinite(value) ? formatted("%.3g", value) : "none"; }

// 1234567 as "1 234 567", with narrow spaces.
std::string count(double value) {
  std::string digits = formatted("%.0f", std::abs(value));
  for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), "\u202f");
  return (value < 0 ? "−" : "") + digits;
}

NumberRow row(const CompareRun& run, const char* name, const char* words, Better better, Words text,
              const Value& value) {
  NumberRow made{name, words, better, {}, {}};
  for (const MethodRecord& method : run.methods) {
    made.values.push_back(value(method));
    made.texts.push_back(made.values.back() ? text(*made.values.back()) : "–");
  }
  return made;
}

NumberGroup costs(const CompareRun& run) {
  using R = const MethodRecord&;
  const bool apart = run.methods.front().measured == PeakMemory::Restarted;
  NumberGroup group{
      "Cost",
      {row(run, "Time", "all steps, as if run alone", Better::Lower, seconds, [](R m) { return m.seconds; }),
       row(run, "of that, shared", "reading and judging the views, done once for all methods",
           Better::Neither, seconds, [](R m) { return m.shared_seconds; }),
       row(run, "Peak memory", "of all steps, as if run alone", Better::Lower, bytes,
           [](R m) { return static_cast<double>(m.peak_memory); })}};
  if (apart)
    group.rows.push_back(row(run, "Peak after judging", "while the surface was made, with the judged views",
                             Better::Lower, bytes,
                             [](R m) { return static_cast<double>(m.own_peak_memory); }));
  return group;
}

NumberGroup surface(const CompareRun& run) {
  using R = const MethodRecord&;
  const auto number = [](auto value) { return static_cast<double>(value); };
  return {
      "Surface",
      {row(run, "Triangles", "", Better::Neither, count, [=](R m) { return number(m.topology.triangles); }),
       row(run, "Components", "pieces that do not touch", Better::Lower, count,
           [=](R m) { return number(m.topology.components); }),
       row(run, "Open edges", "0: watertight", Better::Lower, count,
           [=](R m) { return number(m.topology.open_edges); }),
       row(run, "Non-manifold edges", "of more than two triangles", Better::Lower, count,
           [=](R m) { return number(m.topology.nonmanifold_edges); }),
       row(run, "Euler number", "2 a closed component, less 2 a handle", Better::Neither, count,
           [=](R m) { return number(m.topology.euler_number); }),
       row(run, "Invented", "share of the area that no view supports; the TSDF stays open there",
           Better::Neither, percent, [](R m) { return m.invented_share; }),
       row(run, "Support", "mean over the area: agreeing views (TSDF: their weights)", Better::Neither,
           decimal, [](R m) { return m.mean_support; })}};
}

NumberGroup truth(const CompareRun& run) {
  using R = const MethodRecord&;
  NumberGroup group{"Against the reference",
                    {row(run, "Accuracy", "90 % of the surface lies at most so far from the reference",
                         Better::Lower, length, [](R m) { return m.evaluation->accuracy90; }),
                     row(run, "Accuracy, RMS", "root mean square of those distances", Better::Lower, length,
                         [](R m) { return m.evaluation->accuracy_rms; }),
                     row(run, "IoU", "shared volume, of the volume of both together", Better::Higher, share,
                         [](R m) { return m.evaluation->iou; })}};
  const std::vector<double> taus = tausOf(*run.methods.front().evaluation);
  for (std::size_t t = 0; t < taus.size(); ++t) {
    const std::string within = " within " + length(taus[t]);
    const auto add = [&](const std::string& name, const char* words, double ScoreAtTau::*member) {
      group.rows.push_back(row(run, (name + within).c_str(), words, Better::Higher, percent,
                               [=](R m) { return m.evaluation->scores[t].*member; }));
    };
    add("Precision", "of the surface, that near the reference", &ScoreAtTau::precision);
    add("Completeness", "of the reference, that near the surface (recall)", &ScoreAtTau::recall);
    add("F-score", "harmonic mean of the two", &ScoreAtTau::fscore);
  }
  return group;
}

}  // namespace

std::vector<NumberGroup> numbersOf(const CompareRun& run) {
  std::vector<NumberGroup> groups;
  if (run.methods.front().evaluation) groups.push_back(truth(run));
  groups.push_back(surface(run));
  groups.push_back(costs(run));
  return groups;
}

}  // namespace vdbfuse::tool
