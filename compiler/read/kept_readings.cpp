#include "compiler/read/kept_readings.hpp"

#include <span>

namespace wale {
namespace {

constexpr std::size_t most_kept = 512;          // a few kilobytes each
constexpr std::size_t longest_key = 256 << 10;  // bytes: a program with larger tables has hardly a copy

}  // namespace

std::string KeptReadings::key_of(const Bank& bank) {
  PatchProgram program = bank.program().description();
  // Nothing of this is executed when a hand feels the program.
  program.material.clear();
  program.picture = {}, program.percepts.clear(), program.fates.clear(), program.claims.clear();
  program.layers = {}, program.places = {};
  std::size_t in_tables = 0;
  for (const HeightTable& each : program.tables) in_tables += std::size_t{each.width} * each.height;
  if (in_tables * sizeof(float) > longest_key) return {};
  const std::vector<std::byte> bytes = write_patch_program(program);
  if (bytes.size() > longest_key) return {};
  const PatchSize size = bank.size();
  std::string key(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const auto part : {std::as_bytes(bank.registers()), std::as_bytes(std::span(&size, 1))})
    key.append(reinterpret_cast<const char*>(part.data()), part.size());
  return key;
}

void KeptReadings::complete(const std::string& key, ReadFirst& first) {
  std::shared_ptr<const ReadFirst> known;
  {
    const std::lock_guard lock(mutex_);
    const auto found = known_.find(key);
    if (found == known_.end()) return;
    known = found->second, ++given_;
  }
  if (!first.still) first.still = known->still;
  if (!first.moving && known->moving) first.moving = known->moving, first.at_first = known->at_first;
}

void KeptReadings::keep(const std::string& key, const ReadFirst& first) {
  if (key.empty()) return;
  auto kept = std::make_shared<const ReadFirst>(first);
  const std::lock_guard lock(mutex_);
  const auto [at, is_new] = known_.insert_or_assign(key, std::move(kept));
  if (!is_new) return;
  in_order_.push_back(key);
  if (in_order_.size() <= most_kept) return;
  known_.erase(in_order_.front());
  in_order_.pop_front();
}

std::size_t KeptReadings::given() const {
  const std::lock_guard lock(mutex_);
  return given_;
}

}  // namespace wale
