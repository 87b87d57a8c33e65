#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace wale {

/// The latest of a stream of values: one thread stores and never waits, any number of others read whole values. While a
/// value is being stored, readers get the one before, so they never wait for the storing thread. A reader begins anew
/// only if the storing thread has stored `places - 1` more values while it read one.
template <class Value>
class Latest {
  static_assert(std::is_trivially_copyable_v<Value>);

 public:
  Latest() { store(Value{}); }

  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void store(const Value& value) noexcept {
    Words words{};
    std::memcpy(words.data(), &value, sizeof value);
    const std::uint64_t number = number_.load(std::memory_order_relaxed) + 1;
    Place& place = places_[number % places];
    // The place is marked before it changes. Each word is stored with release order after the mark, so a reader of a
    // new word also sees the mark.
    place.number.store(0, std::memory_order_relaxed);
    for (std::size_t i = 0; i < words.size(); ++i) place.words[i].store(words[i], std::memory_order_release);
    place.number.store(number, std::memory_order_release);
    number_.store(number, std::memory_order_release);
  }

  Value load() const noexcept {
    Words words{};
    for (;;) {
      const std::uint64_t number = number_.load(std::memory_order_acquire);
      const Place& place = places_[number % places];
      if (place.number.load(std::memory_order_acquire) != number) continue;
      for (std::size_t i = 0; i < words.size(); ++i) words[i] = place.words[i].load(std::memory_order_acquire);
      if (place.number.load(std::memory_order_relaxed) == number) break;
    }
    Value value;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
    return value;
  }

 private:
  static constexpr std::size_t places = 4;
  using Words = std::array<std::uint64_t, (sizeof(Value) + 7) / 8>;
  struct Place {
    std::atomic<std::uint64_t> number = 0;  // of its value; 0 while it is stored
    std::array<std::atomic<std::uint64_t>, std::tuple_size_v<Words>> words{};
  };

  std::atomic<std::uint64_t> number_ = 0;
  std::array<Place, places> places_{};
};

}  // namespace wale
