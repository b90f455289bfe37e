#pragma once

#include <span>
#include <string>
#include <string_view>

namespace imunoise {

/// "did you mean WN (angle random walk)?" of a name that is no process or effect: by the names that
/// data sheets, IEEE Std 952 and other programs use (ARW, RRW, BI, RR, Q, GM1, SIN ...), else by
/// the nearest of the known names; "" where there is none. Case does not matter.
std::string meant_by(std::string_view name, std::span<const std::string> known);

}  // namespace imunoise
