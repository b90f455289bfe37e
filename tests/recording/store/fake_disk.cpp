#include "tests/recording/store/fake_disk.h"

#include <algorithm>
#include <random>
#include <utility>

namespace imunoise::recording {
namespace {

tl::unexpected<Error> trouble(const std::filesystem::path& path, const std::string& what) {
  return fail(path.string() + ": " + what);
}

constexpr const char* kInputOutput = "Input/output error";

class Nothing final : public FolderLock {};

}  // namespace

class FakeDisk::File final : public WritableFile {
 public:
  File(FakeDisk& disk, Path path, std::shared_ptr<Content> content)
      : disk_(disk), path_(std::move(path)), content_(std::move(content)) {}

  Result<void> write(std::string_view bytes) override {
    const std::lock_guard guard(disk_.mutex_);
    if (auto good = disk_.begin(path_); !good) return good;
    if (const auto fault = disk_.fault(Call::kWrite)) {
      content_->live += bytes.substr(0, fault->done ? bytes.size() : bytes.size() / 2);
      return trouble(path_, kInputOutput);
    }
    disk_.bytes_written_ += bytes.size();
    const std::size_t used = disk_.used();
    const std::size_t room = disk_.capacity_ > used ? disk_.capacity_ - used : 0;
    content_->live += bytes.substr(0, room);
    if (room < bytes.size()) return trouble(path_, "No space left on device");
    return {};
  }
  Result<void> sync() override {
    std::unique_lock guard(disk_.mutex_);
    if (auto good = disk_.begin(path_); !good) return good;
    if (const auto fault = disk_.fault(Call::kSync)) {
      if (fault->done) content_->synced = content_->live;
      return trouble(path_, kInputOutput);
    }
    disk_.released_.wait(guard, [&] { return path_.parent_path() != disk_.hanging_; });
    if (disk_.sync_fails(path_.parent_path())) return trouble(path_, kInputOutput);
    content_->synced = content_->live;
    return {};
  }

 private:
  FakeDisk& disk_;
  Path path_;
  std::shared_ptr<Content> content_;
};

Result<void> FakeDisk::begin(const Path& path) {
  ++calls_;
  if (left_ == 0) return trouble(path, "the power is cut");
  if (left_ > 0) --left_;
  if (read_only_) return trouble(path, "Read-only file system");
  return {};
}

Result<FakeDisk::Folder*> FakeDisk::parent(const Path& path) {
  const auto found = folders_.find(path.parent_path());
  if (found == folders_.end()) return trouble(path, "No such file or directory");
  return &found->second;
}

bool FakeDisk::sync_fails(const Path& folder) {
  return std::exchange(fail_next_, false) || fail_syncs_ || folder == failing_;
}

std::size_t FakeDisk::used() const {
  std::size_t sum = 0;
  for (const auto& [path, folder] : folders_) {
    for (const auto& [name, content] : folder.live) sum += content ? content->live.size() : 0;
  }
  return sum;
}

std::optional<FakeDisk::Fault> FakeDisk::fault(Call kind) const {
  const auto at = static_cast<std::size_t>(kind);
  ++calls_of_[at];
  std::optional<Fault> out;
  for (Fault& one : faults_[at]) {
    if (one.left > 0 && --one.left == 0) out = one;
  }
  return out;
}

void FakeDisk::fail_once(Call kind, int nth, bool done) {
  const std::lock_guard guard(mutex_);
  faults_[static_cast<std::size_t>(kind)].push_back({nth, done});
}

void FakeDisk::heal() {
  const std::lock_guard guard(mutex_);
  faults_ = {};
}

bool FakeDisk::failed() const {
  const std::lock_guard guard(mutex_);
  return std::all_of(faults_.begin(), faults_.end(), [](const auto& faults) {
    return std::all_of(faults.begin(), faults.end(), [](const Fault& f) { return f.left == 0; });
  });
}

int FakeDisk::calls(Call kind) const {
  const std::lock_guard guard(mutex_);
  return calls_of_[static_cast<std::size_t>(kind)];
}

std::uint64_t FakeDisk::bytes_read() const {
  const std::lock_guard guard(mutex_);
  return bytes_read_;
}

std::uint64_t FakeDisk::bytes_written() const {
  const std::lock_guard guard(mutex_);
  return bytes_written_;
}

Result<std::unique_ptr<WritableFile>> FakeDisk::create(const Path& path) {
  const std::lock_guard guard(mutex_);
  const auto fails = fault(Call::kCreate);
  if (fails && fails->done) (void)create_file(path);
  if (fails) return trouble(path, kInputOutput);
  return create_file(path);
}

Result<void> FakeDisk::rename(const Path& from, const Path& to) {
  const std::lock_guard guard(mutex_);
  return attempt(Call::kRename, to, [&] { return rename_file(from, to); });
}

Result<void> FakeDisk::remove(const Path& path) {
  const std::lock_guard guard(mutex_);
  return attempt(Call::kRemove, path, [&] { return remove_file(path); });
}

Result<void> FakeDisk::make_folder(const Path& path) {
  const std::lock_guard guard(mutex_);
  return attempt(Call::kMakeFolder, path, [&] { return make_one_folder(path); });
}

Result<void> FakeDisk::sync_folder(const Path& path) {
  const std::lock_guard guard(mutex_);
  return attempt(Call::kSyncFolder, path, [&] { return sync_one_folder(path); });
}

Result<void> FakeDisk::attempt(Call kind, const Path& path,
                               const std::function<Result<void>()>& call) {
  const auto fails = fault(kind);
  if (!fails) return call();
  if (fails->done) (void)call();
  return trouble(path, kInputOutput);
}

Result<std::unique_ptr<WritableFile>> FakeDisk::create_file(const Path& path) {
  if (auto good = begin(path); !good) return tl::make_unexpected(good.error());
  const auto folder = parent(path);
  if (!folder) return tl::make_unexpected(folder.error());
  const auto content = std::make_shared<Content>();
  const std::string name = path.filename();
  (*folder)->live[name] = content;
  (*folder)->since.push_back({{name, content}});
  return std::make_unique<File>(*this, path, content);
}

Result<std::string> FakeDisk::read_up_to(const Path& path, std::uint64_t limit) const {
  const std::lock_guard guard(mutex_);
  if (fault(Call::kRead)) return trouble(path, kInputOutput);
  const auto folder = folders_.find(path.parent_path());
  if (folder == folders_.end()) return trouble(path, "No such file or directory");
  const auto found = folder->second.live.find(path.filename());
  if (found == folder->second.live.end() || !found->second) {
    return trouble(path, "No such file or directory");
  }
  if (found->second->live.size() > limit) return tl::make_unexpected(too_large(path, limit));
  bytes_read_ += found->second->live.size();
  return found->second->live;
}

Result<std::vector<std::string>> FakeDisk::list(const Path& path) const {
  const std::lock_guard guard(mutex_);
  if (fault(Call::kList)) return trouble(path, kInputOutput);
  const auto folder = folders_.find(path);
  if (folder == folders_.end()) return trouble(path, "No such file or directory");
  std::vector<std::string> out;
  for (const auto& [name, content] : folder->second.live)
    out.push_back(content ? name : name + "/");
  std::sort(out.begin(), out.end());  // a folder's '/' counts
  return out;
}

Result<bool> FakeDisk::exists(const Path& path) const {
  const std::lock_guard guard(mutex_);
  if (fault(Call::kExists)) return trouble(path, kInputOutput);
  const auto above = folders_.find(path.parent_path());
  return folders_.contains(path) ||
         (above != folders_.end() && above->second.live.contains(path.filename()));
}

Result<std::uint64_t> FakeDisk::free_space(const Path& path) const {
  const std::lock_guard guard(mutex_);
  if (fault(Call::kFreeSpace)) return trouble(path, kInputOutput);
  return capacity_ - std::min(capacity_, used());
}

Result<void> FakeDisk::rename_file(const Path& from, const Path& to) {
  if (auto good = begin(to); !good) return good;
  const auto folder = parent(from);
  if (!folder || from.parent_path() != to.parent_path() ||
      !(*folder)->live.contains(from.filename())) {
    return trouble(from, "No such file or directory");
  }
  Names& live = (*folder)->live;
  const std::shared_ptr<Content> content = live[from.filename()];
  live.erase(from.filename());
  live[to.filename()] = content;
  (*folder)->since.push_back({{from.filename(), std::nullopt}, {to.filename(), content}});
  return {};
}

Result<void> FakeDisk::remove_file(const Path& path) {
  if (auto good = begin(path); !good) return good;
  const auto itself = folders_.find(path);
  if (itself != folders_.end() && !itself->second.live.empty())
    return trouble(path, "Directory not empty");
  const auto folder = parent(path);
  if (!folder || (*folder)->live.erase(path.filename()) == 0) {
    return trouble(path, "No such file or directory");
  }
  if (itself != folders_.end()) folders_.erase(itself);
  (*folder)->since.push_back({{path.filename(), std::nullopt}});
  return {};
}

Result<void> FakeDisk::make_one_folder(const Path& path) {
  if (folders_.contains(path)) return {};
  if (auto good = begin(path); !good) return good;
  const auto folder = parent(path);
  if (!folder) return tl::make_unexpected(folder.error());
  (*folder)->live[path.filename()] = nullptr;
  (*folder)->since.push_back({{path.filename(), std::shared_ptr<Content>()}});
  folders_[path];
  return {};
}

Result<void> FakeDisk::sync_one_folder(const Path& path) {
  if (auto good = begin(path); !good) return good;
  if (sync_fails(path)) return trouble(path, kInputOutput);
  const auto folder = folders_.find(path);
  if (folder == folders_.end()) return trouble(path, "No such file or directory");
  folder->second.synced = folder->second.live;
  folder->second.since.clear();
  return {};
}

Result<std::unique_ptr<FolderLock>> FakeDisk::lock(const Path& folder) {
  const std::lock_guard guard(mutex_);
  if (fault(Call::kLock)) return trouble(folder, kInputOutput);
  return std::make_unique<Nothing>();
}

void FakeDisk::cut_power_after(int calls) {
  const std::lock_guard guard(mutex_);
  left_ = calls;
}

int FakeDisk::calls() const {
  const std::lock_guard guard(mutex_);
  return calls_;
}

void FakeDisk::restore_power(Unsynced unsynced, std::uint64_t seed) {
  const std::lock_guard guard(mutex_);
  std::mt19937_64 random(seed);
  left_ = -1;
  const auto kept = [&] {
    return unsynced == Unsynced::kKept || (unsynced == Unsynced::kAny && random() % 2 == 0);
  };
  for (auto& [path, folder] : folders_) {
    for (const Change& change : folder.since) {
      if (!kept()) continue;
      for (const auto& [name, content] : change) {
        if (content) {
          folder.synced[name] = *content;
        } else {
          folder.synced.erase(name);
        }
      }
    }
    folder.live = folder.synced;
    folder.since.clear();
  }
  // Folders whose name was forgotten are gone with what was in them.
  std::erase_if(folders_, [&](const auto& entry) {
    const Path& path = entry.first;
    for (Path p = path; p != "/"; p = p.parent_path()) {
      const auto above = folders_.find(p.parent_path());
      if (above == folders_.end() || !above->second.live.contains(p.filename())) return true;
    }
    return false;
  });
  for (auto& [path, folder] : folders_) {
    for (auto& [name, content] : folder.live) {
      if (!content) continue;
      // Files only grow between syncs: some of the new bytes, some of them not yet filled in.
      std::string grown = content->live.substr(content->synced.size());
      if (unsynced == Unsynced::kLost) grown.clear();
      if (unsynced == Unsynced::kAny && !grown.empty()) {
        grown.resize(random() % (grown.size() + 1));
        if (random() % 3 == 0) {
          const std::size_t from = random() % (grown.size() + 1);
          std::fill(grown.begin() + static_cast<std::ptrdiff_t>(from), grown.end(), '\0');
        }
      }
      content->live = content->synced + grown;
      content->synced = content->live;
    }
  }
}

void FakeDisk::set_capacity(std::size_t bytes) {
  const std::lock_guard guard(mutex_);
  capacity_ = bytes;
}

void FakeDisk::set_read_only(bool read_only) {
  const std::lock_guard guard(mutex_);
  read_only_ = read_only;
}

void FakeDisk::fail_syncs(bool fail) {
  const std::lock_guard guard(mutex_);
  fail_syncs_ = fail;
}

void FakeDisk::fail_next_sync() {
  const std::lock_guard guard(mutex_);
  fail_next_ = true;
}

void FakeDisk::fail_syncs_in(const Path& folder) {
  const std::lock_guard guard(mutex_);
  failing_ = folder;
}

void FakeDisk::hang_syncs_in(const Path& folder) {
  const std::lock_guard guard(mutex_);
  hanging_ = folder;
}

void FakeDisk::let_go() {
  hang_syncs_in({});
  released_.notify_all();
}

void FakeDisk::overwrite(const Path& path, const std::string& bytes) {
  const std::lock_guard guard(mutex_);
  Content& content = *folders_.at(path.parent_path()).live.at(path.filename());
  content.live = bytes;
  content.synced = bytes;
}

}  // namespace imunoise::recording
