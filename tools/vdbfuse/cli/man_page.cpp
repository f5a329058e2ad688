// SPDX-License-Identifier: Apache-2.0
#include "cli/man_page.h"

#include <sstream>

#include "cli/command_tree.h"
#include "cli/one_of.h"
#include "vdbfuse/base/version.h"

namespace vdbfuse::tool {
namespace {

// No letter may be taken for a request, a hyphen of an option must stay one that can be typed, and what is
// not ASCII is named by its number.
std::string roff(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c == '\'') {
      result += "\\(aq";
    } else if (c == '.' && (i == 0 || text[i - 1] == '\n')) {
      result += "\\&.";
    } else if (c < 0x80) {
      result += static_cast<char>(c);
    } else {
      const int more = c >= 0xf0 ? 3 : c >= 0xe0 ? 2 : 1;
      unsigned code = c & (0x3f >> more);
      for (int k = 0; k < more; ++k) code = code << 6 | (static_cast<unsigned char>(text[++i]) & 0x3f);
      char name[16];
      std::snprintf(name, sizeof name, "\\[u%04X]", code);
      result += name;
    }
  }
  return result;
}

std::string paragraphs(const std::string& text) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) result += line.empty() ? ".PP\n" : roff(line) + "\n";
  return result;
}

std::string signature(const ArgumentInfo& a) {
  if (a.is_flag || a.by_place) return ".B " + roff(a.name) + "\n";
  return ".BI " + roff(a.name) + " \" " + roff(signatureOf(a).substr(a.name.size() + 1)) + "\"\n";
}

std::string entry(const ArgumentInfo& a) {
  std::string text = a.text;
  if (!a.choices.empty() && signatureOf(a).find('|') == std::string::npos)
    text += ": " + joined(a.choices, ", ");
  text += ".";
  if (!a.fallback.empty()) text += " Default: " + a.fallback + ".";
  if (a.required && !a.by_place) text += " Required.";
  return ".TP\n" + signature(a) + roff(text) + "\n";
}

std::string examplesOf(const CommandInfo& command) {
  std::string text = ".SH EXAMPLES\n.EX\n";
  for (const std::string& example : command.examples) text += roff(example) + "\n";
  return text + ".EE\n";
}

std::string optionsOf(const CommandInfo& command) {
  std::string text = command.arguments.empty() ? "" : ".SH ARGUMENTS\n";
  for (const ArgumentInfo& argument : command.arguments) text += entry(argument);
  text += ".SH OPTIONS\n";
  for (const std::string& group : groupsOf(command)) {
    text += ".SS " + roff(group) + "\n";
    for (const ArgumentInfo& option : command.options)
      if (option.group == group) text += entry(option);
  }
  text += ".SS Values\n";
  for (const ValueKind& kind : valueKinds())
    if (*kind.meaning != '\0') text += ".TP\n.I " + roff(kind.name) + "\n" + roff(kind.meaning) + ".\n";
  return text;
}

std::string subcommandsOf(const CLI::App& app) {
  std::string text = ".SH COMMANDS\n";
  for (const CommandInfo& command : describeSubcommands(app))
    text += ".TP\n.B " + roff(command.app->get_name()) + "\n" + roff(command.summary) + ".\n";
  return text;
}

// Of the last change of the command line.
constexpr const char* kDate = "2026-11-28";

constexpr const char* kCommon = R"(.SH CONFIGURATION
A file given by
.B \-\-config
is TOML: one section for each command, keys are names of options without dashes, arguments by place have
names, too, flags are true or false, lists are arrays.
What stands before the first section counts for the command that is run.
The command line wins over the file; a key that is not known is an error.
Relative paths start at the working folder, as on the command line.
.B \-\-save\-config
writes such a file.
.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
Failed; standard error says why.
No half file is left, and files that were there stay.
.TP
.B 2
Wrong usage.
.TP
.B 130
Interrupted by Ctrl\-C (143 by SIGTERM, 129 by SIGHUP).
No half file is left.
What cannot stop by itself is ended after a second, or at the second Ctrl\-C.
.SH ENVIRONMENT
.TP
.B TMPDIR
Folder of depth maps that do not fit into memory; otherwise /var/tmp.
.TP
.B VDBFUSE_PROGRESS
.B json
writes progress as lines of JSON to standard error, also where that is no terminal: step, fraction of the step,
seconds since the beginning, and seconds left in all, null as long as that is not known.
)";

std::string seeAlso(const CLI::App& app, const CLI::App& command) {
  std::string names;
  const auto add = [&](const CLI::App& page) {
    if (&page == &command) return;
    names += (names.empty() ? "" : ",\n") + (".BR " + roff(manPageName(page))) + " (1)";
  };
  add(app);
  for (const CommandInfo& other : describeSubcommands(app)) add(*other.app);
  // The comma belongs to the macro's line.
  std::string text;
  std::istringstream lines(names);
  for (std::string line; std::getline(lines, line);) text += line + "\n";
  return ".SH SEE ALSO\n" + text;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::string manPageName(const CLI::App& command) {
  return command.get_parent() == nullptr ? command.get_name()
                                         : command.get_parent()->get_name() + "-" + command.get_name();
}

std::string manPage(const CLI::App& app, const CLI::App& command) {
  const CommandInfo info = describe(command);
  const bool is_tool = &app == &command;
  std::string summary = info.summary;
  summary[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(summary[0])));
  return ".TH " + upper(roff(manPageName(command))) + " 1 " + kDate +
         " \"vdbfuse " VDBFUSE_VERSION "\" \"vdbfuse\"\n.SH NAME\n" + roff(manPageName(command)) + " \\- " +
         roff(summary) + "\n.SH SYNOPSIS\n.B " + roff(info.name) + "\n" +
         (is_tool ? ".I COMMAND\n[OPTIONS]\n" : roff(usageOf(info)) + "\n") + ".SH DESCRIPTION\n" +
         paragraphs(info.summary + "." + (info.details.empty() ? "" : "\n\n" + info.details)) +
         examplesOf(info) + (is_tool ? subcommandsOf(app) : "") + optionsOf(info) + kCommon +
         seeAlso(app, command);
}

}  // namespace vdbfuse::tool
