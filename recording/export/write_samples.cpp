#include "recording/export/write_samples.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <set>

#include "core/support/counted.h"
#include "recording/export/formats.h"

namespace imunoise::recording {
namespace {

bool has_control_characters(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x20; });
}

Result<void> check(const std::string& file, std::span<const OutputChannel> channels, Hertz rate,
                   const Metadata& metadata) {
  if (channels.empty() || channels.front().values.empty()) {
    return fail(fmt::format("{}: there is nothing to write", file));
  }
  if (!std::isfinite(rate.value) || rate.value <= 0.0) {
    return fail(fmt::format("{}: {} Hz is not a sampling rate", file, rate.value));
  }
  std::set<std::string> names;
  for (const OutputChannel& channel : channels) {
    if (channel.name.empty() || channel.name == "." || has_control_characters(channel.name) ||
        channel.name.find('/') != std::string::npos || !names.insert(channel.name).second) {
      return fail(
          fmt::format("{}: '{}' cannot name a channel: names are not empty, not used twice, "
                      "without '/' and control characters",
                      file, channel.name));
    }
    if (channel.values.size() != channels.front().values.size()) {
      return fail(fmt::format("{}: channel {} has {} where {} has {}", file, channel.name,
                              counted(channel.values.size(), "sample"), channels.front().name,
                              channels.front().values.size()));
    }
    const auto bad = std::find_if(channel.values.begin(), channel.values.end(),
                                  [](double value) { return !std::isfinite(value); });
    if (bad != channel.values.end()) {
      return fail(fmt::format("{}: channel {}: sample {} is not finite", file, channel.name,
                              bad - channel.values.begin()));
    }
  }
  for (const auto& [key, value] : metadata) {
    if (key.empty() || key == "rate_hz" || has_control_characters(key)) {
      return fail(fmt::format("{}: '{}' cannot name a piece of metadata", file, key));
    }
  }
  return {};
}

}  // namespace

Result<void> write_samples(const std::filesystem::path& path,
                           std::span<const OutputChannel> channels, Hertz rate,
                           const Metadata& metadata) {
  const std::string file = path.string();
  const Result<void> sound = check(file, channels, rate, metadata);
  if (!sound) return sound;
  const std::filesystem::path extension = path.extension();
  try {
    if (extension == ".h5" || extension == ".hdf5") {
      return write_hdf5(path, channels, rate, metadata);
    }
    if (extension == ".csv") return write_csv(path, channels, rate, metadata);
    if (extension == ".npy") return write_npy(path, channels, rate, metadata);
  } catch (const std::exception& error) {
    return fail(fmt::format("{}: cannot be written: {}", file, error.what()));
  }
  return fail(fmt::format("{}: no format is known for '{}'; known are .h5, .csv and .npy", file,
                          extension.string()));
}

}  // namespace imunoise::recording
