#include "drivers/xsens/rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "drivers/xsens/codec/items.h"
#include "drivers/xsens/codec/mtdata2.h"
#include "drivers/xsens/codec/sample_clock.h"

namespace imunoise::xsens {
namespace {

using drivers::XsensFormat;

constexpr std::uint32_t kSelfTestPassed = 1U;
constexpr std::uint32_t kClipped = 0x0009'ff00;  // acceleration, rate, field; any of them

struct StoredFormat {
  drivers::NumberType type;
  double scale;  // of whole numbers
};

StoredFormat stored(XsensFormat format) {
  switch (format) {
    case XsensFormat::kFixed12_20:
      return {drivers::NumberType::kInt32, std::ldexp(1.0, -20)};
    case XsensFormat::kFixed16_32:
      return {drivers::NumberType::kInt64, std::ldexp(1.0, -32)};
    case XsensFormat::kFloat64:
      return {drivers::NumberType::kFloat64, 1.0};
    case XsensFormat::kFloat32:
      break;
  }
  return {drivers::NumberType::kFloat32, 1.0};
}

drivers::Channel describe(std::string_view name, std::string_view unit, XsensFormat format) {
  const StoredFormat as = stored(format);
  return {std::string(name), std::string(unit), as.type, as.scale};
}

void set_number(plugin::Row& row, std::size_t channel, XsensFormat format, double number) {
  const StoredFormat as = stored(format);
  if (as.scale == 1.0) {
    row.set(channel, number);
  } else {
    row.set(channel, static_cast<std::int64_t>(number / as.scale));  // exact
  }
}

// MTData2: each stream is the outputs of one rate.
class MtData2Rows final : public RowMaker {
 public:
  explicit MtData2Rows(const std::vector<drivers::XsensOutput>& outputs) {
    std::map<std::uint16_t, std::vector<std::uint16_t>, std::greater<>> by_rate;
    for (const drivers::XsensOutput& output : outputs) {
      if (drivers::find_number_item(output.data_id) == nullptr) continue;
      by_rate[output.rate_hz].push_back(output.data_id);
    }
    for (const auto& [rate, ids] : by_rate) {
      drivers::Stream& stream = streams_.emplace_back();
      stream.name = "imu";
      stream.nominal_rate_hz = rate;
      stream.device_time_tick_s = 1e-4;
      for (const std::uint16_t id : ids) {
        const drivers::XsensNumberItem& item = *drivers::find_number_item(id);
        for (const std::string_view name : item.channels) {
          stream.channels.push_back(describe(name, item.unit, drivers::format_of(id)));
        }
      }
      // The counter counts messages, and only the fastest stream is in all of them.
      if (streams_.size() == 1) {
        stream.counter_maximum = UINT16_MAX;
      } else {
        stream.name += "_" + std::to_string(rate) + "hz";
      }
      items_.push_back(ids);
    }
    restart();
  }

  void add(const drivers::XbusFrame& frame, std::int64_t host_time_ns,
           plugin::Samples& samples) override {
    drivers::Refusals ignored;  // items that are missing show below
    drivers::decode_mtdata2(frame.payload, data_, ignored);
    if (!data_.packet_counter || !data_.sample_time_fine) {
      return samples.refuse(0, plugin::Reason::kMalformed);
    }
    const std::int64_t device_time = clock_(*data_.sample_time_fine);
    for (std::size_t s = 0; s < streams_.size(); ++s) {
      const Found found = find_items(items_[s]);
      if (found == Found::kNothing && s > 0) continue;  // a slower stream is not in every message
      if (found != Found::kAll) {
        samples.refuse(s, plugin::Reason::kMalformed);
        continue;
      }
      plugin::Row row = samples.add(s, {host_time_ns, *data_.packet_counter, device_time,
                                        flags_of(s, data_.packet_counter, data_.status)});
      std::size_t column = 0;
      for (const drivers::XsensItemNumbers* const item : found_) {
        for (std::size_t i = 0; i < item->count; ++i) {
          set_number(row, column++, drivers::format_of(item->id), data_.numbers[item->first + i]);
        }
      }
    }
  }

  void restart() override {
    RowMaker::restart();
    clock_ = {};
  }

 private:
  enum class Found { kNothing, kSome, kAll };
  // Looks up the items of a stream in the message, in the order of its channels. All: each is there
  // once, with all its numbers.
  Found find_items(const std::vector<std::uint16_t>& ids) {
    found_.clear();
    bool complete = true;
    for (const std::uint16_t id : ids) {
      const std::size_t before = found_.size();
      for (const drivers::XsensItemNumbers& item : data_.items) {
        if (item.id == id) found_.push_back(&item);
      }
      complete = complete && found_.size() == before + 1 && found_.back()->count > 0;
    }
    if (found_.empty()) return Found::kNothing;
    return complete ? Found::kAll : Found::kSome;
  }

  std::vector<std::vector<std::uint16_t>> items_;  // by stream, in the order of its channels
  drivers::XsensSampleClock clock_;
  drivers::MtData2 data_;
  std::vector<const drivers::XsensItemNumbers*> found_;  // of one stream, in data_
};

// Legacy MTData: one stream, without a time of its own.
class LegacyRows final : public RowMaker {
 public:
  explicit LegacyRows(const drivers::XsensConfiguration& configuration)
      : layout_(configuration.layout) {
    drivers::Stream& stream = streams_.emplace_back();
    stream.name = "imu";
    stream.nominal_rate_hz = drivers::rate_of(configuration);
    stream.counter_maximum = UINT16_MAX;
    for (const drivers::LegacyChannel& channel : drivers::channels_of(layout_)) {
      stream.channels.push_back(describe(channel.name, channel.unit, drivers::format_of(layout_)));
    }
    restart();
  }

  void add(const drivers::XbusFrame& frame, std::int64_t host_time_ns,
           plugin::Samples& samples) override {
    drivers::Refusals ignored;
    if (!drivers::decode_legacy(frame.payload, layout_, data_, ignored)) {
      return samples.refuse(0, plugin::Reason::kMalformed);
    }
    plugin::Row row =
        samples.add(0, {host_time_ns, *data_.counter, 0, flags_of(0, data_.counter, data_.status)});
    for (std::size_t c = 0; c < data_.numbers.size(); ++c) {
      set_number(row, c, drivers::format_of(layout_), data_.numbers[c]);
    }
  }

 private:
  drivers::LegacyLayout layout_;
  drivers::LegacyData data_;
};

}  // namespace

std::unique_ptr<RowMaker> RowMaker::make(const Setup& setup) {
  if (const auto* const outputs = std::get_if<std::vector<drivers::XsensOutput>>(&setup.sends)) {
    return std::make_unique<MtData2Rows>(*outputs);
  }
  return std::make_unique<LegacyRows>(std::get<drivers::XsensConfiguration>(setup.sends));
}

void RowMaker::restart() {
  last_counter_.reset();
  restarted_.assign(streams_.size(), true);
}

std::uint32_t RowMaker::flags_of(std::size_t stream, std::optional<std::uint16_t> counter,
                                 std::optional<std::uint32_t> status) {
  std::uint32_t out = 0;
  if (restarted_[stream]) out |= IMUNOISE_SAMPLE_AFTER_RESTART;
  restarted_[stream] = false;
  if (stream == 0) {
    const auto last = std::exchange(last_counter_, counter);
    if (last && static_cast<std::uint16_t>(*last + 1U) != counter) out |= IMUNOISE_SAMPLE_AFTER_GAP;
  }
  if (status && (*status & kClipped) != 0) out |= IMUNOISE_SAMPLE_SATURATED;
  if (status && (*status & kSelfTestPassed) == 0) out |= IMUNOISE_SAMPLE_SUSPECT;
  return out;
}

}  // namespace imunoise::xsens
