#include "study/report/html/page_frame.h"

#include <fmt/format.h>

#include "study/figure/assets.h"
#include "study/figure/svg.h"
#include "study/report/html/assets.h"
#include "study/words/text.h"

namespace imunoise::report {

std::string page_frame(std::string_view title, std::string_view brand, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      R"(<meta name="viewport" content="width=device-width, )"
      "initial-scale=1\">\n<title>{}</title>\n"
      "<style>\n{}{}{}</style>\n</head>\n<body>\n<h1 class=\"brand\">imunoise: {}</h1>\n{}"
      "<script>\n{}</script>\n</body>\n</html>\n",
      escape_markup(title), figure::kPaletteCss, figure::kPlotCss, kPageCss, escape_markup(brand),
      body, kPageJs);
}

std::string with_footer(std::string page, std::string_view text) {
  constexpr std::string_view kEnd = "<script>\n";
  const std::size_t at = page.rfind(kEnd);
  const std::string footer = "<footer>" + escape_markup(text) + "</footer>\n";
  return page.insert(at == std::string::npos ? page.size() : at, footer);
}

std::string two_widths(const figure::Figure& figure) {
  constexpr double kDesk = 920.0;   // px
  constexpr double kPhone = 388.0;  // px
  const auto one = [&](double width, const char* kind) {
    return svg(figure, {figure::SvgVariant::kInline, width, 0.0, kind});
  };
  return one(kDesk, "wide") + one(kPhone, "narrow");
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
