#pragma once

#include <google/protobuf/repeated_ptr_field.h>

#include <string>

#include "imunoise/v1/noise.pb.h"
#include "study/words/number.h"

namespace imunoise::report {

enum class UnitSystem {
  kDatasheet,  ///< °/√h, µg; SI where no other unit is customary
  kSi,
};

/// "0.1719 (0.1717 … 0.1721) °/√h"; without an interval three digits. Thread-safe.
std::string value_words(const v1::Coefficient& one, Digits digits,
                        UnitSystem system = UnitSystem::kDatasheet);

/// The value alone: "0.172 °/√h"; "at most 40 (°/h)/√h" where it may be 0.
std::string short_words(const v1::Coefficient& one, Digits digits,
                        UnitSystem system = UnitSystem::kDatasheet);

/// All on one line: "N 0.172 °/√h, σ 20.3 °/h, T 4.89 s, K 31.8 (°/h)/√h".
std::string short_words(const google::protobuf::RepeatedPtrField<v1::Coefficient>& all,
                        Digits digits);

/// Of all terms of a model, in order.
std::string short_words(const google::protobuf::RepeatedPtrField<v1::Term>& terms, Digits digits);

}  // namespace imunoise::report
