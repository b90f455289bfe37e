#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/plugin/device.h"
#include "drivers/text/codec/arrival.h"
#include "drivers/text/codec/lines.h"
#include "drivers/text/codec/row.h"
#include "drivers/text/source/source.h"

namespace imunoise::text {

/// What the user chose.
struct Settings {
  SourcePlace place;
  std::optional<std::string> columns;  ///< none: the device prints a header
  LineForm form;
  std::optional<double> rate_hz;  ///< none: measured while listening
  std::chrono::milliseconds listen{2000};
  std::uint64_t counter_maximum = 0;
};

/// A line, and when its end came, ns of the host's clock.
struct ArrivedLine {
  std::string text;
  std::int64_t host_time_ns = 0;
};

/// A device that prints a line a sample. It is listened to at the beginning, to learn its columns
/// and rate; what is heard then is delivered, too. A source that closes, fails or falls silent is
/// opened again.
class TextDevice final : public plugin::Device {
 public:
  /// Opens the source and listens.
  TextDevice(Settings settings, const plugin::Host& host);

  drivers::DeviceInfo describe() override;
  void read(plugin::Samples& samples, const plugin::Wait& wait) override;

 private:
  using Clock = plugin::Wait::Clock;

  void open(const plugin::Wait& wait);
  bool reopen(const plugin::Wait& wait);
  void listen();
  void learn_columns();
  void learn_rate();
  void hear();
  void take(std::string_view line, std::int64_t now_ns);
  void deliver(plugin::Samples& samples);
  void add(const ArrivedRow& one, plugin::Samples& samples);
  std::string first_line() const;
  [[noreturn]] void refuse(const std::string& what) const;

  Settings settings_;
  plugin::Host host_;
  plugin::WireTap wire_;
  std::unique_ptr<Source> source_;  // none while it is away
  LineReader lines_;
  std::vector<ArrivedLine> heard_;  // not delivered yet
  bool midway_ = false;             // the next line may have begun before it was listened to
  bool ended_ = false;
  std::optional<RowReader> rows_;
  drivers::Stream stream_;
  std::uint32_t flags_ = IMUNOISE_SAMPLE_AFTER_RESTART;  // of the next row
  std::int64_t last_host_ns_ = 0;
  std::optional<std::int64_t> last_time_ns_;
  Clock::time_point last_line_;
  Clock::duration patience_{};
};

}  // namespace imunoise::text
