// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace vdbfuse {

/// Memory that this process may still take without others being driven out, bytes: what the system has
/// available, and no more than the limit of the process's control group leaves. The largest number there is
/// where the system does not tell.
std::size_t availableMemoryBytes();

/// Largest resident memory of this process so far, bytes; 0 where the system does not tell.
std::size_t peakMemoryBytes();

enum class PeakMemory { Restarted, SinceTheStart };

/// Gives memory that was freed back to the system and lets peakMemoryBytes() count from what is in use now.
/// SinceTheStart where the system does not let a process do so: the peak is then that of all its life.
PeakMemory restartPeakMemory();

/// "512 MiB", "7.5 GiB".
std::string sizeText(std::size_t bytes);

}  // namespace vdbfuse
