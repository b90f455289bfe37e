#include <fmt/format.h>

#include <utility>

#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

// What plain LaTeX with UTF-8 input does not print. Longer texts first.
std::string in_latex(std::string text) {
  constexpr std::pair<std::string_view, std::string_view> kSpellings[] = {
      {"_", "\\_"},
      {"#", "\\#"},
      {"%", "\\%"},
      {"&", "\\&"},
      {"√Hz", "$\\sqrt{\\mathrm{Hz}}$"},
      {"√h", "$\\sqrt{\\mathrm{h}}$"},
      {"°", "$^{\\circ}$"},
      {"²", "$^2$"},
      {"³", "$^3$"},
      {"µ", "$\\mu$"},
      {"σ", "$\\sigma$"},
      {"ζ", "$\\zeta$"},
      {"·", "$\\cdot$"}};
  for (const auto& [from, to] : kSpellings) {
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  }
  return text;
}

std::string latex_number(double value) {
  const std::string text = fmt::format("{:.4g}", value);
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return "$" + text + "$";
  return fmt::format("${}\\times10^{{{}}}$", text.substr(0, e), std::stoi(text.substr(e + 1)));
}

std::string latex_file(const Sheet& sheet) {
  std::string out = commented(sheet, "%") +
                    "\\begin{tabular}{llrrl}\n\\hline\n"
                    "channel & coefficient & value & interval & unit \\\\\n\\hline\n";
  for (const SensorNoise* const sensor : {&sheet.imu.gyro, &sheet.imu.accelerometer}) {
    for (const AxisNoise& axis : sensor->axes) {
      for (const CoefficientRow& row : axis.coefficients) {
        const double factor = row.datasheet_unit.empty() ? 1.0 : row.to_datasheet;
        const std::string interval = row.value.bounded()
                                         ? latex_number(row.value.lower * factor) + " -- " +
                                               latex_number(row.value.upper * factor)
                                         : "";
        out += fmt::format("{} & {}, {} & {} & {} & {} \\\\\n", in_latex(axis.channel),
                           in_latex(row.symbol), in_latex(row.title),
                           latex_number(row.value.value * factor), interval,
                           in_latex(row.datasheet_unit.empty() ? row.unit : row.datasheet_unit));
      }
    }
  }
  return out + "\\hline\n\\end{tabular}\n";
}

}  // namespace

const Consumer& latex() {
  static const Consumer kConsumer{
      .name = "latex",
      .title = "LaTeX",
      .file = "noise.tex",
      .holds = "every coefficient with its interval, in the units of data sheets",
      .holding = Holding::kTerms,
      .axes = AxisRule::kEach,
      .write = latex_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
