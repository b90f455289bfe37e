#include "cli/manual/help_text.h"

#include <sstream>

namespace imunoise::manual {
namespace {

constexpr std::size_t kWidth = 100;  // characters of a line
constexpr std::size_t kColumn = 28;  // where explanations begin

// Characters, not bytes: UTF-8 continues with 10xxxxxx.
std::size_t length(const std::string& text) {
  std::size_t out = 0;
  for (const char c : text) out += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1U : 0U;
  return out;
}

// A line of two columns, the second wrapped.
std::string entry(const std::string& left, const std::string& right) {
  std::string out = "  " + left;
  std::size_t at = 2 + length(left);
  if (at + 2 > kColumn) {
    out += '\n';
    at = 0;
  }
  out.append(kColumn - at, ' ');
  at = kColumn;
  std::istringstream words(right);
  bool first = true;
  for (std::string word; words >> word; first = false) {
    if (!first && at + 1 + length(word) > kWidth) {
      out += '\n' + std::string(kColumn, ' ');
      at = kColumn;
    } else if (!first) {
      out += ' ';
      ++at;
    }
    out += word;
    at += length(word);
  }
  return out + '\n';
}

std::string left_of(const OptionText& option) {
  std::string out = CLI::detail::join(option.names, ", ");
  if (option.names.front().front() == '-' && !option.value.empty()) out += " " + option.value;
  return out;
}

std::string section(const std::string& title, const std::vector<OptionText>& options) {
  if (options.empty()) return "";
  std::string out = "\n" + title + ":\n";
  for (const OptionText& one : options) out += entry(left_of(one), one.about);
  return out;
}

}  // namespace

std::string help_text(const CommandText& command) {
  std::string out = command.name + ": " + command.about + "\n\nUsage: " + command.name + " " +
                    usage(command) + "\n";
  if (!command.examples.empty()) out += "\nExamples:\n" + command.examples + "\n";
  for (const std::string& group : command.groups) {
    out += "\n" + group + ":\n";
    for (const CommandText& part : command.parts) {
      if (part.group == group) out += entry(short_name(part), part.about);
    }
  }
  out += section("Arguments", command.arguments) + section("Options", command.options);
  if (!command.notes.empty()) out += "\n" + command.notes + "\n";
  return out;
}

}  // namespace imunoise::manual
