// SPDX-License-Identifier: Apache-2.0
#include <new>

#include "capi/handles.h"
#include "vdbfuse/base/version.h"

namespace vdbfuse::capi {
namespace {

thread_local std::string last_error;

vdbfuse_status remember(vdbfuse_status status, const char* words) noexcept {
  try {
    last_error = words;
  } catch (...) {
    last_error.clear();  // no memory for the words either
  }
  return status;
}

}  // namespace

vdbfuse_status statusOfException() noexcept {
  try {
    throw;
  } catch (const InvalidArgument& error) {
    return remember(VDBFUSE_INVALID_ARGUMENT, error.what());
  } catch (const IoError& error) {
    return remember(VDBFUSE_IO_ERROR, error.what());
  } catch (const Cancelled& error) {
    return remember(VDBFUSE_CANCELLED, error.what());
  } catch (const Error& error) {
    return remember(VDBFUSE_FAILED, error.what());
  } catch (const std::bad_alloc&) {
    return remember(VDBFUSE_OUT_OF_MEMORY, "out of memory");
  } catch (const std::exception& error) {
    return remember(VDBFUSE_INTERNAL, error.what());
  } catch (...) {
    return remember(VDBFUSE_INTERNAL, "unknown error");
  }
}

void requireNotNull(const void* pointer, const char* argument) {
  if (pointer == nullptr) throw InvalidArgument(argument, "must not be NULL");
}

void requireStructSize(std::uint64_t size, std::size_t first, std::size_t now, const char* argument) {
  if (size < first || size > now)
    throw InvalidArgument(argument, "struct_size is " + std::to_string(size) + ", expected " +
                                        std::to_string(first) + " to " + std::to_string(now) +
                                        " (was it initialised, by the header of this library?)");
}

}  // namespace vdbfuse::capi

uint32_t vdbfuse_abi_version(void) { return VDBFUSE_ABI_VERSION; }

const char* vdbfuse_version(void) { return vdbfuse::version(); }

const char* vdbfuse_status_name(vdbfuse_status status) {
  switch (status) {
    case VDBFUSE_OK:
      return "ok";
    case VDBFUSE_INVALID_ARGUMENT:
      return "invalid argument";
    case VDBFUSE_IO_ERROR:
      return "input or output error";
    case VDBFUSE_CANCELLED:
      return "cancelled";
    case VDBFUSE_OUT_OF_MEMORY:
      return "out of memory";
    case VDBFUSE_FAILED:
      return "failed";
    case VDBFUSE_INTERNAL:
      return "internal error";
    default:
      return "unknown status";
  }
}

const char* vdbfuse_last_error(void) { return vdbfuse::capi::last_error.c_str(); }
