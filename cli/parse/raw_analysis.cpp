#include "cli/parse/raw_analysis.h"

#include <algorithm>
#include <array>

namespace imunoise::cli {

std::optional<std::filesystem::path> output_from(const std::string& option, const std::string& text,
                                                 const RawAnalysis& raw) {
  if (text.empty()) return std::nullopt;
  const std::filesystem::path wanted(text);
  static constexpr std::array kOtherPictures{".png", ".jpg", ".jpeg", ".pdf", ".eps", ".gif"};
  if (std::find(kOtherPictures.begin(), kOtherPictures.end(), wanted.extension()) !=
      kOtherPictures.end())
    refuse(option, text + ": it writes no " + wanted.extension().string().substr(1) +
                       "; browsers and Inkscape turn SVG and HTML into other formats");
  for (const std::string& file : raw.input.files) {
    std::error_code unknown;  // of what is not there yet
    if (std::filesystem::equivalent(file, text, unknown))
      refuse(option, text + " is one of the recordings");
  }
  return text;
}

Weighting weighting_from(const std::string& text) {
  return text == "diag" ? Weighting::kDiagonal : Weighting::kFull;
}

std::optional<std::string> model_from(const RawAnalysis& raw) {
  if (raw.model_option->count() == 0) return std::nullopt;
  return raw.model;
}

ShowArguments show_from(const RawAnalysis& raw) {
  return {raw.json, output_from("--report", raw.report, raw)};
}

void add_json(CLI::App& command, RawAnalysis& raw) {
  command.add_flag("--json", raw.json, "Print the result as JSON");
}

void add_report(CLI::App& command, RawAnalysis& raw) {
  command.add_option("--report", raw.report, "HTML report to write, one self-contained page")
      ->type_name("OUT.html");
}

void add_model(CLI::App& command, RawAnalysis& raw, std::string_view unless_given) {
  raw.model_option = command
                         .add_option("--model", raw.model,
                                     "Noise processes and effects, as in \"WN + RW + line(f=5)\"; "
                                     "docs/models.md lists them")
                         ->type_name("MODEL")
                         ->default_str(std::string(unless_given));
}

void add_weights(CLI::App& command, RawAnalysis& raw) {
  command
      .add_option(
          "--weights", raw.weights,
          "Weights of the fit: exact covariance of the wavelet variances (full), or only its "
          "diagonal as in the R packages (diag)")
      ->check(CLI::IsMember({"full", "diag"}))
      ->capture_default_str();
}

void add_confidence(CLI::App& command, RawAnalysis& raw) {
  command.add_option("--confidence", raw.confidence, "Confidence level of the intervals")
      ->type_name("LEVEL")
      ->check(CLI::Range(0.5, 0.9999))
      ->capture_default_str();
}

}  // namespace imunoise::cli
