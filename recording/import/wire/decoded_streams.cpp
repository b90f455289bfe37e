#include "recording/import/wire/decoded_streams.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/support/counted.h"

namespace imunoise::recording {
namespace {

constexpr std::size_t kMostStreams = 256;
constexpr std::size_t kMostLost = 1000;  // rows that stand for lost samples, at one place
constexpr double kSeldom = 0.9;          // of the rows; a channel in fewer is no channel

// Samples of one stream: one message of a bus, or all items of one packet.
class DecodedStream {
 public:
  void add(const drivers::DecodedSample& sample, bool by_counter) {
    if (by_counter) add_lost(sample);
    times_.push(sample.time_ns);
    for (Values& one : values_) one.there = false;
    for (std::size_t v = 0; v < sample.values.size(); ++v) {
      Values* const to = values_of(sample.values[v], v);
      if (to == nullptr || to->there) continue;
      fill(*to, times_.size() - 1);
      to->numbers.push(sample.values[v].value);
      to->there = true;
      ++to->count;
    }
  }

  TimedStream take(std::string name, const std::vector<std::string>& wanted) {
    TimedStream out{std::move(name), {}, {}};
    const std::size_t rows = times_.size();
    for (Values& one : values_) {
      const bool named = std::find(wanted.begin(), wanted.end(), one.name) != wanted.end();
      if (!named && static_cast<double>(one.count) < kSeldom * static_cast<double>(rows - lost_))
        continue;
      fill(one, rows);
      out.columns.push_back({one.name, one.numbers.take(), 1.0, 0.0, one.unit});
    }
    out.times = std::exchange(times_, {});
    return out;
  }

 private:
  struct Values {
    std::string name;
    std::string unit;
    Blocks<double> numbers;
    std::size_t count = 0;
    bool there = false;  // in the sample at hand
  };

  static void fill(Values& one, std::size_t rows) {
    while (one.numbers.size() < rows) one.numbers.push(std::numeric_limits<double>::quiet_NaN());
  }

  // Without times of its own, what the counter skips must not vanish.
  void add_lost(const drivers::DecodedSample& sample) {
    if (sample.counter && counter_ && *sample.counter > *counter_ + 1) {
      const auto lost = static_cast<std::uint64_t>(*sample.counter - *counter_ - 1);
      for (std::uint64_t i = 0; i < std::min<std::uint64_t>(lost, kMostLost); ++i) {
        times_.push(0);
        ++lost_;
      }
    }
    counter_ = sample.counter;
  }

  // Samples of a stream have the same channels in the same order, as a rule.
  Values* values_of(const drivers::DecodedValue& value, std::size_t place) {
    if (place < values_.size() && values_[place].name == value.channel) return &values_[place];
    for (Values& one : values_) {
      if (one.name == value.channel) return &one;
    }
    if (values_.size() >= kMostStreams) return nullptr;
    return &values_.emplace_back(
        Values{std::string(value.channel), std::string(value.unit), {}, 0, false});
  }

  Times times_;  // ns
  std::vector<Values> values_;
  std::optional<std::int64_t> counter_;
  std::size_t lost_ = 0;
};

class DecodedFile {
 public:
  DecodedFile(const File& file, const ImportOptions& options) : file_(file), options_(options) {}

  void add(const drivers::DecodedSample& sample) {
    key_.assign(sample.stream);
    const auto found = streams_.find(key_);
    const bool timed = sample.clock != drivers::Clock::kNone;
    timed_ = timed_ || timed;
    if (found != streams_.end()) {
      found->second.add(sample, !timed);
    } else if (streams_.size() < kMostStreams) {
      streams_[key_].add(sample, !timed);
    }
  }

  Result<Table> finish(const drivers::Tally& tally) {
    std::vector<TimedStream> streams;
    for (auto& [name, stream] : streams_) streams.push_back(stream.take(name, options_.channels));
    if (!timed_ && !options_.rate && !streams.empty()) {
      return fail(fmt::format(
          "{}: its samples carry no time; give the sampling rate with --rate HZ", file_.name()));
    }
    std::erase_if(streams, [](const TimedStream& one) { return one.columns.empty(); });
    auto table = join_streams(file_.name(), std::move(streams), "time of the samples", options_);
    if (!table) return table;
    table->notes.push_back(fmt::format("{}, {} lost by the device's counter, {}",
                                       counted(tally.samples, "sample"), tally.lost,
                                       counted(tally.other_messages, "other message")));
    for (std::size_t i = 0; i < drivers::kRefusals; ++i) {
      const auto reason = static_cast<drivers::Refusal>(i);
      if (tally.refused.count(reason) == 0) continue;
      table->notes.push_back(
          fmt::format("{} refused: {}", tally.refused.count(reason), drivers::meaning_of(reason)));
    }
    return table;
  }

 private:
  const File& file_;
  const ImportOptions& options_;
  std::map<std::string, DecodedStream, std::less<>> streams_;
  std::string key_;
  bool timed_ = false;
};

}  // namespace

Result<Table> read_decoded(const File& file, drivers::StreamDecoder& decoder,
                           const ImportOptions& options, FileProgress& progress) {
  constexpr std::size_t block_bytes = std::size_t{1} << 16U;
  DecodedFile out(file, options);
  std::vector<char> block(block_bytes);
  drivers::DecodedSample sample;
  for (std::uint64_t place = 0; place < file.size();) {
    const Result<std::size_t> got = file.read_at(place, block);
    if (!got) return tl::make_unexpected(got.error());
    if (*got == 0) break;
    place += *got;
    decoder.push(drivers::Bytes(reinterpret_cast<const std::uint8_t*>(block.data()), *got));
    if (place >= file.size()) decoder.finish();
    while (decoder.next(sample)) out.add(sample);
    progress.report(static_cast<double>(place) / static_cast<double>(file.size()));
    if (progress.stopped()) return fail(fmt::format("{}: the import was stopped", file.name()));
  }
  return out.finish(decoder.tally());
}

}  // namespace imunoise::recording
