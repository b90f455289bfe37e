#include "tests/layering/include_rules.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

namespace imunoise::testing {
namespace {

constexpr std::size_t kMostLines = 400;

// A room, and the rooms beside itself that it may include. "*" is every room; "core" every room of
// core.
struct Room {
  std::string_view path;
  std::vector<std::string_view> may_include;
};

// Where one room lies inside another's folder, the longer path decides.
const std::vector<Room>& rooms() {
  static const std::vector<Room> kRooms = {
      {"core/support", {}},
      {"core/signal", {"core/support"}},
      {"core/wavelet", {"core/support", "core/signal"}},
      {"core/spectrum", {"core/support", "core/signal"}},
      {"core/stillness", {"core/support"}},
      {"core/process", {"core/support", "core/signal", "core/wavelet"}},
      {"core/model", {"core/support", "core/signal", "core/wavelet", "core/process"}},
      {"core/estimate",
       {"core/support", "core/signal", "core/wavelet", "core/spectrum", "core/process",
        "core/model"}},
      {"core/inference",
       {"core/support", "core/signal", "core/wavelet", "core/spectrum", "core/process",
        "core/model", "core/estimate"}},
      {"core/integrity", {"core/support", "core/signal", "core/spectrum"}},
      {"core/effect",
       {"core/support", "core/signal", "core/wavelet", "core/spectrum", "core/process",
        "core/model"}},
      {"core/regression",
       {"core/support", "core/signal", "core/wavelet", "core/spectrum", "core/process",
        "core/model", "core/estimate", "core/effect"}},
      {"core/search",
       {"core/support", "core/signal", "core/wavelet", "core/spectrum", "core/process",
        "core/model", "core/estimate", "core/effect", "core/regression"}},
      {"core/effects",
       {"core/support", "core/signal", "core/wavelet", "core/spectrum", "core/process",
        "core/model", "core/estimate", "core/inference", "core/effect", "core/regression",
        "core/search"}},
      {"core/diagnosis",
       {"core/support", "core/signal", "core/wavelet", "core/spectrum", "core/process",
        "core/model", "core/estimate", "core/inference", "core/effect", "core/regression",
        "core/search", "core/effects"}},
      {"core/array",
       {"core/support", "core/signal", "core/wavelet", "core/spectrum", "core/process",
        "core/model", "core/estimate", "core/inference"}},
      {"core/dynamic",
       {"core/support", "core/signal", "core/wavelet", "core/spectrum", "core/process",
        "core/model", "core/estimate", "core/inference"}},
      {"core/faults",
       {"core/support", "core/signal", "core/wavelet", "core/spectrum", "core/process",
        "core/model", "core/estimate", "core/inference", "core/array"}},
      {"core/simulate",
       {"core/support", "core/signal", "core/wavelet", "core/process", "core/model"}},
      {"proto", {}},
      {"recording/hdf5", {"core/support"}},
      {"recording/scratch", {"core/support"}},
      {"recording/export", {"core/support", "proto", "recording/hdf5"}},
      {"recording/import/table", {"core/support", "core/signal", "proto"}},
      {"recording/import/preflight",
       {"core/support", "core/integrity", "core/stillness", "recording/import/table"}},
      {"recording/import/text", {"core/support", "recording/import/table"}},
      {"recording/import/binary",
       {"core/support", "proto", "recording/import/table", "recording/import/packed"}},
      {"recording/import/arrays",
       {"core/support", "recording/import/table", "recording/import/packed",
        "recording/import/binary"}},
      {"recording/import/packed", {"core/support", "recording/import/table"}},
      {"recording/import/ros",
       {"core/support", "recording/import/table", "recording/import/packed"}},
      {"recording/import/ulog", {"core/support", "recording/import/table"}},
      {"recording/import/wire",
       {"core/support", "recording/import/table", "drivers/codec", "drivers/can/codec",
        "drivers/xsens/codec"}},
      {"recording/import/hdf5", {"core/support", "recording/import/table", "recording/hdf5"}},
      {"recording/import", {"core/support", "core/signal", "recording/import"}},
      {"recording/store/format", {"core/support"}},
      {"recording/store/stream", {"core/support", "proto"}},
      {"recording/store/disk", {"core/support", "recording/import/table"}},
      {"recording/store/chunk",
       {"core/support", "proto", "recording/hdf5", "recording/store/format",
        "recording/store/stream"}},
      {"recording/store/journal",
       {"core/support", "proto", "recording/store/format", "recording/store/stream",
        "recording/store/disk", "recording/store/chunk"}},
      {"recording/store/manifest",
       {"core/support", "proto", "recording/store/format", "recording/store/stream",
        "recording/store/disk", "recording/store/chunk"}},
      {"recording/store/recovery",
       {"core/support", "proto", "recording/store/format", "recording/store/stream",
        "recording/store/disk", "recording/store/chunk", "recording/store/journal",
        "recording/store/manifest"}},
      {"recording/store/recorder",
       {"core/support", "proto", "recording/store/format", "recording/store/stream",
        "recording/store/disk", "recording/store/chunk", "recording/store/journal",
        "recording/store/manifest", "recording/store/recovery"}},
      {"recording/store/timeline",
       {"core/support", "core/signal", "proto", "recording/store/stream"}},
      {"recording/store/reading",
       {"core/support", "core/signal", "proto", "recording/import", "recording/store/format",
        "recording/store/stream", "recording/store/disk", "recording/store/chunk",
        "recording/store/journal", "recording/store/manifest", "recording/store/timeline"}},
      {"recording/store/verify",
       {"core/support", "core/signal", "proto", "recording/store/format", "recording/store/stream",
        "recording/store/disk", "recording/store/chunk", "recording/store/manifest",
        "recording/store/timeline", "recording/store/reading", "recording/store/recovery"}},
      {"study", {"core", "recording", "study", "proto"}},
      {"study/words", {"core/support"}},
      {"study/figure", {"study/words"}},
      {"study/report", {"core/support", "study/words", "proto"}},
      {"study/report/view", {"core/support", "study/words", "proto"}},
      {"study/report/figures", {"study/words", "study/figure", "study/report/view", "proto"}},
      {"study/report/documents",
       {"study/words", "study/figure", "study/report/view", "study/report/figures", "proto"}},
      {"study/report/html",
       {"study/words", "study/figure", "study/report/view", "study/report/figures",
        "study/report/documents", "proto"}},
      {"study/report/terminal",
       {"study/words", "study/figure", "study/report/view", "study/report/figures",
        "study/report/documents", "proto"}},
      {"drivers",
       {"core/support", "core/signal", "drivers/codec", "drivers/adis16405/codec",
        "drivers/can/codec", "drivers/xsens/codec"}},
      {"drivers/replay", {"core", "recording", "drivers"}},
      {"drivers/adis16405/codec", {"core/support", "drivers/codec"}},
      {"drivers/can/codec", {"core/support", "drivers/codec"}},
      {"drivers/xsens/codec", {"core/support", "drivers/codec"}},
      {"drivers/codec", {"core/support"}},
      {"drivers/emulator/measurement", {"core/support", "drivers/codec"}},
      {"drivers/emulator/effects", {"core/support", "core/model", "drivers/emulator/measurement"}},
      {"drivers/emulator/faults", {"core/support", "drivers/emulator/effects"}},
      {"drivers/emulator/usb", {"core/support", "drivers"}},
      {"drivers/emulator/lines", {"drivers"}},
      {"drivers/emulator/sensors",
       {"core/support", "drivers/codec", "drivers/adis16405/codec", "drivers/can/codec",
        "drivers/xsens/codec", "drivers/emulator/measurement", "drivers/emulator/faults",
        "drivers/emulator/usb", "drivers/emulator/lines"}},
      {"drivers/emulator/serving", {"core/support", "drivers"}},
      {"daemon", {"core", "recording", "study", "drivers", "proto"}},
      {"daemon/config", {"core/support", "core/model", "core/effects", "drivers", "proto"}},
      {"daemon/acquire", {"core", "recording", "study", "drivers", "proto", "daemon/config"}},
      {"daemon/acquire/campaign",
       {"core/support", "recording", "drivers", "proto", "daemon/acquire"}},
      {"daemon/service/http", {"core/support"}},
      {"daemon/service/access", {"core/support", "proto"}},
      {"daemon/service/page", {"core/support", "daemon/service/http"}},
      {"daemon/service/api",
       {"core/support", "study", "proto", "daemon/service/http", "daemon/service/access",
        "daemon/service/page"}},
      {"daemon/service/campaigns",
       {"core/support", "recording", "drivers", "proto", "daemon/acquire", "daemon/service/http",
        "daemon/service/api"}},
      {"daemon/service/exports",
       {"core/support", "study", "proto", "daemon/service/api", "daemon/service/recordings",
        "daemon/service/studies"}},
      {"daemon/service/live",
       {"core/support", "study", "proto", "daemon/service/api", "daemon/service/campaigns"}},
      {"daemon/service/recordings",
       {"core/support", "recording", "study", "proto", "daemon/catalogue", "daemon/service/api"}},
      {"daemon/service/studies",
       {"core/support", "recording", "study", "proto", "daemon/config", "daemon/service/api",
        "daemon/service/recordings"}},
      {"daemon/service",
       {"core/support", "recording", "drivers", "proto", "daemon/acquire", "daemon/service"}},
      {"daemon/app",
       {"core/support", "recording", "study", "drivers", "proto", "daemon", "cli/manual"}},
      {"daemon/catalogue", {"core", "recording", "study", "proto"}},
      {"daemon/batch", {"core/support", "recording", "study", "proto", "daemon/process"}},
      {"daemon/process", {"core/support"}},
      {"daemon/live", {"core", "recording", "proto", "daemon/acquire", "daemon/config"}},
      {"cli", {"*"}},
      {"cli/manual", {}},
      {"python", {"core", "recording", "study", "proto"}},
      {"bench", {"*"}},
      {"tests", {"*"}},
      {"tests/hidden_effects",
       {"core/support", "core/signal", "core/wavelet", "core/model", "core/estimate",
        "core/inference", "core/array", "core/simulate", "recording", "study", "drivers", "proto",
        "tests"}},
      // The generator may not reach the detector's code through another header either: see below.
      {"tests/hidden_effects/generator", {"core/support", "core/signal"}},
  };
  return kRooms;
}

bool lies_in(std::string_view path, std::string_view folder) {
  return path.starts_with(folder) &&
         (path.size() == folder.size() || path[folder.size()] == '/' || folder.ends_with('/'));
}

bool lies_in_any(std::string_view path, const std::vector<std::string_view>& folders) {
  return std::any_of(folders.begin(), folders.end(),
                     [&](std::string_view folder) { return lies_in(path, folder); });
}

const Room* find_room(std::string_view path) {
  const Room* found = nullptr;
  for (const Room& room : rooms()) {
    if (lies_in(path, room.path) && (found == nullptr || room.path.size() > found->path.size())) {
      found = &room;
    }
  }
  return found;
}

// What may be seen only in some places: a library's header, or a name of the standard library.
struct Confined {
  std::regex pattern;
  std::vector<std::string_view> only_in;  // empty: anywhere but in never_in
  std::vector<std::string_view> never_in;
  std::string_view reason;
};

// Matched against what stands between < and >.
const std::vector<Confined>& confined_headers() {
  static const std::vector<Confined> kConfined = {
      {std::regex("(iostream|ostream|istream|fstream|filesystem|cstdio|stdio\\.h|syncstream)"),
       {},
       {"core"},
       "core has no files and prints nothing"},
      {std::regex("spdlog/.*|syslog\\.h"),
       {"daemon/app", "cli"},
       {},
       "only daemon/app and cli/ log; the others return facts"},
      {std::regex("google/protobuf/.*"), {}, {"core"}, "core knows nothing of proto"},
      {std::regex("Eigen/(Dense|Eigen|Cholesky|Eigenvalues|SVD|QR|LU|Householder|Jacobi|Geometry|"
                  "Sparse.*)"),
       {"core/support/linear_algebra.cpp", "tests"},
       {},
       "decompositions cost 11 s a file: use core/support/linear_algebra.h"},
      {std::regex("boost/math/.*"),
       {"core/support/distributions.cpp", "core/support/roots.cpp", "tests"},
       {},
       "Boost.Math is slow to compile: use core/support/distributions.h or roots.h"},
      {std::regex("tbb/.*|oneapi/tbb/.*"),
       {"core/support"},
       {},
       "results must not depend on the number of threads: use core/support/parallel.h"},
      {std::regex("nlopt\\.(h|hpp)"), {"core/estimate"}, {}, "the search lives in core/estimate"},
      {std::regex("pybind11/.*"), {"python"}, {}, "only the Python module knows Python"},
      {std::regex("CLI/.*"), {"cli", "daemon/app"}, {}, "only programs parse arguments"},
      {std::regex("toml\\+\\+/.*"),
       {"daemon/config/toml_document.cpp"},
       {},
       "toml++ is slow to compile: use daemon/config/toml_document.h"},
      {std::regex("systemd/.*"), {"daemon/app"}, {}, "only the daemon talks to systemd"},
      {std::regex("curl/.*"),
       {"cli/client/daemon_client.cpp"},
       {},
       "the daemon is asked through cli/client/daemon_client.h"},
      {std::regex("boost/(asio|beast)/.*"),
       {"daemon/service/http/http_server.cpp", "daemon/service/http/http_connection.h"},
       {},
       "Beast takes 20 s to compile: use daemon/service/http/http_server.h"},
      {std::regex("soci/.*|sqlite3\\.h|libpq.*"),
       {"daemon/catalogue/database.cpp", "recording/import/ros/ros2_sqlite.cpp"},
       {},
       "databases are daemon/catalogue/database.h"},
      {std::regex("libusb.*"),
       {"drivers/transport", "tests"},
       {},
       "USB is drivers/transport/usb.h"},
      {std::regex("hdf5(_hl)?\\.h|H5.*\\.h|highfive/.*"),
       {"recording", "tests"},
       {},
       "only recording knows HDF5"},
  };
  return kConfined;
}

// Matched against code, comments and literals removed.
const std::vector<Confined>& confined_code() {
  const std::vector<std::string_view> below = {"core", "recording", "study", "drivers"};
  static const std::vector<Confined> kConfined = {
      {std::regex("\\b(v?f?printf|puts|fputs|putchar|perror)\\s*\\(|\\bstd::(cout|cerr|clog)\\b|"
                  "\\bfmt::print\\s*\\("),
       {},
       below,
       "nothing below daemon/app and cli/ prints"},
      {std::regex("\\b(system_clock|steady_clock|high_resolution_clock)\\b"),
       {},
       {"core"},
       "core has no clock"},
      {std::regex("\\brandom_device\\b"), {}, below, "every random number has a seed"},
  };
  return kConfined;
}

bool allowed(const Confined& rule, std::string_view path) {
  return (rule.only_in.empty() || lies_in_any(path, rule.only_in)) &&
         !lies_in_any(path, rule.never_in);
}

// The text with comments and literals blanked; lines stay where they are. Paths of includes stay.
std::string code_only(const std::string& text) {
  std::string out = text;
  const auto end_of = [&](std::size_t found, std::size_t length) {
    return found == std::string::npos ? text.size() : found + length;
  };
  const auto blank = [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) out[k] = out[k] == '\n' ? '\n' : ' ';
  };
  const auto in_name = [&](std::size_t at) {
    return at < text.size() &&
           (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
  };
  bool directive = false;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    std::size_t end = i + 1;
    if (text.compare(i, 2, "//") == 0) {
      end = std::min(text.find('\n', i), text.size());
      blank(i, end);
    } else if (text.compare(i, 2, "/*") == 0) {
      end = end_of(text.find("*/", i + 2), 2);
      blank(i, end);
    } else if (text.compare(i, 2, "R\"") == 0 && (i == 0 || !in_name(i - 1))) {
      const std::size_t open = std::min(text.find('(', i), text.size());
      const std::string close = ")" + text.substr(i + 2, open - std::min(open, i + 2)) + "\"";
      end = end_of(text.find(close, open), close.size());
      blank(i, end);
    } else if ((c == '"' && !directive) || (c == '\'' && (i == 0 || !in_name(i - 1)))) {
      while (end < text.size() && text[end] != c && text[end] != '\n')
        end += text[end] == '\\' ? 2U : 1U;
      end = std::min(end + 1, text.size());
      blank(i, end);
    } else if (c == '#') {
      directive = true;
    } else if (c == '\n') {
      directive = false;
    }
    i = end;
  }
  return out;
}

struct Include {
  std::size_t line;
  bool quoted;
  std::string path;
};

struct Source {
  std::vector<Include> includes;
  std::vector<std::string> code;  // one entry a line
};

Source read_source(const std::string& text) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  Source out;
  const std::string code = code_only(text);
  for (std::size_t begin = 0; begin < code.size();) {
    const std::size_t end = std::min(code.find('\n', begin), code.size());
    out.code.push_back(code.substr(begin, end - begin));
    std::smatch found;
    if (std::regex_search(out.code.back(), found, kInclude)) {
      out.includes.push_back({out.code.size(), found[1] == "\"", found[2]});
    }
    begin = end + 1;
  }
  return out;
}

// A header that the build makes from a .proto, or that stands in the tree.
bool exists(const Tree& tree, const std::string& path) {
  return path.starts_with("imunoise/") || tree.contains(path);
}

std::string list(const std::vector<std::string_view>& names) {
  std::string out;
  for (const std::string_view name : names) out += (out.empty() ? "" : ", ") + std::string(name);
  return out.empty() ? "nothing" : out;
}

using Sources = std::map<std::string, Source>;

std::string at(const std::string& path, std::size_t line) {
  return path + ":" + std::to_string(line) + ": ";
}

void check_rooms(const Tree& tree, const std::string& path, const Source& source,
                 std::vector<std::string>& out) {
  const Room* const room = find_room(path);
  if (room == nullptr) {
    out.push_back(path + ": lies in no room of the table (tests/layering/include_rules.cpp)");
    return;
  }
  for (const Include& include : source.includes) {
    if (!include.quoted) continue;
    if (!exists(tree, include.path)) {
      out.push_back(at(path, include.line) + "includes \"" + include.path +
                    "\", which is no path from the project's root");
      continue;
    }
    const std::string other = room_of(include.path);
    const bool same = other == room->path;
    const bool any = !room->may_include.empty() && room->may_include.front() == "*";
    if (!same && !any && !lies_in_any(other, room->may_include)) {
      out.push_back(at(path, include.line) + "includes " + include.path + "; " +
                    std::string(room->path) + " may include " + list(room->may_include));
    }
  }
}

void check_confined(const std::string& path, const Source& source, std::vector<std::string>& out) {
  for (const Include& include : source.includes) {
    for (const Confined& rule : confined_headers()) {
      if (std::regex_match(include.path, rule.pattern) && !allowed(rule, path)) {
        out.push_back(at(path, include.line) + "includes <" + include.path +
                      ">: " + std::string(rule.reason));
      }
    }
  }
  for (std::size_t i = 0; i < source.code.size(); ++i) {
    for (const Confined& rule : confined_code()) {
      std::smatch found;
      if (!allowed(rule, path) && std::regex_search(source.code[i], found, rule.pattern)) {
        out.push_back(at(path, i + 1) + found.str() + ": " + std::string(rule.reason));
      }
    }
  }
}

// The blind trial's generator must not share a line with the detector, not even through other
// headers.
void check_generator(const Sources& sources, std::vector<std::string>& out) {
  for (const auto& [path, source] : sources) {
    if (!lies_in(path, "tests/hidden_effects/generator")) continue;
    std::set<std::string> seen = {path};
    std::vector<std::string> open = {path};
    while (!open.empty()) {
      const auto next = sources.find(open.back());
      open.pop_back();
      if (next == sources.end()) continue;
      for (const Include& include : next->second.includes) {
        if (!include.quoted || !seen.insert(include.path).second) continue;
        open.push_back(include.path);
        if (lies_in_any(include.path,
                        {"core/process", "core/model", "core/effect", "core/regression",
                         "core/search", "core/diagnosis", "study"})) {
          out.push_back(path + ": reaches " + include.path + " through " + next->first +
                        "; the blind trial's generator may not");
        }
      }
    }
  }
}

}  // namespace

Tree read_tree(const std::string& project_root) {
  namespace fs = std::filesystem;
  Tree out;
  for (const char* const folder :
       {"core", "recording", "study", "drivers", "daemon", "cli", "tests", "bench"}) {
    const fs::path root = fs::path(project_root) / folder;
    if (!fs::exists(root)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp" && extension != ".inl") continue;
      std::ifstream file(entry.path(), std::ios::binary);
      out[fs::relative(entry.path(), project_root).generic_string()] =
          std::string(std::istreambuf_iterator<char>(file), {});
    }
  }
  return out;
}

std::string room_of(std::string_view path) {
  if (path.starts_with("imunoise/")) return "proto";
  const Room* const room = find_room(path);
  return room == nullptr ? "" : std::string(room->path);
}

std::vector<std::string> layering_violations(const Tree& tree) {
  std::vector<std::string> out;
  Sources sources;
  for (const auto& [path, text] : tree) sources[path] = read_source(text);
  for (const auto& [path, source] : sources) {
    check_rooms(tree, path, source, out);
    check_confined(path, source, out);
  }
  check_generator(sources, out);
  return out;
}

std::vector<std::string> unguarded_headers(const Tree& tree) {
  std::vector<std::string> out;
  for (const auto& [path, text] : tree) {
    if (path.ends_with(".h") && !code_only(text).starts_with("#pragma once\n") &&
        code_only(text).find("\n#pragma once\n") == std::string::npos) {
      out.push_back(path);
    }
  }
  return out;
}

std::vector<std::string> long_files(const Tree& tree) {
  std::vector<std::string> out;
  for (const auto& [path, text] : tree) {
    const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    if (lines > kMostLines && !lies_in(path, "tests") && !lies_in(path, "bench")) {
      out.push_back(path + ": " + std::to_string(lines) + " lines");
    }
  }
  return out;
}

}  // namespace imunoise::testing
