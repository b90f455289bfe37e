#include <fmt/format.h>

#include "study/report/documents/array_tables.h"
#include "study/report/documents/inference_documents.h"
#include "study/report/figures/cross_figure.h"
#include "study/report/figures/interval_figure.h"
#include "study/report/view/verdict.h"

namespace imunoise::report {
namespace {

Table pairs(const v1::ArrayReport& report, Digits digits) {
  Table out{"Which sensors share noise",
            {"sensors", "share noise?", "p", "most at", "correlation", "sigma"},
            {}};
  for (const v1::SensorPair& one : report.pairs()) {
    const double p = one.adjusted_p_value();
    out.rows.push_back({one.first() + ", " + one.second(), one.dependent() ? "yes" : "not shown",
                        p < 1e-4 ? "< 0.0001" : number(p, 2, digits),
                        duration(one.strongest_tau_s()), number(one.correlation(), 2, digits),
                        signed_sigma(one.z(), digits)});
  }
  return out;
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
  Table out{"Wavelet variance relative to the mean of the sensors",
            {"averaging time", "by the model", "on held-out replicates"},
            {}};
  for (const v1::ScaleGain& one : sensor.scale_gains()) {
    out.rows.push_back({duration(one.tau_s()), number(one.predicted(), 3, digits),
                        one.has_measured() ? number(one.measured(), 3, digits) : "–"});
  }
  return out;
}

std::optional<figure::Figure> gain_figure(const v1::VirtualSensor& sensor) {
  std::vector<IntervalRow> rows;
  for (const v1::ScaleGain& one : sensor.scale_gains()) {
    const double seen = one.has_measured() ? one.measured() : one.predicted();
    rows.push_back({duration(one.tau_s()), seen, std::min(seen, one.predicted()),
                    std::max(seen, one.predicted()), seen > 1.0});
  }
  return interval_figure("Gain of the virtual sensor",
                         "wavelet variance relative to the mean of the sensors",
                         "One dot per scale: measured on held-out replicates if there are "
                         "any, else by the model; the whisker ends at the prediction of the model. "
                         "Left of 1, the virtual "
                         "sensor is quieter than the mean of all sensors; orange: noisier there.",
                         rows, 1.0);
}

}  // namespace

Document document(const v1::ArrayReport& report, Digits digits) {
  Section section;
  section.title = joined(report.sensors());
  bool shared = false;
  for (const v1::SensorPair& pair : report.pairs()) shared = shared || pair.dependent();
  section.badge = shared ? "shared noise" : "no shared noise detected";
  section.mood = shared ? Mood::kDoubtful : Mood::kGood;
  section.facts = fmt::format("{} · {:g} Hz · {} sensors · {} replicates · {}", report.model(),
                              report.rate_hz(), report.sensors_size(), report.replicates(),
                              report.termination()) +
                  estimator_fact(report.estimator());
  section.summary = report.summary();
  if (auto figure = gain_figure(report.virtual_sensor())) {
    section.figures.push_back(std::move(*figure));
  }
  if (auto figure = cross_figure(report)) section.figures.push_back(std::move(*figure));
  section.tables = {pairs(report, digits), weights(report.virtual_sensor(), digits),
                    gains(report.virtual_sensor(), digits),
                    sensor_budgets("What explains each sensor's noise, over all averaging times",
                                   "sensor", report.budgets()),
                    array_parameters("Parameters", report.parameters(), digits)};
  if (Table shown = array_correlations(report.parameters(), digits); !shown.rows.empty()) {
    section.tables.push_back(std::move(shown));
  }
  section.notes.assign(report.notes().begin(), report.notes().end());
  return {"array", {section}};
}

}  // namespace imunoise::report
