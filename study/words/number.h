#pragma once

// How people read numbers: the one home of rounding and spelling for every renderer.

#include <cstdint>
#include <string>

#include "core/support/counted.h"

namespace imunoise::report {

enum class Digits {
  kPlain,    ///< "-1.2e-9": can be copied into a program.
  kTypeset,  ///< "−1.2×10⁻⁹": true minus sign and superscripts.
};

/// `value` with so many significant digits; scientific below 1e-3 and from 1e5. "n/a" if not
/// finite.
std::string number(double value, int significant, Digits style);

/// A number within a sentence, without zeros at its end: "0.25", "20", "1536".
std::string brief(double value, int significant = 3, Digits style = Digits::kTypeset);

/// Value and interval rounded to the interval's precision (two digits of its half-width when they
/// are 10 to 35, else one): "0.1175 (0.1171 … 0.1180)", "3.21 (3.15 … 3.27) ×10⁻⁹". The value
/// alone, with four significant digits, when there is no interval (lower ≥ upper, or not finite).
std::string with_interval(double value, double lower, double upper, Digits style);

/// The value alone, rounded alike: "0.1175".
std::string rounded(double value, double lower, double upper, Digits style);

/// The interval alone, rounded alike: "0.1171 … 0.1180"; "" when there is none.
std::string interval(double value, double lower, double upper, Digits style);

/// A time people can picture: "20 ms", "2.6 s", "44 min", "1.5 h", "3 d".
std::string duration(double seconds);

/// A day and a minute in UTC, of nanoseconds since 1970-01-01: "2026-11-22", "2026-11-22 06:40";
/// "unknown" for 0.
std::string day(std::int64_t ns);
std::string minute(std::int64_t ns);

/// Two times, with as many decimals as tell the ends of a part that long: "120 to 240", "0.25 to
/// 0.50".
std::string stretch(double from, double until);

/// A p-value: two digits; "< 0.0001" below that.
std::string p_value(double value, Digits style);

/// "37 %"; "< 1 %" when it is not quite nothing.
std::string percent(double fraction);

/// An integer in groups of three: "1 000 000", with narrow spaces when typeset.
std::string count(std::uint64_t value, Digits style = Digits::kPlain);

/// A residual with its sign: "+3.1", "−0.4".
std::string signed_sigma(double value, Digits style);

/// A round number on an axis, as short as it goes: "0.02", "5", "1000".
std::string tick_label(double value);

/// An integer exponent in superscript characters: "⁻⁹".
std::string superscript(int exponent);

}  // namespace imunoise::report
