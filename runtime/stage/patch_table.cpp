#include "runtime/stage/patch_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "runtime/stage/scheduling.hpp"

namespace wale {
namespace {

/// s; how far ahead the hand's path counts when the next bank is chosen.
constexpr float foresight = 0.1f;

bool same_program(const Placement& one, const Placement& other) {
  return &one.program.decoded() == &other.program.decoded();
}

/// m, from a point to a patch; 0 within it.
float distance(glm::vec2 point, const Placement& patch) {
  const float x = std::max(std::abs(point.x - patch.position.x) - patch.size.width / 2, 0.0f);
  const float y = std::max(std::abs(point.y - patch.position.y) - patch.size.height / 2, 0.0f);
  return std::hypot(x, y);
}

/// How soon the hand may need the patch; the least comes first. The patch under the hand comes before all others.
float urgency(const PatchTable::Nearby& hand, const Placement& patch) {
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
    case Kind::range: return bank->sample(&stop);
  }
  return true;
}

PatchTable::Slot* PatchTable::find(PatchName name) {
  if (name.number >= slots_.size() || slots_[name.number].generation != name.generation) return nullptr;
  return &slots_[name.number];
}

const PatchTable::Slot* PatchTable::find(PatchName name) const {
  if (name.number >= slots_.size() || slots_[name.number].generation != name.generation) return nullptr;
  return &slots_[name.number];
}

const Placement* PatchTable::wanted(PatchName name) const {
  const Slot* const slot = find(name);
  return slot != nullptr && slot->wanted ? &*slot->wanted : nullptr;
}

PatchName PatchTable::reserve() {
  std::uint32_t number = 0;
  if (free_.empty()) {
    number = static_cast<std::uint32_t>(slots_.size());
    slots_.emplace_back();
  } else {
    number = free_.back();
    free_.pop_back();
  }
  Slot& slot = slots_[number];
  slot.taken = slot.reserved = true;
  return {number, ++slot.generation};
}

void PatchTable::release(PatchName name) {
  Slot* const slot = find(name);
  if (slot == nullptr || !slot->reserved) return;
  slot->taken = slot->reserved = false;
  ++slot->generation;
  free_.push_back(name.number);
}

void PatchTable::free_slot(std::uint32_t number) {
  Slot& slot = slots_[number];
  slot.felt.reset();
  slot.bank.reset();
  slot.ready.reset();
  slot.memory.reset();
  slot.taken = slot.touched = slot.renewed = slot.loose = slot.sampled = false;
  free_.push_back(number);
}

void PatchTable::mark(std::uint32_t number) {
  if (!running_ || std::exchange(slots_[number].dirty, true)) return;
  dirty_.push_back(number);
}

void PatchTable::withdraw_request(Slot& slot, std::uint32_t number) {
  Jobs::value_type* const job = std::exchange(slot.job, nullptr);
  if (job == nullptr) return;
  std::erase(job->second.slots, number);
  if (job->second.slots.empty() && !job->second.begun) jobs_.erase(jobs_.find(job->first));
}

void PatchTable::request(std::uint32_t number) {
  Slot& slot = slots_[number];
  withdraw_request(slot, number);
  slot.ready = nullptr;
  if (!running_ || manner_ == Manner::together) return;
  BankKey key = slot.wanted->key();
  slot.ready = banks_.find(key);
  if (slot.ready) return;
  const auto [job, is_new] = jobs_.try_emplace(std::move(key));
  if (is_new) job->second.order = ++job_order_;
  job->second.slots.push_back(number);
  slot.job = &*job;
  hurry_.store(true, std::memory_order_relaxed);
}

void PatchTable::want(std::vector<Wish> wishes) {
  std::vector<std::uint32_t> numbers;
  bool waits = false;
  for (auto& [name, wish] : wishes) {
    Slot& slot = slots_[name.number];
    numbers.push_back(name.number);
    if (!wish) {
      if (!slot.wanted) continue;
      withdraw_request(slot, name.number);
      slot.wanted.reset();
      ++slot.generation;  // the handle names nothing any more, and the slot is free once the loop has let it go
      --count_;
      if (running_)
        mark(name.number);
      else
        free_slot(name.number);
      continue;
    }
    const bool is_new = !slot.wanted;
    if (is_new) ++count_, slot.reserved = false;
    const bool other_bank = is_new || !(slot.wanted->key() == wish->key());
    slot.wanted = std::move(wish);
    if (other_bank) request(name.number);
    mark(name.number);
    waits = waits || slot.edit != 0;
  }
  if (!running_ || manner_ == Manner::together || wishes.size() < 2) {
    for (const std::uint32_t number : numbers)
      if (slots_[number].edit != 0) settle(slots_[number].edit);
    return;
  }
  for (const std::uint32_t number : numbers) waits = waits || !is_ready(slots_[number]);
  if (waits) join(std::move(numbers));
}

void PatchTable::join(std::vector<std::uint32_t> numbers) {
  const std::uint32_t edit = ++last_edit_;
  std::vector<std::uint32_t> all;
  const auto add = [&](std::uint32_t number) {
    if (slots_[number].edit == edit) return;
    slots_[number].edit = edit;
    all.push_back(number);
  };
  for (const std::uint32_t number : numbers) {
    const std::uint32_t before = slots_[number].edit;
    if (before != 0 && before != edit) {
      for (const std::uint32_t other : edits_[before]) add(other);
      edits_.erase(before);
    }
    add(number);
  }
  edits_[edit] = std::move(all);
  settle(edit);
}

void PatchTable::settle(std::uint32_t edit) {
  const auto waiting = edits_.find(edit);
  if (waiting == edits_.end()) return;
  if (!std::ranges::all_of(waiting->second, [&](std::uint32_t number) { return is_ready(slots_[number]); })) return;
  const std::vector<std::uint32_t> numbers = std::move(waiting->second);
  edits_.erase(waiting);
  for (const std::uint32_t number : numbers) {
    slots_[number].edit = 0;
    mark(number);
  }
}

void PatchTable::begin(Manner manner, bool lock_memory) {
  lock_memory_ = lock_memory;
  running_ = true;
  manner_ = manner;
  revision_ = 0;
  arrangement_.clear();
  for (std::uint32_t number = 0; number < slots_.size(); ++number) {
    Slot& slot = slots_[number];
    if (!slot.wanted) continue;
    slot.felt.reset();
    slot.bank.reset();
    slot.memory.reset();
    slot.sampled = slot.touched = slot.renewed = false;
    slot.withdrawn = 0;
    request(number);
    mark(number);
  }
}

void PatchTable::end() {
  running_ = false;
  jobs_.clear();
  edits_.clear();
  replaced_.clear();
  unsampled_.clear();
  dirty_.clear();
  for (std::uint32_t number = 0; number < slots_.size(); ++number) {
    Slot& slot = slots_[number];
    const bool removed = slot.taken && !slot.wanted && !slot.reserved;
    slot.job = nullptr;
    slot.edit = 0;
    slot.dirty = false;
    slot.withdrawn = 0;
    if (removed) free_slot(number);
  }
}

bool PatchTable::changes_outline(const Slot& slot) const {
  if (!slot.felt) return false;
  if (!slot.wanted || !slot.wanted->enabled) return true;
  const Placement &then = *slot.felt, &now = *slot.wanted;
  return then.position != now.position || then.layer != now.layer || then.order != now.order ||
         (slot.ready && then.size != now.size);
}

void PatchTable::publish(Exchange<PlacedPatches>& patches, RecordWriter* recorder) {
  if (dirty_.empty()) return;
  std::vector<std::uint32_t> numbers = std::exchange(dirty_, {});
  std::size_t outlines = 0;
  for (const std::uint32_t number : numbers) {
    Slot& slot = slots_[number];
    slot.dirty = false;
    if (manner_ == Manner::together && slot.wanted) {
      slot.ready = banks_.get(slot.wanted->key());
      if (!slot.loose) slot.ready->sample();
    }
    outlines += changes_outline(slot) && arrangement_.is_in_base(number);
  }
  for (const std::uint32_t number : replaced_)
    if (slots_[number].memory) slots_[number].memory->forget_predecessor();
  arrangement_.expect(outlines);
  if (recorder != nullptr && manner_ == Manner::together) std::sort(numbers.begin(), numbers.end());
  bool changed = false;
  for (const std::uint32_t number : numbers)
    if (slots_[number].edit == 0) changed = publish_slot(number, recorder) || changed;
  if (!changed) return;
  ++revision_;
  if (recorder != nullptr) recorder->publish(revision_);
  if (arrangement_.wants_base() && (manner_ == Manner::together || revision_ == 1)) arrangement_.make_base();
  patches.publish(arrangement_.hand_over(revision_));
}

bool PatchTable::publish_slot(std::uint32_t number, RecordWriter* recorder) {
  Slot& slot = slots_[number];
  if (!slot.wanted) {
    const bool was_there = slot.felt.has_value();
    if (was_there) {
      arrangement_.remove(number);
      if (recorder != nullptr) recorder->remove(number);
    }
    free_slot(number);
    return was_there;
  }
  if (!slot.ready && !slot.bank) return false;  // a new patch is not felt until it is ready
  Placement next = *slot.wanted;
  if (!slot.ready) {
    next.program = slot.felt->program;
    next.parameters = slot.felt->parameters;
    next.size = slot.felt->size;
  }
  const std::shared_ptr<const PreparedBank> bank = slot.ready ? slot.ready : slot.bank;
  const bool other_program = !slot.felt || !same_program(*slot.felt, next) || slot.renewed;
  const bool changed = bank != slot.bank || other_program || slot.touched;
  const bool sampled = bank->is_sampled() && !slot.loose;
  if (other_program) {
    slot.memory =
        slot.memory ? std::make_shared<Memory>(next.program, slot.memory) : std::make_shared<Memory>(next.program);
    if (slot.felt && std::ranges::find(replaced_, number) == replaced_.end()) replaced_.push_back(number);
  }
  const bool moved = !slot.felt || next.position != slot.felt->position || next.layer != slot.felt->layer ||
                     next.order != slot.felt->order || next.enabled != slot.felt->enabled;
  if (!changed && !moved && sampled == slot.sampled) return false;
  if (changed) slot.change = ++changes_;
  if (lock_memory_ && changed) {
    lock_pages(bank->registers.registers().data(), bank->registers.registers().size_bytes());
    lock_pages(slot.memory->cells().data(), slot.memory->cells().size_bytes());
    lock_pages(slot.memory->states().data(), slot.memory->states().size_bytes());
  }
  if (recorder != nullptr) record(slot, number, next, changed, other_program, sampled, *recorder);
  if (next.enabled) {
    arrangement_.put(
        {.bank = bank,
         .memory = slot.memory,
         .outline = {next.position, bank->bank.size().width, bank->bank.size().height, next.layer, next.order},
         .number = number,
         .generation = slot.generation,
         .change = slot.change,
         .potential_range = bank->potential_range(sampled)});
  } else {
    arrangement_.remove(number);
    slot.withdrawn = revision_ + 1;
  }
  slot.bank = bank;
  slot.felt = std::move(next);
  slot.sampled = sampled;
  slot.touched = slot.renewed = false;
  if (!sampled && manner_ == Manner::piecewise) unsampled_.push_back(number);
  return true;
}

void PatchTable::record(const Slot& slot, std::uint32_t number, const Placement& next, bool changed, bool renewed,
                        bool sampled, RecordWriter& recorder) const {
  const auto same_bits = [](float one, float other) {
    return std::bit_cast<std::uint32_t>(one) == std::bit_cast<std::uint32_t>(other);
  };
  const bool whole = !slot.felt || renewed || next.size != slot.felt->size || next.layer != slot.felt->layer ||
                     next.order != slot.felt->order || next.enabled != slot.felt->enabled;
  if (whole) {
    recorder.put({.patch = number,
                  .position = next.position,
                  .size = next.size,
                  .layer = next.layer,
                  .parameters = next.parameters,
                  .order = next.order,
                  .enabled = next.enabled,
                  .changed = changed,
                  .renewed = renewed,
                  .sampled = sampled},
                 next.program);
    return;
  }
  bool was_set = false;
  for (std::size_t i = 0; i < next.parameters.size(); ++i) {
    if (same_bits(next.parameters[i], slot.felt->parameters[i])) continue;
    recorder.set(number, i, next.parameters[i]);
    was_set = true;
  }
  if (next.position != slot.felt->position) recorder.move(number, next.position);
  if (sampled != (was_set || slot.sampled)) recorder.bound(number, sampled);
}

std::optional<PatchTable::Work> PatchTable::next_work(const Nearby& hand) {
  Jobs::value_type* best = nullptr;
  float least = 0;
  for (auto& job : jobs_) {
    if (job.second.begun) continue;
    float soonest = std::numeric_limits<float>::infinity();
    for (const std::uint32_t number : job.second.slots)
      soonest = std::min(soonest, urgency(hand, *slots_[number].wanted));
    const bool sooner =
        best == nullptr || soonest < least || (soonest == least && job.second.order < best->second.order);
    if (sooner) best = &job, least = soonest;
  }
  if (best != nullptr) {
    best->second.begun = true;
    return Work{.kind = Work::Kind::bank, .key = best->first};
  }
  if (arrangement_.wants_base() && !base_under_way_) {
    base_under_way_ = true;
    return Work{.kind = Work::Kind::base, .outlines = arrangement_.outlines()};
  }
  hurry_.store(false, std::memory_order_relaxed);
  std::erase_if(unsampled_, [&](std::uint32_t number) {
    const Slot& slot = slots_[number];
    if (!slot.felt || slot.sampled) return true;
    if (!slot.bank->is_sampled()) return false;
    mark(number);
    return true;
  });
  const auto sooner = [&](std::uint32_t one, std::uint32_t other) {
    return urgency(hand, *slots_[one].felt) < urgency(hand, *slots_[other].felt);
  };
  const auto next = std::min_element(unsampled_.begin(), unsampled_.end(), sooner);
  if (next == unsampled_.end()) return std::nullopt;
  return Work{.kind = Work::Kind::range, .bank = slots_[*next].bank};
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
  jobs_.erase(job);
  for (const std::uint32_t number : numbers) {
    Slot& slot = slots_[number];
    slot.job = nullptr;
    slot.ready = work.bank;
    if (slot.edit != 0)
      settle(slot.edit);
    else
      mark(number);
  }
}

PatchTable::Felt PatchTable::felt(PatchName name) const {
  const Slot* const slot = find(name);
  if (slot == nullptr || !slot->wanted) return {};
  const bool placed = running_ && slot->felt && slot->felt->enabled;
  return {slot->memory, slot->bank, placed, slot->withdrawn};
}

void PatchTable::touch(PatchName name, bool renew) {
  if (Slot* const slot = find(name)) {
    slot->touched = true;
    slot->renewed = slot->renewed || renew;
    mark(name.number);
  }
}

void PatchTable::loosen(PatchName name, bool loose) {
  if (Slot* const slot = find(name)) {
    slot->loose = loose;
    mark(name.number);
  }
}

}  // namespace wale
