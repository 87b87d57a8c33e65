// What the thread that prepares banks does, and in which order.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/stage/patch_table.hpp"

namespace wale {
namespace {

/// s; how far ahead the hand's path counts when the next bank is chosen.
constexpr float foresight = 0.1f;

/// After so many banks a base or a range that was waiting comes first.
constexpr int most_banks_before_others = 16;

/// m, from a point to a patch; 0 within it.
float distance(glm::vec2 point, const WantedPatch& patch) {
  const float x = std::max(std::abs(point.x - patch.position.x) - patch.size.width / 2, 0.0f);
  const float y = std::max(std::abs(point.y - patch.position.y) - patch.size.height / 2, 0.0f);
  return std::hypot(x, y);
}

/// How soon the hand may need the patch; the least comes first. The patch under the hand comes before all others.
float urgency(const PatchTable::Nearby& hand, const WantedPatch& patch) {
  if (!patch.enabled) return std::numeric_limits<float>::max();
  const float here = distance(hand.position, patch);
  if (here > 0) return 1 + std::min(here, distance(hand.position + foresight * hand.velocity, patch));
  return 0.5f - std::atan(patch.layer) / 4;  // less than 1, and the less the farther in front
}

}  // namespace

bool PatchTable::Work::run(BankCache& banks, const std::atomic<bool>& stop) {
  switch (kind) {
    case Kind::bank: bank = banks.get(*key); return true;
    case Kind::base: base = std::make_shared<const FrontMost>(outlines.outlines, outlines.numbers); return true;
    case Kind::range: return bank->sample(may_stop ? &stop : nullptr);
  }
  return true;
}

std::optional<PatchTable::Work> PatchTable::next_work(const Nearby& hand) {
  Jobs::value_type* best = nullptr;
  std::pair<float, std::uint64_t> least;  // how soon it is needed, and since when it has waited
  for (auto& job : jobs_) {
    if (job.second.begun) continue;
    std::pair<float, std::uint64_t> soonest{std::numeric_limits<float>::infinity(), ~std::uint64_t{0}};
    for (const std::uint32_t number : job.second.slots)
      soonest = std::min(soonest, std::pair{urgency(hand, *slots_[number].wanted), slots_[number].since});
    if (best == nullptr || soonest < least) best = &job, least = soonest;
  }
  const bool others_first = banks_before_others_ >= most_banks_before_others;
  if (best != nullptr && !others_first) {
    const bool others_wait = arrangement_.wants_base() || !unsampled_.empty();
    banks_before_others_ = others_wait ? banks_before_others_ + 1 : 0;
    best->second.begun = true;
    return Work{.kind = Work::Kind::bank, .key = best->first};
  }
  if (others_first) banks_before_others_ = 0;
  if (arrangement_.wants_base() && !base_under_way_) {
    base_under_way_ = true;
    return Work{.kind = Work::Kind::base, .outlines = arrangement_.outlines()};
  }
  hurry_.store(false, std::memory_order_relaxed);
  if (auto range = next_range(hand, others_first)) return range;
  return best != nullptr ? next_work(hand) : std::nullopt;
}

std::optional<PatchTable::Work> PatchTable::next_range(const Nearby& hand, bool longest_first) {
  std::erase_if(unsampled_, [&](std::uint32_t number) {
    Slot& slot = slots_[number];
    const bool stays = slot.felt && !slot.sampled && !slot.bank->is_sampled();
    if (stays) return false;
    slot.is_unsampled = false;
    if (slot.felt && !slot.sampled) mark(number);
    return true;
  });
  if (unsampled_.empty()) return std::nullopt;
  const auto sooner = [&](std::uint32_t one, std::uint32_t other) {
    return urgency(hand, *slots_[one].felt) < urgency(hand, *slots_[other].felt);
  };
  auto next = unsampled_.begin();
  if (!longest_first) next = std::min_element(unsampled_.begin(), unsampled_.end(), sooner);
  const std::uint32_t number = *next;
  // The next time that the longest wait counts, it is another one's turn.
  if (longest_first) std::rotate(unsampled_.begin(), unsampled_.begin() + 1, unsampled_.end());
  return Work{.kind = Work::Kind::range, .bank = slots_[number].bank, .may_stop = !longest_first};
}

void PatchTable::finish(Work work, bool done) {
  if (work.kind == Work::Kind::base) {
    base_under_way_ = false;
    if (running_) arrangement_.take_base(std::move(work.base), work.outlines);
    return;
  }
  if (work.kind == Work::Kind::range) {
    if (!done || !running_) return;
    for (const std::uint32_t number : unsampled_)
      if (slots_[number].felt && !slots_[number].sampled && slots_[number].bank == work.bank) mark(number);
    return;
  }
  const auto job = jobs_.find(*work.key);
  if (job == jobs_.end()) return;
  const std::vector<std::uint32_t> numbers = std::move(job->second.slots);
  const std::vector<Overtaken> overtaken = std::move(job->second.overtaken);
  jobs_.erase(job);
  const auto tell = [&](std::uint32_t number) {
    if (slots_[number].edit != 0)
      settle(slots_[number].edit);
    else
      mark(number);
  };
  for (const std::uint32_t number : numbers) {
    Slot& slot = slots_[number];
    slot.job = nullptr;
    slot.ready = work.bank;
    slot.older.reset();
    slot.since = 0;
    tell(number);
  }
  for (const Overtaken& each : overtaken) {
    take_older(each, work);
    tell(each.name.number);
  }
}

void PatchTable::take_older(const Overtaken& overtaken, const Work& work) {
  Slot* const slot = find(overtaken.name);
  const bool is_news = slot != nullptr && slot->wanted && !slot->ready && overtaken.version > slot->felt_version &&
                       (!slot->older || overtaken.version > slot->older->version);
  if (!is_news) return;
  slot->older = Older{*work.key, work.bank, overtaken.version};
  slot->since = ++waits_;  // others have their turn
}

}  // namespace wale
