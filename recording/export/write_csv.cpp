#include <fmt/format.h>

#include <iterator>

#include "recording/export/formats.h"
#include "recording/export/output_file.h"

namespace imunoise::recording {
namespace {

std::string header_field(const OutputChannel& channel) {
  const std::string text = fmt::format("{} [{}]", channel.name, channel.unit.symbol);
  if (text.find_first_of(",\"") == std::string::npos && text.front() != '#') return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

}  // namespace

Result<void> write_csv(const std::filesystem::path& path, std::span<const OutputChannel> channels,
                       Hertz rate, const Metadata& metadata) {
  constexpr std::size_t block = std::size_t{1} << 20U;  // bytes
  OutputFile file(path);
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  // Metadata first: a last comment that looks like a header could be taken for one.
  for (const auto& [key, value] : metadata) fmt::format_to(out, "# {}: {}\n", key, one_line(value));
  fmt::format_to(out, "# rate_hz: {}\n", rate.value);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    fmt::format_to(out, "{}{}", c == 0 ? "" : ",", header_field(channels[c]));
  }
  text.push_back('\n');
  for (std::size_t i = 0; i < channels.front().values.size(); ++i) {
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (c > 0) text.push_back(',');
      fmt::format_to(out, "{}", channels[c].values[i]);
    }
    text.push_back('\n');
    if (text.size() >= block) {
      file.write({text.data(), text.size()});
      text.clear();
    }
  }
  file.write({text.data(), text.size()});
  return file.finish();
}

}  // namespace imunoise::recording
