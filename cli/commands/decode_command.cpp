#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "cli/commands/commands.h"
#include "cli/output.h"
#include "core/support/json_text.h"
#include "drivers/adis16405/codec/decoder.h"
#include "drivers/adis16405/codec/registers.h"
#include "drivers/can/codec/dbc.h"
#include "drivers/can/codec/dbc_file.h"
#include "drivers/can/codec/decoder.h"
#include "drivers/can/codec/presets.h"
#include "drivers/xsens/codec/decoder.h"

namespace imunoise::cli {
namespace {

using drivers::DecodedSample;
using drivers::StreamDecoder;
using drivers::Tally;
using drivers::WireFormat;
using DecoderPointer = std::unique_ptr<StreamDecoder>;

constexpr std::size_t kBlockBytes = std::size_t{1} << 16U;

Result<drivers::CanChannels> can_channels(const DecodeArguments& arguments) {
  if (!arguments.dbc) {
    if (arguments.preset.empty()) {
      return fail(
          fmt::format("candump: what the messages mean is needed: --dbc FILE, or --preset "
                      "with one of {}",
                      fmt::join(drivers::preset_names(), ", ")));
    }
    return drivers::make_preset(arguments.preset);
  }
  const auto text = drivers::read_dbc_text(*arguments.dbc);
  if (!text) return tl::unexpected(text.error());
  Result<drivers::CanDatabase> database = drivers::parse_dbc(*text, arguments.dbc->string());
  if (!database) return tl::unexpected(database.error());
  return drivers::CanChannels::make(std::move(*database), {});
}

Result<DecoderPointer> make_decoder(const DecodeArguments& arguments) {
  switch (arguments.format) {
    case WireFormat::kXbus:
      break;
    case WireFormat::kCandump: {
      Result<drivers::CanChannels> channels = can_channels(arguments);
      if (!channels) return tl::unexpected(channels.error());
      return DecoderPointer(std::make_unique<drivers::CandumpDecoder>(std::move(*channels)));
    }
    case WireFormat::kAdis16405: {
      const auto scales = drivers::adis16405::count_scales(arguments.sens_avg);
      if (!scales) return tl::unexpected(scales.error());
      return DecoderPointer(std::make_unique<drivers::adis16405::BurstDecoder>(
          *scales, drivers::adis16405::sample_rate(arguments.smpl_prd)));
    }
  }
  return DecoderPointer(std::make_unique<drivers::XbusDecoder>());
}

// Texts are UTF-8: from the program, the database, interface names in ASCII.
void append_line(std::string& out, const DecodedSample& sample) {
  out += "{\"stream\":";
  append_json_string(out, sample.stream);
  if (!sample.source.empty()) {
    out += ",\"source\":";
    append_json_string(out, sample.source);
  }
  if (sample.clock != drivers::Clock::kNone) {
    const bool before_zero = sample.time_ns < 0;
    const auto ns = static_cast<std::uint64_t>(before_zero ? -sample.time_ns : sample.time_ns);
    fmt::format_to(std::back_inserter(out), ",\"time_s\":{}{}.{:09},\"clock\":\"{}\"",
                   before_zero ? "-" : "", ns / 1'000'000'000, ns % 1'000'000'000,
                   drivers::name_of(sample.clock));
  }
  if (sample.counter) fmt::format_to(std::back_inserter(out), ",\"counter\":{}", *sample.counter);
  out += ",\"values\":{";
  for (const drivers::DecodedValue& value : sample.values) {
    if (&value != &sample.values.front()) out += ',';
    append_json_string(out, value.channel);
    fmt::format_to(std::back_inserter(out), ":{{\"value\":{},\"unit\":", value.value);
    append_json_string(out, value.unit);
    out += '}';
  }
  out += "},\"flags\":[";
  for (const std::string_view& flag : sample.flags) {
    if (&flag != &sample.flags.front()) out += ',';
    append_json_string(out, flag);
  }
  out += "]}\n";
}

// Calls visit(reason, count) for what was refused.
template <class Visit>
void for_each_refusal(const Tally& tally, Visit visit) {
  for (std::size_t i = 0; i < drivers::kRefusals; ++i) {
    const auto reason = static_cast<drivers::Refusal>(i);
    if (tally.refused.count(reason) > 0) visit(reason, tally.refused.count(reason));
  }
}

std::string summary_json(const DecodeArguments& arguments, std::uint64_t bytes,
                         const Tally& tally) {
  std::string out = fmt::format(
      "{{\"summary\":{{\"format\":\"{}\",\"bytes\":{},\"samples\":{},\"lost\":{},"
      "\"other_messages\":{},\"refused\":{{",
      name_of(arguments.format), bytes, tally.samples, tally.lost, tally.other_messages);
  bool first = true;
  for_each_refusal(tally, [&](drivers::Refusal reason, std::uint64_t count) {
    out += fmt::format("{}\"{}\":{{\"count\":{},\"meaning\":\"{}\"}}",
                       std::exchange(first, false) ? "" : ",", drivers::name_of(reason), count,
                       drivers::meaning_of(reason));
  });
  return out + "}}}\n";
}

std::string summary_text(const DecodeArguments& arguments, std::uint64_t bytes,
                         const Tally& tally) {
  std::string out = fmt::format(
      "{}: {}: {} samples from {} bytes; {} lost, as the device's counter says; {} other "
      "messages\n",
      arguments.file, name_of(arguments.format), tally.samples, bytes, tally.lost,
      tally.other_messages);
  for_each_refusal(tally, [&](drivers::Refusal reason, std::uint64_t count) {
    out += fmt::format("refused {:>8} {:<17} {}\n", count, drivers::name_of(reason),
                       drivers::meaning_of(reason));
  });
  return tally.refused.none() ? out + "refused nothing\n" : out;
}

// A descriptor, because fread() would wait for a whole block of a live pipe.
class Input {
 public:
  /// "-" is standard input. Error: the file cannot be opened.
  static Result<Input> open(const std::string& name) {
    if (name == "-") return Input(STDIN_FILENO);
    const int descriptor = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return fail(fmt::format("{}: {}", name, std::strerror(errno)));
    return Input(descriptor);
  }
  Input(Input&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  ~Input() {
    if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
  }
  Input& operator=(Input&&) = delete;

  /// Bytes read into `block`, 0 at the end. Error: errno's text.
  Result<std::size_t> read(std::vector<std::uint8_t>& block) const {
    while (true) {
      const ssize_t got = ::read(descriptor_, block.data(), block.size());
      if (got >= 0) return static_cast<std::size_t>(got);
      if (errno != EINTR) return fail(std::strerror(errno));
    }
  }

 private:
  explicit Input(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace

int run(const DecodeArguments& arguments) {
  const Result<DecoderPointer> made = make_decoder(arguments);
  if (!made) return print_error(made.error());
  StreamDecoder& decoder = **made;
  const Result<Input> input = Input::open(arguments.file);
  if (!input) return print_error(input.error());
  std::vector<std::uint8_t> block(kBlockBytes);
  std::string lines;
  DecodedSample sample;
  std::uint64_t bytes = 0;
  for (bool more = true; more;) {
    const Result<std::size_t> got = input->read(block);
    if (!got) return print_error({fmt::format("{}: {}", arguments.file, got.error().message)});
    bytes += *got;
    more = *got > 0;
    if (more) {
      decoder.push(drivers::Bytes(block).first(*got));
    } else {
      decoder.finish();
    }
    while (decoder.next(sample)) append_line(lines, sample);
    print(lines);
    std::fflush(stdout);  // a live pipe's samples are seen as they come
    lines.clear();
  }
  const Tally& tally = decoder.tally();
  if (arguments.json) {
    print(summary_json(arguments, bytes, tally));
  } else {
    fmt::print(stderr, "{}", summary_text(arguments, bytes, tally));
  }
  if (tally.samples > 0) return 0;
  return print_error(
      {fmt::format("{}: no samples; is this {}?", arguments.file, name_of(arguments.format))});
}

}  // namespace imunoise::cli
