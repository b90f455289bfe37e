#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/report/documents/diagnosis_words.h"
#include "study/report/documents/effect_rows.h"
#include "study/report/documents/inference_documents.h"
#include "study/report/documents/preflight_section.h"
#include "study/report/figures/comparison_figures.h"
#include "study/report/figures/diagnosis_pictures.h"
#include "study/report/figures/error_panel.h"
#include "study/report/figures/interval_figure.h"
#include "study/report/view/coefficient_words.h"
#include "study/report/view/verdict.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

constexpr int kMostShown = 8;
// With fewer of them, the size of a measured integrated error is a matter of chance.
constexpr std::uint64_t kFewStretches = 10;

// "WN + RW" for the first rung, "+ RES − AR1" for what came after.
std::string name_of(const v1::Rung& rung) {
  if (rung.added().empty()) return rung.model();
  std::string out = "+ " + rung.added();
  for (const std::string& term : rung.dropped()) out += " − " + term;
  return out;
}

// Empty where there are none.
std::string nats(double value, int significant, Digits digits) {
  constexpr double kNothing = 0.05;
  return std::abs(value) < kNothing ? "" : number(value, significant, digits) + " nats";
}

std::string unexplained_of(const v1::Rung& rung, Digits digits) {
  if (!rung.has_unexplained()) return "-";
  std::string out = rung.has_unexplained_lower()
                        ? with_interval(rung.unexplained(), rung.unexplained_lower(),
                                        rung.unexplained_upper(), digits)
                        : number(rung.unexplained(), 3, digits);
  if (rung.has_single_replicate_nats())
    out +=
        fmt::format(", {} nats in one replicate", number(rung.single_replicate_nats(), 3, digits));
  return out;
}

Table ladder_table(const v1::DiagnosisReport& report, Digits digits) {
  const v1::Rung& last = report.ladder(report.ladder_size() - 1);
  Table out{last.forecast() ? "The ladder: unexplained error (floor 1, a forecast)"
                            : "The ladder: unexplained error (floor 1)",
            {"added", "unexplained", "gained", "misfit p"},
            {}};
  for (const v1::Rung& rung : report.ladder()) {
    out.rows.push_back({name_of(rung), unexplained_of(rung, digits),
                        nats(rung.log_likelihood(), 4, digits), p_value(rung.misfit_p(), digits)});
  }
  return out;
}

Table consequence_table(const v1::DiagnosisReport& report) {
  Table out{"What each model lacks against the best, and what that costs", {"model", ""}, {}};
  for (const v1::Rung& rung : report.ladder()) {
    if (!rung.consequence().empty()) out.rows.push_back({name_of(rung), rung.consequence()});
  }
  return out;
}

// "0.34 %" of an error in a view.
std::string view_value(double value, const v1::ErrorView& view, Digits digits) {
  if (view.unit() == "dB") return fmt::format("{:.1f} dB", value);
  return number(value, 2, digits) + (view.unit() == "1" ? "" : " " + view.unit());
}

const v1::ErrorView* view_of(const v1::Rung& rung, const std::string& name) {
  for (const v1::ErrorView& one : rung.views()) {
    if (one.view() == name) return &one;
  }
  return nullptr;
}

// Each view of the last rung, beside that of the first where there are two.
Table error_table(const v1::DiagnosisReport& report, Digits digits) {
  const v1::Rung& last = report.ladder(report.ladder_size() - 1);
  const bool grown = report.ladder_size() > 1;
  Table out{"How far the model is off, view by view", {"view"}, {}};
  if (grown) out.head.emplace_back("before");
  for (const char* const word : {"now", "floor", "where"}) out.head.emplace_back(word);
  for (const v1::ErrorView& now : last.views()) {
    std::vector<std::string> row{view_title(now)};
    const v1::ErrorView* const before = view_of(report.ladder(0), now.view());
    if (grown) row.push_back(before != nullptr ? view_value(before->value(), *before, digits) : "");
    row.push_back(view_value(now.value(), now, digits));
    row.push_back(view_value(now.floor(), now, digits));
    row.push_back(now.sentence());
    out.rows.push_back(std::move(row));
  }
  return out;
}

std::string confusions(const v1::EffectCandidate& one) {
  std::string out;
  for (const std::string& id : one.confused_with()) out += (out.empty() ? "" : ", ") + id;
  return out;
}

Table candidate_table(const v1::DiagnosisReport& report, Digits digits) {
  Table out{"Effects that may be missing, best first",
            {"effect", "term", "gain", "p", "unexplained", "looks like"},
            {}};
  for (int i = 0; i < std::min(kMostShown, report.candidates_size()); ++i) {
    const v1::EffectCandidate& one = report.candidates(i);
    if (!beyond_chance(one)) continue;
    const std::string gain = nats(one.gain_nats(), 3, digits);
    if (gain.empty() && !one.term().empty()) continue;  // a defect of the samples has no gain
    out.rows.push_back({one.effect(), one.term(), gain, p_value(one.familywise_p(), digits),
                        one.has_unexplained_after()
                            ? fmt::format("{} → {}", number(one.unexplained_before(), 3, digits),
                                          number(one.unexplained_after(), 3, digits))
                            : "",
                        confusions(one)});
  }
  return out;
}

Table effect_table(const v1::EffectCandidate& best, Digits digits) {
  Table out{fmt::format("{}: its numbers", best.title()), {"", "value"}, {}};
  for (const v1::EffectParameter& one : best.parameters())
    out.rows.push_back({one.name(), value_of(one, digits)});
  out.rows.push_back({"physics", best.cause()});
  out.rows.push_back({"to be sure, record", best.record_next()});
  return out;
}

// The effects of the last model of the ladder, with what was fitted of them.
Table effect_table(const v1::Rung& last, Digits digits) {
  return {
      "The effects in the last model", {"term", "", "value"}, effect_rows(last.effects(), digits)};
}

Table misfit_table(const v1::DiagnosisReport& report) {
  Table out{"Where the model fails", {"kind", ""}, {}};
  for (const v1::Misfit& one : report.misfits()) out.rows.push_back({one.kind(), one.sentence()});
  return out;
}

Table drift_table(const v1::DiagnosisReport& report, Digits digits) {
  Table out{
      "Integrated error after averaging the bias for the same time: predicted / measured, × best "
      "model",
      {"model"},
      {}};
  for (const v1::IntegratedError& one : report.ladder(0).drift())
    out.head.push_back(
        one.stretches() > 0 && one.stretches() < kFewStretches
            ? fmt::format("{:g} s (only {})", one.seconds(), counted(one.stretches(), "stretch"))
            : fmt::format("{:g} s", one.seconds()));
  for (const v1::Rung& rung : report.ladder()) {
    std::vector<std::string> row{name_of(rung)};
    for (const v1::IntegratedError& one : rung.drift()) {
      row.push_back(fmt::format("{} / {} {}{}", number(one.predicted(), 3, digits),
                                number(one.measured(), 3, digits), one.unit(),
                                one.has_best() && one.best() > 0.0
                                    ? fmt::format(", × {:.2f}", one.measured() / one.best())
                                    : ""));
    }
    out.rows.push_back(std::move(row));
  }
  return out;
}

Table integrity_table(const v1::DiagnosisReport& report) {
  Table out{"Quality of the samples", {"defect", ""}, {}};
  for (const v1::IntegrityFinding& one : report.integrity())
    out.rows.push_back({one.effect(), one.sentence()});
  return out;
}

Table limit_table(const v1::DiagnosisReport& report, Digits digits) {
  Table out{"Detection limits (90 % power)", {"effect", "from", "of"}, {}};
  for (const v1::DetectionLimit& one : report.limits()) {
    const std::string effect =
        one.witness().empty() ? one.effect() : fmt::format("{} ({})", one.effect(), one.witness());
    const std::string unit = one.unit() == "1" ? "" : " " + one.unit();
    std::string of =
        one.term().empty() ? one.parameter() : fmt::format("{}, {}", one.parameter(), one.term());
    if (one.has_lowest_hz())
      of += fmt::format(", above {} Hz", number(one.lowest_hz(), 2, Digits::kPlain));
    out.rows.push_back({effect, number(one.value(), 2, digits) + unit, of});
  }
  return out;
}

figure::Figure titled(figure::Figure figure, const std::string& title, const std::string& model) {
  figure.title = title;
  figure.caption = "Model: " + model;
  return figure;
}

void add_spectrum(const v1::DiagnosisReport& report, const v1::Comparison& compared,
                  const std::string& title, Section& to) {
  if (auto figure = spectrum_figure(report, compared, title))
    to.figures.push_back(std::move(*figure));
}

std::optional<figure::Figure> ladder_figure(const v1::DiagnosisReport& report) {
  std::vector<IntervalRow> rows;
  for (const v1::Rung& rung : report.ladder()) {
    if (!rung.has_unexplained()) continue;
    const bool known = rung.has_unexplained_lower();
    rows.push_back({name_of(rung), rung.unexplained(),
                    known ? rung.unexplained_lower() : rung.unexplained(),
                    known ? rung.unexplained_upper() : rung.unexplained(), rung.misfit_p() < 0.01});
  }
  return interval_figure("How the error falls", "unexplained error, 1 = floor",
                         "Distance to the best model on held-out data, with its interval over "
                         "replicates. The line at 1 is the floor; orange models do not fit.",
                         rows, 1.0);
}

void add_figures(const v1::DiagnosisReport& report, Section& to) {
  if (report.ladder_size() == 0) return;
  const bool grown = report.has_compared_after();
  to.figures.push_back(
      titled(before_figure(report), grown ? "Before" : "Model and data", report.model()));
  add_spectrum(report, report.compared_before(), grown ? "Spectrum before" : "Spectrum", to);
  for (figure::Figure& one : comparison_figures(report, report.compared_before()))
    to.figures.push_back(std::move(one));
  if (report.ladder_size() < 2) return;
  if (grown) {
    const v1::Rung& last = report.ladder(report.ladder_size() - 1);
    to.figures.push_back(
        titled(after_figure(report), "After: measurements without the effects", last.model()));
    add_spectrum(report, report.compared_after(), "Spectrum after", to);
  }
  if (auto ladder = ladder_figure(report)) to.figures.push_back(std::move(*ladder));
}

Section section(const v1::DiagnosisReport& report, Digits digits) {
  Section out;
  out.title = channel_name(report.channel());
  std::string witnesses;
  for (const std::string& name : report.witnesses())
    witnesses += (witnesses.empty() ? "" : ", ") + name;
  out.facts = fmt::format("{:g} Hz · model {} · witnesses {}", report.rate_hz(), report.model(),
                          witnesses.empty() ? "none" : witnesses) +
              estimator_fact(report.estimator());
  out.badge = diagnosis_words(report).badge;
  out.mood = diagnosis_words(report).mood;
  out.summary = report.summary();
  add_figures(report, out);
  if (report.ladder_size() > 0) {
    out.panel = error_panel(report);
    out.tables.push_back(error_table(report, digits));
  }
  if (report.integrity_size() > 0) out.tables.push_back(integrity_table(report));
  if (report.misfits_size() > 0) out.tables.push_back(misfit_table(report));
  if (report.candidates_size() > 0) {
    if (Table listed = candidate_table(report, digits); !listed.rows.empty())
      out.tables.push_back(std::move(listed));
    if (report.verdict() == v1::found || report.verdict() == v1::one_of)
      out.tables.push_back(effect_table(report.candidates(0), digits));
  }
  if (report.ladder_size() > 0) {
    out.tables.push_back(ladder_table(report, digits));
    const v1::Rung& last = report.ladder(report.ladder_size() - 1);
    if (last.effects_size() > 0) out.tables.push_back(effect_table(last, digits));
    out.tables.push_back(consequence_table(report));
    if (report.ladder(0).drift_size() > 0) out.tables.push_back(drift_table(report, digits));
  }
  if (report.verdict() == v1::none) out.tables.push_back(limit_table(report, digits));
  out.notes.assign(report.notes().begin(), report.notes().end());
  return out;
}

}  // namespace

VerdictWords diagnosis_words(const v1::DiagnosisReport& report) {
  switch (report.verdict()) {
    case v1::found:
      return {"effect found", Mood::kBad};
    case v1::several:
      return {"effects found", Mood::kBad};
    case v1::one_of:
      return {"one of several", Mood::kDoubtful};
    case v1::unknown:
      return {"something unknown", Mood::kDoubtful};
    default:
      return {"nothing missing", Mood::kGood};
  }
}

Document document(const v1::DiagnosisReports& reports, Digits digits) {
  Document out{"diagnosis", {}};
  for (const v1::DiagnosisReport& one : reports.channels())
    out.sections.push_back(section(one, digits));
  if (reports.channels_size() > 0) add_files(reports.channels(0).preflight(), digits, out);
  return out;
}

Document document(const v1::Study& study, Digits digits) {
  // The attempts that led to the current model are its ladder.
  v1::DiagnosisReport report = study.diagnosis();
  report.set_channel(study.channel());
  report.clear_ladder();
  report.clear_compared_after();  // of a candidate that was not added
  std::vector<const v1::StudyAttempt*> path;
  for (const v1::StudyAttempt* at = &study.attempts(static_cast<int>(study.current()));;
       at = &study.attempts(static_cast<int>(at->parent()))) {
    path.push_back(at);
    if (!at->has_parent()) break;
  }
  std::reverse(path.begin(), path.end());
  for (const v1::StudyAttempt* one : path) *report.add_ladder() = one->rung();
  Section out = section(report, digits);
  if (!study.has_diagnosis()) {
    out.badge.clear();
    out.mood = Mood::kNeutral;
    const v1::Rung& now = path.back()->rung();
    out.facts = "model " + now.model() + estimator_fact(now.estimator());
    out.summary = "Run imunoise study candidates to find what this model lacks.";
    out.figures.clear();
    const v1::Rung& last = path.back()->rung();
    out.panel = error_panel(report);
    out.tables = {error_table(report, digits), ladder_table(report, digits)};
    if (last.effects_size() > 0) out.tables.push_back(effect_table(last, digits));
    out.tables.push_back(consequence_table(report));
    out.tables.push_back(drift_table(report, digits));
  }
  Table attempts{"All attempts", {"", "model", "coefficients", "unexplained", ""}, {}};
  for (int i = 0; i < study.attempts_size(); ++i) {
    const v1::StudyAttempt& one = study.attempts(i);
    const bool current = i == static_cast<int>(study.current());
    attempts.rows.push_back(
        {std::to_string(i), one.rung().model(), short_words(one.rung().picture().terms(), digits),
         one.rung().has_unexplained() ? number(one.rung().unexplained(), 3, digits) : "-",
         current        ? "current"
         : one.undone() ? "undone"
                        : ""});
  }
  out.tables.push_back(std::move(attempts));
  Document all{"study", {std::move(out)}};
  add_files(study.preflight(), digits, all);
  return all;
}

}  // namespace imunoise::report
