#include <fmt/format.h>

#include "study/report/documents/batch_documents.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

constexpr int kDigits = 4;      // of a parameter
constexpr int kShownOpen = 20;  // shards that are not done

std::string optional_number(bool known, double value, Digits digits) {
  return known ? number(value, kDigits, digits) : "";
}

// The last message of a worker: an error may show its place in further lines.
std::string last_word(const v1::ShardStatus& shard) {
  for (int i = shard.log_size() - 1; i >= 0; --i) {
    if (shard.log(i).starts_with("imunoise: ")) return shard.log(i);
  }
  return shard.log().empty() ? "" : shard.log(shard.log_size() - 1);
}

Table parameters_of(const v1::SimulationSummary& simulation, Digits digits) {
  Table out{
      "Parameters", {"term", "parameter", "true", "mean", "deviation", "seen", "covered"}, {}};
  for (const v1::SimulatedParameter& one : simulation.parameters()) {
    out.rows.push_back({one.term(), one.name(),
                        optional_number(one.has_truth(), one.truth(), digits),
                        optional_number(one.has_mean(), one.mean(), digits),
                        optional_number(one.has_deviation(), one.deviation(), digits),
                        fmt::format("{} of {}", one.seen(), simulation.fits_size()),
                        one.has_covered() ? percent(one.covered()) : ""});
  }
  return out;
}

Section simulation_section(const v1::SimulationSummary& simulation, Digits digits) {
  const v1::SimulationTask& task = simulation.task();
  Section out;
  out.title = task.model();
  out.facts = fmt::format("{} {} of {}, {} {} each at {:g} Hz · seed {}",
                          count(task.sets(), digits), plural(task.sets(), "set"),
                          counted(task.replicates(), "replicate"), count(task.samples(), digits),
                          plural(task.samples(), "sample"), task.rate_hz(), task.seed());
  out.summary =
      fmt::format("{} was fitted to each set; the goodness-of-fit test rejected {} of {} at 5 %.",
                  task.fit(), simulation.rejected(), simulation.tested());
  out.tables = {parameters_of(simulation, digits)};
  out.notes = {fmt::format(
      "Seen: sets that identify the parameter, used for mean and deviation. Covered: share of "
      "all {:g} % intervals that contain the true value.",
      100.0 * task.confidence())};
  return out;
}

Section calibrations_section(const v1::BatchReport& report) {
  Section out;
  out.title = "calibrations";
  out.summary = fmt::format("{} recordings were calibrated; each has its calibration.json.",
                            report.calibrations_size());
  Table table{"Recordings", {"recording", "calibration"}, {}};
  for (const v1::CalibratedRecording& one : report.calibrations())
    table.rows.push_back({one.recording(), one.summary()});
  out.tables = {std::move(table)};
  return out;
}

}  // namespace

Document document(const v1::BatchStatus& status, Digits) {
  Section out;
  out.title = status.folder();
  out.summary = fmt::format("{} of {} shards are complete.", status.done(), status.shards());
  out.mood = status.open().empty() ? Mood::kGood : Mood::kDoubtful;
  Table table{"Incomplete shards", {"shard", "result", "last message of its worker"}, {}};
  for (const v1::ShardStatus& one : status.open()) {
    if (static_cast<int>(table.rows.size()) == kShownOpen) break;
    table.rows.push_back({std::to_string(one.number()),
                          one.state() == v1::damaged ? "damaged" : "missing", last_word(one)});
    if (!one.trouble().empty()) out.notes.push_back(one.trouble());
  }
  if (status.open_size() > kShownOpen)
    out.notes.push_back(fmt::format("{} more are incomplete.", status.open_size() - kShownOpen));
  if (!table.rows.empty()) out.tables = {std::move(table)};
  return {"batch", {out}};
}

Document document(const v1::BatchReport& report, Digits digits) {
  return {"batch",
          {report.has_simulation() ? simulation_section(report.simulation(), digits)
                                   : calibrations_section(report)}};
}

}  // namespace imunoise::report
