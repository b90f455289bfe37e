#include <algorithm>

#include "cli/manual/completion.h"

namespace imunoise::manual {
namespace {

// Within '...' and within the [...] or :...: of _arguments.
std::string quoted(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else if (c == '[' || c == ']' || c == ':' || c == '\\') {
      out += std::string("\\") + c;
    } else {
      out += c;
    }
  }
  return out;
}

std::string action(const OptionText& option) {
  switch (option.values) {
    case Values::kChoices:
      return "(" + CLI::detail::join(option.choices, " ") + ")";
    case Values::kDriver:
      return "{compadd -- $(_call_program drivers imunoise drivers --names)}";
    case Values::kFolder:
      return "_files -/";
    case Values::kFile:
      return "_files";
    case Values::kNone:
    case Values::kOther:
      break;
  }
  return " ";
}

std::string function_name(const CommandText& command) {
  std::string out = "_" + command.name;
  std::replace(out.begin(), out.end(), ' ', '_');
  return out;
}

std::string arguments(const CommandText& command) {
  std::string out;
  for (const OptionText& option : command.options) {
    for (const std::string& name : option.names) {
      out += " \\\n    '" + std::string(option.several ? "*" : "") + name + "[" +
             quoted(option.about) + "]";
      if (option.values != Values::kNone) out += ":" + quoted(option.value) + ":" + action(option);
      out += "'";
    }
  }
  for (const OptionText& one : command.arguments) {
    out += " \\\n    '" + std::string(one.several ? "*:" : ":") + quoted(one.names.front()) + ":" +
           action(one) + "'";
  }
  return out;
}

std::string function_of(const CommandText& command) {
  std::string out = function_name(command) + "() {\n";
  if (command.parts.empty()) return out + "  _arguments" + arguments(command) + "\n}\n\n";
  out +=
      "  local context curcontext=\"$curcontext\" state line\n"
      "  typeset -A opt_args\n"
      "  _arguments -C" +
      arguments(command) +
      " \\\n    '1:command:->command' \\\n    '*::argument:->argument'\n"
      "  case $state in\n"
      "    command)\n"
      "      local -a commands=(\n";
  for (const CommandText& part : command.parts)
    out += "        '" + short_name(part) + ":" + quoted(part.about) + "'\n";
  out +=
      "      )\n"
      "      _describe -t commands command commands ;;\n"
      "    argument)\n"
      "      case $line[1] in\n";
  for (const CommandText& part : command.parts)
    out += "        " + short_name(part) + ") " + function_name(part) + " ;;\n";
  out += "      esac ;;\n  esac\n}\n\n";
  for (const CommandText& part : command.parts) out += function_of(part);
  return out;
}

}  // namespace

std::string zsh_completion(const CommandText& program) {
  return "#compdef " + program.name + "\n# Completion of " + program.name + " for zsh.\n\n" +
         function_of(program) + function_name(program) + " \"$@\"\n";
}

}  // namespace imunoise::manual
