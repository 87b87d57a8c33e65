#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "compiler/read/read_again.hpp"

namespace wale {

/// What was measured of the programs that were read last, for others that execute the same: in a library that grew, many
/// materials differ in their words alone. Programs count as the same only if all their code and figures have the same
/// bytes. Thread-safe.
class KeptReadings {
 public:
  /// All that decides what is measured of a program at this bank's parameters; empty if that is too much to be kept.
  static std::string key_of(const Bank& bank);

  /// Gives `first` what is known and what it has not.
  void complete(const std::string& key, ReadFirst& first);
  /// Keeps what `first` has, and forgets the oldest for it.
  void keep(const std::string& key, const ReadFirst& first);
  /// How often something was known.
  std::size_t given() const;

 private:
  mutable std::mutex mutex_;
  std::unordered_map<std::string, std::shared_ptr<const ReadFirst>> known_;
  std::deque<std::string> in_order_;  ///< the oldest first
  std::size_t given_ = 0;
};

}  // namespace wale
