#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/stage/bank_cache.hpp"
#include "runtime/stage/front_most.hpp"
#include "wale/memory.hpp"

namespace wale {

/// A patch as the control side hands it over. The memory belongs to the bank's program, and a patch keeps it while only
/// its parameters change. Only the thread that serves the ticks uses the memory; the control side frees it.
struct PlacedPatch {
  std::shared_ptr<const PreparedBank> bank;
  std::shared_ptr<Memory> memory;
  PatchOutline outline;               ///< with the bank's size
  std::uint32_t number = 0;           ///< of its slot on the stage; a later patch may have the same
  std::uint32_t generation = 0;       ///< of the slot, which tells the two apart
  std::uint64_t change = 0;           ///< another one after each change of its program, parameters or size
  std::uint64_t outlined = 0;         ///< the arrangement's time at which it got this outline
  double potential_range = HUGE_VAL;  ///< J, of the bank's force; infinite: its energy is not limited
};

/// All patches on the workspace, as the control side hands them over. A value shares with the one before it all that
/// did not change. Most patches are found through a search over all outlines that was made some time ago (the base).
/// Patches that have changed since, and those that a change may have uncovered, are searched separately (the overlay).
/// So the cost of a change hardly grows with the number of patches. `Arrangement` makes these values.
class PlacedPatches {
 public:
  static constexpr std::size_t chunk_size = 128;
  using Chunk = std::array<std::shared_ptr<const PlacedPatch>, chunk_size>;

  std::uint32_t revision = 0;  ///< the number of this hand-over in the run, from 1 on

  /// The front-most patch under a point (m from the workspace's centre), or null.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  const PlacedPatch* at(glm::dvec2 point) const noexcept;

  /// The patch in a slot, or null. Real-time as `at`.
  const PlacedPatch* patch(std::uint32_t number) const noexcept {
    const std::size_t chunk = number / chunk_size;
    return chunk < chunks_.size() ? (*chunks_[chunk])[number % chunk_size].get() : nullptr;
  }

 private:
  friend class Arrangement;
  std::vector<std::shared_ptr<const Chunk>> chunks_;
  std::shared_ptr<const FrontMost> base_ = std::make_shared<const FrontMost>();
  std::uint64_t base_time_ = 0;               // the base is right about patches whose outline is not newer
  std::shared_ptr<const FrontMost> overlay_;  // null where there is none
};

/// Arranges patches for the search, on the control side. One thread at a time may use it.
class Arrangement {
 public:
  /// Puts a patch in its slot, in place of any before.
  void put(PlacedPatch patch);
  /// Empties a slot.
  void remove(std::uint32_t number);
  void clear() { *this = Arrangement(); }

  /// The patches as they are now. Takes time in proportion to the number of patches in the overlay.
  PlacedPatches hand_over(std::uint32_t revision);

  /// The outlines for a new base, and the time at which they were right.
  struct Outlines {
    std::vector<PatchOutline> outlines;
    std::vector<std::uint32_t> numbers;
    std::uint64_t time = 0;
  };
  /// Whether so many patches are in the overlay that a new base is worth its cost.
  bool wants_base() const { return settled_ > most_settled + spots_.size() / 64; }
  /// For a new base: `FrontMost(outlines, numbers)`, which any thread may make, and which takes time in proportion to
  /// the number of patches. Patches that have moved lately stay out: they will move again.
  Outlines outlines();
  void take_base(std::shared_ptr<const FrontMost> base, const Outlines& of);
  /// Makes a new base at once.
  void make_base();
  /// So many patches that are in the base are about to change. If they are many, the base is given up, and made anew by
  /// the next `hand_over`: that costs less than looking what each of them uncovers.
  void expect(std::size_t changes);
  bool is_in_base(std::uint32_t number) const { return number < spots_.size() && spots_[number].in_base; }

  /// How many patches are in the overlay.
  std::size_t overlay() const { return overlay_.size(); }

 private:
  static constexpr std::size_t most_settled = 256;

  /// What is known of a slot.
  struct Spot {
    PatchOutline base;          // in the base, if `in_base`
    bool in_base = false;       // the base has an outline of it that is right
    bool in_overlay = false;    // its number is in `overlay_`
    std::uint8_t restless = 0;  // for so many more bases it stays out
  };

  /// A patch that has moved stays out of so many bases.
  static constexpr std::uint8_t bases_after_a_move = 4;

  const std::shared_ptr<const PlacedPatch>& held(std::uint32_t number) const;
  void store(std::uint32_t number, std::shared_ptr<const PlacedPatch> patch);
  /// The base is no longer right about a patch with this outline: what lies behind it may come to light.
  void uncover(const PatchOutline& outline);
  void join_overlay(std::uint32_t number);

  std::vector<std::shared_ptr<PlacedPatches::Chunk>> chunks_;
  std::vector<char> shared_;  // by chunk: it has been handed over, and must not change any more
  std::vector<Spot> spots_;
  std::vector<std::uint32_t> overlay_;
  std::size_t settled_ = 0;  // of the overlay, those that are not restless
  bool base_given_up_ = false;
  bool overlay_changed_ = false;
  std::shared_ptr<const FrontMost> overlay_search_;
  std::shared_ptr<const FrontMost> base_ = std::make_shared<const FrontMost>();
  std::uint64_t base_time_ = 0, time_ = 0;
};

}  // namespace wale
