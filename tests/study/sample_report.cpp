#include "tests/study/sample_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/support/random.h"

namespace imunoise::report {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr double kMicroG = 9.80665e-6;  // m/s²

double white(double m, double sigma2) { return sigma2 / (2.0 * m); }
double quantisation(double m, double q2) { return 6.0 * q2 / (4.0 * m * m); }
double random_walk(double m, double gamma2) { return gamma2 * (4.0 * m * m + 2.0) / (24.0 * m); }
double ar1(double m, double phi, double s2) {
  const double p = std::pow(phi, m);
  return s2 * (m * (1 - phi * phi) - phi * (3.0 - 4.0 * p + p * p)) /
         (2.0 * m * m * (1 - phi) * (1 - phi) * (1 - phi * phi));
}

struct Recipe {
  double rate = 100.0;  // Hz
  double samples = 1e6;
  int per_octave = 1;
  int replicates = 6;
  double bump = 0.0;        // relative excess of the measured variance ..
  double bump_from = 20.0;  // .. from this averaging time, s
  double bump_to = 80.0;    // .. to this, s
};

v1::Parameter* parameter(v1::Term* term, const char* name, double value, double spread,
                         const char* unit, const char* meaning) {
  v1::Parameter* p = term->add_parameters();
  p->set_name(name);
  p->set_value(value);
  p->set_lower(value * (1.0 - spread));
  p->set_upper(value * (1.0 + spread));
  p->set_unit(unit);
  p->set_meaning(meaning);
  p->set_observability(v1::observed);
  return p;
}

void coefficient(v1::Term* term, const char* symbol, const char* title, double value, double spread,
                 const char* unit, double factor, const char* datasheet) {
  v1::Coefficient* c = term->add_coefficients();
  c->set_symbol(symbol);
  c->set_title(title);
  c->set_value(value);
  c->set_lower(value * (1.0 - spread));
  c->set_upper(value * (1.0 + spread));
  c->set_unit(unit);
  c->set_datasheet_unit(datasheet);
  if (*datasheet == '\0') return;
  c->set_datasheet_value(value * factor);
  c->set_datasheet_lower(value * factor * (1.0 - spread));
  c->set_datasheet_upper(value * factor * (1.0 + spread));
}

v1::Term* term(v1::FitReport& report, const char* name, const char* title, const char* meaning) {
  v1::Term* out = report.add_terms();
  out->set_name(name);
  out->set_title(title);
  out->set_meaning(meaning);
  return out;
}

// Half-widths in samples, up to 2^17 at one scale an octave for 1e6 samples.
std::vector<double> half_widths(const Recipe& recipe) {
  const int levels = static_cast<int>(std::floor(std::log2(recipe.samples))) - 1;
  std::vector<double> out;
  for (int i = 0; i <= (levels - 1) * recipe.per_octave; ++i) {
    const double m = std::round(std::pow(2.0, static_cast<double>(i) / recipe.per_octave));
    if (out.empty() || m > out.back()) out.push_back(m);
  }
  return out;
}

// Measured = model times log-normal noise of the spread that 1.1·T/2m degrees of freedom give.
void measure(v1::FitReport& report, const Recipe& recipe) {
  v1::NoiseBudget& budget = *report.mutable_budget();
  const std::vector<double> widths = half_widths(recipe);
  double chi2 = 0.0;
  int tested = 0;
  for (int r = 0; r < recipe.replicates; ++r) {
    report.add_replicates()->set_name("2024-03-1" + std::to_string(r) + "_static_2h47.imu");
    report.mutable_replicates(r)->set_samples(static_cast<std::uint32_t>(recipe.samples));
  }
  for (std::size_t k = 0; k < widths.size(); ++k) {
    const double seconds = 2.0 * widths[k] / recipe.rate;
    double model = 0.0;
    for (const v1::Term& t : report.terms()) model += t.variance(static_cast<int>(k));
    const double edof = std::max(1.0, 1.1 * recipe.samples / (2.0 * widths[k]));
    const double spread = std::sqrt(2.0 / edof);
    const double bump =
        seconds >= recipe.bump_from && seconds <= recipe.bump_to ? 1.0 + recipe.bump : 1.0;
    double pooled = 0.0;
    for (int r = 0; r < recipe.replicates; ++r) {
      RandomStream random(20240311, {static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(k)});
      const double measured =
          model * bump * std::exp(spread * random.normal() - spread * spread / 2);
      v1::ReplicateResidual& replicate = *report.mutable_replicates(r);
      replicate.add_scales_s(seconds);
      replicate.add_measured(measured);
      replicate.add_residual((measured - model) / (model * spread));
      pooled += measured / recipe.replicates;
    }
    const double sd = spread / std::sqrt(recipe.replicates);
    budget.add_scales(2.0 * widths[k]);
    budget.add_scales_s(seconds);
    budget.add_measured(pooled);
    budget.add_lower(pooled * std::exp(-1.96 * sd));
    budget.add_upper(pooled * std::exp(1.96 * sd));
    budget.add_model(model);
    budget.add_residual((pooled - model) / (model * sd));
    budget.add_tested(edof >= 5.0);
    if (edof >= 5.0) {
      chi2 += std::pow((pooled - model) / (model * sd), 2);
      ++tested;
    }
  }
  report.set_degrees_of_freedom(tested - 5);
  report.set_j_statistic(chi2);
}

template <class Variance>
void fill(v1::Term* out, const Recipe& recipe, Variance variance) {
  for (const double m : half_widths(recipe)) out->add_variance(variance(m));
}

v1::FitReport gyro(const Recipe& recipe, bool with_random_walk) {
  v1::FitReport report;
  report.set_channel("gyro_x");
  report.set_unit("rad/s");
  report.set_quantity("angular rate");
  report.set_rate_hz(recipe.rate);
  report.set_model("AR1 + WN + RW + QN");
  report.set_estimator("MuGMWM");
  report.set_weights("full");
  report.set_objective(14.21);
  report.set_termination("converged: the objective changed by less than 1e-12");
  report.set_confidence(0.95);
  report.set_fitted_model(
      "AR1(phi=0.9996, sigma2=8e-12) + WN(sigma2=2.16e-05) + RW(gamma2=3e-14) + QN(q2=4.1e-06)");

  const double phi = 0.9996;
  const double innovations = 8e-12;
  v1::Term* markov = term(report, "AR1", "correlated noise",
                          "A disturbance that forgets itself with a time constant, such as flicker "
                          "seen over a limited band.");
  parameter(markov, "phi", phi, 2.1e-5, "1", "correlation of neighbouring samples");
  parameter(markov, "sigma2", innovations, 0.045, "(rad/s)²", "variance of the innovations");
  coefficient(markov, "σ", "standard deviation", std::sqrt(innovations / (1 - phi * phi)), 0.03,
              "rad/s", kDegreesPerRadian * 3600.0, "°/h");
  fill(markov, recipe, [&](double m) { return ar1(m, phi, innovations); });

  v1::Term* noise =
      term(report, "WN", "angle random walk", "Broadband electronic and thermal noise.");
  parameter(noise, "sigma2", 2.16e-5, 0.0009, "(rad/s)²", "variance of each sample");
  coefficient(noise, "N", "angle random walk", std::sqrt(2.16e-5 / recipe.rate), 0.00045,
              "rad/s/√Hz", kDegreesPerRadian * 60.0, "°/√h");
  fill(noise, recipe, [](double m) { return white(m, 2.16e-5); });

  const double gamma2 = with_random_walk ? 3e-14 : 0.0;
  v1::Term* walk = term(report, "RW", "rate random walk", "A bias that drifts without bound.");
  v1::Parameter* drift =
      parameter(walk, "gamma2", gamma2, 0.31, "(rad/s)²", "variance of the steps");
  coefficient(walk, "K", "rate random walk", std::sqrt(gamma2 * recipe.rate), 0.15, "rad/s²/√Hz",
              kDegreesPerRadian * 3600.0 * 60.0, "(°/h)/√h");
  fill(walk, recipe, [&](double m) { return random_walk(m, gamma2); });
  if (!with_random_walk) {
    drift->set_upper(3.2e-16);
    drift->set_observability(v1::upper_bound_only);
    drift->set_record_longer(5.0);
  }

  v1::Term* steps = term(report, "QN", "quantisation noise", "Rounding of an accumulated angle.");
  parameter(steps, "q2", 4.1e-6, 0.013, "(rad/s)²", "variance of the rounding error")
      ->set_observability(v1::indistinguishable);
  coefficient(steps, "Q", "quantisation noise", std::sqrt(4.1e-6) / recipe.rate, 0.007, "rad",
              kDegreesPerRadian * 3600.0, "arcsec");
  fill(steps, recipe, [](double m) { return quantisation(m, 4.1e-6); });
  measure(report, recipe);
  return report;
}

}  // namespace

v1::FitReport good_gyro() {
  v1::FitReport report = gyro({}, true);
  report.set_p_value(0.37);
  report.set_summary(
      "AR1 + WN + RW + QN explains all six replicates: white noise of 0.16 °/√h rules below 10 s, "
      "a slow "
      "correlated noise from there on.");
  report.add_notes("The last scale has fewer than five degrees of freedom and was not tested.");
  return report;
}

v1::FitReport misfit_gyro() {
  Recipe recipe;
  recipe.bump = 0.38;
  v1::FitReport report = gyro(recipe, true);
  report.set_channel("gyro_z");
  report.set_p_value(2.3e-9);
  report.set_summary("Between 20 and 80 s the gyro is 38 % noisier than the model can explain.");
  report.add_notes("All six replicates show it: look for something that repeats at each power-on.");
  return report;
}

v1::FitReport bounded_gyro() {
  v1::FitReport report = gyro({}, false);
  report.set_channel("gyro_y");
  report.set_p_value(0.023);
  report.set_summary("No random walk can be seen in 2.8 hours.");
  return report;
}

v1::FitReport accelerometer() {
  Recipe recipe;
  recipe.rate = 200.0;
  recipe.samples = 3e5;
  recipe.replicates = 1;
  v1::FitReport report;
  report.set_channel("accel_z");
  report.set_unit("m/s^2");
  report.set_quantity("acceleration");
  report.set_rate_hz(recipe.rate);
  report.set_model("WN + RW");
  report.set_default_model(true);
  report.set_estimator("GMWM");
  report.set_weights("full");
  report.set_confidence(0.95);
  report.set_summary("White noise of 101 µg/√Hz and a slow bias walk explain the recording.");
  v1::Term* noise =
      term(report, "WN", "velocity random walk", "Broadband electronic and thermal noise.");
  parameter(noise, "sigma2", 1.96e-4, 0.004, "(m/s²)²", "variance of each sample");
  coefficient(noise, "N", "velocity random walk", std::sqrt(1.96e-4 / 200.0), 0.002, "m/s²/√Hz",
              1.0 / kMicroG, "µg/√Hz");
  fill(noise, recipe, [](double m) { return white(m, 1.96e-4); });
  v1::Term* walk = term(report, "RW", "bias random walk", "A bias that drifts without bound.");
  parameter(walk, "gamma2", 2.5e-12, 0.5, "(m/s²)²", "variance of the steps");
  fill(walk, recipe, [](double m) { return random_walk(m, 2.5e-12); });
  measure(report, recipe);
  report.set_p_value(0.61);
  return report;
}

v1::FitReport dense_unknown_unit() {
  Recipe recipe;
  recipe.per_octave = 4;
  v1::FitReport report;
  report.set_channel("strain");
  report.set_unit("1");
  report.set_rate_hz(recipe.rate);
  report.set_model("2*AR1 + WN");
  report.set_estimator("AGMWM");
  report.set_weights("diag");
  report.set_confidence(0.95);
  for (const auto& [phi, s2] : {std::pair{0.9, 1e-3}, std::pair{0.9995, 4e-6}}) {
    v1::Term* markov = term(report, "AR1", "correlated noise", "Noise with a memory.");
    parameter(markov, "phi", phi, 0.0004, "1", "correlation of neighbouring samples");
    parameter(markov, "sigma2", s2, 0.2, "unit²", "variance of the innovations");
    coefficient(markov, "σ", "standard deviation", std::sqrt(s2 / (1 - phi * phi)), 0.1, "unit",
                1.0, "");
    fill(markov, recipe, [phi = phi, s2 = s2](double m) { return ar1(m, phi, s2); });
  }
  v1::Term* noise = term(report, "WN", "white noise density", "Broadband noise.");
  parameter(noise, "sigma2", 2.0, 0.001, "unit²", "variance of each sample");
  fill(noise, recipe, [](double m) { return white(m, 2.0); });
  measure(report, recipe);
  report.set_p_value(0.18);
  report.set_summary("Two correlated noises and white noise explain the signal.");
  return report;
}

v1::FitReport hostile_names() {
  v1::FitReport report = misfit_gyro();
  const std::string attack = "</script><script>alert(\"x\")</script>\x1b[31m&'\xff\u202Eevil";
  report.set_channel(attack);
  report.set_summary(attack);
  report.set_model("WN\n" + attack);
  report.set_fitted_model("]]>" + attack);
  report.set_unit("<b>" + attack);
  report.add_notes(attack);
  report.mutable_replicates(0)->set_name(attack);
  report.mutable_terms(0)->set_name("<img src=x onerror=alert(1)>");
  report.mutable_terms(0)->set_title(attack);
  report.mutable_terms(0)->mutable_parameters(0)->set_meaning(attack);
  report.mutable_terms(0)->mutable_coefficients(0)->set_unit(attack);
  return report;
}

v1::FitReport broken_arrays() {
  v1::FitReport report = good_gyro();
  report.set_p_value(std::nan(""));
  report.set_confidence(std::nan(""));
  v1::NoiseBudget& budget = *report.mutable_budget();
  budget.set_measured(3, 0.0);
  budget.set_lower(4, 0.0);
  budget.set_model(5, 0.0);
  budget.set_scales_s(6, 0.0);
  budget.mutable_residual()->Truncate(9);
  budget.mutable_tested()->Truncate(12);
  report.mutable_terms(1)->mutable_variance()->Truncate(2);
  report.mutable_replicates(2)->mutable_measured()->Clear();
  report.mutable_replicates(3)->mutable_residual()->Truncate(1);
  return report;
}

v1::WaveletVarianceReport measured_gyro() {
  const v1::FitReport fit = good_gyro();
  v1::WaveletVarianceReport report;
  report.set_channel(fit.channel());
  report.set_unit(fit.unit());
  report.set_rate_hz(fit.rate_hz());
  report.set_estimator("classical");
  report.set_confidence(0.95);
  *report.mutable_scales() = fit.budget().scales();
  *report.mutable_scales_s() = fit.budget().scales_s();
  *report.mutable_variance() = fit.budget().measured();
  *report.mutable_lower() = fit.budget().lower();
  *report.mutable_upper() = fit.budget().upper();
  return report;
}

}  // namespace imunoise::report
