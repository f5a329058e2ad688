// SPDX-License-Identifier: Apache-2.0
// Text and files as parts of an HTML page.
#pragma once

#include <string>
#include <string_view>

namespace vdbfuse {

/// Safe as text and as the value of an attribute: & < > " ' become character references.
std::string escapeHtml(std::string_view text);

/// RFC 4648 with padding, in one line.
std::string base64(std::string_view bytes);

/// `bytes` as an address that needs no file: data:MEDIA_TYPE;base64,…
std::string dataUri(std::string_view media_type, std::string_view bytes);

/// JSON as the content of a <script> element: every < becomes \u003c, so that nothing ends the element.
std::string jsonInScript(std::string_view json);

}  // namespace vdbfuse
