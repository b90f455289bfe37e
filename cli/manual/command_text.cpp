#include "cli/manual/command_text.h"

#include <algorithm>
#include <regex>

namespace imunoise::manual {
namespace {

std::string full_name(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  if (parent == nullptr) return command.get_name();
  return full_name(*parent) + (command.get_name().empty() ? "" : " " + command.get_name());
}

// CLI11 writes a type as "HZ:POSITIVE", "COUNT:INT in [1 - 100]", "NAME:{full,diag}".
struct Type {
  std::string name;
  std::string range;
  std::vector<std::string> choices;
};

Type type_of(const CLI::Option& option) {
  Type out;
  const std::string text = option.get_type_name();
  out.name = text.substr(0, text.find(':'));
  std::smatch found;
  static const std::regex kChoices(R"(:\{([^}]*)\})");
  static const std::regex kRange(R"(:\w+ in \[(\S+) - (\S+)\])");
  static const std::regex kSign(":(above 0|at least 0)");
  if (std::regex_search(text, found, kChoices)) out.choices = CLI::detail::split(found[1], ',');
  if (std::regex_search(text, found, kRange)) out.range = found[1].str() + " to " + found[2].str();
  if (std::regex_search(text, found, kSign)) out.range = found[1];
  return out;
}

Values values_of(const Type& type) {
  if (!type.choices.empty()) return Values::kChoices;
  const auto ends = [&](std::string_view end) { return type.name.ends_with(end); };
  if (type.name == "DEVICE") return Values::kDriver;
  if (type.name == "FOLDER" || type.name == "RECORDING") return Values::kFolder;
  if (ends("FILE") || ends("FILES") || ends("PATH") || ends("SOURCE") || ends(".html") ||
      ends(".svg") || ends("STUDY") || ends("CONFIG")) {
    return Values::kFile;
  }
  return Values::kOther;
}

std::string in_brackets(const CLI::Option& option, const Type& type, bool several) {
  std::vector<std::string> facts;
  if (option.get_required() && option.nonpositional()) facts.push_back("required");
  if (several && option.nonpositional()) facts.push_back("repeatable");
  if (!type.range.empty()) facts.push_back(type.range);
  for (const CLI::Option* other : option.get_needs()) facts.push_back("needs " + other->get_name());
  for (const CLI::Option* other : option.get_excludes())
    facts.push_back("excludes " + other->get_name());
  if (!option.get_default_str().empty()) facts.push_back("default: " + option.get_default_str());
  return facts.empty() ? "" : " [" + CLI::detail::join(facts, "; ") + "]";
}

OptionText read_option(const CLI::Option& option) {
  OptionText out;
  for (const std::string& one : option.get_snames()) out.names.push_back("-" + one);
  for (const std::string& one : option.get_lnames()) out.names.push_back("--" + one);
  if (!option.nonpositional()) out.names = {option.get_single_name()};
  out.required = option.get_required();
  out.several = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  Type type;
  if (!option.get_type_name().empty()) {  // else a flag
    type = type_of(option);
    if (!option.nonpositional()) type.name = option.get_single_name();
    out.values = values_of(type);
    out.choices = type.choices;
    out.value = type.choices.empty() ? type.name : CLI::detail::join(type.choices, "|");
  }
  out.about = option.get_description() + in_brackets(option, type, out.several);
  return out;
}

// Options of its own and of the nameless groups in it, where CLI11 keeps alternatives.
void read_options(const CLI::App& command, CommandText& out) {
  const bool named = !command.get_name().empty();
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty() || (!named && option == command.get_help_ptr())) continue;
    (option->nonpositional() ? out.options : out.arguments).push_back(read_option(*option));
  }
  for (const CLI::App* part : command.get_subcommands({})) {
    if (part->get_name().empty()) read_options(*part, out);
  }
}

// Options of the program stand behind a command, too, where they concern it.
void read_inherited(const CLI::App& command, CommandText& out) {
  for (const CLI::App* above = command.get_parent(); above != nullptr;
       above = above->get_parent()) {
    for (const CLI::Option* option : above->get_options()) {
      const bool informs = option == above->get_help_ptr() || option == above->get_version_ptr();
      if (!informs && option->nonpositional() && !option->get_group().empty())
        out.options.push_back(read_option(*option));
    }
  }
}

void split_footer(const std::string& footer, CommandText& out) {
  static const std::string kTitle = "Examples:\n";
  std::string text = footer.substr(std::min(footer.find_first_not_of('\n'), footer.size()));
  if (text.starts_with(kTitle)) {
    const std::size_t end = std::min(text.find("\n\n"), text.size());
    out.examples = text.substr(kTitle.size(), end - kTitle.size());
    text = text.substr(end);
  }
  const std::size_t begin = std::min(text.find_first_not_of('\n'), text.size());
  out.notes = text.substr(begin, text.find_last_not_of('\n') + 1 - begin);
}

}  // namespace

CommandText read_command(const CLI::App& command) {
  CommandText out;
  out.name = full_name(command);
  out.about = command.get_description();
  split_footer(command.get_footer(), out);
  read_options(command, out);
  read_inherited(command, out);
  for (const CLI::App* part : command.get_subcommands({})) {
    if (part->get_name().empty()) continue;
    CommandText& text = out.parts.emplace_back(read_command(*part));
    text.group = part->get_group() == "Subcommands" ? "Commands" : part->get_group();
    if (std::find(out.groups.begin(), out.groups.end(), text.group) == out.groups.end())
      out.groups.push_back(text.group);
  }
  return out;
}

std::string usage(const CommandText& command) {
  std::string out = "[OPTIONS]";
  for (const OptionText& one : command.arguments) {
    const std::string name = one.names.front() + (one.several ? "..." : "");
    out += one.required ? " " + name : " [" + name + "]";
  }
  if (!command.parts.empty()) out += " COMMAND";
  return out;
}

std::string short_name(const CommandText& command) {
  return command.name.substr(command.name.rfind(' ') + 1);
}

}  // namespace imunoise::manual
