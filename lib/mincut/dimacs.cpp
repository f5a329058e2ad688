// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/dimacs.h"

#include <algorithm>
#include <charconv>
#include <istream>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr std::int64_t kLargestCapacity = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t kLargestNode = std::numeric_limits<std::int32_t>::max();

/// The words of one line, with errors that name it.
class Line {
 public:
  Line(const std::filesystem::path& path, std::size_t number, std::string_view text)
      : path_(path), number_(number), rest_(text) {}

  [[noreturn]] void refuse(const std::string& expected, std::string_view found) const {
    const std::string shown = found.empty() ? "the end of the line" : "'" + std::string(found) + "'";
    throw IoError(path_, "line " + std::to_string(number_), expected, shown);
  }
  std::string_view word() {
    const std::size_t begin = std::min(rest_.find_first_not_of(" \t\r"), rest_.size());
    const std::size_t end = std::min(rest_.find_first_of(" \t\r", begin), rest_.size());
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }
  std::int64_t number(const std::string& what, std::int64_t least, std::int64_t most) {
    const std::string_view text = word();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most)
      refuse(what + " from " + std::to_string(least) + " to " + std::to_string(most), text);
    return value;
  }
  void finish() {
    if (const std::string_view more = word(); !more.empty()) refuse("the end of the line", more);
  }

 private:
  const std::filesystem::path& path_;
  std::size_t number_;
  std::string_view rest_;
};

class Reader {
 public:
  Reader(std::istream& input, const std::filesystem::path& path) : input_(input), path_(path) {}

  MaxFlowProblem run() {
    std::string text;
    while (std::getline(input_, text)) {
      Line line(path_, ++number_, text);
      const std::string_view kind = line.word();
      if (kind.empty() || kind == "c") continue;
      if (kind == "p")
        readProblem(line);
      else if (kind == "n")
        readTerminal(line);
      else if (kind == "a")
        readArc(line);
      else
        line.refuse("a line of kind c, p, n or a", kind);
      line.finish();
    }
    if (!nodes_) refuseEnd("a problem line 'p max NODES ARCS'", "none");
    if (arcs_read_ != arcs_)
      refuseEnd(std::to_string(arcs_) + " arcs, as the problem line says", std::to_string(arcs_read_));
    return finish();
  }

 private:
  [[noreturn]] void refuseEnd(const std::string& expected, const std::string& found) const {
    throw IoError(path_, "line " + std::to_string(number_), expected, found);
  }

  void readProblem(Line& line) {
    if (nodes_) line.refuse("one problem line", "p");
    if (const std::string_view kind = line.word(); kind != "max") line.refuse("the problem kind 'max'", kind);
    nodes_ = line.number("number of nodes", 2, kLargestNode);
    arcs_ = line.number("number of arcs", 0, 2 * kLargestNode);
  }

  void readTerminal(Line& line) {
    if (!nodes_) line.refuse("a problem line before this", "n");
    const std::int64_t node = line.number("node", 1, *nodes_);
    const std::string_view kind = line.word();
    if (kind != "s" && kind != "t") line.refuse("s or t", kind);
    std::optional<std::int64_t>& terminal = kind == "s" ? source_ : sink_;
    if (terminal || source_ == node || sink_ == node) line.refuse("one source and one sink", kind);
    terminal = node;
    if (source_ && sink_) {
      supply_.assign(static_cast<std::size_t>(*nodes_), 0);
      demand_.assign(static_cast<std::size_t>(*nodes_), 0);
    }
  }

  void readArc(Line& line) {
    if (!source_ || !sink_) line.refuse("the source and the sink before the first arc", "a");
    if (++arcs_read_ > arcs_) line.refuse("no more than " + std::to_string(arcs_) + " arcs", "a");
    const std::int64_t from = line.number("node", 1, *nodes_), to = line.number("node", 1, *nodes_);
    const bool at_terminal = from == *source_ || to == *sink_;
    const std::int64_t capacity =
        line.number("capacity", 0, at_terminal ? kLargestTerminal : kLargestCapacity);
    if (to == *source_ || from == *sink_ || from == to) return;  // carries nothing
    if (from == *source_ && to == *sink_)
      problem_.constant += capacity;
    else if (from == *source_)
      supply_[static_cast<std::size_t>(to - 1)] += capacity;
    else if (to == *sink_)
      demand_[static_cast<std::size_t>(from - 1)] += capacity;
    else
      addEdge(static_cast<std::uint32_t>(from - 1), static_cast<std::uint32_t>(to - 1),
              static_cast<std::int32_t>(capacity));
  }

  /// Nodes by their numbers in the file less one; finish() leaves source and sink out.
  void addEdge(std::uint32_t from, std::uint32_t to, std::int32_t capacity) {
    if (!problem_.edges.empty() && last_is_open_) {
      NetworkEdge& last = problem_.edges.back();
      last_is_open_ = !(last.from == to && last.to == from);
      if (!last_is_open_) {
        last.reverse_capacity = capacity;
        return;
      }
    }
    problem_.edges.push_back({from, to, capacity, 0});
    last_is_open_ = true;
  }

  MaxFlowProblem finish() {
    if (!source_ || !sink_) refuseEnd("a source and a sink ('n NODE s', 'n NODE t')", "fewer");
    const auto without = [&](std::uint32_t node) {
      return node - (node > *source_ - 1 ? 1 : 0) - (node > *sink_ - 1 ? 1 : 0);
    };
    for (NetworkEdge& edge : problem_.edges) edge.from = without(edge.from), edge.to = without(edge.to);
    for (std::size_t node = 0; node < supply_.size(); ++node) {
      const auto number = static_cast<std::int64_t>(node) + 1;
      if (number == *source_ || number == *sink_) continue;
      problem_.constant += std::min(supply_[node], demand_[node]);
      problem_.terminals.push_back(supply_[node] - demand_[node]);
    }
    return std::move(problem_);
  }

  std::istream& input_;
  const std::filesystem::path& path_;
  std::size_t number_ = 0;
  std::optional<std::int64_t> nodes_, source_, sink_;
  std::int64_t arcs_ = 0, arcs_read_ = 0;
  std::vector<std::int64_t> supply_, demand_;
  bool last_is_open_ = false;  ///< the last edge has had no reverse
  MaxFlowProblem problem_;
};

}  // namespace

MaxFlowProblem readDimacs(std::istream& input, const std::filesystem::path& path) {
  return Reader(input, path).run();
}

void writeDimacs(const MaxFlowProblem& problem, std::ostream& output) {
  const std::size_t nodes = problem.terminals.size(), source = nodes + 1, sink = nodes + 2;
  const auto terminals =
      nodes - static_cast<std::size_t>(std::ranges::count(problem.terminals, std::int64_t{0}));
  const std::size_t arcs = 2 * problem.edges.size() + terminals + (problem.constant > 0 ? 1 : 0);
  output << "c nodes 1 to " << nodes << ", then source and sink\n"
         << "p max " << nodes + 2 << ' ' << arcs << "\nn " << source << " s\nn " << sink << " t\n";
  if (problem.constant > 0) output << "a " << source << ' ' << sink << ' ' << problem.constant << '\n';
  for (std::size_t node = 0; node < nodes; ++node) {
    const std::int64_t terminal = problem.terminals[node];
    if (terminal > 0) output << "a " << source << ' ' << node + 1 << ' ' << terminal << '\n';
    if (terminal < 0) output << "a " << node + 1 << ' ' << sink << ' ' << -terminal << '\n';
  }
  for (const NetworkEdge& edge : problem.edges) {
    output << "a " << edge.from + 1 << ' ' << edge.to + 1 << ' ' << edge.capacity << '\n';
    output << "a " << edge.to + 1 << ' ' << edge.from + 1 << ' ' << edge.reverse_capacity << '\n';
  }
}

}  // namespace vdbfuse
