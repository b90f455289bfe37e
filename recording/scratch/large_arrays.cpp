#include "recording/scratch/large_arrays.h"

#ifndef IMUNOISE_SANITIZED

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <thread>

#include "recording/scratch/scratch_file.h"

// The linker's option --wrap leads calls of malloc in this program to __wrap_malloc, and calls of
// __real_malloc to the C library's.
// NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)
extern "C" {
void* __real_malloc(std::size_t bytes);
void* __real_calloc(std::size_t count, std::size_t bytes);
void* __real_realloc(void* old, std::size_t bytes);
void __real_free(void* old);
void* __wrap_malloc(std::size_t bytes);
void* __wrap_calloc(std::size_t count, std::size_t bytes);
void* __wrap_realloc(void* old, std::size_t bytes);
void __wrap_free(void* old);
}

namespace imunoise::recording {
namespace {

constexpr std::chrono::milliseconds kLook{2};  // between two looks at what is mapped

// Lives as long as the process: memory is freed until its very end.
struct State {
  LargeArrays how;
  std::mutex opening;
  bool tried = false;
};

State* state = nullptr;                      // set once, before there are threads
std::atomic<ScratchFile*> scratch{nullptr};  // set once, when it is first needed
std::atomic<std::int64_t> in_memory{0};      // bytes of large arrays in ordinary memory
std::atomic<bool> forked{false};

// Bytes of mapped files that are in this process's memory.
std::size_t mapped_now(int statm) {
  std::array<char, 128> text{};
  const ssize_t got = ::pread(statm, text.data(), text.size(), 0);
  std::array<std::size_t, 3> pages{};  // of addresses, in memory, of these in files
  const char* at = text.data();
  const char* const end = at + std::max<ssize_t>(got, 0);
  for (std::size_t& one : pages) {
    const auto [stop, error] = std::from_chars(at, end, one);
    if (error != std::errc{}) return 0;
    at = std::min(stop + 1, end);
  }
  static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return pages[2] * page;
}

[[noreturn]] void watch(ScratchFile& file, const LargeArrays& how) {
  const int statm = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  for (;;) {
    std::this_thread::sleep_for(kLook);
    if (mapped_now(statm) > how.mapped) file.shrink(how.mapped / 2);
  }
}

// On a thread that takes no signals, which are for others.
void start_watch(ScratchFile& file, const LargeArrays& how) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread([&file, &how] { watch(file, how); }).detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

// Null where there is none. Small allocations in here come from ordinary memory.
ScratchFile* opened() {
  if (ScratchFile* const file = scratch.load(std::memory_order_acquire)) return file;
  const std::lock_guard lock(state->opening);
  if (state->tried) return scratch.load(std::memory_order_acquire);
  state->tried = true;
  std::error_code wrong;
  const std::optional<int> descriptor = ScratchFile::create(state->how.folder);
  if (!descriptor) return nullptr;
  // A quarter of the disk is left to others.
  const auto space = std::filesystem::space(state->how.folder, wrong);
  const std::size_t most = wrong ? 0 : space.available / 4 * 3;
  auto* const file = new ScratchFile(*descriptor, most);
  pthread_atfork(nullptr, nullptr, [] { forked = true; });
  scratch.store(file, std::memory_order_release);
  start_watch(*file, state->how);
  return file;
}

bool fits(std::size_t bytes) {
  return in_memory.load(std::memory_order_relaxed) + static_cast<std::int64_t>(bytes) <=
         static_cast<std::int64_t>(state->how.in_memory);
}

void* counted(void* large) {
  if (large != nullptr) in_memory += static_cast<std::int64_t>(malloc_usable_size(large));
  return large;
}

bool is_large(std::size_t bytes) { return bytes >= kLargeArray && state != nullptr; }

// From the file, or null: it lies in memory.
void* from_file(std::size_t bytes) {
  if (fits(bytes) || forked) return nullptr;
  ScratchFile* const file = opened();
  return file == nullptr ? nullptr : file->take(bytes);
}

bool in_file(const void* at) {
  const ScratchFile* const file = scratch.load(std::memory_order_acquire);
  return file != nullptr && file->holds(at);
}

}  // namespace

void keep_large_arrays(const LargeArrays& how) {
  if (how.folder.empty()) return;
  static State only{how, {}, false};
  state = &only;
}

}  // namespace imunoise::recording

using imunoise::recording::counted;
using imunoise::recording::forked;
using imunoise::recording::from_file;
using imunoise::recording::in_file;
using imunoise::recording::in_memory;
using imunoise::recording::is_large;
using imunoise::recording::kLargeArray;
using imunoise::recording::scratch;

void* __wrap_malloc(std::size_t bytes) {
  if (!is_large(bytes)) return __real_malloc(bytes);
  void* const out = from_file(bytes);
  return out != nullptr ? out : counted(__real_malloc(bytes));
}

void* __wrap_calloc(std::size_t count, std::size_t bytes) {
  std::size_t all = 0;
  if (__builtin_mul_overflow(count, bytes, &all) || !is_large(all))
    return __real_calloc(count, bytes);
  void* const out = from_file(all);
  return out != nullptr ? std::memset(out, 0, all) : counted(__real_calloc(count, bytes));
}

void __wrap_free(void* old) {
  if (in_file(old)) {
    if (!forked) scratch.load()->give_back(old);
    return;
  }
  const std::size_t bytes = old == nullptr ? 0 : malloc_usable_size(old);
  if (bytes >= kLargeArray) in_memory -= static_cast<std::int64_t>(bytes);
  __real_free(old);
}

void* __wrap_realloc(void* old, std::size_t bytes) {
  if (old == nullptr) return __wrap_malloc(bytes);
  const bool file = in_file(old);
  const std::size_t before = file ? scratch.load()->size_of(old) : malloc_usable_size(old);
  if (bytes == 0 || (before < kLargeArray && bytes < kLargeArray))
    return __real_realloc(old, bytes);
  void* const out = __wrap_malloc(bytes);
  if (out == nullptr) return nullptr;
  std::memcpy(out, old, std::min(before, bytes));
  __wrap_free(old);
  return out;
}
// NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)

// As the standard library's, but by the functions above.
void* operator new(std::size_t bytes) {
  for (;;) {
    if (void* const out = __wrap_malloc(std::max<std::size_t>(bytes, 1))) return out;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}
void operator delete(void* old) noexcept { __wrap_free(old); }
void operator delete(void* old, std::size_t) noexcept { __wrap_free(old); }

#else

namespace imunoise::recording {

void keep_large_arrays(const LargeArrays&) {}

}  // namespace imunoise::recording

#endif
