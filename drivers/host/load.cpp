#include "drivers/host/load.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "core/support/nearest_word.h"
#include "drivers/host/check.h"
#include "drivers/host/services.h"

namespace imunoise::drivers {
namespace {

namespace fs = std::filesystem;

using Entry = decltype(&imunoise_driver_entry);

Result<Entry> entry_of(const fs::path& file) {
  // LOCAL: plugins do not see one another. NODELETE: not even by mistake is one unloaded.
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): glibc keeps the text for each thread.
    const char* const text = ::dlerror();
    return fail(text == nullptr ? "cannot be loaded" : text);
  }
  void* const symbol = ::dlsym(library, IMUNOISE_DRIVER_ENTRY);
  if (symbol == nullptr) {
    return fail("has no function " IMUNOISE_DRIVER_ENTRY
                "; is it a driver, and ends it with IMUNOISE_DRIVER(...)?");
  }
  Entry entry = nullptr;
  std::memcpy(&entry, &symbol, sizeof entry);  // POSIX has them alike; C++ does not cast
  return entry;
}

Result<Driver> load_driver(const fs::path& file) {
  const Result<Entry> entry = entry_of(file);
  if (!entry) return tl::make_unexpected(entry.error());
  const imunoise_driver* table = nullptr;
  try {
    table = (*entry)(IMUNOISE_DRIVER_ABI, &host_services());
  } catch (...) {
    return fail(IMUNOISE_DRIVER_ENTRY " threw an exception");
  }
  Result<DriverInfo> info = check_driver(table);
  if (!info) return tl::make_unexpected(info.error());
  return Driver{std::move(*info), file, table};
}

std::vector<fs::path> plugins_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code trouble;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, trouble)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("imunoise-") && name.ends_with(".so")) out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

std::vector<fs::path> driver_folders(std::span<const fs::path> first) {
  std::vector<fs::path> wanted(first.begin(), first.end());
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing of ours changes the environment.
  if (const char* const list = std::getenv("IMUNOISE_DRIVER_PATH")) {
    std::string_view rest = list;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(':'), rest.size());
      if (end > 0) wanted.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  std::error_code trouble;
  const fs::path program = fs::read_symlink("/proc/self/exe", trouble).parent_path();
  if (!trouble) {
    wanted.push_back(program / IMUNOISE_DRIVERS_FROM_BIN);
    wanted.push_back(program / "lib/imunoise/drivers");  // the build tree's
  }
  std::vector<fs::path> out;
  for (const fs::path& folder : wanted) {
    const fs::path real = fs::weakly_canonical(folder, trouble);
    if (!trouble && std::find(out.begin(), out.end(), real) == out.end()) out.push_back(real);
  }
  return out;
}

Drivers load_drivers(std::vector<fs::path> folders) {
  Drivers out;
  out.folders = std::move(folders);
  for (const fs::path& folder : out.folders) {
    for (const fs::path& file : plugins_in(folder)) {
      Result<Driver> driver = load_driver(file);
      if (!driver) {
        out.refused.push_back({file, driver.error().message});
        continue;
      }
      const auto twin = std::find_if(out.found.begin(), out.found.end(), [&](const Driver& other) {
        return other.info.name == driver->info.name;
      });
      if (twin == out.found.end()) {
        out.found.push_back(std::move(*driver));
      } else {
        out.refused.push_back({file, fmt::format("the name '{}' is taken by {}", twin->info.name,
                                                 twin->file.string())});
      }
    }
  }
  return out;
}

Result<const Driver*> Drivers::find(std::string_view name) const {
  std::string known;
  std::vector<std::string> names;
  for (const Driver& driver : found) {
    if (driver.info.name == name) return &driver;
    names.push_back(driver.info.name);
    known += (known.empty() ? "" : ", ") + driver.info.name;
  }
  for (const RefusedPlugin& plugin : refused) {
    if (plugin.file.filename() == fmt::format("imunoise-{}.so", name)) {
      return fail(fmt::format("driver {}: {} cannot be loaded: {}", name, plugin.file.string(),
                              plugin.reason));
    }
  }
  const std::string meant = did_you_mean(name, names);
  return fail(fmt::format("no driver '{}'; there are: {} (see imunoise drivers){}", name,
                          known.empty() ? "none" : known, meant.empty() ? "" : "; " + meant));
}

}  // namespace imunoise::drivers
