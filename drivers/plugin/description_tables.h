#pragma once

// C++ descriptions as the tables of driver.h, which point into them.

#include <deque>
#include <memory>
#include <vector>

#include "drivers/description.h"

namespace imunoise::plugin {

/// A list as driver.h has it: an array of pointers to structs that stay where they are.
template <class Struct>
class PointerList {
 public:
  PointerList() = default;
  PointerList(PointerList&&) noexcept = default;
  PointerList& operator=(PointerList&&) noexcept = default;
  PointerList(const PointerList&) = delete;
  PointerList& operator=(const PointerList&) = delete;
  ~PointerList() = default;

  void add(const Struct& item) {
    items_.push_back(std::make_unique<Struct>(item));
    pointers_.push_back(items_.back().get());
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(pointers_.size()); }
  const Struct* const* data() const { return pointers_.data(); }

 private:
  std::vector<std::unique_ptr<Struct>> items_;
  std::vector<const Struct*> pointers_;
};

/// Streams as C structs. Borrows: the descriptions must outlive it, where they are.
class StreamTables {
 public:
  explicit StreamTables(const std::vector<drivers::Stream>& streams) {
    for (const drivers::Stream& stream : streams) {
      PointerList<imunoise_channel>& channels = channels_.emplace_back();
      for (const drivers::Channel& channel : stream.channels) {
        channels.add({sizeof(imunoise_channel), static_cast<std::uint32_t>(channel.type),
                      channel.name.c_str(), channel.long_name.c_str(), channel.units.c_str(),
                      channel.scale_factor, channel.add_offset});
      }
      streams_.add({sizeof(imunoise_stream), channels.size(), stream.name.c_str(), channels.data(),
                    stream.nominal_rate_hz, stream.counter_maximum, stream.device_time_tick_s});
    }
  }
  std::uint32_t size() const { return streams_.size(); }
  const imunoise_stream* const* data() const { return streams_.data(); }

 private:
  std::deque<PointerList<imunoise_channel>> channels_;  // a deque does not move what it holds
  PointerList<imunoise_stream> streams_;
};

/// Options as C structs. Borrows: the descriptions must outlive it, where they are.
class OptionTables {
 public:
  explicit OptionTables(const std::vector<drivers::Option>& options) {
    for (const drivers::Option& option : options) {
      std::vector<const char*>& choices = choices_.emplace_back();
      for (const std::string& choice : option.choices) choices.push_back(choice.c_str());
      const auto properties =
          static_cast<std::uint32_t>((option.required ? IMUNOISE_OPTION_REQUIRED : 0) |
                                     (option.repeated ? IMUNOISE_OPTION_REPEATED : 0));
      options_.add({sizeof(imunoise_option), static_cast<std::uint32_t>(option.type), properties,
                    static_cast<std::uint32_t>(choices.size()), option.name.c_str(),
                    option.description.c_str(), option.unit.c_str(),
                    option.by_default ? option.by_default->c_str() : nullptr, choices.data(),
                    option.minimum, option.maximum});
    }
  }
  std::uint32_t size() const { return options_.size(); }
  const imunoise_option* const* data() const { return options_.data(); }

 private:
  std::deque<std::vector<const char*>> choices_;
  PointerList<imunoise_option> options_;
};

}  // namespace imunoise::plugin
