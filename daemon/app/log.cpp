#include "daemon/app/log.h"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/sinks/systemd_sink.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

namespace imunoise::app {
namespace {

constexpr std::size_t kLines = 20;
constexpr std::chrono::seconds kWindow{60};

// Whether standard error is the journal: systemd names its device and inode, and what it started
// may have put another file in its place.
bool in_journal() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing of ours changes the environment.
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat errors {};
  return stream != nullptr && ::fstat(STDERR_FILENO, &errors) == 0 &&
         fmt::format("{}:{}", errors.st_dev, errors.st_ino) == stream;
}

spdlog::sink_ptr make_sink() {
  if (in_journal()) {
    return std::make_shared<spdlog::sinks::systemd_sink_mt>("imunoised");
  }
  auto out = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  out->set_pattern("%Y-%m-%dT%H:%M:%S.%e %l: %v");
  return out;
}

}  // namespace

Log::Log()
    : logger_(std::make_shared<spdlog::logger>("imunoised", make_sink())), limit_(kLines, kWindow) {
  logger_->flush_on(spdlog::level::info);
}

void Log::fact(const std::string& text) { logger_->info("{}", text); }
void Log::warning(const std::string& text) { logger_->warn("{}", text); }
void Log::error(const std::string& text) { logger_->error("{}", text); }

void Log::chatter(const std::string& source, const std::string& text) {
  std::optional<std::size_t> left_out;
  {
    const std::lock_guard lock(mutex_);
    left_out = limit_.pass(source, std::chrono::steady_clock::now());
  }
  if (!left_out) return;
  if (*left_out > 0) fact(fmt::format("{}: {} lines were left out", source, *left_out));
  fact(fmt::format("{}: {}", source, text));
}

}  // namespace imunoise::app
