#pragma once

// Recordings that lie in several files of one folder: the bags of ROS 2.

#include <filesystem>
#include <vector>

namespace imunoise::recording {

/// The pieces of a split bag in the folder, in order of their numbers (a_2 before a_10), packed or
/// not; empty: it is no such folder.
std::vector<std::filesystem::path> pieces_of(const std::filesystem::path& folder);

}  // namespace imunoise::recording
