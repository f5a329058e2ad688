// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/stereo/stereo.h"

#include <gtest/gtest.h>
