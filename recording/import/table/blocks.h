#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <vector>

namespace imunoise::recording {

/// Memory of whole pages, which go back to the system when they are freed. Blocks of several
/// columns lie interleaved: the heap would keep them all until the program ends.
template <class Number>
struct Pages {
  using value_type = Number;

  Pages() = default;
  template <class Other>
  explicit Pages(const Pages<Other>& /*other*/) {}

  Number* allocate(std::size_t count) {
    void* const out = ::mmap(nullptr, count * sizeof(Number), PROT_READ | PROT_WRITE,
                             MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (out == MAP_FAILED) throw std::bad_alloc();
    return static_cast<Number*>(out);
  }
  void deallocate(Number* from, std::size_t count) { ::munmap(from, count * sizeof(Number)); }
  friend bool operator==(Pages, Pages) { return true; }
};

/// Numbers that come one by one, kept in blocks: memory holds them once.
template <class Number>
class Blocks {
 public:
  void push(Number value) {
    if (blocks_.empty() || blocks_.back().size() == kNumbers) {
      blocks_.emplace_back().reserve(kNumbers);
    }
    blocks_.back().push_back(value);
  }
  std::size_t size() const {
    return blocks_.empty() ? 0 : (blocks_.size() - 1) * kNumbers + blocks_.back().size();
  }
  /// All of them; none stay behind.
  std::vector<Number> take() {
    std::vector<Number> out;
    out.reserve(size());
    for (Block& block : blocks_) {
      out.insert(out.end(), block.begin(), block.end());
      block = {};
    }
    blocks_.clear();
    return out;
  }

 private:
  static constexpr std::size_t kNumbers = std::size_t{1} << 16U;
  using Block = std::vector<Number, Pages<Number>>;
  std::vector<Block> blocks_;
};

}  // namespace imunoise::recording
