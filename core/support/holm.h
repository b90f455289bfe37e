#pragma once

#include <span>
#include <vector>

namespace imunoise {

/// p-values corrected for their number, in the order given, each at most 1: the smallest times
/// their number, the next times one less, and so on, never falling. The chance that any of them is
/// below a level, were all null hypotheses true, is at most that level. Source: Holm (1979),
/// Scandinavian Journal of Statistics 6, 65-70.
std::vector<double> holm(std::span<const double> p_values);

}  // namespace imunoise
