#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "study/report/documents/inference_documents.h"
#include "study/report/documents/preflight_section.h"
#include "study/report/figures/interval_figure.h"
#include "study/report/view/verdict.h"

namespace imunoise::report {
namespace {

constexpr double kHopeless = 100.0;  // error, from which its interval tells nothing more

const char* words(v1::ChoiceVerdict verdict) {
  switch (verdict) {
    case v1::selected:
      return "selected";
    case v1::equivalent:
      return "equivalent";
    default:
      return "worse";
  }
}

std::string error(double value, double lower, double upper, Digits digits) {
  return value < kHopeless ? with_interval(value, lower, upper, digits) : number(value, 3, digits);
}

// Those that have a held-out likelihood, the best first.
Table likelihood_table(const v1::ChoiceReport& report, Digits digits) {
  std::vector<const v1::CandidateModel*> order;
  for (const v1::CandidateModel& one : report.candidates()) {
    if (one.has_shortfall()) order.push_back(&one);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->shortfall() < b->shortfall(); });
  Table out{
      "Models by held-out likelihood", {"model", "below the best", "worse in", "free", ""}, {}};
  constexpr double kSame = 0.05;  // nats
  for (const v1::CandidateModel* one : order) {
    const bool best = one->shortfall() < kSame;
    out.rows.push_back({one->model(), best ? "" : number(one->shortfall(), 3, digits) + " nats",
                        best ? "" : std::to_string(one->replicates_worse()),
                        std::to_string(one->parameters()),
                        one->model() == report.chosen() ? "chosen" : ""});
  }
  return out;
}

Section section(const v1::ChoiceReport& report, Digits digits) {
  Section out;
  out.title = channel_name(report.channel());
  out.facts = fmt::format("{:g} Hz · {} {} · {} splits ({}) · weights {}", report.rate_hz(),
                          report.replicates(),
                          report.contiguous_blocks() ? "contiguous blocks" : "replicates",
                          report.split_count(), report.splits(), report.weights()) +
              estimator_fact(report.estimator());
  out.summary = report.summary();
  Table table{"Models by held-out error (CV-WVIC, noise floor = 1)",
              {"model", "error", "above the best", "free", ""},
              {}};
  std::vector<IntervalRow> rows;
  for (const v1::CandidateModel& one : report.candidates()) {
    table.rows.push_back({one.model(),
                          error(one.merit(), one.merit_lower(), one.merit_upper(), digits),
                          one.verdict() == v1::selected
                              ? ""
                              : error(one.excess(), one.excess_lower(), one.excess_upper(), digits),
                          std::to_string(one.parameters()), words(one.verdict())});
    rows.push_back({one.model(), one.merit(), one.merit_lower(), one.merit_upper(),
                    one.verdict() == v1::not_appropriate});
  }
  if (report.candidates_size() > 0) {
    out.badge = report.chosen().empty() ? report.candidates(0).model() : report.chosen();
    out.mood = report.far_from_floor() ? Mood::kDoubtful : Mood::kGood;
  }
  auto figure =
      interval_figure("Held-out error", "held-out error, 1 = noise floor",
                      "Each model was fitted without the held-out replicates. The line at 1 is "
                      "the noise floor; orange models are significantly worse than the best.",
                      rows, 1.0);
  if (figure) out.figures.push_back(std::move(*figure));
  if (!report.chosen().empty()) out.tables.push_back(likelihood_table(report, digits));
  out.tables.push_back(std::move(table));
  out.notes.assign(report.notes().begin(), report.notes().end());
  return out;
}

}  // namespace

Document document(const v1::ChoiceReports& reports, Digits digits) {
  Document out{"model choice", {}};
  for (const v1::ChoiceReport& one : reports.channels()) {
    out.sections.push_back(section(one, digits));
  }
  if (reports.channels_size() > 0) add_files(reports.channels(0).preflight(), digits, out);
  return out;
}

}  // namespace imunoise::report
