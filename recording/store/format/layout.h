#pragma once

// Where things lie in a recording's folder, and what their names say.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace imunoise::recording {

inline constexpr std::string_view kManifestName = "manifest.json";
inline constexpr std::string_view kChunkSuffix = ".h5";
inline constexpr std::string_view kJournalSuffix = ".journal";
/// Appended to what was damaged and set aside.
inline constexpr std::string_view kBrokenSuffix = ".broken";

/// "000012.h5.broken", "000012.h5.broken-2"
bool is_broken(std::string_view name);
/// What it was called before it was set aside.
std::string_view name_before(std::string_view broken);

/// "replicate-1"
std::string replicate_folder(std::uint32_t replicate);
/// The inverse; nothing for another name.
std::optional<std::uint32_t> replicate_of(std::string_view folder);

/// "replicate-1.json", the manifest of the replicate; beside its folder, so that the one is there
/// when the other is lost
std::string replicate_manifest(std::uint32_t replicate);
/// The inverse; nothing for another name.
std::optional<std::uint32_t> replicate_of_manifest(std::string_view name);

/// "000012.h5": segment and chunk of one number hold the same samples.
std::string numbered(std::uint64_t number, std::string_view suffix);
/// The number of "000012.h5"; nothing for another name or suffix.
std::optional<std::uint64_t> number_of(std::string_view name, std::string_view suffix);

}  // namespace imunoise::recording
