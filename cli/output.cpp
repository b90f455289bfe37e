#include "cli/output.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

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

int print_error(const Error& error) {
  tell(fmt::format("imunoise: {}\n", error.message));
  return 1;
}

std::filesystem::path with_word(const std::filesystem::path& path, const std::string& word) {
  std::filesystem::path out = path;
  out.replace_filename(path.stem().string() + "_" + word + path.extension().string());
  return out;
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
