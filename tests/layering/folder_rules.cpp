#include "tests/layering/folder_rules.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>

namespace imunoise::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSources = 25;

std::map<std::string, std::set<std::string>> sources_by_folder(const Tree& tree) {
  std::map<std::string, std::set<std::string>> out;
  for (const auto& [path, text] : tree) {
    out[fs::path(path).parent_path().generic_string()].insert(fs::path(path).stem().string());
  }
  return out;
}

// A folder with sources in it, or in a folder within it.
bool in_house(const Tree& tree, const std::string& folder) {
  const auto next = tree.lower_bound(folder + "/");
  return next != tree.end() && next->first.starts_with(folder + "/");
}

}  // namespace

std::vector<std::string> crowded_folders(const Tree& tree) {
  std::vector<std::string> out;
  for (const auto& [folder, sources] : sources_by_folder(tree)) {
    if (sources.size() > kMostSources) {
      out.push_back(folder + ": " + std::to_string(sources.size()) + " sources");
    }
  }
  return out;
}

std::set<std::string> read_maps(const std::string& project_root) {
  std::set<std::string> out;
  for (auto at = fs::recursive_directory_iterator(project_root);
       at != fs::recursive_directory_iterator(); ++at) {
    const std::string name = at->path().filename().string();
    if (at->is_directory() &&
        (name == "build" || name == "node_modules" || name.starts_with("."))) {
      at.disable_recursion_pending();
    } else if (name == "README.md") {
      out.insert(fs::relative(at->path(), project_root).generic_string());
    }
  }
  return out;
}

std::vector<std::string> folders_without_map(const Tree& tree, const std::set<std::string>& maps) {
  constexpr std::string_view kTests = "tests/";
  std::vector<std::string> out;
  for (const auto& [folder, sources] : sources_by_folder(tree)) {
    const bool mirrors = folder.starts_with(kTests) && in_house(tree, folder.substr(kTests.size()));
    if (!mirrors && !maps.contains(folder + "/README.md")) out.push_back(folder);
  }
  return out;
}

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> missing_places(const std::string& text, const std::string& project_root) {
  static const std::regex kPath("`([a-z_0-9]+/[a-z_0-9./]*)`");
  std::vector<std::string> out;
  for (std::sregex_iterator at(text.begin(), text.end(), kPath), end; at != end; ++at) {
    const std::string path = (*at)[1];
    if (!fs::exists(fs::path(project_root) / path)) out.push_back(path);
  }
  return out;
}

}  // namespace imunoise::testing
