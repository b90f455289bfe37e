#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "cli/arguments.h"
#include "cli/parse/input_options.h"
#include "study/analysis/prepare.h"

namespace imunoise::cli {

/// What the commands of analysis have in common, as it was typed.
struct RawAnalysis {
  RawInput input;
  std::string model;
  CLI::Option* model_option = nullptr;
  std::string weights = "full";
  double confidence = 0.95;
  std::string report;
  bool json = false;
};

/// Where something is to be written; refuses what is read.
std::optional<std::filesystem::path> output_from(const std::string& option, const std::string& text,
                                                 const RawAnalysis& raw);
Weighting weighting_from(const std::string& text);
/// What was typed, were it nothing: an empty model is no request for the default.
std::optional<std::string> model_from(const RawAnalysis& raw);
ShowArguments show_from(const RawAnalysis& raw);

void add_json(CLI::App& command, RawAnalysis& raw);
void add_report(CLI::App& command, RawAnalysis& raw);
void add_model(CLI::App& command, RawAnalysis& raw,
               std::string_view unless_given = study::kDefaultModel);
void add_weights(CLI::App& command, RawAnalysis& raw);
void add_confidence(CLI::App& command, RawAnalysis& raw);

}  // namespace imunoise::cli
