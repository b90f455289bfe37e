#include "study/analysis/vocabulary.h"

#include <fmt/format.h>

#include <cmath>

namespace imunoise::study {
namespace {

// N, B, K, R and Q are known by themselves; what describes a correlated noise needs the noise's
// name.
bool stands_alone(Coefficient coefficient) {
  return coefficient == Coefficient::kQuantisation || coefficient == Coefficient::kRandomWalk ||
         coefficient == Coefficient::kBiasInstability ||
         coefficient == Coefficient::kRateRandomWalk || coefficient == Coefficient::kRamp;
}

}  // namespace

Result<void> check_bootstrap(std::size_t sets) {
  const auto fewest = static_cast<std::size_t>(std::lround(1.0 / kLevel)) - 1;
  if (sets == 0 || sets >= fewest) return {};
  return fail(fmt::format(
      "a bootstrap of {} sets cannot reject at 5 %: take at least {}, better 999", sets, fewest));
}

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

v1::Coefficient coefficient_message(Coefficient which, double value, const std::string& label,
                                    Quantity measures) {
  const CoefficientUnits units = coefficient_units(which, measures);
  v1::Coefficient out;
  out.set_symbol(std::string(units.symbol));
  out.set_title(stands_alone(which) ? std::string(units.title)
                                    : fmt::format("{} of {}", units.title, label));
  out.set_value(value);
  out.set_unit(units.si);
  if (units.datasheet.empty()) return out;
  out.set_datasheet_value(value * units.to_datasheet);
  out.set_datasheet_unit(units.datasheet);
  return out;
}

v1::Term term_message(const Model& model, std::size_t term, Quantity measures, Hertz rate,
                      const Eigen::ArrayXd& m) {
  const Process& process = model.terms[term].process;
  v1::Term out;
  out.set_name(std::string(info(process).name));
  out.set_title(std::string(info(process).title));
  out.set_meaning(std::string(info(process).meaning));
  const std::vector<double> known = values(process);
  const std::vector<ParameterInfo> about = parameters(process);
  for (std::size_t p = 0; p < about.size(); ++p) {
    v1::Parameter& parameter = *out.add_parameters();
    parameter.set_name(about[p].name);
    parameter.set_value(known[p]);
    parameter.set_unit(unit_of(about[p].dimension, measures));
    parameter.set_meaning(std::string(about[p].meaning));
  }
  for (const DerivedQuantity& one : derived(process, rate)) {
    *out.add_coefficients() =
        coefficient_message(one.coefficient, one.value, label_of(model, term), measures);
  }
  for (const double value : variance(process, m)) out.add_variance(value);
  return out;
}

std::string moments_estimator(std::size_t replicates) { return replicates > 1 ? "MuGMWM" : "GMWM"; }
std::string likelihood_estimator(const std::string& moments) { return moments + " + Whittle"; }

std::string chance_words(double p) {
  return p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.2g}", p);
}

}  // namespace imunoise::study
