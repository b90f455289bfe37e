#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace imunoise::emulator {

/// Whether an emulated device keeps what it sent, for a test to compare; one that runs for days
/// does not.
enum class Memory { kAll, kNone };

/// What was sent so far, or how much of it.
template <class Item>
class History {
 public:
  explicit History(Memory memory) : memory_(memory) {}

  void push_back(Item item) {
    ++size_;
    if (memory_ == Memory::kAll) items_.push_back(std::move(item));
  }
  /// All that there were, kept or not.
  std::size_t size() const { return size_; }
  const std::vector<Item>& items() const { return items_; }

 private:
  Memory memory_;
  std::size_t size_ = 0;
  std::vector<Item> items_;
};

}  // namespace imunoise::emulator
