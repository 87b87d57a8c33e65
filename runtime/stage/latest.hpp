#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace wale {

/// The latest of a stream of values (a sequence lock): one thread stores and never waits, others read whole values.
template <class Value>
class Latest {
  static_assert(std::is_trivially_copyable_v<Value>);

 public:
  Latest() { store(Value{}); }

  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void store(const Value& value) noexcept {
    Words words{};
    std::memcpy(words.data(), &value, sizeof value);
    const std::uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);  // odd: under way
    // Each word is stored with release order after the version, so a reader of a new word also sees the new version.
    for (std::size_t i = 0; i < words.size(); ++i) words_[i].store(words[i], std::memory_order_release);
    version_.store(version + 2, std::memory_order_release);
  }

  Value load() const noexcept {
    Words words{};
    std::uint64_t before = 0;
    do {
      before = version_.load(std::memory_order_acquire);
      for (std::size_t i = 0; i < words.size(); ++i) words[i] = words_[i].load(std::memory_order_acquire);
    } while (before % 2 != 0 || version_.load(std::memory_order_relaxed) != before);
    Value value;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
    return value;
  }

 private:
  using Words = std::array<std::uint64_t, (sizeof(Value) + 7) / 8>;

  std::atomic<std::uint64_t> version_ = 0;
  std::array<std::atomic<std::uint64_t>, std::tuple_size_v<Words>> words_{};
};

}  // namespace wale
