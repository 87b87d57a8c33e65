#include "runtime/stage/bank_cache.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace wale {
namespace {

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

bool same_bits(float one, float other) { return bits(one) == bits(other); }

/// Bytes of a program, roughly: its maps, as they are and prefiltered, and an allowance for all else.
std::size_t bytes_of(const Program& program) {
  constexpr std::size_t all_else = std::size_t{32} << 10;
  std::size_t heights = 0;
  for (const HeightTable& table : program.description().tables) heights += std::size_t{table.width} * table.height;
  return all_else + 2 * sizeof(float) * heights;
}

}  // namespace

bool PreparedBank::sample(const std::atomic<bool>* stop) const {
  if (is_sampled()) return true;
  const std::optional<double> range = wale::potential_range(bank, stop);
  if (range) sampled_.store(*range, std::memory_order_release);
  return range.has_value();
}

bool operator==(const BankKey& one, const BankKey& other) {
  return &one.program.decoded() == &other.program.decoded() && same_bits(one.size.width, other.size.width) &&
         same_bits(one.size.height, other.size.height) && same_bits(one.size.rim, other.size.rim) &&
         std::equal(one.parameters.begin(), one.parameters.end(), other.parameters.begin(), other.parameters.end(),
                    same_bits);
}

std::size_t BankKeyHash::operator()(const BankKey& key) const noexcept {
  std::uint64_t mixed = std::bit_cast<std::uintptr_t>(&key.program.decoded());
  const auto mix = [&mixed](float value) {
    mixed = (mixed ^ bits(value)) * 0x9e3779b97f4a7c15u;
    mixed ^= mixed >> 32;
  };
  for (const float value : {key.size.width, key.size.height, key.size.rim}) mix(value);
  for (const float value : key.parameters) mix(value);
  return mixed;
}

void BankCache::keep(Entries::value_type& entry, std::shared_ptr<const PreparedBank> bank) {
  if (entry.second.kept) {
    order_.splice(order_.begin(), order_, entry.second.place);
    return;
  }
  Order place{&entry};  // what needs memory comes first
  KeptProgram& program = kept_programs_[&entry.first.program.decoded()];
  kept_bytes_ += bank->bytes();
  if (program.banks++ == 0) {
    program.bytes = bytes_of(entry.first.program);
    kept_program_bytes_ += program.bytes;
  }
  entry.second.kept = std::move(bank);
  order_.splice(order_.begin(), place);
  entry.second.place = order_.begin();
  while (keeps_too_much()) let_oldest_go();
}

bool BankCache::keeps_too_much() const {
  return (kept_bytes_ > most_bytes_ && order_.size() > 1) ||
         (kept_program_bytes_ > most_program_bytes_ && kept_programs_.size() > 1);
}

void BankCache::let_oldest_go() {
  Entries::value_type& oldest = *order_.back();
  order_.pop_back();
  kept_bytes_ -= oldest.second.kept->bytes();
  const auto program = kept_programs_.find(&oldest.first.program.decoded());
  if (--program->second.banks == 0) {
    kept_program_bytes_ -= program->second.bytes;
    kept_programs_.erase(program);
  }
  oldest.second.kept.reset();
  if (oldest.second.bank.expired()) entries_.erase(entries_.find(oldest.first));
}

void BankCache::sweep() {
  if (entries_.size() < next_sweep_) return;
  std::erase_if(entries_, [](const auto& each) { return each.second.bank.expired(); });
  next_sweep_ = 2 * entries_.size() + 64;
}

std::shared_ptr<const PreparedBank> BankCache::find(const BankKey& key) {
  const std::lock_guard lock(mutex_);
  const auto known = entries_.find(key);
  if (known == entries_.end()) return nullptr;
  auto bank = known->second.bank.lock();
  if (bank) keep(*known, bank);
  return bank;
}

std::shared_ptr<const PreparedBank> BankCache::get(const BankKey& key) {
  if (auto known = find(key)) return known;
  // Without the mutex: others may look meanwhile. If another thread prepares the same bank, the first one is used.
  auto made = std::make_shared<const PreparedBank>(Bank(key.program, key.parameters, key.size));
  const std::lock_guard lock(mutex_);
  sweep();
  Entries::value_type& entry = *entries_.try_emplace(key).first;
  if (auto other = entry.second.bank.lock()) return other;
  entry.second.bank = made;
  keep(entry, made);
  return made;
}

std::size_t BankCache::kept_bytes() const {
  const std::lock_guard lock(mutex_);
  return kept_bytes_;
}

std::size_t BankCache::size() const {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

}  // namespace wale
