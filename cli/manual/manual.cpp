#include "cli/manual/manual.h"

#include <filesystem>
#include <fstream>
#include <memory>

#include "cli/manual/completion.h"
#include "cli/manual/help_text.h"

namespace imunoise::manual {
namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw CLI::FileError(file.string() + ": cannot be written");
}

void write_page(const ManPage& page, const std::filesystem::path& folder) {
  const std::string number = std::to_string(page.section);
  write(folder / "man" / ("man" + number) / (page.name + "." + number), page.text);
}

void write_manual(const CLI::App& program, int section, const std::string& version,
                  const std::filesystem::path& folder) {
  const CommandText text = read_command(program);
  for (const ManPage& page : man_pages(text, section, version)) write_page(page, folder);
  write(folder / "bash-completion" / "completions" / text.name, bash_completion(text));
  write(folder / "zsh" / "vendor-completions" / ("_" + text.name), zsh_completion(text));
}

}  // namespace

void add_manual(CLI::App& program, int section, const std::string& version,
                const std::function<std::vector<FileText>()>& files) {
  program.formatter_fn([](const CLI::App* app, const std::string& /*name*/, CLI::AppFormatMode) {
    return help_text(read_command(*app));
  });
  program.set_help_flag("-h,--help", "Print this help and exit");
  program.set_version_flag("--version", version, "Print the version and exit");
  program
      .add_option_function<std::string>(
          "--write-manual",
          [&program, section, version, files](const std::string& folder) {
            write_manual(program, section, version, folder);
            if (files) {
              for (const FileText& file : files()) write_page(file_page(file, version), folder);
            }
            throw CLI::Success();
          },
          "Write manual pages and completions")
      ->type_name("FOLDER")
      ->group("");
}

}  // namespace imunoise::manual
