#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "drivers/can/codec/candump_reader.h"
#include "drivers/can/frame_streams.h"
#include "drivers/replay/wire/codec.h"
#include "drivers/replay/wire/parsed_file.h"

namespace imunoise::replay {
namespace {

constexpr double kShortest = 1e-3;  // s, that a log takes

using LogFile = ParsedFile<drivers::CandumpReader>;

class CandumpCodec final : public WireCodec {
 public:
  CandumpCodec(const std::filesystem::path& file, drivers::CanChannels channels,
               std::string product, std::optional<double> rate_hz)
      : product_(std::move(product)),
        channels_(std::move(channels)),
        streams_(make_streams(channels_)),
        log_(file) {
    LogFile whole(file);
    std::optional<std::int64_t> begin_ns;
    while (read_frame(whole)) {
      if (!begin_ns) begin_ns = time_ns_;
      streams_.hear(frame_, time_ns_);
    }
    const double seconds = 1e-9 * static_cast<double>(time_ns_ - begin_ns.value_or(time_ns_));
    const auto left_out = streams_.settle(rate_hz, std::max(seconds, kShortest));
    if (streams_.streams().empty() && !left_out.empty()) {
      throw plugin::DeviceError(
          IMUNOISE_BAD_OPTION,
          fmt::format("{}: message {} comes once, which tells no rate; give it (rate=100)",
                      file.string(), left_out.front().message().name));
    }
    if (streams_.streams().empty()) {
      throw plugin::DeviceError(
          IMUNOISE_BAD_OPTION,
          fmt::format("{}: no line of candump -L with a message of {}; is it another IMU's?",
                      file.string(), product_));
    }
    for (const imunoise::can::CanStream& one : left_out) {
      notes_.push_back(
          fmt::format("{}: message {} comes once, which tells no rate; it is left out (rate=100 "
                      "records it)",
                      file.string(), one.message().name));
    }
  }

  drivers::DeviceInfo info() const override { return {streams_.descriptions(), product_}; }

  std::vector<std::string> notes() const override { return notes_; }

  std::optional<std::int64_t> next() override {
    if (!read_frame(log_)) return std::nullopt;
    if (!first_ns_) first_ns_ = time_ns_;
    return time_ns_ - *first_ns_;
  }

  void take(std::int64_t host_time_ns, plugin::Samples& samples) override {
    streams_.take(frame_, host_time_ns, samples);
  }

 private:
  static imunoise::can::FrameStreams make_streams(const drivers::CanChannels& channels) {
    auto streams = imunoise::can::FrameStreams::make(channels);
    if (!streams) throw plugin::DeviceError(IMUNOISE_BAD_OPTION, streams.error().message);
    return std::move(*streams);
  }

  // The next frame of data.
  bool read_frame(LogFile& log) {
    while (const auto line = log.next()) {
      if (line->frame.error || line->frame.remote) continue;
      frame_ = line->frame;
      time_ns_ = line->time_ns;
      return true;
    }
    return false;
  }

  std::string product_;
  std::vector<std::string> notes_;
  drivers::CanChannels channels_;
  imunoise::can::FrameStreams streams_;
  LogFile log_;
  drivers::CanFrame frame_;
  std::int64_t time_ns_ = 0;
  std::optional<std::int64_t> first_ns_;
};

}  // namespace

std::unique_ptr<WireCodec> open_candump(const std::filesystem::path& file,
                                        drivers::CanChannels channels, std::string product,
                                        std::optional<double> rate_hz) {
  return std::make_unique<CandumpCodec>(file, std::move(channels), std::move(product), rate_hz);
}

}  // namespace imunoise::replay
