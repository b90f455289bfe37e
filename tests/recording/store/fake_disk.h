#pragma once

// A disk in memory that forgets what was not synced, gets full, fails, or cannot be written.

#include <array>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <vector>

#include "recording/store/disk/file_system.h"

namespace imunoise::recording {

/// Thread-safe. Survives as ext4 and xfs promise: the contents of a file up to its last sync, the
/// names in a folder up to its last sync; a rename happens whole or not at all; anything else may
/// or may not.
class FakeDisk final : public FileSystem {
 public:
  using Path = std::filesystem::path;

  Result<std::unique_ptr<WritableFile>> create(const Path& path) override;
  Result<std::vector<std::string>> list(const Path& folder) const override;
  Result<bool> exists(const Path& path) const override;
  Result<std::uint64_t> free_space(const Path& path) const override;
  Result<void> rename(const Path& from, const Path& to) override;
  Result<void> remove(const Path& path) override;
  Result<void> make_folder(const Path& path) override;
  Result<void> sync_folder(const Path& path) override;
  Result<std::unique_ptr<FolderLock>> lock(const Path& folder) override;

  /// Calls that change something (or sync) from now on until the power fails: they and all later
  /// ones return errors.
  void cut_power_after(int calls);
  /// Changing calls so far.
  int calls() const;
  /// What happens to what was not synced.
  enum class Unsynced { kLost, kKept, kAny };
  /// The disk as it is found when the power is back.
  void restore_power(Unsynced unsynced, std::uint64_t seed);

  void set_capacity(std::size_t bytes);  ///< Of all files; a write beyond it is cut short.
  void set_read_only(bool read_only);
  void fail_syncs(bool fail);  ///< EIO; what was written stays readable.
  void fail_next_sync();
  /// Only in this folder, from now on.
  void fail_syncs_in(const Path& folder);
  /// Syncs of files in this folder do not return until let_go().
  void hang_syncs_in(const Path& folder);
  void let_go();

  /// What a program may ask of a disk.
  enum class Call {
    kCreate,
    kWrite,
    kSync,
    kRead,
    kList,
    kExists,
    kRename,
    kRemove,
    kMakeFolder,
    kSyncFolder,
    kLock,
    kFreeSpace,
  };
  static constexpr int kKinds = 12;
  /// The `nth` call of this kind from now on, from 1, fails once: EIO. A write that fails leaves
  /// half of its bytes. `done`: the disk has done it all the same, only the answer is an error
  /// (reads and lists give nothing in any case).
  void fail_once(Call kind, int nth, bool done = false);
  /// No more of them.
  void heal();
  /// Whether all of them have come.
  bool failed() const;
  /// So many so far.
  int calls(Call kind) const;
  std::uint64_t bytes_read() const;
  std::uint64_t bytes_written() const;

  /// For tests that damage a file.
  void overwrite(const Path& path, const std::string& bytes);

 private:
  struct Content {
    std::string live;
    std::string synced;
  };
  using Names = std::map<std::string, std::shared_ptr<Content>>;  // of a folder: null
  // Of a folder: names set or (without a value) removed, all or none.
  using Change = std::vector<std::pair<std::string, std::optional<std::shared_ptr<Content>>>>;
  struct Folder {
    Names live;
    Names synced;
    std::vector<Change> since;  // the last sync
  };
  class File;

  struct Fault {
    int left = 0;  // calls until it comes; 0: it came
    bool done = false;
  };
  Result<std::string> read_up_to(const Path& path, std::uint64_t limit) const override;
  Result<void> begin(const Path& path);  // counts a changing call; the lock is held
  std::optional<Fault> fault(Call kind) const;
  Result<void> attempt(Call kind, const Path& path, const std::function<Result<void>()>& call);
  Result<std::unique_ptr<WritableFile>> create_file(const Path& path);
  Result<void> rename_file(const Path& from, const Path& to);
  Result<void> remove_file(const Path& path);
  Result<void> make_one_folder(const Path& path);
  Result<void> sync_one_folder(const Path& path);
  Result<Folder*> parent(const Path& path);
  std::size_t used() const;
  bool sync_fails(const Path& folder);

  mutable std::mutex mutex_;
  std::map<Path, Folder> folders_ = {{"/", {}}};
  mutable std::array<int, kKinds> calls_of_ = {};
  mutable std::array<std::vector<Fault>, kKinds> faults_ = {};
  mutable std::uint64_t bytes_read_ = 0;
  std::uint64_t bytes_written_ = 0;
  int calls_ = 0;
  int left_ = -1;  // calls until the power fails; negative: it does not
  std::size_t capacity_ = SIZE_MAX;
  bool read_only_ = false;
  bool fail_syncs_ = false;
  bool fail_next_ = false;
  Path failing_;  // folder whose syncs fail
  Path hanging_;  // folder whose syncs hang
  std::condition_variable released_;
};

}  // namespace imunoise::recording
