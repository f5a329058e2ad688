// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/viewer.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "report/assets.h"
#include "vdbfuse/report/color_map.h"
#include "vdbfuse/report/html.h"

namespace vdbfuse {
namespace {

using Json = nlohmann::ordered_json;

// glTF's axes: +z of the world becomes +y.
Json turned(const Eigen::Vector3d& v) { return {v.x(), v.z(), -v.y()}; }

// three.js gives attributes of one's own lower case.
std::string lower(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

Json ramp() {
  constexpr int kColors = 64;
  Json colors = Json::array();
  for (int k = 0; k < kColors; ++k) colors.push_back(sequentialColor(k / (kColors - 1.0)));
  return colors;
}

Json coloringsJson(const std::vector<ViewerColoring>& colorings) {
  Json list = Json::array();
  for (const ViewerColoring& c : colorings)
    list.push_back({{"label", c.label},
                    {"attribute", lower(c.attribute)},
                    {"high", c.high},
                    {"orangeBelow", c.orange_below},
                    {"lowWords", c.low_words},
                    {"highWords", c.high_words}});
  return list;
}

std::string pane(const ViewerMesh& mesh, std::size_t index) {
  const std::string number = std::to_string(index);
  return "<div class=\"pane\"><strong>" + escapeHtml(mesh.name) + "</strong><small>" +
         escapeHtml(mesh.words) + "</small><a id=\"glb-link-" + number + "\" download=\"" +
         escapeHtml(mesh.name) + ".glb\">glb</a></div>\n";
}

std::string meshElement(const ViewerMesh& mesh, std::size_t index) {
  return "<script type=\"text/plain\" id=\"glb-" + std::to_string(index) + "\">" + base64(mesh.glb) +
         "</script>\n";
}

}  // namespace

ViewerScript viewerScriptState() {
  return threeScript().empty() ? ViewerScript::Missing : ViewerScript::Included;
}

std::string viewerLicence() {
  return threeScript().empty() ? std::string() : std::string(threeLicenceText());
}

std::string viewerHtml(const std::vector<ViewerMesh>& meshes, const std::vector<ViewerColoring>& colorings,
                       const ViewerCamera& camera) {
  if (viewerScriptState() == ViewerScript::Missing)
    return "<p class=\"notice\">This vdbfuse was built without three.js (Debian: libjs-three), so there is "
           "no "
           "interactive viewer. The meshes lie beside this page.</p>\n";
  const Json data = {{"count", meshes.size()},
                     {"eye", turned(camera.eye)},
                     {"target", turned(camera.target)},
                     {"up", turned(camera.up)},
                     {"ramp", ramp()},
                     {"colorings", coloringsJson(colorings)}};
  std::string html =
      "<div id=\"viewer-buttons\" class=\"buttons\"></div>\n<div id=\"viewer-stage\" class=\"panes\"" +
      std::string(" style=\"--columns:") + std::to_string(meshes.size()) + "\">\n<canvas></canvas>\n";
  for (std::size_t i = 0; i < meshes.size(); ++i) html += pane(meshes[i], i);
  html += "</div>\n<p id=\"viewer-key\" class=\"key\"></p>\n";
  html += "<noscript><p class=\"notice\">The viewer needs JavaScript.</p></noscript>\n";
  for (std::size_t i = 0; i < meshes.size(); ++i) html += meshElement(meshes[i], i);
  html += "<script type=\"application/json\" id=\"viewer-data\">" + jsonInScript(data.dump()) + "</script>\n";
  html += "<script>\n/*\n" + std::string(threeLicenceText()) + "*/\n" + std::string(threeScript()) +
          "</script>\n<script>\n" + std::string(viewerScript()) + "</script>\n";
  return html;
}

}  // namespace vdbfuse
