#include <algorithm>

#include "cli/manual/completion.h"

namespace imunoise::manual {
namespace {

// Names and values have none of the shell's own characters but these two.
std::string words(const std::vector<std::string>& all) { return CLI::detail::join(all, " "); }

// "batch new": without the program's name.
std::string below_program(const CommandText& command) {
  const std::size_t blank = command.name.find(' ');
  return blank == std::string::npos ? "" : command.name.substr(blank + 1);
}

std::string values(const OptionText& option) {
  switch (option.values) {
    case Values::kChoices:
      return "_imunoise_words \"" + words(option.choices) + "\"";
    case Values::kDriver:
      return "_imunoise_words \"$(\"${COMP_WORDS[0]}\" drivers --names 2>/dev/null)\"";
    case Values::kFolder:
      return "_imunoise_folders";
    case Values::kFile:
      return "COMPREPLY=()";
    case Values::kNone:
    case Values::kOther:
      break;
  }
  return "_imunoise_words \"\"";
}

struct Lists {
  std::string commands;  // patterns of `case`: a command and the word that leads to it
  std::string words;     // branches: what can follow a command
  std::string values;    // branches: what can follow an option
};

void walk(const CommandText& command, Lists& out) {
  const std::string name = below_program(command);
  std::vector<std::string> parts;
  std::vector<std::string> options;
  for (const CommandText& part : command.parts) parts.push_back(short_name(part));
  for (const OptionText& option : command.options) {
    for (const std::string& one : option.names) {
      options.push_back(one);
      if (option.values != Values::kNone)
        out.values += "    \"" + name + ":" + one + "\") " + values(option) + "; return ;;\n";
    }
  }
  out.words += "    \"" + name + "\") parts=\"" + words(parts) + "\" options=\"" + words(options) +
               "\" ;;\n";
  for (const CommandText& part : command.parts) {
    out.commands +=
        (out.commands.empty() ? "" : " | ") + ("\"" + name + ":") + short_name(part) + "\"";
    walk(part, out);
  }
}

// Finds the command that the words lead to; a program without commands has none.
std::string way_to_command(const std::string& patterns) {
  if (patterns.empty()) return "";
  return "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    case \"$command:${COMP_WORDS[i]}\" in\n"
         "      " +
         patterns +
         ")\n"
         "        command=${command:+$command }${COMP_WORDS[i]} ;;\n"
         "    esac\n"
         "  done\n";
}

}  // namespace

std::string bash_completion(const CommandText& program) {
  Lists lists;
  walk(program, lists);
  const std::string function = "_" + program.name;  // both programs' may be loaded at once
  return "# Completion of " + program.name +
         " for bash.\n\n"
         "_imunoise_words() {\n"
         "  compopt +o default +o bashdefault 2>/dev/null\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$word\")\n"
         "}\n\n"
         "_imunoise_folders() {\n"
         "  compopt -o filenames 2>/dev/null\n"
         "  mapfile -t COMPREPLY < <(compgen -d -- \"$word\")\n"
         "}\n\n" +
         function +
         "() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}\n"
         "  local command=\"\" parts=\"\" options=\"\" i\n"
         "  COMPREPLY=()\n" +
         way_to_command(lists.commands) + "  case \"$command:$before\" in\n" + lists.values +
         "  esac\n"
         "  case \"$command\" in\n" +
         lists.words +
         "  esac\n"
         "  if [[ $word == -* ]]; then\n"
         "    _imunoise_words \"$options\"\n"
         "  elif [[ -n $parts ]]; then\n"
         "    _imunoise_words \"$parts\"\n"
         "  fi\n"
         "}\n\n"
         "complete -o bashdefault -o default -F " +
         function + " " + program.name + "\n";
}

}  // namespace imunoise::manual
