#include "tests/study/markup_check.h"

#include <regex>

namespace imunoise::report {
namespace {

Element parse_tag(const std::string& tag) {
  Element out;
  out.name = tag.substr(0, tag.find_first_of(" \n/"));
  static const std::regex attribute_pattern("([\\w:-]+)=\"([^\"<]*)\"");
  for (auto it = std::sregex_iterator(tag.begin(), tag.end(), attribute_pattern);
       it != std::sregex_iterator(); ++it) {
    out.attributes[(*it)[1]] = (*it)[2];
  }
  return out;
}

bool entities_are_whole(const std::string& text) {
  static const std::regex entity_pattern("&(amp|lt|gt|quot|#39);");
  return std::regex_replace(text, entity_pattern, "").find('&') == std::string::npos;
}

}  // namespace

Markup read_markup(const std::string& source) {
  Markup out;
  std::vector<std::size_t> open;
  for (std::size_t at = 0; at < source.size();) {
    const auto tag_begin = source.find('<', at);
    const std::string text = source.substr(at, tag_begin - at);
    const bool raw = !open.empty() && (out.elements[open.back()].name == "style" ||
                                       out.elements[open.back()].name == "script");
    if (!raw && !entities_are_whole(text)) out.error = "bare & in: " + text;
    for (const std::size_t element : open) out.elements[element].text += text;
    if (tag_begin == std::string::npos) break;
    // '>' may stand in no attribute: the renderers escape it.
    const auto tag_end = source.find('>', tag_begin);
    const std::string tag = source.substr(tag_begin + 1, tag_end - tag_begin - 1);
    at = tag_end + 1;
    if (raw && tag != "/" + out.elements[open.back()].name) continue;
    if (tag.empty() || tag_end == std::string::npos) out.error = "broken tag";
    if (tag[0] == '!') continue;
    if (tag[0] == '/') {
      if (open.empty() || out.elements[open.back()].name != tag.substr(1)) {
        out.error = "closes what is not open: " + tag;
        return out;
      }
      open.pop_back();
      continue;
    }
    out.elements.push_back(parse_tag(tag));
    if (tag.back() != '/' && out.elements.back().name != "meta")
      open.push_back(out.elements.size() - 1);
  }
  if (!open.empty()) out.error = "not closed: " + out.elements[open.back()].name;
  return out;
}

}  // namespace imunoise::report
