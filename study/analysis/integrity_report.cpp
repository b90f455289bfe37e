#include "study/analysis/integrity_report.h"

#include <fmt/format.h>

#include "core/diagnosis/causes.h"
#include "core/integrity/integrity.h"
#include "core/support/counted.h"
#include "core/support/parallel.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

std::string defect_words(const Defect& defect, double rate) {
  if (defect.effect == "duplicated_samples")
    return fmt::format("{} {} the one before; noise like this repeats {:.0f}",
                       counted(defect.count, "sample"), defect.count == 1 ? "repeats" : "repeat",
                       defect.number);
  if (defect.effect == "stuck") {
    const std::string places =
        defect.places > 1 ? fmt::format(" in {} places, the first", defect.places) : "";
    return fmt::format("the output stands still for {}{} from {:.2f} s on",
                       counted(defect.count, "sample"), places,
                       static_cast<double>(defect.first) / rate);
  }
  if (defect.effect == "saturation")
    return fmt::format("{} {} at the {} end of the range, {:.0f} next to it",
                       counted(defect.count, "sample"), defect.count == 1 ? "lies" : "lie",
                       defect.wrong.front().beyond > 0 ? "upper" : "lower", defect.number);
  if (defect.effect == "dropouts")
    return fmt::format(
        "{} have the value {:.6g} (SI), far from all others, in place of missing ones",
        counted(defect.count, "sample"), defect.number);
  if (defect.effect == "interpolated_samples")
    return fmt::format(
        "its samples were interpolated from another sampling rate: the power of their differences "
        "repeats at {} Hz, the beat of the two rates",
        report::brief(defect.number * rate, 4));
  if (defect.effect == "missing_codes")
    return fmt::format(
        "{} codes of the converter never occur between others that do; noise like "
        "this would give them {:.0f} samples",
        defect.count, defect.number);
  const std::string steps =
      defect.number < 0.1 ? "less than 0.1" : fmt::format("only {:.2g}", defect.number);
  return fmt::format(
      "from one sample to the next, it changes by {} steps of the converter, so that rounding "
      "hides "
      "its fast noise: {} codes occur",
      steps, defect.count);
}

void add_finding(const std::string& effect, const std::string& replicate, std::uint64_t count,
                 const std::string& words, v1::DiagnosisReport& to) {
  v1::IntegrityFinding& finding = *to.add_integrity();
  finding.set_effect(effect);
  finding.set_replicate(replicate);
  finding.set_count(count);
  finding.set_sentence(fmt::format("{}: {}.", replicate, words));
}

}  // namespace

void add_integrity(const Series& series, v1::DiagnosisReport& to) {
  std::vector<std::vector<Defect>> defects(series.replicates.size());
  for_each_index(defects.size(),
                 [&](std::size_t k) { defects[k] = integrity(series.replicates[k]); });
  for (std::size_t k = 0; k < defects.size(); ++k) {
    for (const Defect& defect : defects[k]) {
      add_finding(defect.effect, series.names[k], defect.count,
                  defect_words(defect, series.replicates[k].rate().value), to);
    }
  }
}

void add_timing(const std::vector<recording::Replicate>& recordings, v1::DiagnosisReport& to) {
  constexpr double kUneven = 0.05;  // periods
  for (const recording::Replicate& one : recordings) {
    const recording::Timing& timing = one.timing;
    if (timing.gaps > 0) {
      const std::string lost =
          timing.lost > 0 ? fmt::format("{}", timing.lost) : "an unknown number of";
      add_finding("lost_samples", one.name, timing.lost,
                  fmt::format("{} {} lost in {}; the recording is cut there, and its parts are "
                              "replicates",
                              lost, timing.lost == 1 ? "sample was" : "samples were",
                              counted(timing.gaps, "place")),
                  to);
    }
    if (timing.jitter > kUneven) {
      add_finding("clock_jitter", one.name, 0,
                  fmt::format("its time stamps depart from even spacing by {:.2f} of a period "
                              "(rms); a host's or rounded ones do, but if the device sampled so "
                              "unevenly, its fastest signals are blurred",
                              timing.jitter),
                  to);
    }
  }
}

void put_defects_first(bool mended, v1::DiagnosisReport& to) {
  if (to.integrity_size() == 0) return;
  const v1::IntegrityFinding& finding = to.integrity(0);
  const Cause& about = defect_info(finding.effect());
  v1::EffectCandidate defect;
  defect.set_effect(finding.effect());
  defect.set_title(std::string(about.title));
  defect.set_cause(std::string(about.physics));
  defect.set_record_next(std::string(about.record_next));
  defect.set_sentence(finding.sentence());
  google::protobuf::RepeatedPtrField<v1::EffectCandidate> all;
  *all.Add() = std::move(defect);
  all.MergeFrom(to.candidates());
  to.mutable_candidates()->Swap(&all);
  to.set_verdict(v1::found);
  to.set_summary(
      fmt::format("The samples themselves are defective: {} {}", finding.sentence(),
                  mended ? "What follows is of the samples as they were mended: see the notes."
                         : "Mend this first; it can look like any effect."));
}

}  // namespace imunoise::study
