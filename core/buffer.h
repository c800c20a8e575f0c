// Memory for what is as large as a photograph.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace striae {

/// Leaves elements that are made without a value as they are (std::allocator writes zeros, and the first touch of a
/// large block costs more than most of what is done with it), and asks for huge pages where they pay.
template <typename T>
struct BufferAllocator {
  using value_type = T;
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;
  static constexpr std::size_t kLarge = 2 * kHugePage;

  BufferAllocator() = default;
  template <typename U>
  BufferAllocator(const BufferAllocator<U>&) {}  // NOLINT(google-explicit-constructor): allocators convert

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T) / 2) throw std::bad_alloc();
    const std::size_t bytes = count * sizeof(T);
    const bool large = bytes >= kLarge;
    const std::size_t unit = large ? kHugePage : alignof(std::max_align_t);
    void* memory = std::aligned_alloc(unit, (bytes + unit - 1) / unit * unit);
    if (memory == nullptr) throw std::bad_alloc();
#if defined(MADV_HUGEPAGE)
    if (large) madvise(memory, bytes, MADV_HUGEPAGE);  // advice: nothing is lost where it is not taken
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t /*count*/) { std::free(memory); }

  template <typename U>
  void construct(U* at) {
    if constexpr (!std::is_trivially_destructible_v<U> || !std::is_trivially_copyable_v<U>) std::construct_at(at);
  }
  template <typename U, typename... Args>
  void construct(U* at, Args&&... args) {
    std::construct_at(at, std::forward<Args>(args)...);
  }
  template <typename U>
  bool operator==(const BufferAllocator<U>&) const {
    return true;
  }
};

/// A vector whose resize() leaves new numbers unset: write before you read.
template <typename T>
using Buffer = std::vector<T, BufferAllocator<T>>;

}  // namespace striae
