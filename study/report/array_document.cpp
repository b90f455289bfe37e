#include <fmt/format.h>

#include "study/report/cross_chart.h"
#include "study/report/inference_documents.h"
#include "study/report/interval_chart.h"
#include "study/report/verdict.h"

namespace imunoise::report {
namespace {

std::string joined(const google::protobuf::RepeatedPtrField<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

Table parameters(const v1::ArrayReport& report, Digits digits) {
  Table out{"Parameters", {"term", "sensors", "", "value", "interval", "unit"}, {}};
  for (const v1::ArrayParameter& one : report.parameters()) {
    if (one.has_correlation()) continue;
    const double upper = one.has_upper() ? one.upper() : one.lower();
    out.rows.push_back({one.term(), joined(one.sensors()), one.parameter(),
                        rounded(one.value(), one.lower(), upper, digits),
                        interval(one.value(), one.lower(), upper, digits),
                        one.unit() == "1" ? "" : one.unit()});
  }
  return out;
}

Table correlations(const v1::ArrayReport& report, Digits digits) {
  Table out{"Correlation of what the sensors have of a process",
            {"term", "sensors", "correlation", "interval"},
            {}};
  for (const v1::ArrayParameter& one : report.parameters()) {
    if (!one.has_correlation()) continue;
    out.rows.push_back(
        {one.term(), joined(one.sensors()),
         rounded(one.correlation(), one.correlation_lower(), one.correlation_upper(), digits),
         interval(one.correlation(), one.correlation_lower(), one.correlation_upper(), digits)});
  }
  return out;
}

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

Table budgets(const v1::ArrayReport& report) {
  Table out{"What explains each sensor's noise, over all averaging times", {"sensor"}, {}};
  for (const v1::SensorBudget& one : report.budgets()) {
    std::vector<std::string> row = {one.sensor()};
    for (const v1::TermShare& term : one.terms()) {
      if (out.rows.empty()) out.head.push_back(term.term());
      row.push_back(percent(term.share()));
    }
    out.rows.push_back(std::move(row));
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
  Table out{"Its wavelet variance over that of the sensors' mean",
            {"averaging time", "by the model", "on unseen replicates"},
            {}};
  for (const v1::ScaleGain& one : sensor.scale_gains()) {
    out.rows.push_back({duration(one.tau_s()), number(one.predicted(), 3, digits),
                        one.has_measured() ? number(one.measured(), 3, digits) : "–"});
  }
  return out;
}

std::optional<Figure> gain_chart(const v1::VirtualSensor& sensor) {
  std::vector<IntervalRow> rows;
  for (const v1::ScaleGain& one : sensor.scale_gains()) {
    const double seen = one.has_measured() ? one.measured() : one.predicted();
    rows.push_back({duration(one.tau_s()), seen, std::min(seen, one.predicted()),
                    std::max(seen, one.predicted()), seen > 1.0});
  }
  return interval_chart(
      "What the virtual sensor gains", "wavelet variance over that of the sensors' mean",
      "A dot a scale: measured on replicates that the weights were not made from where there are "
      "any, else by the model; the whisker runs to what the model predicts. Left of 1 the virtual "
      "sensor is quieter than the mean of all sensors; orange: noisier there.",
      rows, 1.0);
}

}  // namespace

Document document(const v1::ArrayReport& report, Digits digits) {
  Section section;
  section.title = joined(report.sensors());
  bool shared = false;
  for (const v1::SensorPair& pair : report.pairs()) shared = shared || pair.dependent();
  section.badge = shared ? "shared noise" : "no shared noise seen";
  section.mood = shared ? Mood::kDoubtful : Mood::kGood;
  section.facts = fmt::format("{} · {:g} Hz · {} sensors · {} replicates · {}", report.model(),
                              report.rate_hz(), report.sensors_size(), report.replicates(),
                              report.termination());
  section.summary = report.summary();
  if (auto figure = gain_chart(report.virtual_sensor())) {
    section.figures.push_back(std::move(*figure));
  }
  if (auto figure = cross_chart(report)) section.figures.push_back(std::move(*figure));
  section.tables = {pairs(report, digits), weights(report.virtual_sensor(), digits),
                    gains(report.virtual_sensor(), digits), budgets(report),
                    parameters(report, digits)};
  if (Table shown = correlations(report, digits); !shown.rows.empty()) {
    section.tables.push_back(std::move(shown));
  }
  section.notes.assign(report.notes().begin(), report.notes().end());
  return {"array", {section}};
}

}  // namespace imunoise::report
