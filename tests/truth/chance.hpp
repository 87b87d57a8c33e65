#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace wale::truth {

/// Random numbers that are the same on every machine for the same name and index.
class Chance {
 public:
  Chance(std::string_view name, std::size_t index) : state_(1469598103934665603ull) {
    for (const char each : name) state_ = (state_ ^ static_cast<unsigned char>(each)) * 1099511628211ull;
    state_ = mixed(state_ ^ mixed(index + 1));
  }

  /// From `low` up to `high`.
  double between(double low, double high) { return low + (high - low) * share(); }
  /// Every octave alike.
  double octaves(double low, double high) { return low * std::pow(high / low, share()); }
  /// Whether something of this probability happens.
  bool happens(double probability) { return share() < probability; }
  template <typename Value>
  Value one_of(std::initializer_list<Value> values) {
    return values.begin()[static_cast<std::size_t>(share() * static_cast<double>(values.size()))];
  }

 private:
  /// Splitmix64: Steele, Lea and Flood 2014.
  static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  double share() { return static_cast<double>(mixed(state_ += 0x9e3779b97f4a7c15ull) >> 11) * 0x1p-53; }

  std::uint64_t state_;
};

}  // namespace wale::truth
