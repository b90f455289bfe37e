#include "drivers/can/codec/candump.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <utility>

#include "drivers/can/frame_streams.h"
#include "drivers/replay/wire/codec.h"

namespace imunoise::replay {
namespace {

constexpr std::size_t kLongestLine = 4096;  // far beyond any frame's
constexpr double kShortest = 1e-3;          // s, that a log takes

class CandumpCodec final : public WireCodec {
 public:
  CandumpCodec(const std::filesystem::path& file, drivers::CanChannels channels,
               std::string product, std::optional<double> rate_hz)
      : path_(file),
        product_(std::move(product)),
        channels_(std::move(channels)),
        streams_(make_streams(channels_)) {
    open();
    std::optional<std::int64_t> begin_ns;
    while (read_frame()) {
      if (!begin_ns) begin_ns = time_ns_;
      streams_.hear(frame_, time_ns_);
    }
    const double seconds = 1e-9 * static_cast<double>(time_ns_ - begin_ns.value_or(time_ns_));
    const auto left_out = streams_.settle(rate_hz, std::max(seconds, kShortest));
    if (streams_.streams().empty() && !left_out.empty()) {
      throw plugin::DeviceError(
          IMUNOISE_BAD_OPTION,
          fmt::format("{}: message {} comes once, which tells no rate; give it (rate=100)",
                      path_.string(), left_out.front().message().name));
    }
    if (streams_.streams().empty()) {
      throw plugin::DeviceError(
          IMUNOISE_BAD_OPTION,
          fmt::format("{}: no line of candump -L with a message of {}; is it another IMU's?",
                      path_.string(), product_));
    }
    open();
  }

  drivers::DeviceInfo info() const override { return {streams_.descriptions(), product_}; }

  std::optional<std::int64_t> next() override {
    if (!read_frame()) return std::nullopt;
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

  void open() {
    file_ = std::ifstream(path_, std::ios::binary);
    if (!file_ || std::filesystem::is_directory(path_)) {
      throw plugin::DeviceError(IMUNOISE_NOT_FOUND,
                                path_.string() + ": cannot be read; is it there?");
    }
  }

  // The next line that is a frame of data.
  bool read_frame() {
    while (std::getline(file_, line_)) {
      if (!line_.empty() && line_.back() == '\r') line_.pop_back();
      if (line_.size() > kLongestLine) continue;
      const auto read = drivers::parse_candump_line(line_);
      if (!read || read->frame.error || read->frame.remote) continue;
      frame_ = read->frame;
      time_ns_ = read->time_ns;
      return true;
    }
    return false;
  }

  std::filesystem::path path_;
  std::string product_;
  drivers::CanChannels channels_;
  imunoise::can::FrameStreams streams_;
  std::ifstream file_;
  std::string line_;
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
