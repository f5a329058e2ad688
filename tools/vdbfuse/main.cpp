// SPDX-License-Identifier: Apache-2.0
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "commands.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/version.h"

namespace {

// Exit codes of the tool, whatever the parser library returns.
constexpr int kDone = 0, kFailed = 1, kWrongUsage = 2, kInterrupted = 130;

int run(const vdbfuse::tool::Action& action) {
  try {
    action();
    return kDone;
  } catch (const vdbfuse::Cancelled&) {
    std::fprintf(stderr, "vdbfuse: interrupted\n");
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "vdbfuse: out of memory; try a larger --voxel\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vdbfuse: %s\n", error.what());
  }
  return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  // Images go back to the system when they are freed. By default the C library would keep their memory for
  // smaller things, a fifth of the peak.
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  CLI::App app("Depth maps, or photographs, to watertight surfaces by probabilistic visibility.", "vdbfuse");
  app.set_version_flag("--version", "vdbfuse " VDBFUSE_VERSION);
  app.require_subcommand(1);
  vdbfuse::tool::Action action;
  vdbfuse::tool::addFormats(app, action);
  vdbfuse::tool::addInfo(app, action);
  vdbfuse::tool::addConvert(app, action);
  vdbfuse::tool::addStereo(app, action);
  vdbfuse::tool::addJudge(app, action);
  vdbfuse::tool::addFuse(app, action);
  vdbfuse::tool::addRender(app, action);
  vdbfuse::tool::addSynth(app, action);
  vdbfuse::tool::addEvaluate(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongUsage;
  }
  return run(action);
}
