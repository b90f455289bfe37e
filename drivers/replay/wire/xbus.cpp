#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "drivers/replay/wire/codec.h"
#include "drivers/replay/wire/parsed_file.h"
#include "drivers/xsens/codec/frame.h"
#include "drivers/xsens/codec/items.h"
#include "drivers/xsens/codec/mtdata2.h"
#include "drivers/xsens/refusal_counter.h"
#include "drivers/xsens/rows.h"

namespace imunoise::replay {
namespace {

using drivers::XbusFrame;
using drivers::XsensMessage;
using drivers::XsensOutput;

constexpr std::size_t kLook = 1000;  // messages that tell the outputs of a capture without a start
constexpr double kTicksPerSecond = 1e4;

XsensMessage message_of(const XbusFrame& frame) {
  return static_cast<XsensMessage>(frame.message_id);
}

bool acknowledges(const XbusFrame& frame, XsensMessage request) {
  return frame.message_id == drivers::acknowledged_by(request);
}

// What messages of measured data tell of the outputs that they were configured to.
class Outputs {
 public:
  std::size_t messages() const { return messages_; }

  void prepare_channel(const XbusFrame& frame) {
    ++messages_;
    drivers::Refusals ignored;
    drivers::decode_mtdata2(frame.payload, data_, ignored);
    if (data_.sample_time_fine) {
      if (!first_ticks_) first_ticks_ = data_.sample_time_fine;
      last_ticks_ = *data_.sample_time_fine;
    }
    std::set<std::uint16_t> seen;  // an item may stand in a message twice
    for (drivers::Bytes rest = frame.payload; const auto item = drivers::take_item(rest);) {
      if (!seen.insert(item->id).second) continue;
      if (counts_[item->id]++ == 0) order_.push_back(item->id);
    }
  }

  // Their order is that of the messages. `rate_hz`: of messages, where the user says it.
  std::vector<XsensOutput> found(std::optional<double> rate_hz) const {
    const double rate = rate_hz.value_or(measured_rate());
    std::vector<XsensOutput> out;
    for (const std::uint16_t id : order_) {
      const double share = static_cast<double>(counts_.at(id)) /
                           static_cast<double>(std::max<std::size_t>(1, messages_));
      const double times = std::max(1.0, std::round(1.0 / share));
      out.push_back({id, static_cast<std::uint16_t>(std::lround(rate / times))});
    }
    return out;
  }

 private:
  double measured_rate() const {
    const double ticks =
        first_ticks_ && last_ticks_ > *first_ticks_ ? last_ticks_ - *first_ticks_ : 0.0;
    if (ticks == 0.0) return 100.0;  // as from the factory
    return std::min(2000.0, static_cast<double>(messages_ - 1) * kTicksPerSecond / ticks);
  }

  std::size_t messages_ = 0;
  drivers::MtData2 data_;
  std::optional<std::uint32_t> first_ticks_;
  std::uint32_t last_ticks_ = 0;
  std::map<std::uint16_t, std::size_t> counts_;
  std::vector<std::uint16_t> order_;
};

using Frames = ParsedFile<drivers::XbusParser>;

struct Beginning {
  xsens::Setup setup;
  bool started = false;  // measurement begins within the capture
};

Beginning prepare_channel(const std::filesystem::path& path, std::optional<double> rate_hz) {
  Beginning out;
  Outputs outputs;
  bool configured = false;
  Frames frames(path);
  while (const auto frame = frames.next()) {
    xsens::identify_by(*frame, out.setup);
    if (message_of(*frame) == XsensMessage::kOutputConfiguration) {
      const auto sent = drivers::decode_output_configuration(frame->payload);
      if (!sent || sent->empty()) continue;
      out.setup.sends = *sent;
      configured = true;
    } else if (message_of(*frame) == XsensMessage::kConfiguration) {
      const auto sent = drivers::decode_configuration(frame->payload);
      if (!sent) continue;
      out.setup.sends = *sent;
      configured = true;
    } else if (message_of(*frame) == XsensMessage::kMtData2 && outputs.messages() < kLook) {
      outputs.prepare_channel(*frame);
    } else if (acknowledges(*frame, XsensMessage::kGoToMeasurement) && configured) {
      out.started = true;
      return out;
    }
  }
  if (configured) return out;
  out.setup.sends = outputs.found(rate_hz);
  if (outputs.messages() > 0) return out;
  throw plugin::DeviceError(
      IMUNOISE_BAD_OPTION,
      path.string() +
          ": no Xbus frame of MTData2, nor a Configuration message before legacy "
          "MTData; what each message says: imunoise decode --format xbus");
}

class XbusCodec final : public WireCodec {
 public:
  XbusCodec(const std::filesystem::path& path, std::optional<double> rate_hz)
      : beginning_(prepare_channel(path, rate_hz)),
        rows_(make_rows(path, beginning_.setup)),
        rate_hz_(rows_->streams().front().nominal_rate_hz),
        frames_(path),
        measures_(!beginning_.started) {}

  drivers::DeviceInfo info() const override {
    const xsens::Setup& setup = beginning_.setup;
    return {rows_->streams(), setup.product, setup.serial, setup.firmware};
  }

  std::optional<std::int64_t> next() override {
    while (const auto frame = frames_.next()) {
      if (acknowledges(*frame, XsensMessage::kGoToMeasurement)) {
        measures_ = true;
        rows_->restart();
        refused_.begin(frames_.parser());
      } else if (acknowledges(*frame, XsensMessage::kGoToConfig)) {
        measures_ = false;
      } else if (message_of(*frame) == XsensMessage::kWakeUp) {
        rows_->restart();
      }
      const bool sample = message_of(*frame) == XsensMessage::kMtData2 ||
                          message_of(*frame) == XsensMessage::kMtData;
      if (!sample || !measures_) continue;
      frame_ = *frame;
      return std::llround(static_cast<double>(count_++) / rate_hz_ * 1e9);
    }
    return std::nullopt;
  }

  void take(std::int64_t host_time_ns, plugin::Samples& samples) override {
    refused_.count(frames_.parser(), samples);
    rows_->add(frame_, host_time_ns, samples);
  }

 private:
  static std::unique_ptr<xsens::RowMaker> make_rows(const std::filesystem::path& path,
                                                    const xsens::Setup& setup) {
    auto out = xsens::RowMaker::make(setup);
    if (!out->streams().empty() && !out->streams().front().channels.empty() &&
        out->streams().front().nominal_rate_hz > 0.0) {
      return out;
    }
    throw plugin::DeviceError(IMUNOISE_BAD_OPTION,
                              path.string() + ": its messages carry no numbers to record");
  }

  Beginning beginning_;
  std::unique_ptr<xsens::RowMaker> rows_;
  double rate_hz_;
  Frames frames_;
  xsens::RefusalCounter refused_;
  bool measures_;
  XbusFrame frame_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<WireCodec> open_xbus(const std::filesystem::path& file,
                                     std::optional<double> rate_hz) {
  return std::make_unique<XbusCodec>(file, rate_hz);
}

}  // namespace imunoise::replay
