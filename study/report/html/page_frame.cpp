#include "study/report/html/page_frame.h"

#include <fmt/format.h>

#include "study/report/assets.h"
#include "study/words/text.h"

namespace imunoise::report {

std::string page_frame(std::string_view title, std::string_view brand, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      R"(<meta name="viewport" content="width=device-width, )"
      "initial-scale=1\">\n<title>{}</title>\n"
      "<style>\n{}{}{}</style>\n</head>\n<body>\n<h1 class=\"brand\">imunoise: {}</h1>\n{}"
      "<script>\n{}</script>\n</body>\n</html>\n",
      escape_markup(title), kPaletteCss, kPlotCss, kPageCss, escape_markup(brand), body, kPageJs);
}

std::string markup_cell(std::string_view css_class, std::string_view markup) {
  return fmt::format(R"(<td class="{}">{}</td>)", css_class, markup);
}

std::string cell(std::string_view css_class, std::string_view text) {
  return markup_cell(css_class, escape_markup(text));
}

std::string table_head(const std::vector<std::string>& titles) {
  std::string out = "<thead><tr>";
  for (const std::string& title : titles) {
    out += fmt::format(R"(<th scope="col">{}</th>)", escape_markup(title));
  }
  return out + "</tr></thead>\n";
}

}  // namespace imunoise::report
