#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "drivers/emulator/effects/modelled_source.h"

namespace imunoise::testing {

inline constexpr const char* kSilent = "gyro: WN(sigma2=0)";

/// A source that must be made.
inline std::unique_ptr<emulator::ModelledSource> make_source(emulator::SourceTexts texts) {
  auto out = emulator::ModelledSource::make(texts);
  if (!out) throw std::runtime_error(out.error().message);
  return std::move(*out);
}

/// Without noise, so that effects stand alone.
inline std::unique_ptr<emulator::ModelledSource> silent_source(std::vector<std::string> effects,
                                                               std::uint64_t seed = 1) {
  return make_source({.models = {kSilent}, .effects = std::move(effects), .seed = seed});
}

/// n samples of the gyroscope about x, taken `rate` times a second from time 0.
inline std::vector<double> take_gyro_x(emulator::SampleSource& source, std::size_t n, double rate) {
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = source.measure(static_cast<double>(i) / rate).rate[0];
  }
  return out;
}

}  // namespace imunoise::testing
