#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "study/report/documents/array_tables.h"
#include "study/report/documents/inference_documents.h"
#include "study/report/documents/preflight_section.h"
#include "study/report/figures/cross_figure.h"
#include "study/report/figures/virtual_sensor_figures.h"
#include "study/report/view/verdict.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

Table pairs(const v1::ArrayReport& report, Digits digits) {
  Table out{"Which sensors share noise",
            {"sensors", "share noise?", "p", "most at", "correlation", "sigma"},
            {}};
  for (const v1::SensorPair& one : report.pairs()) {
    const double p = one.adjusted_p_value();
    const char* const shared = one.withheld()    ? "not judged"
                               : one.dependent() ? "yes"
                                                 : "not shown";
    out.rows.push_back({one.first() + ", " + one.second(), shared,
                        p < 1e-4 ? "< 0.0001" : number(p, 2, digits),
                        duration(one.strongest_tau_s()), number(one.correlation(), 2, digits),
                        signed_sigma(one.z(), digits)});
  }
  return out;
}

Table sensor_fits(const v1::ArrayReport& report, Digits digits) {
  Table out{
      "Does the model fit each sensor?", {"sensor", "fits?", "p", "χ²", "degrees of freedom"}, {}};
  for (const v1::SensorFit& one : report.sensor_fits()) {
    const double p = one.adjusted_p_value();
    const bool tested = one.degrees_of_freedom() > 0;
    out.rows.push_back({one.sensor(),
                        !tested      ? "not tested"
                        : one.fits() ? "yes"
                                     : "no",
                        !tested ? "–" : p_value(p, digits),
                        !tested ? "–" : number(one.statistic(), 3, digits),
                        std::to_string(one.degrees_of_freedom())});
  }
  return out;
}

void add_verdict(const v1::ArrayReport& report, Section& section) {
  const auto any = [](const auto& all, const auto& is) {
    return std::any_of(all.begin(), all.end(), is);
  };
  const bool misfit = any(report.sensor_fits(), [](const auto& one) { return !one.fits(); });
  const bool shared = any(report.pairs(), [](const auto& one) { return one.dependent(); });
  const bool maybe = report.correlation_found();
  section.badge = shared   ? "shared noise"
                  : misfit ? "the model does not fit"
                  : maybe  ? "shared noise is uncertain"
                           : "no shared noise detected";
  section.mood = shared || misfit || maybe ? Mood::kDoubtful : Mood::kGood;
}

Table weights(const v1::VirtualSensor& sensor, Digits digits) {
  Table out{
      fmt::format("Virtual sensor ({}, for {} averaging times)", sensor.rule(), sensor.scales()),
      {"sensor", "weight", "standard error"},
      {}};
  for (const v1::SensorWeight& one : sensor.weights()) {
    out.rows.push_back({one.sensor(), number(one.weight(), 4, digits),
                        one.has_standard_error() ? number(one.standard_error(), 2, digits) : "–"});
  }
  return out;
}

Table gains(const v1::VirtualSensor& sensor, Digits digits) {
  Table out{sensor.plain_mean()
                ? "Wavelet variance of the best weights, which are not used, relative to the mean "
                  "of the sensors"
                : "Wavelet variance relative to the mean of the sensors",
            {"averaging time", "by the model", "on held-out replicates"},
            {}};
  for (const v1::ScaleGain& one : sensor.scale_gains()) {
    out.rows.push_back({duration(one.tau_s()), number(one.predicted(), 3, digits),
                        one.has_measured() ? number(one.measured(), 3, digits) : "–"});
  }
  return out;
}

}  // namespace

Document document(const v1::ArrayReport& report, Digits digits) {
  Section section;
  section.title = joined(report.sensors());
  add_verdict(report, section);
  section.facts = fmt::format("{} · {:g} Hz · {} · {} · {}", report.model(), report.rate_hz(),
                              counted(report.sensors_size(), "sensor"),
                              counted(report.replicates(), "replicate"), report.termination()) +
                  estimator_fact(report.estimator());
  section.summary = report.summary();
  if (auto figure = gain_figure(report.virtual_sensor())) {
    section.figures.push_back(std::move(*figure));
  }
  if (auto figure = cross_figure(report)) section.figures.push_back(std::move(*figure));
  section.tables = {sensor_fits(report, digits),
                    pairs(report, digits),
                    weights(report.virtual_sensor(), digits),
                    gains(report.virtual_sensor(), digits),
                    sensor_budgets("What explains each sensor's noise, over all averaging times",
                                   "sensor", report.budgets()),
                    array_parameters("Parameters", report.parameters(), digits)};
  if (Table shown = array_correlations(report.parameters(), digits); !shown.rows.empty()) {
    section.tables.push_back(std::move(shown));
  }
  section.notes.assign(report.notes().begin(), report.notes().end());
  Document out{"array", {std::move(section)}};
  add_files(report.preflight(), digits, out);
  return out;
}

}  // namespace imunoise::report
