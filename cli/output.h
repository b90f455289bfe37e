#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/support/result.h"
#include "study/report/terminal/fit_text.h"

namespace imunoise::cli {

/// Width, colour and character set of standard output.
report::TerminalStyle terminal_style();

void print(std::string_view text);
/// The same of what tells of work that is done: false where standard output takes no more.
bool try_print(std::string_view text);
/// On standard error. A terminal or a reader that has gone ends no work: the text is lost.
void tell(std::string_view text);
/// "imunoise: message" on standard error; returns the exit status of a failed command.
int print_error(const Error& error);
/// Lines of text, without what would steer a terminal (report::clean_text()).
std::string printable(std::string_view text);

/// A word with the quotes that a shell needs.
std::string in_shell(const std::string& word);

/// OUT_word.svg of OUT.svg.
std::filesystem::path with_word(const std::filesystem::path& path, const std::string& word);

/// Writes an HTML report, and tells so. Its last line says which version of imunoise made it, when
/// (UTC; the time in SOURCE_DATE_EPOCH if it is set), and by which command.
Result<void> write_report(const std::filesystem::path& path, std::string page);

/// Writes a whole file, under a temporary name first.
Result<void> write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace imunoise::cli
