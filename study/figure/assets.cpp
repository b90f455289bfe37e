#include "study/figure/assets.h"

#include <cassert>

namespace imunoise::figure {
namespace {

// The value of a variable in the first block of the palette, which is the light one.
std::string_view light_colour(std::string_view variable) {
  const auto at = kPaletteCss.find(std::string(variable) + ":");
  assert(at != std::string_view::npos);
  const auto from = kPaletteCss.find_first_not_of(' ', at + variable.size() + 1);
  return kPaletteCss.substr(from, kPaletteCss.find(';', from) - from);
}

}  // namespace

std::string plot_style_for_paper() {
  constexpr std::string_view var_open = "var(";
  std::string out;
  std::string_view rest = kPlotCss;
  for (auto at = rest.find(var_open); at != std::string_view::npos; at = rest.find(var_open)) {
    const auto end = rest.find(')', at);
    out += rest.substr(0, at);
    out += light_colour(rest.substr(at + var_open.size(), end - at - var_open.size()));
    rest.remove_prefix(end + 1);
  }
  return out.append(rest);
}

}  // namespace imunoise::figure
