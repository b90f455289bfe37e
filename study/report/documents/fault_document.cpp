#include <fmt/format.h>

#include <set>
#include <utility>

#include "study/report/documents/inference_documents.h"
#include "study/report/documents/preflight_section.h"
#include "study/report/figures/fault_figure.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

std::string accused(const v1::SensorFault& fault) {
  std::string out;
  for (const std::string& name : fault.sensors()) out += (out.empty() ? "" : " or ") + name;
  return out;
}

std::string with_unit(std::string value, const std::string& unit) {
  return unit == "1" ? value : value + " " + unit;
}

std::string size_of(const v1::SensorFault& fault, const std::string& unit, Digits digits) {
  if (fault.kind() == "stuck") return fmt::format("{:.0f} equal readings", fault.size());
  if (fault.kind() == "noisy") {
    const std::string added = with_unit("+" + number(fault.size(), 2, digits), unit);
    return fault.has_end_s() ? added + " for " + duration(fault.end_s() - fault.onset_s()) : added;
  }
  const double low = fault.size() - fault.size_error();
  const double high = fault.size() + fault.size_error();
  return with_unit(fmt::format("{} ± {}", rounded(fault.size(), low, high, digits),
                               number(fault.size_error(), 1, digits)),
                   unit);
}

Table faults(const v1::FaultReport& report, Digits digits) {
  Table out{"Faults", {"sensor", "fault", "size", "from", "seen after", "evidence", "in"}, {}};
  for (const v1::SensorFault& one : report.faults()) {
    out.rows.push_back({accused(one), one.kind(), size_of(one, report.unit(), digits),
                        duration(one.onset_s()), duration(one.delay_s()),
                        number(one.evidence(), 2, digits) + " nats", one.replicate()});
  }
  return out;
}

Table rules(const v1::FaultReport& report, Digits digits) {
  Table out{"When a sensor counts as stuck", {"sensor", "resolution", "equal readings"}, {}};
  for (const v1::StuckRule& one : report.stuck_rules()) {
    out.rows.push_back(
        {one.sensor(), with_unit(number(one.resolution(), 2, digits), report.unit()),
         one.has_repetitions() ? fmt::format("{}", one.repetitions() + 1) : "not detectable"});
  }
  return out;
}

}  // namespace

Document document(const v1::FaultReport& report, Digits digits) {
  Section section;
  for (const std::string& name : report.sensors()) {
    section.title += (section.title.empty() ? "" : ", ") + name;
  }
  const bool sound = report.faults_size() == 0;
  const bool watched = report.watched_s() > 0.0;
  section.badge = !sound ? "faulty" : watched ? "no fault" : "not watched";
  section.mood = !sound ? Mood::kBad : watched ? Mood::kGood : Mood::kNeutral;
  section.facts = fmt::format(
      "{} · {:g} Hz · {} sensors · {} · fitted to {} · {} false alarms per hour allowed",
      report.model(), report.rate_hz(), report.sensors_size(),
      counted(report.replicates_size(), "replicate"),
      report.trained_elsewhere() ? counted(report.trained_on(), "other replicate")
                                 : "what is sound of these",
      number(report.false_alarms_per_hour(), 3, digits));
  section.summary = report.summary();
  std::set<std::string> drawn;
  for (const v1::SensorFault& fault : report.faults()) {
    if (!drawn.insert(fault.replicate()).second) continue;
    if (auto figure = fault_figure(report, fault.replicate())) {
      section.figures.push_back(std::move(*figure));
    }
  }
  if (!sound) section.tables.push_back(faults(report, digits));
  section.tables.push_back(rules(report, digits));
  section.notes.assign(report.notes().begin(), report.notes().end());
  Document out{"faults", {std::move(section)}};
  add_files(report.preflight(), digits, out);
  return out;
}

}  // namespace imunoise::report
