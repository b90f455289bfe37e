#include "cli/manual/man_page.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace imunoise::manual {
namespace {

std::string page_name(const std::string& command) {
  std::string out = command;
  std::replace(out.begin(), out.end(), ' ', '-');
  return out;
}

// Text as groff prints it letter by letter; a line may not begin with a control character.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\'') {
      out += "\\(aq";
    } else {
      const bool begins = out.empty() || out.back() == '\n';
      out += begins && c == '.' ? "\\&." : std::string(1, c);
    }
  }
  return out;
}

std::string as_it_stands(const std::string& lines) {
  return ".nf\n" + escaped(lines) + (lines.ends_with('\n') ? "" : "\n") + ".fi\n";
}

// Paragraphs are filled; lines that begin with a blank, and one that ends with a colon before
// them, stand as they are.
std::string notes(const std::string& text) {
  std::string out;
  std::string paragraph;
  std::string fixed;
  const auto flush = [&] {
    if (!paragraph.empty()) out += ".PP\n" + escaped(paragraph);
    if (!fixed.empty()) out += ".PP\n" + as_it_stands(fixed);
    paragraph.clear();
    fixed.clear();
  };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool stands = line.starts_with(' ');
    if (line.empty() || (stands ? fixed.empty() : !fixed.empty())) flush();
    if (!line.empty()) (stands ? fixed : paragraph) += line + "\n";
  }
  flush();
  return out;
}

// `argument`: its name stands for a value.
std::string option(const OptionText& one, bool argument) {
  std::string names;
  for (const std::string& name : one.names) {
    names += (names.empty() ? "" : ", ") + std::string(argument ? "\\fI" : "\\fB") + escaped(name) +
             "\\fR";
  }
  if (!argument && !one.value.empty()) names += " \\fI" + escaped(one.value) + "\\fR";
  return ".TP\n" + names + "\n" + escaped(one.about) + "\n";
}

std::string list(const std::string& title, const std::vector<OptionText>& options,
                 bool arguments = false) {
  if (options.empty()) return "";
  std::string out = ".SH " + title + "\n";
  for (const OptionText& one : options) out += option(one, arguments);
  return out;
}

std::string reference(const std::string& name, int section) {
  return "\\fB" + escaped(name) + "\\fR(" + std::to_string(section) + ")";
}

std::string commands(const CommandText& command, int section) {
  if (command.parts.empty()) return "";
  std::string out = ".SH COMMANDS\n";
  for (const std::string& group : command.groups) {
    out += ".SS " + escaped(group) + "\n";
    for (const CommandText& part : command.parts) {
      if (part.group != group) continue;
      out += ".TP\n" + reference(page_name(part.name), section) + "\n" + escaped(part.about) + "\n";
    }
  }
  return out;
}

std::string head(const std::string& name, const std::string& about, int section,
                 const std::string& version) {
  std::string title = name;
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return ".TH " + escaped(title) + " " + std::to_string(section) + " \"\" \"imunoise " +
         escaped(version) + "\" \"imunoise\"\n.SH NAME\n" + escaped(name) + " \\- " +
         escaped(about) + "\n";
}

std::string see_also(const std::vector<std::string>& pages) {
  return ".SH SEE ALSO\n" + CLI::detail::join(pages, ",\n") +
         "\n.PP\nGuides: /usr/share/doc/imunoise\n";
}

// The commands that a part belongs to; of a program the other one and the file format.
std::vector<std::string> related(const CommandText& command, int section) {
  std::vector<std::string> out;
  for (std::string above = command.name; above.find(' ') != std::string::npos;) {
    above.resize(above.rfind(' '));
    out.push_back(reference(page_name(above), section));
  }
  if (!out.empty()) return out;
  return {section == 1 ? reference("imunoised", 8) : reference("imunoise", 1),
          reference("imunoise-campaign", 5)};
}

std::string page(const CommandText& command, int section, const std::string& version) {
  std::string out = head(page_name(command.name), command.about, section, version) +
                    ".SH SYNOPSIS\n\\fB" + escaped(command.name) + "\\fR " +
                    escaped(usage(command)) + "\n";
  if (!command.examples.empty()) out += ".SH EXAMPLES\n" + as_it_stands(command.examples);
  out += commands(command, section);
  out += list("ARGUMENTS", command.arguments, true) + list("OPTIONS", command.options);
  if (!command.notes.empty()) out += ".SH NOTES\n" + notes(command.notes);
  return out + see_also(related(command, section));
}

}  // namespace

std::vector<ManPage> man_pages(const CommandText& command, int section,
                               const std::string& version) {
  std::vector<ManPage> out = {{page_name(command.name), section, page(command, section, version)}};
  for (const CommandText& part : command.parts) {
    for (ManPage& one : man_pages(part, section, version)) out.push_back(std::move(one));
  }
  return out;
}

ManPage file_page(const FileText& file, const std::string& version) {
  std::string text = head(file.name, file.about, 5, version) + ".SH DESCRIPTION\n" +
                     notes(file.description) + ".SH EXAMPLE\n" + as_it_stands(file.example);
  for (const auto& [title, keys] : file.keys) text += list(title, keys);
  return {file.name, 5, text + see_also({reference("imunoised", 8), reference("imunoise", 1)})};
}

}  // namespace imunoise::manual
