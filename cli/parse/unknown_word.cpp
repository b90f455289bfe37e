#include "cli/parse/unknown_word.h"

#include <fmt/format.h>

#include <regex>
#include <vector>

#include "core/support/nearest_word.h"

namespace imunoise::cli {
namespace {

// The command that was recognised last: of `batch nwe` it is batch.
const CLI::App* recognised(const CLI::App* app) {
  const std::vector<CLI::App*> below = app->get_subcommands();
  return below.empty() ? app : recognised(below.back());
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::App* one : app.get_subcommands([](const CLI::App*) { return true; }))
    out.push_back(one->get_name());
  return out;
}

std::vector<std::string> options_of(const CLI::App& app, const CLI::App& program) {
  std::vector<std::string> out;
  for (const CLI::App* one : {&app, &program}) {
    for (const CLI::Option* option : one->get_options()) {
      for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
    }
  }
  return out;
}

std::string unknown(const char* what, const std::string& word,
                    const std::vector<std::string>& known) {
  const std::string meant = did_you_mean(word, known);
  return fmt::format("unknown {} '{}'{}{}", what, word, meant.empty() ? "" : "; ", meant);
}

// "--to: kalibrr not in {kalibr,openvins}" with what was meant.
std::string with_nearest_choice(std::string text) {
  constexpr std::string_view between = " not in {";
  const std::size_t at = text.find(between);
  const std::size_t begin = text.find(": ");
  if (at == std::string::npos || begin > at || !text.ends_with('}')) return text;
  std::string_view list = std::string_view(text).substr(at + between.size());
  list.remove_suffix(1);
  const std::vector<std::string> choices = CLI::detail::split(std::string(list), ',');
  const std::string word = text.substr(begin + 2, at - begin - 2);
  const std::string meant = did_you_mean(word, choices);
  if (!meant.empty()) return text + "; " + meant;
  // "kf" of kf-json, kf-numpy, ...
  std::string longer;
  for (const std::string& one : choices) {
    if (one.starts_with(word + "-")) longer += (longer.empty() ? "" : ", ") + one;
  }
  return longer.empty() ? text : text + "; choose one of " + longer;
}

// "0.500000" as "0.5".
std::string short_number(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

// "--confidence: Value 95 not in range 0.500000 to 0.999900" in fewer words.
std::string with_plain_range(const std::string& text) {
  static const std::regex kRange("(.*): Value (.*) not in range (.*) to (.*)");
  std::smatch found;
  if (!std::regex_match(text, found, kRange)) return text;
  return fmt::format("{}: {} is not between {} and {}", found.str(1), found.str(2),
                     short_number(found.str(3)), short_number(found.str(4)));
}

std::string sentence(const CLI::App& program, const CLI::Error& error) {
  const CLI::App& at = *recognised(&program);
  const bool wants_command = at.get_require_subcommand_min() > 0;
  for (const std::string& word : program.remaining(true)) {
    const bool option = word.starts_with("--");
    if (option) return unknown("option", word.substr(0, word.find('=')), options_of(at, program));
    if (wants_command) return unknown("command", word, commands_of(at));
  }
  return with_plain_range(with_nearest_choice(error.what()));
}

}  // namespace

std::string usage_error(const CLI::App* program, const CLI::Error& error) {
  std::string path;
  for (const CLI::App* at = recognised(program); at != nullptr; at = at->get_parent())
    path = at->get_name() + " " + path;
  return fmt::format("imunoise: {}\nRun {}--help for more information.\n",
                     sentence(*program, error), path);
}

}  // namespace imunoise::cli
