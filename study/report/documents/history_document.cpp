#include <fmt/format.h>

#include <cmath>
#include <set>

#include "study/report/documents/catalogue_documents.h"
#include "study/report/figures/history_figure.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

constexpr int kMostTables = 4;  // of points; with more parameters the overview must do

std::string change_words(double fraction) {
  if (std::abs(fraction) >= 10.0) return brief(1.0 + fraction) + " times";
  return fmt::format("{:+.2g} %", 100.0 * fraction);
}

std::string value_of(const v1::HistoryPoint& point, const ShownUnit& unit, Digits digits) {
  if (!point.has_upper()) return number(point.value() * unit.factor, 3, digits);
  if (!(point.lower() > 0.0))
    return fmt::format("at most {}", number(point.upper() * unit.factor, 3, digits));
  return with_interval(point.value() * unit.factor, point.lower() * unit.factor,
                       point.upper() * unit.factor, digits);
}

std::string verdict_of(const v1::ParameterHistory& one) {
  if (!one.has_drift()) return "not compared";
  return one.drift().newest_alarm() ? "CHANGED" : "compatible";
}

std::string name_of(const v1::ParameterHistory& one) {
  return fmt::format("{} {} of {}, {}", one.channel(), one.parameter(), one.term(),
                     shown_unit(one).name);
}

Table overview(const v1::History& history, Digits digits) {
  Table out{"The newest calibration against the earlier ones",
            {"", "newest", "expected", "change", "p", "verdict"},
            {}};
  for (const v1::ParameterHistory& one : history.parameters()) {
    const double factor = shown_unit(one).factor;
    const v1::DriftReport& drift = one.drift();
    std::vector<std::string> row = {name_of(one),
                                    number(one.points().rbegin()->value() * factor, 3, digits)};
    if (one.has_drift()) {
      row.push_back(fmt::format("{} … {}", number(drift.expected_lower() * factor, 3, digits),
                                number(drift.expected_upper() * factor, 3, digits)));
      row.push_back(change_words(drift.change()));
      row.push_back(p_value(drift.p_value(), digits));
    } else {
      row.insert(row.end(), {"–", "–", "–"});
    }
    row.push_back(verdict_of(one));
    out.rows.push_back(std::move(row));
  }
  return out;
}

Table trends(const v1::History& history, Digits digits) {
  Table out{"Long-term trend: a straight line through all",
            {"", "from first to newest", "p", "verdict"},
            {}};
  for (const v1::ParameterHistory& one : history.parameters()) {
    if (!one.drift().has_trend()) continue;
    out.rows.push_back({name_of(one), change_words(one.drift().trend()),
                        p_value(one.drift().trend_p_value(), digits),
                        one.drift().trend_alarm() ? "DRIFT" : "none"});
  }
  return out;
}

Table points(const v1::ParameterHistory& history, Digits digits) {
  const ShownUnit unit = shown_unit(history);
  Table out{fmt::format("{}, {}", history_title(history), unit.name),
            {"recorded (UTC)", "folder", "value", "model", ""},
            {}};
  for (const v1::HistoryPoint& one : history.points()) {
    out.rows.push_back({minute(one.started_ns()),
                        one.bench().empty() ? one.folder() : one.bench() + ": " + one.folder(),
                        value_of(one, unit, digits), one.model(),
                        one.compared() ? "" : "not compared"});
  }
  return out;
}

bool is_tested(const v1::History& history) {
  for (const v1::ParameterHistory& one : history.parameters()) {
    if (one.has_drift()) return true;
  }
  return false;
}

}  // namespace

Document document(const v1::History& history, Digits digits) {
  Section section;
  section.title = history.device().id();
  section.badge = history.alarm() ? "drift" : is_tested(history) ? "compatible" : "not compared";
  section.mood = history.alarm() ? Mood::kBad : is_tested(history) ? Mood::kGood : Mood::kNeutral;
  std::set<std::pair<std::string, std::string>> calibrations;
  for (const v1::ParameterHistory& one : history.parameters()) {
    for (const v1::HistoryPoint& point : one.points())
      calibrations.emplace(point.bench(), point.folder());
  }
  section.facts =
      fmt::format("{} · {} · {} · false-alarm probability {}", history.device().name(),
                  history.device().driver(), counted(calibrations.size(), "calibration"),
                  percent(history.level()));
  section.summary = history.summary();
  section.tables = {overview(history, digits), trends(history, digits)};
  for (const v1::ParameterHistory& one : history.parameters()) {
    if (auto figure = history_figure(one)) section.figures.push_back(std::move(*figure));
    if (history.parameters_size() <= kMostTables) section.tables.push_back(points(one, digits));
  }
  section.notes.assign(history.notes().begin(), history.notes().end());
  return {"history", {section}};
}

}  // namespace imunoise::report
