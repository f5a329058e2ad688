// SPDX-License-Identifier: Apache-2.0
// Files that were put into the library when it was built: cmake/embed_files.cmake.
#pragma once

#include <string_view>

namespace vdbfuse {

std::string_view pageStyle();         ///< page/page.css
std::string_view viewerScript();      ///< page/viewer.js
std::string_view threeScript();       ///< three.js with its loader and controls; empty: it was not there
std::string_view threeLicenceText();  ///< page/three_licence.txt

}  // namespace vdbfuse
