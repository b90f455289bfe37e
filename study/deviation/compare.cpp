#include "study/deviation/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/deviation/deviations.h"

namespace imunoise::study {
namespace {

double allan_of(const Model& model, double m) {
  return std::sqrt(2.0 * variance(model, Eigen::ArrayXd::Constant(1, m))(0));
}

// The averaging time of a measurement at which a term has most of the printed model.
struct Best {
  const v1::DeviationPoint* point = nullptr;
  double share = 0.0;  // of the variance
};

// Of a random walk, which shows behind the minimum of the curve.
Best best_point(const Model& model, std::size_t term, const v1::DeviationReport& measured) {
  const Model alone{{model.terms[term]}};
  Best out;
  for (const v1::DeviationPoint& one : measured.points()) {
    if (one.tau_s() < measured.minimum().tau_s()) continue;
    const auto m = static_cast<double>(one.samples());
    const double share = std::pow(allan_of(alone, m) / allan_of(model, m), 2);
    // Of equal shares the shorter time, which is measured best.
    if (out.point == nullptr || share > out.share * 1.0001) out = {&one, share};
  }
  return out;
}

// A figure is missed where the device lies above all that is printed, at that averaging time:
// other printed noise is no fault of the one that is read there.
void set_verdict(const v1::DeviationPoint& at, const Model& printed, v1::DatasheetFigure& to) {
  const double allowed = allan_of(printed, static_cast<double>(at.samples()));
  to.set_verdict(at.lower() > allowed ? "missed" : "met");
}

// White noise is read where the curve falls as it does: a filter hides it at shorter times, other
// noise at longer ones.
Best white_point(const Model& model, std::size_t term, const v1::DeviationReport& measured) {
  constexpr double kWhiteSlope = -0.5;  // of the logarithm of the deviation
  constexpr double kWorse = 3.0;
  constexpr double kMost = 0.75;
  const Model alone{{model.terms[term]}};
  Best out;
  double least = kMost;
  for (int i = 0; i < measured.points_size(); ++i) {
    const v1::DeviationPoint& left = measured.points(std::max(i - 1, 0));
    const v1::DeviationPoint& right = measured.points(std::min(i + 1, measured.points_size() - 1));
    const auto m = static_cast<double>(measured.points(i).samples());
    const double share = std::pow(allan_of(alone, m) / allan_of(model, m), 2);
    if (!(share > 0.5) || left.samples() == right.samples()) continue;
    const double width = std::log(right.tau_s() / left.tau_s());
    const double slope = std::log(right.deviation() / left.deviation()) / width;
    // As far as the slope is off, so is N: that counts more than the standard error, which its
    // interval shows.
    const double off = kWorse * std::abs(slope - kWhiteSlope) +
                       std::sqrt(0.5 / measured.points(i).degrees_of_freedom());
    if (!(off < least)) continue;
    least = off;
    out = {&measured.points(i), share};
  }
  return out;
}

void measure_term(const Model& model, std::size_t term, const v1::DeviationReport& measured,
                  v1::DatasheetFigure& to) {
  const bool white = std::holds_alternative<WhiteNoise>(model.terms[term].process);
  const Best best = white ? white_point(model, term, measured) : best_point(model, term, measured);
  if (best.point == nullptr || best.share < 0.5) {
    to.set_verdict("not seen");
    return;
  }
  const v1::DeviationPoint& at = *best.point;
  const double per =
      to.value() / allan_of({{model.terms[term]}}, static_cast<double>(at.samples()));
  to.set_measured(at.deviation() * per);
  to.set_lower(at.lower() * per);
  to.set_upper(at.upper() * per);
  to.set_tau_s(at.tau_s());
  set_verdict(at, model, to);
  // A curve that does not surely rise after its minimum shows no walk.
  if (!white && to.verdict() == "missed" && !(at.lower() > measured.minimum().deviation()))
    to.set_verdict("not seen");
}

void measure_floor(const Model& printed, const v1::DeviationReport& measured,
                   v1::DatasheetFigure& to) {
  const auto lowest = std::find_if(
      measured.points().begin(), measured.points().end(),
      [&](const v1::DeviationPoint& one) { return one.tau_s() == measured.minimum().tau_s(); });
  to.set_measured(lowest->deviation() / kFlickerFloor);
  to.set_lower(lowest->lower() / kFlickerFloor);
  to.set_upper(lowest->upper() / kFlickerFloor);
  to.set_tau_s(lowest->tau_s());
  set_verdict(*lowest, printed, to);
  // Longer recordings may show a lower one.
  if (measured.minimum().at_edge() && to.measured() > to.value()) to.set_verdict("not seen");
}

std::string summary_of(const v1::DatasheetReport& report) {
  std::string missed;
  std::string unseen;
  for (const v1::DatasheetFigure& one : report.figures()) {
    if (one.verdict() == "missed")
      missed += fmt::format("{}{} by {:.0f} %", missed.empty() ? "" : ", ", one.symbol(),
                            100.0 * (one.measured() / one.value() - 1.0));
    if (one.verdict() == "not seen") unseen += (unseen.empty() ? "" : ", ") + one.symbol();
  }
  std::string out =
      missed.empty() ? "The device misses no printed figure" : "The device misses " + missed;
  if (!unseen.empty()) out += fmt::format("; record longer to see {}", unseen);
  return out + ".";
}

}  // namespace

v1::DatasheetReport printed_report(const PrintedFigures& printed, Hertz rate) {
  v1::DatasheetReport out;
  const Model model = printed_model(printed, rate);
  out.set_unit(std::string(si_symbol(printed.quantity)));
  out.set_rate_hz(rate.value);
  out.set_model(print_with_values(model));
  for (const PrintedFigure& from : printed.figures) {
    const CoefficientUnits units = coefficient_units(from.coefficient, printed.quantity);
    v1::DatasheetFigure& to = *out.add_figures();
    to.set_symbol(std::string(units.symbol));
    to.set_title(std::string(units.title));
    to.set_printed(from.text);
    to.set_value(from.value);
    to.set_unit(units.si);
    to.set_datasheet_value(from.value * units.to_datasheet);
    to.set_datasheet_unit(units.datasheet);
    to.set_verdict("not measured");
  }
  constexpr double kShortest = 0.01;  // s
  constexpr int kDecades = 7;
  for (int i = 0; i <= 8 * kDecades; ++i) {
    const double m = std::round(kShortest * std::pow(10.0, i / 8.0) * rate.value);
    const bool known =
        out.printed_tau_s_size() > 0 && *out.printed_tau_s().rbegin() * rate.value > m - 0.5;
    if (m < 1.0 || known) continue;
    out.add_printed_tau_s(m / rate.value);
    out.add_printed_deviation(allan_of(model, m));
  }
  return out;
}

Result<v1::DatasheetReport> compare_with_datasheet(const Series& series,
                                                   const PrintedFigures& printed,
                                                   double confidence) {
  auto measured = deviations(series, DeviationKind::kAllan, confidence);
  if (!measured) return tl::unexpected(measured.error());
  const Hertz rate{measured->rate_hz()};
  v1::DatasheetReport out = printed_report(printed, rate);
  out.set_channel(series.channel);
  const Model model = printed_model(printed, rate);
  for (std::size_t i = 0; i < printed.figures.size(); ++i) {
    v1::DatasheetFigure& to = *out.mutable_figures(static_cast<int>(i));
    if (printed.figures[i].coefficient == Coefficient::kBiasInstability)
      measure_floor(model, *measured, to);
    else
      measure_term(model, i, *measured, to);
  }
  *out.mutable_measured() = std::move(*measured);
  out.set_summary(summary_of(out));
  return out;
}

}  // namespace imunoise::study
