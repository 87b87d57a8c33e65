#include "runtime/stage/patch_table.hpp"

#include <algorithm>
#include <bit>

#include "runtime/stage/scheduling.hpp"

namespace wale {
namespace {

/// Memories that one after the other wait for the hand. It bounds the memory that replacing takes where no hand comes,
/// and the tick at which it comes.
constexpr std::size_t most_memories_waiting = 64;

bool same_program(const WantedPatch& one, const WantedPatch& other) {
  return &one.program.decoded() == &other.program.decoded();
}

/// As comparing their keys, without making these.
bool same_bank(const WantedPatch& one, const WantedPatch& other) noexcept {
  const auto same_bits = [](float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); };
  return same_program(one, other) && same_bits(one.size.width, other.size.width) &&
         same_bits(one.size.height, other.size.height) && same_bits(one.size.rim, other.size.rim) &&
         std::ranges::equal(one.parameters, other.parameters, same_bits);
}

/// Room for the numbers of so many slots, so that noting one never needs memory.
void make_room(std::vector<std::uint32_t>& numbers, std::size_t slots) {
  if (numbers.capacity() < slots) numbers.reserve(std::max(slots, 2 * numbers.capacity()));
}

}  // namespace

PatchTable::Slot* PatchTable::find(PatchName name) {
  if (name.number >= slots_.size() || slots_[name.number].generation != name.generation) return nullptr;
  return &slots_[name.number];
}

const PatchTable::Slot* PatchTable::find(PatchName name) const {
  if (name.number >= slots_.size() || slots_[name.number].generation != name.generation) return nullptr;
  return &slots_[name.number];
}

const WantedPatch* PatchTable::wanted(PatchName name) const {
  const Slot* const slot = find(name);
  if (slot == nullptr) return nullptr;
  const std::optional<WantedPatch>& wanted = slot->later ? *slot->later : slot->wanted;
  return wanted ? &*wanted : nullptr;
}

PatchName PatchTable::reserve() {
  std::uint32_t number = 0;
  if (free_.empty()) {
    number = static_cast<std::uint32_t>(slots_.size());
    for (std::vector<std::uint32_t>* each : {&free_, &dirty_, &replaced_, &unsampled_, &later_})
      make_room(*each, slots_.size() + 1);
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

bool PatchTable::is_reserved(PatchName name) const {
  const Slot* const slot = find(name);
  return slot != nullptr && slot->reserved;
}

void PatchTable::free_slot(std::uint32_t number) {
  Slot& slot = slots_[number];
  slot.felt.reset();
  slot.felt_before.reset();
  slot.bank.reset();
  slot.ready.reset();
  slot.older.reset();
  slot.memory.reset();
  slot.shape = slot.stretched = Shape();
  slot.since = 0;
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
  if (job->second.begun)
    job->second.overtaken.push_back({{number, slot.generation}, slot.version});
  else if (job->second.slots.empty())
    jobs_.erase(jobs_.find(job->first));
}

void PatchTable::request(std::uint32_t number, Prepared prepared) noexcept {
  Slot& slot = slots_[number];
  withdraw_request(slot, number);
  slot.ready = std::move(prepared.ready);
  ++slot.version;
  if (!running_ || manner_ == Manner::together) return;
  if (slot.ready) {
    slot.older.reset();
    slot.since = 0;
    return;
  }
  if (slot.since == 0) slot.since = ++waits_;  // a change that replaces one that waits does not wait anew
  slot.job = prepared.job;
  hurry_.store(true, std::memory_order_relaxed);
}

void PatchTable::want(std::vector<Wish> wishes) {
  bool waits = false;
  std::size_t come = 0, go = 0;
  for (const auto& [name, wish] : wishes) {
    const Slot& slot = slots_[name.number];
    const bool was_there = slot.later ? slot.later->has_value() : slot.wanted.has_value();
    go += was_there && !wish;
    come += !was_there && wish;
    waits = waits || slot.later || (slot.edit != 0 && wishes.size() > 1);
  }
  if (!waits) take_wishes(wishes);
  count_ += come - go;
  for (auto& [name, wish] : wishes) {
    Slot& slot = slots_[name.number];
    if (wish) slot.reserved = false;
    if (!waits) continue;
    if (!slot.later) later_.push_back(name.number);
    slot.later = std::move(wish);
  }
}

void PatchTable::take_later_wishes() {
  if (std::ranges::any_of(later_, [&](std::uint32_t number) { return slots_[number].edit != 0; })) return;
  std::vector<Wish> wishes;
  wishes.reserve(later_.size());
  for (const std::uint32_t number : later_) {
    Slot& slot = slots_[number];
    wishes.emplace_back(PatchName{number, slot.generation}, *std::exchange(slot.later, std::nullopt));
  }
  try {
    take_wishes(wishes);
  } catch (...) {
    for (auto& [name, wish] : wishes) slots_[name.number].later = std::move(wish);
    throw;
  }
  later_.clear();
}

/// Of a run that has ended, so that nobody prepares anything.
void PatchTable::take_later_wishes_at_rest() noexcept {
  for (const std::uint32_t number : later_) {
    Slot& slot = slots_[number];
    std::optional<WantedPatch> wish = *std::exchange(slot.later, std::nullopt);
    if (!wish) {
      drop(number);
      continue;
    }
    if (!slot.wanted || !same_bank(*slot.wanted, *wish)) slot.ready = nullptr, ++slot.version;
    slot.wanted = std::move(wish);
  }
  later_.clear();
}

bool PatchTable::drop(std::uint32_t number) noexcept {
  Slot& slot = slots_[number];
  withdraw_request(slot, number);
  ++slot.generation;  // the handle names nothing any more, and the slot is free once the loop has let it go
  const bool was_there = slot.wanted.has_value();
  slot.wanted.reset();
  if (running_ && was_there) return true;
  free_slot(number);
  return false;
}

std::vector<PatchTable::Prepared> PatchTable::prepare(const std::vector<Wish>& wishes) {
  std::vector<Prepared> all(wishes.size());
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    const auto& [name, wish] = wishes[i];
    Slot& slot = slots_[name.number];
    if (slot.job != nullptr) slot.job->second.overtaken.reserve(slot.job->second.overtaken.size() + wishes.size());
    if (!wish) continue;
    all[i].other_bank = !slot.wanted || !same_bank(*slot.wanted, *wish);
    if (!all[i].other_bank || !running_) continue;
    if (slot.ready && slot.ready != slot.bank) all[i].older = slot.wanted->key();
    if (manner_ == Manner::together) continue;
    BankKey key = wish->key();
    all[i].ready = banks_.find(key);
    if (all[i].ready) continue;
    all[i].job = &*jobs_.try_emplace(std::move(key)).first;
    std::vector<std::uint32_t>& waiting = all[i].job->second.slots;
    waiting.reserve(waiting.size() + wishes.size());
  }
  return all;
}

void PatchTable::forget_idle_jobs() noexcept {
  std::erase_if(jobs_, [](const auto& job) { return job.second.slots.empty() && !job.second.begun; });
}

void PatchTable::take_wishes(std::vector<Wish>& wishes) {
  // First all that needs memory.
  std::vector<Prepared> prepared;
  std::vector<std::uint32_t> numbers;
  std::map<std::uint32_t, Edit> edit;
  try {
    numbers.reserve(wishes.size());
    if (running_ && manner_ == Manner::piecewise && wishes.size() > 1) edit.try_emplace(last_edit_ + 1);
    prepared = prepare(wishes);
  } catch (...) {
    forget_idle_jobs();
    throw;
  }
  // The new jobs have their slots before any old job is withdrawn, which might be one of them.
  for (std::size_t i = 0; i < wishes.size(); ++i)
    if (prepared[i].job != nullptr) prepared[i].job->second.slots.push_back(wishes[i].first.number);
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    const std::uint32_t number = wishes[i].first.number;
    std::optional<WantedPatch>& wish = wishes[i].second;
    if (!wish) {
      if (drop(number)) mark(number), numbers.push_back(number);
      continue;
    }
    Slot& slot = slots_[number];
    if (prepared[i].older) slot.older = Older{*std::move(prepared[i].older), slot.ready, slot.version};
    slot.wanted = std::move(wish);
    if (prepared[i].other_bank) request(number, std::move(prepared[i]));
    mark(number);
    numbers.push_back(number);
  }
  if (!running_ || manner_ == Manner::together) return;
  if (wishes.size() < 2) {
    for (const std::uint32_t number : numbers) settle(slots_[number].edit);
    return;
  }
  ++last_edit_;
  for (const std::uint32_t number : numbers) {
    slots_[number].edit = last_edit_;
    slots_[number].edit_version = slots_[number].version;
  }
  edit.begin()->second.slots = std::move(numbers);
  edits_.merge(edit);
  settle(last_edit_);
}

void PatchTable::settle(std::uint32_t edit) {
  const auto waiting = edits_.find(edit);
  if (waiting == edits_.end()) return;
  const std::vector<std::uint32_t>& slots = waiting->second.slots;
  waiting->second.settled = std::ranges::all_of(slots, [&](std::uint32_t number) { return is_ready(slots_[number]); });
  if (!waiting->second.settled) return;
  for (const std::uint32_t number : slots) mark(number);
}

void PatchTable::end_edits(const std::vector<std::uint32_t>& numbers) {
  for (const std::uint32_t number : numbers) {
    const auto edit = edits_.find(slots_[number].edit);
    if (edit == edits_.end() || !edit->second.settled) continue;
    for (const std::uint32_t each : edit->second.slots) slots_[each].edit = 0;
    edits_.erase(edit);
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
    if (slot.felt) slot.felt_before = std::move(slot.felt);
    slot.felt.reset();
    slot.bank.reset();
    slot.memory.reset();
    slot.older.reset();
    slot.sampled = slot.touched = slot.renewed = slot.is_unsampled = false;
    slot.withdrawn = 0;
    slot.since = slot.felt_version = 0;
    Prepared prepared;
    if (manner == Manner::piecewise) {
      BankKey key = slot.wanted->key();
      prepared.ready = banks_.find(key);
      if (!prepared.ready) {
        prepared.job = &*jobs_.try_emplace(std::move(key)).first;
        prepared.job->second.slots.push_back(number);
      }
    }
    request(number, std::move(prepared));
    mark(number);
  }
}

void PatchTable::end() noexcept {
  running_ = false;
  for (Slot& slot : slots_) slot.job = nullptr;
  jobs_.clear();
  take_later_wishes_at_rest();
  edits_.clear();
  replaced_.clear();
  unsampled_.clear();
  dirty_.clear();
  banks_before_others_ = 0;
  for (std::uint32_t number = 0; number < slots_.size(); ++number) {
    Slot& slot = slots_[number];
    const bool removed = slot.taken && !slot.wanted && !slot.reserved;
    slot.edit = 0;
    slot.dirty = slot.is_unsampled = slot.is_replaced = false;
    slot.withdrawn = 0;
    slot.older.reset();
    if (removed) free_slot(number);
  }
}

bool PatchTable::changes_outline(const Slot& slot) const {
  if (!slot.felt) return false;
  if (!slot.wanted || !slot.wanted->enabled) return true;
  const WantedPatch &then = *slot.felt, &now = *slot.wanted;
  return then.position != now.position || then.layer != now.layer || then.order != now.order ||
         (slot.ready && then.size != now.size) || (slot.older && then.size != slot.older->key.size);
}

void PatchTable::publish(Exchange<PlacedPatches>& patches, RecordWriter* recorder) {
  if (dirty_.empty()) return;
  std::vector<std::uint32_t> numbers = dirty_;
  dirty_.clear();  // keeps its room
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
  std::erase_if(replaced_, [&](std::uint32_t number) {
    Slot& slot = slots_[number];
    slot.is_replaced = slot.memory && !slot.memory->forget_predecessor();
    return !slot.is_replaced;
  });
  arrangement_.expect(outlines);
  if (recorder != nullptr && manner_ == Manner::together) std::sort(numbers.begin(), numbers.end());
  bool changed = false;
  for (const std::uint32_t number : numbers)
    if (!waits_for_its_edit(slots_[number])) changed = publish_slot(number, recorder) || changed;
  end_edits(numbers);
  take_later_wishes();
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
  if (!slot.ready && !slot.older && !slot.bank) return false;  // a new patch is not felt until it is ready
  WantedPatch next = *slot.wanted;
  std::shared_ptr<const PreparedBank> bank = slot.ready;
  if (!bank) {
    const BankKey key = slot.older ? slot.older->key : slot.felt->key();
    next.program = key.program;
    next.parameters = key.parameters;
    next.size = key.size;
    bank = slot.older ? slot.older->bank : slot.bank;
  }
  if (slot.ready || slot.older) slot.felt_version = slot.ready ? slot.version : slot.older->version;
  slot.older.reset();
  const bool other_program = !slot.felt || !same_program(*slot.felt, next) || slot.renewed;
  const bool changed = bank != slot.bank || other_program || slot.touched;
  const bool sampled = bank->is_sampled() && !slot.loose;
  if (other_program) {
    const bool succeeds = slot.memory && slot.memory->predecessors() < most_memories_waiting;
    slot.memory =
        succeeds ? std::make_shared<Memory>(next.program, slot.memory) : std::make_shared<Memory>(next.program);
    if (slot.felt && !std::exchange(slot.is_replaced, true)) replaced_.push_back(number);
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
  arrange(number, next, bank, sampled);
  slot.bank = bank;
  slot.felt = std::move(next);
  slot.sampled = sampled;
  slot.touched = slot.renewed = false;
  if (!sampled && manner_ == Manner::piecewise && !std::exchange(slot.is_unsampled, true)) unsampled_.push_back(number);
  return true;
}

void PatchTable::arrange(std::uint32_t number, const WantedPatch& next, const std::shared_ptr<const PreparedBank>& bank,
                         bool sampled) {
  Slot& slot = slots_[number];
  if (!next.enabled) {
    arrangement_.remove(number);
    slot.withdrawn = revision_ + 1;
    return;
  }
  const glm::vec2 size(bank->bank.size().width, bank->bank.size().height);
  if (!(slot.shape == next.shape) || slot.stretched.size() != size) {
    slot.shape = next.shape;
    slot.stretched = next.shape.stretched(size);
  }
  arrangement_.put({.bank = bank,
                    .memory = slot.memory,
                    .outline = {next.position, size.x, size.y, next.layer, next.order, slot.stretched},
                    .number = number,
                    .generation = slot.generation,
                    .change = slot.change,
                    .potential_range = bank->potential_range(
                        sampled && (next.shape.is_rectangle() || !reads_shape_edge(next.program)))});
}

void PatchTable::record(const Slot& slot, std::uint32_t number, const WantedPatch& next, bool changed, bool renewed,
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
                  .sampled = sampled,
                  .shape = next.shape},
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

PatchTable::Felt PatchTable::felt(PatchName name) const {
  const Slot* const slot = find(name);
  if (slot == nullptr || !slot->wanted) return {};
  const bool placed = running_ && slot->felt && slot->felt->enabled;
  return {slot->memory, slot->bank, placed, slot->withdrawn, slot->felt ? &*slot->felt : nullptr,
          slot->felt_before ? &*slot->felt_before : nullptr};
}

std::vector<PatchTable::Published> PatchTable::published(const std::unordered_set<std::uint32_t>& changes) const {
  std::vector<Published> all;
  for (std::uint32_t number = 0; number < slots_.size(); ++number) {
    const Slot& slot = slots_[number];
    if (slot.wanted && slot.felt && changes.contains(static_cast<std::uint32_t>(slot.change)))
      all.push_back({{number, slot.generation}, slot.felt->key(), slot.change});
  }
  return all;
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
