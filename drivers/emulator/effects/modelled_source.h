#pragma once

// What an emulated sensor measures: at rest, with the noise of any model and any effects.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/model/model_sampler.h"
#include "core/support/result.h"
#include "drivers/emulator/effects/effect_catalogue.h"
#include "drivers/emulator/measurement/quantity.h"
#include "drivers/emulator/measurement/sample_source.h"

namespace imunoise::emulator {

/// A sensor that lies still: 1 g upwards along z, 45 µT of which half points north, 25 °C, 5 V.
Measurement at_rest();

/// As the user says it.
struct SourceTexts {
  /// "QUANTITY: MODEL" as in "gyro: WN(sigma2=1e-6) + RW(gamma2=1e-12)", with every value given;
  /// without a quantity it is the gyroscopes'. Per sample, SI. A later one of a quantity replaces
  /// an earlier one. None at all: white noise and random walk as in a datasheet.
  std::vector<std::string> models = {};
  std::vector<std::string> effects = {};  ///< As add_effect() takes them.
  std::uint64_t seed = 1;
  Hertz rate{100.0};  ///< For models that count in seconds.
};

/// Constants, effects, noise and limits, in this order, in bounded memory. The same texts and times
/// give the same numbers; axes and quantities have noise of their own, whatever the others have.
class ModelledSource final : public SampleSource {
 public:
  /// Error: a text that cannot be read, and why.
  static Result<std::unique_ptr<ModelledSource>> make(const SourceTexts& texts);

  Measurement measure(double time) override;

 private:
  ModelledSource() = default;
  Result<void> add_model(std::string_view text, const SourceTexts& texts);
  Moment moment_of(double time);

  std::array<std::optional<ModelSampler>, kQuantities.size()> noise_;
  Effects effects_;
  std::optional<double> last_;        // time of the last sample
  double before_power_failed_ = 0.0;  // s
};

}  // namespace imunoise::emulator
