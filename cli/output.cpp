#include "cli/output.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>

#include "study/report/html/page_frame.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::cli {
namespace {

bool utf8_locale() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* const value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    const std::string_view text(value);
    return text.find("UTF-8") != std::string_view::npos ||
           text.find("utf8") != std::string_view::npos;
  }
  return false;
}

// The command as it was typed, with quotes where the shell needs them.
std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string out;
  for (std::string word; std::getline(file, word, '\0');) {
    if (out.empty()) word = std::filesystem::path(word).filename().string();
    out += (out.empty() ? "" : " ") + in_shell(word);
  }
  return out;
}

std::int64_t now_ns() {
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (const char* const fixed = std::getenv("SOURCE_DATE_EPOCH"))
    return std::strtoll(fixed, nullptr, 10) * kSecond;
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

report::TerminalStyle terminal_style() {
  report::TerminalStyle style;
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  winsize size{};
  if (terminal && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    style.width = std::clamp<decltype(style.width)>(size.ws_col, 60, 140);
  }
  style.colour = terminal && std::getenv("NO_COLOR") == nullptr;
  style.unicode = !terminal || utf8_locale();
  return style;
}

void print(std::string_view text) { fmt::print("{}", text); }

bool try_print(std::string_view text) {
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() &&
         std::fflush(stdout) == 0;
}

void tell(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    out += report::clean_text(text.substr(0, end)) + '\n';
    text.remove_prefix(end + 1);
  }
  return out + report::clean_text(text);
}

int print_error(const Error& error) {
  tell(fmt::format("imunoise: {}\n", printable(error.message)));
  return 1;
}

std::string in_shell(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=./,:@%+";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::filesystem::path with_word(const std::filesystem::path& path, const std::string& word) {
  std::filesystem::path out = path;
  out.replace_filename(path.stem().string() + "_" + word + path.extension().string());
  return out;
}

Result<void> write_report(const std::filesystem::path& path, std::string page) {
  const std::string made =
      fmt::format("imunoise {}, {} UTC: {}", IMUNOISE_VERSION, report::minute(now_ns()),
                  report::clean_text(command_line()));
  auto done = write_file(path, report::with_footer(std::move(page), made));
  if (done) tell(fmt::format("wrote {}\n", path.string()));
  return done;
}

Result<void> write_file(const std::filesystem::path& path, std::string_view content) {
  const std::filesystem::path temporary = path.string() + ".part";
  {
    std::ofstream file(temporary, std::ios::binary);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.flush();
    if (!file) {
      return fail(fmt::format("{}: cannot be written; is the folder there, and is there room?",
                              path.string()));
    }
  }
  std::error_code code;
  std::filesystem::rename(temporary, path, code);
  if (code) return fail(fmt::format("{}: {}", path.string(), code.message()));
  return {};
}

}  // namespace imunoise::cli
