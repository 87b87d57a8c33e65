#pragma once

#include <cstddef>

namespace wale {

/// The parts of a compilation whose work may be far greater than the text: they multiply what it says.
enum class Work {
  expansion,  ///< functions, curves and constants, expanded where they are used
  assembly,   ///< materials that are made from others
  blend,      ///< the components of a blend, and of the blends in it
  solving,    ///< percepts, and the laws of their maps
  gradient,   ///< `grad`, and the force of a height
  program,    ///< values, registers and sections of the program
};

/// Counts the operations of a compilation before they are done, so that no text keeps the compiler busy for long. An
/// operation is a step of some ten nanoseconds: an expression read, a name compared, a value made. It is counted and
/// not timed, so a text that compiles does so on every computer.
class Budget {
 public:
  /// Operations of a compilation whatever its text, about a thousand times those of a material of 40 lines, and as many
  /// again for each byte of the text, since a long text has much to say.
  static constexpr std::size_t for_any_text = std::size_t{1} << 20, for_each_byte = 16;

  /// Takes operations from the budget; false if there are not enough, and then none are left.
  bool take(std::size_t operations) {
    if (operations > left_) [[unlikely]] {
      left_ = 0;
      return false;
    }
    left_ -= operations;
    return true;
  }
  /// Samples of pictures and tables that a compilation keeps: those of eight pictures of the largest size, 256 MB.
  static constexpr std::size_t most_samples = std::size_t{8} * 4096 * 4096;
  /// A picture or table that a material has already is kept once, and only looked at: that costs as much as keeping
  /// one sample in so many.
  static constexpr std::size_t looks_for_a_sample = 16;

  /// Counts the samples of a picture or table; false if the compilation then has more than `most_samples`.
  bool take_samples(std::size_t samples, bool is_new) {
    const std::size_t looks = is_new ? samples * looks_for_a_sample : samples;
    const bool enough = looks <= looks_left_;
    looks_left_ -= enough ? looks : looks_left_;
    return enough;
  }
  bool has_samples() const { return looks_left_ > 0; }

  void allow(std::size_t operations) { left_ += operations, allowed_ += operations; }
  std::size_t allowed() const { return allowed_; }
  std::size_t taken() const { return allowed_ - left_; }

 private:
  std::size_t allowed_ = for_any_text, left_ = for_any_text;
  std::size_t looks_left_ = most_samples * looks_for_a_sample;
};

}  // namespace wale
