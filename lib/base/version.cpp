// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/version.h"

namespace vdbfuse {

const char* version() { return VDBFUSE_VERSION; }

}  // namespace vdbfuse
