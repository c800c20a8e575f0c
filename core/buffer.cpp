#include "core/buffer.h"

#include <cstdlib>
#include <mutex>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace striae {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::size_t kLarge = 2 * kHugePage;

std::size_t Rounded(std::size_t bytes) {
  const std::size_t unit = bytes >= kLarge ? kHugePage : std::size_t{64};
  return (bytes + unit - 1) / unit * unit;
}

void* Fresh(std::size_t rounded) {
  const bool large = rounded >= kLarge;
  void* memory = std::aligned_alloc(large ? kHugePage : std::size_t{64}, rounded);
  if (memory == nullptr) throw std::bad_alloc();
#if defined(MADV_HUGEPAGE)
  if (large) madvise(memory, rounded, MADV_HUGEPAGE);  // advice: nothing is lost where it is not taken
#endif
  return memory;
}

/// Large blocks that were given back, up to a limit.
class Shelf {
 public:
  /// The smallest block that fits, if no more than a third of it would lie idle.
  void* Take(std::size_t rounded) {
    const std::lock_guard lock(mutex_);
    Block* best = nullptr;
    for (Block& block : blocks_) {
      if (block.memory == nullptr || block.size < rounded || block.size - rounded > block.size / 3) continue;
      if (best == nullptr || block.size < best->size) best = &block;
    }
    return best != nullptr ? Clear(*best) : nullptr;
  }
  /// False when there is no room: the caller keeps the block.
  bool Put(void* memory, std::size_t size) noexcept {
    const std::lock_guard lock(mutex_);
    if (held_ + size > kMost) return false;
    for (Block& block : blocks_) {
      if (block.memory != nullptr) continue;
      block = {memory, size};
      held_ += size;
      return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t kMost = std::size_t{192} << 20;
  struct Block {
    void* memory = nullptr;
    std::size_t size = 0;
  };
  void* Clear(Block& block) {
    held_ -= block.size;
    return std::exchange(block.memory, nullptr);
  }
  std::mutex mutex_;
  Block blocks_[8];
  std::size_t held_ = 0;
};

[[maybe_unused]] Shelf& TheShelf() {
  static auto* shelf = new Shelf;  // never destroyed: buffers of static storage may outlive it
  return *shelf;
}

}  // namespace

void* AllocateBuffer(std::size_t bytes) {
  const std::size_t rounded = Rounded(bytes);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  if (rounded >= kLarge) {
    if (void* memory = TheShelf().Take(rounded)) return memory;
  }
#endif
  return Fresh(rounded);
}

void FreeBuffer(void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const std::size_t rounded = Rounded(bytes);
  // A block that came from the shelf may be larger than what was asked for; it is put back as what it was asked for.
  if (rounded >= kLarge && TheShelf().Put(memory, rounded)) return;
#endif
  std::free(memory);
}

}  // namespace striae
