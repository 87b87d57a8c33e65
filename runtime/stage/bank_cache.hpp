#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "runtime/stage/potential_range.hpp"
#include "wale/program.hpp"

namespace wale {

/// A bank after setup and its peaks. All patches of a stage with the same program, parameters and size share one.
class PreparedBank {
 public:
  explicit PreparedBank(Bank prepared)
      : bank(std::move(prepared)), registers(bank), trivial_(wale::trivial_potential_range(bank)) {
    if (!wale::has_sampled_range(bank.program())) sampled_.store(trivial_, std::memory_order_relaxed);
  }

  const Bank bank;
  /// What the loop ticks. Ticks leave nothing in it that the next one reads, so patches may share it. Only the thread
  /// that serves the ticks may use it.
  mutable Bank registers;

  /// J, an upper bound of the range of the bank's potential: the sampled one, if it is known, or the trivial one.
  double potential_range(bool sampled) const {
    const double known = sampled_.load(std::memory_order_acquire);
    return sampled && !std::isnan(known) ? known : trivial_;
  }
  bool is_sampled() const { return !std::isnan(sampled_.load(std::memory_order_acquire)); }
  /// Samples the range if that is not done yet; see `potential_range`. False if `stop` ended it.
  bool sample(const std::atomic<bool>* stop = nullptr) const;

  std::size_t bytes() const { return sizeof *this + 2 * sizeof(float) * bank.registers().size(); }

 private:
  double trivial_;
  mutable std::atomic<double> sampled_ = std::nan("");
};

/// What a prepared bank depends on. Parameters and sizes are compared bit for bit.
struct BankKey {
  Program program;
  std::vector<float> parameters;
  PatchSize size;

  friend bool operator==(const BankKey& one, const BankKey& other);
};

struct BankKeyHash {
  std::size_t operator()(const BankKey& key) const noexcept;
};

/// The prepared banks of a stage. It finds all banks that are in use, and those used last, up to a number of bytes of
/// banks and, if they are of more than one program, of programs.
/// Keys hold their program, so an entry never answers for another program at the same address. From any thread.
class BankCache {
 public:
  /// More than the banks of all shipped materials need.
  static constexpr std::size_t usual_bytes = std::size_t{8} << 20;

  /// Kept banks hold their programs, whose maps may be much larger than the banks.
  static constexpr std::size_t usual_program_bytes = std::size_t{32} << 20;

  explicit BankCache(std::size_t most_bytes = usual_bytes, std::size_t most_program_bytes = usual_program_bytes)
      : most_bytes_(most_bytes), most_program_bytes_(most_program_bytes) {}

  /// The bank of a key, or null if it is not known.
  std::shared_ptr<const PreparedBank> find(const BankKey& key);
  /// The bank of a key; runs setup and peaks if it is not known. Does not sample its range.
  std::shared_ptr<const PreparedBank> get(const BankKey& key);

  /// Bytes of the banks that are kept because they were used last.
  std::size_t kept_bytes() const;
  /// Banks that are kept or were in use at the last sweep.
  std::size_t size() const;

 private:
  struct Entry;
  using Entries = std::unordered_map<BankKey, Entry, BankKeyHash>;
  using Order = std::list<Entries::value_type*>;  // nodes of the map stay where they are
  struct Entry {
    std::weak_ptr<const PreparedBank> bank;
    std::shared_ptr<const PreparedBank> kept;  // null when it is only found as long as it is in use
    Order::iterator place;                     // in `order_`, if it is kept
  };

  struct KeptProgram {
    std::size_t banks = 0, bytes = 0;
  };

  /// With the mutex held: makes it the one used last.
  void keep(Entries::value_type& entry, std::shared_ptr<const PreparedBank> bank);
  void let_oldest_go();
  bool keeps_too_much() const;
  void sweep();

  const std::size_t most_bytes_, most_program_bytes_;
  mutable std::mutex mutex_;
  Entries entries_;
  Order order_;  // the kept ones; the one used last comes first
  std::unordered_map<const DecodedProgram*, KeptProgram> kept_programs_;
  std::size_t kept_bytes_ = 0, kept_program_bytes_ = 0;
  std::size_t next_sweep_ = 64;
};

}  // namespace wale
