// Memory for what is as large as a photograph.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace striae {

/// Memory of at least `bytes`, aligned for any vector instruction; its content is unset. Large blocks ask for huge
/// pages, and blocks that were given back are handed out again: the first touch of a fresh one costs more than most of
/// what is done with it. Throws std::bad_alloc. Safe to call from several threads.
void* AllocateBuffer(std::size_t bytes);
void FreeBuffer(void* memory, std::size_t bytes) noexcept;

/// Leaves elements that are made without a value as they are, where std::allocator writes zeros.
template <typename T>
struct BufferAllocator {
  using value_type = T;

  BufferAllocator() = default;
  template <typename U>
  BufferAllocator(const BufferAllocator<U>&) {}  // NOLINT(google-explicit-constructor): allocators convert

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T) / 2) throw std::bad_alloc();
    return static_cast<T*>(AllocateBuffer(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t count) { FreeBuffer(memory, count * sizeof(T)); }

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
