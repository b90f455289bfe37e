#include "recording/store/reading/sample_ranges.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace imunoise::recording {

RangeBuilder::RangeBuilder(const v1::RecordedStream& stream, std::uint32_t samples_each) {
  out_.set_stream(stream.name());
  out_.set_samples_each(samples_each);
  for (const v1::RecordedChannel& one : stream.channels()) {
    units_.push_back(units_of(one));
    v1::RangeChannel& to = *out_.add_channels();
    to.set_channel(one.name());
    to.set_units(units_.back().symbol);
  }
  newest_.resize(units_.size());
}

void RangeBuilder::take(const Rows& rows, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const bool starts = held_ == 0;
    if ((rows.flags[i] & kLostBefore) != 0 && !times_.empty()) {
      const auto place = static_cast<std::uint32_t>(times_.size()) - (starts ? 0U : 1U);
      if (out_.gaps().empty() || *out_.gaps().rbegin() != place) out_.add_gaps(place);
    }
    if (starts) times_.push_back(rows.host_time[i]);
    for (std::size_t c = 0; c < units_.size(); ++c) {
      const double number = std::visit(
          [i](const auto& values) { return static_cast<double>(values[i]); }, rows.channels[c]);
      const auto value = static_cast<float>(units_[c].value(number));
      if (std::isfinite(value)) newest_[c] = value;
      v1::RangeChannel& to = *out_.mutable_channels(static_cast<int>(c));
      if (starts) {
        to.add_lower(newest_[c]);
        to.add_upper(newest_[c]);
        continue;
      }
      const int last = to.lower_size() - 1;
      to.set_lower(last, std::min(to.lower(last), newest_[c]));
      to.set_upper(last, std::max(to.upper(last), newest_[c]));
    }
    if (++held_ == out_.samples_each()) held_ = 0;
  }
}

v1::SampleRanges RangeBuilder::finish(std::int64_t begin_ns) && {
  out_.set_begin_ns(begin_ns);
  for (const std::int64_t time : times_)
    out_.add_time_s(1e-9 * static_cast<double>(time - begin_ns));
  return std::move(out_);
}

v1::SampleRanges coarser(const v1::SampleRanges& fine, int begin, int end, int together,
                         const std::vector<int>& channels) {
  v1::SampleRanges out;
  out.set_stream(fine.stream());
  out.set_begin_ns(fine.begin_ns());
  out.set_samples_each(fine.samples_each() * static_cast<std::uint32_t>(together));
  for (int k = begin; k < end; k += together) out.add_time_s(fine.time_s(k));
  for (const std::uint32_t gap : fine.gaps()) {
    const int at = static_cast<int>(gap);
    if (at < begin || at >= end) continue;
    const auto place = static_cast<std::uint32_t>((at - begin) / together);
    if (out.gaps().empty() || *out.gaps().rbegin() != place) out.add_gaps(place);
  }
  for (const int c : channels) {
    const v1::RangeChannel& from = fine.channels(c);
    v1::RangeChannel& to = *out.add_channels();
    to.set_channel(from.channel());
    to.set_units(from.units());
    for (int k = begin; k < end; k += together) {
      const int stop = std::min(end, k + together);
      to.add_lower(*std::min_element(from.lower().begin() + k, from.lower().begin() + stop));
      to.add_upper(*std::max_element(from.upper().begin() + k, from.upper().begin() + stop));
    }
  }
  return out;
}

}  // namespace imunoise::recording
