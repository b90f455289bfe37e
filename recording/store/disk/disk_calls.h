#pragma once

// Which calls of a disk have not returned yet: a disk that hangs returns no error.

#include <chrono>
#include <filesystem>
#include <list>
#include <mutex>
#include <string_view>
#include <vector>

namespace imunoise::recording {

/// A call that has not returned.
struct DiskCall {
  std::string_view what;  ///< "write", "sync", "rename", ...
  std::filesystem::path path;
  std::chrono::steady_clock::time_point since;
};

/// Thread-safe.
class DiskCalls {
 public:
  /// One call, or work of several calls, from its beginning to its end.
  class Watch {
   public:
    /// `what` is a literal; `of` outlives the watch.
    Watch(DiskCalls& of, std::string_view what, const std::filesystem::path& path);
    ~Watch();
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;
    /// Work of several calls makes progress: its time counts from now.
    void progress();

   private:
    DiskCalls& of_;
    std::list<DiskCall>::iterator place_;
  };

  /// Those in progress, the oldest first.
  std::vector<DiskCall> pending() const;

 private:
  mutable std::mutex mutex_;
  std::list<DiskCall> calls_;
};

}  // namespace imunoise::recording
