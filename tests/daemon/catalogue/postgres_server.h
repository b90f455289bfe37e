#pragma once

// A PostgreSQL server of Debian's package, started in a folder of its own, on a socket there.

#include <pwd.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "tests/study/simulated_recording.h"

namespace imunoise::testing {

class PostgresServer {
 public:
  PostgresServer() {
    if (const auto bin = programs()) {
      bin_ = *bin;
    } else {
      trouble_ = "PostgreSQL's server is not installed (package postgresql)";
      return;
    }
    // It refuses to run as root: then as the user that its package made.
    if (::geteuid() == 0) {
      const passwd* const user = ::getpwnam("postgres");
      if (user == nullptr || ::chown(folder_.path().c_str(), user->pw_uid, user->pw_gid) != 0) {
        trouble_ = "PostgreSQL does not run as root, and there is no user postgres";
        return;
      }
    }
    if (!run("initdb -D '" + data() + "' --auth=trust -U imunoise --no-sync"))
      trouble_ = "initdb failed: " + log();
    else if (!run("pg_ctl -D '" + data() + "' -w -o \"-k " + folder_.path().string() +
                  " -h '' -F\" -l '" + data() + ".log' start"))
      trouble_ = "the server does not start: " + log();
    else
      running_ = true;
  }
  ~PostgresServer() {
    if (running_) run("pg_ctl -D '" + data() + "' -m immediate -w stop");
  }
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  /// Why there is none; empty when it runs.
  const std::string& trouble() const { return trouble_; }
  /// A catalogue in a database of this name, which is made.
  std::string make_database(const std::string& name) const {
    run("createdb -h '" + folder_.path().string() + "' -U imunoise " + name);
    return "postgresql://host=" + folder_.path().string() + " user=imunoise dbname=" + name;
  }

 private:
  static std::optional<std::filesystem::path> programs() {
    const std::filesystem::path all = "/usr/lib/postgresql";
    if (!std::filesystem::exists(all)) return std::nullopt;
    for (const auto& version : std::filesystem::directory_iterator(all)) {
      if (std::filesystem::exists(version.path() / "bin" / "initdb")) return version.path() / "bin";
    }
    return std::nullopt;
  }
  std::string data() const { return (folder_.path() / "data").string(); }
  std::string log() const { return (folder_.path() / "log").string(); }
  bool run(const std::string& program) const {
    const std::string command = "cd / && '" + bin_.string() + "'/" + program;
    std::string quoted;
    for (const char c : command) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    const std::string user = ::geteuid() == 0 ? "runuser -u postgres -- " : "";
    return std::system((user + "sh -c '" + quoted + "' >'" + log() + "' 2>&1").c_str()) == 0;
  }

  TemporaryFolder folder_;
  std::filesystem::path bin_;
  std::string trouble_;
  bool running_ = false;
};

}  // namespace imunoise::testing
