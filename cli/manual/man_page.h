#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/manual/command_text.h"

namespace imunoise::manual {

struct ManPage {
  std::string name;  ///< "imunoise-batch-new"
  int section = 1;
  std::string text;  ///< for groff's man macros, in UTF-8
};

/// A file format: keys as options, in sections with titles.
struct FileText {
  std::string name;
  std::string about;
  std::string description;
  std::string example;
  std::vector<std::pair<std::string, std::vector<OptionText>>> keys;
};

ManPage file_page(const FileText& file, const std::string& version);

/// The page of a command, and those of all below it.
std::vector<ManPage> man_pages(const CommandText& command, int section, const std::string& version);

}  // namespace imunoise::manual
