#include "study/analysis/preflights.h"

#include <cstdint>

namespace imunoise::study {

google::protobuf::RepeatedPtrField<v1::Preflight> preflights(
    std::span<const recording::Replicate> replicates) {
  google::protobuf::RepeatedPtrField<v1::Preflight> out;
  const recording::Preflight* before = nullptr;
  for (const recording::Replicate& one : replicates) {
    const recording::Preflight* const found = one.preflight.get();
    if (found == nullptr || found == before) continue;
    before = found;
    v1::Preflight& to = *out.Add();
    to.set_file(found->file);
    *to.mutable_recognised() = {found->recognised.begin(), found->recognised.end()};
    for (const recording::Finding& finding : found->findings) {
      v1::PreflightFinding& told = *to.add_findings();
      told.set_left_out(finding.severity == recording::Severity::kLeftOut);
      told.set_text(finding.text);
    }
    to.set_samples(found->samples);
    to.set_used(found->used);
    to.set_stretches(static_cast<std::uint32_t>(found->stretches));
  }
  return out;
}

}  // namespace imunoise::study
