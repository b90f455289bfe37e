#pragma once

#include "core/estimate/profile.h"

namespace imunoise {

/// Points from which to refine, best first: the `most` best of a scan over all combinations of the
/// processes' own grids, or, where those are too many, of a beam search that adds one term after
/// another. `base` (a smaller model's optimum, with the term `added` still open) restricts the scan
/// to that term.
std::vector<std::vector<double>> starting_points(const Profile& profile, std::size_t most);
std::vector<std::vector<double>> starting_points(const Profile& profile, std::size_t most,
                                                 const std::vector<double>& base,
                                                 std::size_t added);

}  // namespace imunoise
