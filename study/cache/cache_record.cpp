#include "study/cache/cache_record.h"

#include "core/spectrum/cosine_transform.h"
#include "core/spectrum/cross_power.h"

namespace imunoise::study {
namespace {

// Whether each replicate has samples and as many cosines as a transform of them gives.
bool hangs_together(const CacheFile& file) {
  const auto count = static_cast<std::size_t>(file.header.replicates_size());
  if (count == 0 || file.arrays.size() != 2 * count) return false;
  for (std::size_t k = 0; k < count; ++k) {
    const auto n = static_cast<std::size_t>(file.arrays[2 * k].size());
    if (n < kFewestSamples || quick_length(n) != n ||
        static_cast<std::size_t>(file.arrays[2 * k + 1].size()) != n - 1)
      return false;
  }
  return true;
}

std::optional<WaveletVariance> moments_of(const v1::CachedReplicate& from, Hertz rate,
                                          Quantity quantity) {
  WaveletVariance out;
  out.samples = from.samples();
  out.scales = Scales::for_samples(out.samples);
  if (out.scales.size() != static_cast<std::size_t>(from.variance_size())) return std::nullopt;
  out.variance = Eigen::Map<const Eigen::ArrayXd>(from.variance().data(), from.variance_size());
  out.rate = rate;
  out.quantity = quantity;
  set_chi_square_interval(out);
  return out;
}

CacheFile file_of(const std::string& channel, Quantity quantity, Hertz rate,
                  const std::vector<SharedVector>& samples,
                  const std::vector<SharedVector>& cosines) {
  CacheFile out;
  out.header.set_channel(channel);
  out.header.set_quantity(std::string(si_symbol(quantity)));
  out.header.set_rate_hz(rate.value);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    out.header.add_replicates();
    out.arrays.push_back(samples[k]);
    out.arrays.push_back(cosines[k]);
  }
  return out;
}

std::vector<SharedVector> every_second(const std::vector<SharedVector>& arrays, std::size_t from) {
  std::vector<SharedVector> out;
  for (std::size_t i = from; i < arrays.size(); i += 2) out.push_back(arrays[i]);
  return out;
}

}  // namespace

CacheFile record_of(const PreparedChannel& prepared) {
  const Subject& subject = *prepared.subject;
  CacheFile out =
      file_of(prepared.name, subject.quantity, subject.rate, subject.samples, subject.cosines);
  for (const std::string& note : prepared.notes) out.header.add_notes(note);
  out.header.set_changed(prepared.changed);
  out.header.set_fingerprint(prepared.fingerprint);
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    v1::CachedReplicate& one = *out.header.mutable_replicates(static_cast<int>(k));
    one.set_name(prepared.replicates[k]);
    one.set_recorded(subject.parts[k].recorded);
    one.set_first(static_cast<std::uint64_t>(subject.parts[k].first));
    one.set_samples(prepared.moments[k].samples);
    for (const double variance : prepared.moments[k].variance) one.add_variance(variance);
  }
  return out;
}

CacheFile record_of(const Witness& witness, Hertz rate) {
  CacheFile out = file_of(witness.name, witness.quantity, rate, witness.samples, witness.cosines);
  out.header.set_unit(witness.unit);
  for (const double level : witness.levels) out.header.add_levels(level);
  return out;
}

std::optional<PreparedChannel> channel_of(const CacheFile& file) {
  const v1::CacheHeader& header = file.header;
  const auto unit = parse_unit(header.quantity());
  if (!unit || !(header.rate_hz() > 0.0) || !hangs_together(file)) return std::nullopt;
  auto subject = std::make_shared<Subject>(Subject{Hertz{header.rate_hz()},
                                                   unit->quantity,
                                                   every_second(file.arrays, 0),
                                                   every_second(file.arrays, 1),
                                                   {},
                                                   {}});
  PreparedChannel out;
  out.name = header.channel();
  out.notes.assign(header.notes().begin(), header.notes().end());
  out.changed = header.changed();
  out.fingerprint = header.fingerprint();
  for (const v1::CachedReplicate& one : header.replicates()) {
    auto moments = moments_of(one, subject->rate, unit->quantity);
    if (!moments) return std::nullopt;
    out.moments.push_back(std::move(*moments));
    out.replicates.push_back(one.name());
    subject->parts.push_back({one.recorded(), static_cast<Eigen::Index>(one.first())});
  }
  out.subject = std::move(subject);
  return out;
}

std::optional<Witness> witness_of(const CacheFile& file) {
  const auto unit = parse_unit(file.header.quantity());
  if (!unit || !hangs_together(file)) return std::nullopt;
  Witness out{file.header.channel(),        unit->quantity,     every_second(file.arrays, 0),
              every_second(file.arrays, 1), file.header.unit(), {}};
  const auto& levels = file.header.levels();
  if (static_cast<std::size_t>(levels.size()) != out.samples.size()) return std::nullopt;
  out.levels.assign(levels.begin(), levels.end());
  return out;
}

}  // namespace imunoise::study
