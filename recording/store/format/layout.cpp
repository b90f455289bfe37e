#include "recording/store/format/layout.h"

#include <fmt/core.h>

#include <charconv>

namespace imunoise::recording {
namespace {

constexpr std::string_view kFolderPrefix = "replicate-";
constexpr std::string_view kReplicateManifestSuffix = ".json";

template <class Number>
std::optional<Number> positive(std::string_view digits) {
  Number out = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, out);
  if (error != std::errc{} || stop != end || out == 0) return std::nullopt;
  return out;
}

}  // namespace

bool is_broken(std::string_view name) {
  const std::size_t at = name.rfind(kBrokenSuffix);
  if (at == std::string_view::npos) return false;
  const std::string_view rest = name.substr(at + kBrokenSuffix.size());
  return rest.empty() || (rest.front() == '-' && positive<std::uint32_t>(rest.substr(1)));
}

std::string_view name_before(std::string_view broken) {
  return broken.substr(0, broken.rfind(kBrokenSuffix));
}

std::string replicate_folder(std::uint32_t replicate) {
  return fmt::format("{}{}", kFolderPrefix, replicate);
}

std::optional<std::uint32_t> replicate_of(std::string_view folder) {
  if (!folder.starts_with(kFolderPrefix)) return std::nullopt;
  return positive<std::uint32_t>(folder.substr(kFolderPrefix.size()));
}

std::string replicate_manifest(std::uint32_t replicate) {
  return replicate_folder(replicate).append(kReplicateManifestSuffix);
}

std::optional<std::uint32_t> replicate_of_manifest(std::string_view name) {
  if (!name.ends_with(kReplicateManifestSuffix)) return std::nullopt;
  return replicate_of(name.substr(0, name.size() - kReplicateManifestSuffix.size()));
}

std::string numbered(std::uint64_t number, std::string_view suffix) {
  return fmt::format("{:06}{}", number, suffix);
}

std::optional<std::uint64_t> number_of(std::string_view name, std::string_view suffix) {
  if (!name.ends_with(suffix)) return std::nullopt;
  const auto out = positive<std::uint64_t>(name.substr(0, name.size() - suffix.size()));
  if (!out || numbered(*out, suffix) != name) return std::nullopt;
  return out;
}

}  // namespace imunoise::recording
