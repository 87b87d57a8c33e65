#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wale {

/// Hands out the temporary registers of one piece of code and takes them back after their last use.
class Temporaries {
 public:
  /// The lowest register that is free.
  std::size_t take() {
    std::size_t word = 0;  // 64 registers at a time, since hundreds may be in use
    while (word < used_.size() && used_[word] == ~std::uint64_t{0}) ++word;
    if (word == used_.size()) used_.push_back(0);
    const std::size_t first = word * word_bits + static_cast<std::size_t>(std::countr_one(used_[word]));
    used_[word] |= bit(first);
    most_ = std::max(most_, first + 1);
    return first;
  }
  /// `count` neighbouring registers, the lowest that are free.
  std::size_t take(std::size_t count) {
    if (count == 1) return take();
    std::size_t first = 0;
    for (std::size_t run = 0, i = 0; run < count; ++i) {
      run = is_used(i) ? 0 : run + 1;
      first = i + 1 - run;
    }
    used_.resize(std::max(used_.size(), (first + count - 1) / word_bits + 1));
    for (std::size_t i = first; i < first + count; ++i) used_[i / word_bits] |= bit(i);
    most_ = std::max(most_, first + count);
    return first;
  }
  void give_back(std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) used_[i / word_bits] &= ~bit(i);
  }
  std::size_t most() const { return most_; }

 private:
  static constexpr std::size_t word_bits = 64;

  static std::uint64_t bit(std::size_t i) { return std::uint64_t{1} << i % word_bits; }
  bool is_used(std::size_t i) const { return i / word_bits < used_.size() && (used_[i / word_bits] & bit(i)) != 0; }

  std::vector<std::uint64_t> used_;  ///< a bit for each register
  std::size_t most_ = 0;
};

}  // namespace wale
