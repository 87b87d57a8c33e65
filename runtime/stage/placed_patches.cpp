#include "runtime/stage/placed_patches.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wale {
namespace {

/// m, more than rounding moves an edge.
constexpr double about_an_edge = 1e-5;

bool overlap(const PatchOutline& one, const PatchOutline& other) {
  const auto meet = [](double here, double there, double sizes) {
    return !(std::abs(here - there) > sizes / 2 + about_an_edge);  // also where one is not a number
  };
  return meet(one.position.x, other.position.x, static_cast<double>(one.width) + static_cast<double>(other.width)) &&
         meet(one.position.y, other.position.y, static_cast<double>(one.height) + static_cast<double>(other.height));
}

}  // namespace

const PlacedPatch* PlacedPatches::at(glm::dvec2 point) const noexcept {
  const PlacedPatch* found = nullptr;
  if (const std::uint32_t number = base_->at(point); number != FrontMost::none) {
    found = patch(number);
    if (found != nullptr && found->outlined > base_time_) found = nullptr;
  }
  const std::uint32_t number = overlay_ ? overlay_->at(point) : FrontMost::none;
  if (number == FrontMost::none) return found;
  const PlacedPatch* const other = patch(number);
  return found == nullptr || other->outline.is_before(found->outline, other->number, found->number) ? other : found;
}

const std::shared_ptr<const PlacedPatch>& Arrangement::held(std::uint32_t number) const {
  static const std::shared_ptr<const PlacedPatch> none;
  const std::size_t chunk = number / PlacedPatches::chunk_size;
  return chunk < chunks_.size() ? (*chunks_[chunk])[number % PlacedPatches::chunk_size] : none;
}

void Arrangement::store(std::uint32_t number, std::shared_ptr<const PlacedPatch> patch) {
  const std::size_t chunk = number / PlacedPatches::chunk_size;
  while (chunks_.size() <= chunk) {
    chunks_.push_back(std::make_shared<PlacedPatches::Chunk>());
    shared_.push_back(0);
  }
  if (std::exchange(shared_[chunk], 0) != 0) chunks_[chunk] = std::make_shared<PlacedPatches::Chunk>(*chunks_[chunk]);
  (*chunks_[chunk])[number % PlacedPatches::chunk_size] = std::move(patch);
}

void Arrangement::join_overlay(std::uint32_t number) {
  overlay_changed_ = true;
  Spot& spot = spots_[number];
  if (std::exchange(spot.in_overlay, true)) return;
  overlay_.push_back(number);
  settled_ += spot.restless == 0;
}

void Arrangement::uncover(const PatchOutline& outline) {
  for (std::uint32_t number = 0; number < spots_.size(); ++number) {
    const Spot& each = spots_[number];
    if (each.in_base && !each.in_overlay && overlap(each.base, outline)) join_overlay(number);
  }
}

void Arrangement::put(PlacedPatch patch) {
  const std::uint32_t number = patch.number;
  if (spots_.size() <= number) spots_.resize(number + 1);
  const std::shared_ptr<const PlacedPatch>& before = held(number);
  if (before && before->outline == patch.outline && before->generation == patch.generation) {
    patch.outlined = before->outlined;
  } else {
    Spot& spot = spots_[number];
    patch.outlined = ++time_;
    if (std::exchange(spot.in_base, false)) uncover(spot.base);
    if (before && std::exchange(spot.restless, bases_after_a_move) == 0 && spot.in_overlay) --settled_;
    join_overlay(number);
  }
  store(number, std::make_shared<const PlacedPatch>(std::move(patch)));
}

void Arrangement::remove(std::uint32_t number) {
  if (!held(number)) return;
  Spot& spot = spots_[number];
  ++time_;
  if (std::exchange(spot.in_base, false)) uncover(spot.base);
  if (spot.in_overlay) {
    overlay_.erase(std::find(overlay_.begin(), overlay_.end(), number));
    settled_ -= spot.restless == 0;
    overlay_changed_ = true;
  }
  spot = Spot();
  store(number, nullptr);
}

void Arrangement::expect(std::size_t changes) {
  if (changes <= most_settled / 4 + spots_.size() / 64) return;
  base_given_up_ = true;
  for (Spot& spot : spots_) spot.in_base = false;
}

PlacedPatches Arrangement::hand_over(std::uint32_t revision) {
  if (base_given_up_) make_base();
  if (std::exchange(overlay_changed_, false)) {
    std::vector<PatchOutline> outlines;
    outlines.reserve(overlay_.size());
    for (const std::uint32_t number : overlay_) outlines.push_back(held(number)->outline);
    overlay_search_ = overlay_.empty() ? nullptr : std::make_shared<const FrontMost>(outlines, overlay_);
  }
  PlacedPatches all;
  all.revision = revision;
  all.chunks_.assign(chunks_.begin(), chunks_.end());
  std::fill(shared_.begin(), shared_.end(), char{1});
  all.base_ = base_;
  all.base_time_ = base_time_;
  all.overlay_ = overlay_search_;
  return all;
}

Arrangement::Outlines Arrangement::outlines() {
  Outlines all;
  all.time = time_;
  for (std::uint32_t number = 0; number < spots_.size(); ++number) {
    const auto& patch = held(number);
    if (!patch) continue;
    if (Spot& spot = spots_[number]; spot.restless > 0) {
      settled_ += --spot.restless == 0 && spot.in_overlay;
      continue;
    }
    all.outlines.push_back(patch->outline);
    all.numbers.push_back(number);
  }
  return all;
}

void Arrangement::take_base(std::shared_ptr<const FrontMost> base, const Outlines& of) {
  base_ = std::move(base);
  base_time_ = of.time;
  base_given_up_ = false;
  overlay_.clear();
  settled_ = 0;
  overlay_changed_ = true;
  for (Spot& spot : spots_) spot.in_base = spot.in_overlay = false;
  std::vector<PatchOutline> outdated;
  for (std::size_t i = 0; i < of.numbers.size(); ++i) {
    Spot& spot = spots_[of.numbers[i]];
    spot.base = of.outlines[i];
    const auto& patch = held(of.numbers[i]);
    spot.in_base = patch && patch->outlined <= base_time_;
    if (!spot.in_base) outdated.push_back(spot.base);
  }
  for (const PatchOutline& outline : outdated) uncover(outline);
  for (std::uint32_t number = 0; number < spots_.size(); ++number)
    if (held(number) && !spots_[number].in_base) join_overlay(number);
}

void Arrangement::make_base() {
  const Outlines all = outlines();
  take_base(std::make_shared<const FrontMost>(all.outlines, all.numbers), all);
}

}  // namespace wale
