#include "tests/layering/plain_english.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

namespace imunoise::testing {
namespace {

struct Riddle {
  std::regex pattern;
  std::string remedy;
};

const std::vector<Riddle>& refused() {
  static const auto words = [](const char* pattern) {
    return std::regex(pattern, std::regex::icase | std::regex::optimize);
  };
  static const std::vector<Riddle> kRefused = {
      {words(R"(\b(whoever|nobody|somebody)\b)"), "say who does it"},
      {words(R"(\b(shall|lest|heeded)\b)"), "write it in everyday words"},
      {words(R"(\b(is|are|was|were) told\b)"), "say who reports what"},
      {words(R"(\b(is|was) gone\b)"), "say what happened: not found, unplugged, deleted"},
      {words(R"(\b(is|are) no (number|regular|chunk|count|terminal|recording|identifier)\b)"),
       "write 'is not a ...'"},
      {words(R"(\bof freedoms?\b|\bfreedoms?\b)"), "degrees of freedom"},
      {words(R"(\bchance of a false alarm\b)"), "false-alarm probability"},
      {words(R"(\berror on replicates not used\b)"), "held-out error"},
      {words(R"(\bnine times in ten\b)"), "90 % power"}};
  return kRefused;
}

// "degrees of freedom" is the term that "freedom" alone hides.
std::string without_terms(const std::string& line) {
  static const std::regex kTerm("degrees? of freedom", std::regex::icase);
  return std::regex_replace(line, kTerm, "df");
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool is_prose(const std::string& path) {
  return path.ends_with(".md") && path != "CHANGELOG.md" && path != "DECISIONS.md";
}

}  // namespace

std::string quoted_only(const std::string& source) {
  std::string out;
  bool inside = false;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const char c = source[i];
    if (c == '\n') {
      inside = false;
      out += c;
    } else if (!inside && source.compare(i, 2, "//") == 0) {
      i = std::min(source.find('\n', i), source.size()) - 1;
    } else if (!inside && source.compare(i, 3, "'\"'") == 0) {
      i += 2;
    } else if (c == '"') {
      inside = !inside;
      out += ' ';
    } else if (inside) {
      out += c;
      if (c == '\\' && i + 1 < source.size()) out += source[++i];
    }
  }
  return out;
}

Tree read_prose(const std::string& project_root) {
  namespace fs = std::filesystem;
  Tree out;
  for (const auto& [path, text] : read_tree(project_root)) {
    if (!path.starts_with("tests/") && !path.starts_with("bench/")) out[path] = quoted_only(text);
  }
  for (fs::recursive_directory_iterator entry(project_root), end; entry != end; ++entry) {
    const std::string name = entry->path().filename().string();
    if (entry->is_directory() &&
        (name == "build" || name == "node_modules" || name.starts_with('.'))) {
      entry.disable_recursion_pending();
      continue;
    }
    const std::string path = fs::relative(entry->path(), project_root).generic_string();
    if (entry->is_regular_file() && is_prose(path)) out[path] = contents(entry->path());
  }
  return out;
}

std::vector<std::string> riddles(const Tree& prose) {
  std::vector<std::string> out;
  for (const auto& [path, text] : prose) {
    std::size_t number = 1;
    for (std::size_t begin = 0; begin < text.size(); ++number) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::string line = without_terms(text.substr(begin, end - begin));
      begin = end + 1;
      for (const Riddle& one : refused()) {
        std::smatch found;
        if (std::regex_search(line, found, one.pattern))
          out.push_back(path + ":" + std::to_string(number) + ": '" + found.str() +
                        "': " + one.remedy);
      }
    }
  }
  return out;
}

std::vector<std::string> without_heading(const Tree& prose) {
  std::vector<std::string> out;
  for (const auto& [path, text] : prose) {
    if (path.ends_with(".md") && !text.starts_with("# ")) out.push_back(path);
  }
  return out;
}

}  // namespace imunoise::testing
