#include "study/analysis/vocabulary.h"

#include <fmt/format.h>

namespace imunoise::study {

std::string_view quantity_name(Quantity quantity) {
  switch (quantity) {
    case Quantity::kAngularRate:
      return "angular rate";
    case Quantity::kAcceleration:
      return "acceleration";
    case Quantity::kMagneticFluxDensity:
      return "magnetic flux density";
    case Quantity::kTemperature:
      return "temperature";
    case Quantity::kVoltage:
      return "voltage";
    case Quantity::kUnknown:
      break;
  }
  return "";
}

std::string unit_of(Dimension dimension, Quantity quantity) {
  switch (dimension) {
    case Dimension::kPower:
      return quantity == Quantity::kUnknown ? "unit²" : fmt::format("({})²", si_symbol(quantity));
    case Dimension::kSeconds:
      return "s";
    case Dimension::kPurePerSample:
      break;
  }
  return "1";
}

std::string label_of(const Model& model, std::size_t term) {
  const auto same = [&](std::size_t other) {
    return model.terms[other].process.index() == model.terms[term].process.index();
  };
  std::size_t number = 0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    if (same(t)) ++count;
    if (t == term) number = count;
  }
  const std::string name(info(model.terms[term].process).name);
  return count > 1 ? fmt::format("{} ({})", name, number) : name;
}

std::string moments_estimator(std::size_t replicates) { return replicates > 1 ? "MuGMWM" : "GMWM"; }
std::string likelihood_estimator(const std::string& moments) { return moments + " + Whittle"; }

std::string chance_words(double p) {
  return p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.2g}", p);
}

}  // namespace imunoise::study
