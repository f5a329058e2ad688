// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/page.h"

#include <algorithm>

#include "report/assets.h"
#include "vdbfuse/report/color_map.h"
#include "vdbfuse/report/html.h"

namespace vdbfuse {
namespace {

// Also an attribute that says where an error came from, for who looks into the page by machine.
constexpr const char* kCountErrors =
    "<script>addEventListener('error',e=>{const d=document.documentElement.dataset;"
    "d.errors=(d.errors||'')+e.message+';'})</script>\n";

std::string element(const char* name, const std::string& text) {
  return "<" + std::string(name) + ">" + escapeHtml(text) + "</" + name + ">";
}

std::string paragraph(const std::string& text) { return text.empty() ? "" : element("p", text) + "\n"; }

const char* arrowOf(Better better) {
  if (better == Better::Neither) return "";
  return better == Better::Lower ? " <span class=\"better\" title=\"lower is better\">↓</span>"
                                 : " <span class=\"better\" title=\"higher is better\">↑</span>";
}

std::string tableRow(const NumberRow& row) {
  const std::vector<std::size_t> best = bestOf(row);
  std::string html = "<tr><th scope=\"row\">" + escapeHtml(row.name) + arrowOf(row.better);
  if (!row.words.empty()) html += "<small>" + escapeHtml(row.words) + "</small>";
  html += "</th>";
  for (std::size_t i = 0; i < row.texts.size(); ++i) {
    const bool is_best = std::find(best.begin(), best.end(), i) != best.end();
    html += (is_best ? "<td class=\"best\">" : "<td>") + escapeHtml(row.texts[i]) + "</td>";
  }
  return html + "</tr>\n";
}

std::string cssColor(const Rgb8& color) {
  return "rgb(" + std::to_string(color[0]) + "," + std::to_string(color[1]) + "," + std::to_string(color[2]) +
         ")";
}

std::string columnStyle(std::size_t columns) {
  return " style=\"--columns:" + std::to_string(columns) + "\"";
}

std::string contents(const std::vector<Section>& sections) {
  std::string html = "<nav>";
  for (const Section& section : sections)
    html += "<a href=\"#" + escapeHtml(section.id) + "\">" + escapeHtml(section.title) + "</a>";
  return html + "</nav>\n";
}

}  // namespace

std::vector<std::size_t> bestOf(const NumberRow& row) {
  std::vector<std::size_t> with_value, best;
  for (std::size_t i = 0; i < row.values.size(); ++i)
    if (row.values[i]) with_value.push_back(i);
  if (row.better == Better::Neither || with_value.size() < 2) return {};
  const auto first =
      *std::min_element(with_value.begin(), with_value.end(), [&](std::size_t a, std::size_t b) {
        return row.better == Better::Lower ? *row.values[a] < *row.values[b]
                                           : *row.values[a] > *row.values[b];
      });
  for (const std::size_t i : with_value)
    if (row.texts[i] == row.texts[first]) best.push_back(i);
  if (best.size() == with_value.size()) best.clear();
  return best;
}

std::string numberTable(const std::vector<std::string>& columns, const std::vector<NumberGroup>& groups) {
  std::string html = "<div class=\"scroll\"><table>\n<thead><tr><td></td>";
  for (const std::string& column : columns) html += "<th scope=\"col\">" + escapeHtml(column) + "</th>";
  html += "</tr></thead>\n";
  for (const NumberGroup& group : groups) {
    html += "<tbody>\n<tr class=\"group\"><th scope=\"rowgroup\" colspan=\"" +
            std::to_string(columns.size() + 1) + "\">" + escapeHtml(group.title) + "</th></tr>\n";
    for (const NumberRow& row : group.rows) html += tableRow(row);
    html += "</tbody>\n";
  }
  return html + "</table></div>\n";
}

std::string pictureGrid(const std::vector<std::string>& columns, const std::vector<PictureRow>& rows) {
  std::string html = "<div class=\"pictures\"" + columnStyle(columns.size()) + ">\n";
  for (const PictureRow& row : rows) {
    html += "<figure><div class=\"row\">\n";
    for (std::size_t i = 0; i < columns.size(); ++i) {
      html += "<div class=\"cell\"><span>" + escapeHtml(columns[i]) + "</span>";
      html += row.pngs[i].empty()
                  ? "<div class=\"none\">does not apply</div>"
                  : "<img loading=\"lazy\" alt=\"" + escapeHtml(columns[i] + ": " + row.caption) +
                        "\" src=\"" + dataUri("image/png", row.pngs[i]) + "\">";
      html += "</div>\n";
    }
    html += "</div><figcaption>" + escapeHtml(row.caption) + row.key_html + "</figcaption></figure>\n";
  }
  return html + "</div>\n";
}

std::string colorBar(const std::string& low, const std::string& high) {
  constexpr int kStops = 9;
  std::string gradient;
  for (int k = 0; k < kStops; ++k) gradient += "," + cssColor(sequentialColor(k / (kStops - 1.0)));
  return "<span class=\"key\">" + escapeHtml(low) +
         " <i class=\"bar\" style=\"background:linear-gradient(90deg" + gradient + ")\"></i> " +
         escapeHtml(high) + "</span>";
}

std::string colorKey(const std::vector<KeyColor>& colors) {
  std::string html = "<span class=\"key\">";
  for (const KeyColor& each : colors)
    html += "<i class=\"spot\" style=\"background:" + escapeHtml(each.color) + "\"></i> " +
            escapeHtml(each.words) + " ";
  return html + "</span>";
}

std::string formatPage(const Page& page) {
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += "<link rel=\"icon\" href=\"data:,\">\n";  // none: not asked for
  html += element("title", page.title) + "\n<style>\n" + std::string(pageStyle()) + "</style>\n";
  html += kCountErrors;
  html += "</head>\n<body>\n<header>\n" + element("h1", page.title) + "\n" + paragraph(page.words) +
          contents(page.sections) + "</header>\n<main>\n";
  for (const Section& section : page.sections) {
    html += "<section id=\"" + escapeHtml(section.id) + "\">\n" + element("h2", section.title) + "\n" +
            paragraph(section.words) + section.html + "</section>\n";
  }
  return html + "</main>\n<footer>\n" + page.footer_html + "</footer>\n</body>\n</html>\n";
}

}  // namespace vdbfuse
