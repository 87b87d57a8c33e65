#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wale {

/// Allocates the temporary registers of one piece of code and frees them after their last use.
class Temporaries {
 public:
  /// Whether there is room for that many adjacent registers: always.
  static constexpr bool has_room(std::size_t) { return true; }
  /// Allocates the lowest free register.
  std::size_t take() {
    while (free_[first_word_] == 0)  // 64 registers at a time, since thousands may be in use
      if (++first_word_ == free_.size()) add_word();
    std::uint64_t& free = free_[first_word_];
    const std::size_t first = first_word_ * word_bits + static_cast<std::size_t>(std::countr_zero(free));
    free &= free - 1;
    if (first >= most_) most_ = first + 1;
    return first;
  }
  /// Allocates the lowest `count` adjacent free registers, and returns the first.
  std::size_t take(std::size_t count) { return count == 1 ? take() : take_neighbours(count); }
  void give_back(std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) free_[i / word_bits] |= bit(i);
    first_word_ = std::min(first_word_, first / word_bits);
  }
  /// Frees registers if `given`; otherwise does nothing, and `first` may be any number.
  void give_back_if(bool given, std::size_t first, std::size_t count) {
    if (given) give_back(first, count);
  }
  std::size_t most() const { return most_; }

 private:
  static constexpr std::size_t word_bits = 64;

  static std::uint64_t bit(std::size_t i) { return std::uint64_t{1} << i % word_bits; }

  // Separate from `take`, which is called for every instruction and must stay small.

  [[gnu::noinline]] void add_word() { free_.push_back(~std::uint64_t{0}); }
  [[gnu::noinline]] std::size_t take_neighbours(std::size_t count) {
    std::size_t first = 0;
    for (std::size_t run = 0, i = first_word_ * word_bits; run < count; ++i) {
      if (i / word_bits == free_.size()) add_word();
      run = (free_[i / word_bits] & bit(i)) != 0 ? run + 1 : 0;
      first = i + 1 - run;
    }
    for (std::size_t i = first; i < first + count; ++i) free_[i / word_bits] &= ~bit(i);
    most_ = std::max(most_, first + count);
    return first;
  }

  std::vector<std::uint64_t> free_{~std::uint64_t{0}};  ///< a bit for each register
  std::size_t first_word_ = 0;                          ///< no word before it has a free register
  std::size_t most_ = 0;
};

/// The same for code that needs few registers and no adjacent ones, as nearly all code does.
class FewTemporaries {
 public:
  bool has_room(std::size_t count) const { return free_ != 0 && count == 1; }
  std::size_t take(std::size_t) {
    const int first = std::countr_zero(free_);
    free_ &= free_ - 1;
    touched_ |= ~free_;
    return static_cast<std::size_t>(first);
  }
  void give_back(std::size_t first, std::size_t) { free_ |= std::uint64_t{1} << first % 64; }
  /// Without a branch, which would be unpredictable.
  void give_back_if(bool given, std::size_t first, std::size_t) { free_ |= std::uint64_t{given} << first % 64; }
  std::size_t most() const { return static_cast<std::size_t>(std::bit_width(touched_)); }

 private:
  std::uint64_t free_ = ~std::uint64_t{0}, touched_ = 0;  ///< a bit for each register
};

}  // namespace wale
