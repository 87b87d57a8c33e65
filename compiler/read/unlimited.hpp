#pragma once

#include <cmath>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// The largest force that a program gives, N.
struct ForceLimit {
  double along_axis = HUGE_VAL;  ///< along x and along y: its device's
  double any_way = HUGE_VAL;     ///< its author's, of the whole force; infinite if there is none

  double least() const { return std::fmin(along_axis, any_way); }
  /// What is left of a force.
  glm::dvec2 cut(glm::dvec2 force) const;
  /// Whether a force is at the limit, so that its law may ask for more.
  bool reached_by(glm::dvec2 force) const;
  ForceLimit operator*(double times) const { return {times * along_axis, times * any_way}; }
};

/// What limits the force of a bank's program: the device, and the author if the last that is done to the whole force is
/// a `limit`.
ForceLimit limit_of(const Bank& bank);

/// A program as if nothing limited its force, so that a law shows whole where it is cut off.
struct Unlimited {
  Bank bank;         ///< at the same parameters; its forces are smaller
  double scale = 1;  ///< the forces of `bank` times this are those that the formulas ask for, N
};

/// The forces of the bank become as much smaller as the device's ticks in a second, `times` over: a stronger force
/// meets the limit still. Nothing if the program has no such form, which does not happen to a program of the compiler.
std::optional<Unlimited> without_limit(const Bank& bank, int times = 1);

/// A `limit` of a part of the force, beside other forces, or a number that is kept between two opposite ones.
struct PartLimit {
  double ceiling = 0;                        ///< at this bank's parameters, of what is limited, which may be no force
  std::vector<std::size_t> multiply, limit;  ///< instructions of a tick: where the part becomes smaller
  RegisterNumber factor = 0;                 ///< by which both are multiplied
  RegisterNumber one = 0;                    ///< has the number 1
  /// Of a number that is kept: the instructions that do so, and what each is given.
  std::vector<std::pair<std::size_t, RegisterNumber>> keeping = {};
};

/// The limits of parts of the force, in the order of the program; that of the whole force is not among them. The
/// 99th percentile of a texture is one of them.
std::vector<PartLimit> part_limits(const Bank& bank);

/// The program without some limits of parts of its force, which becomes smaller as that of `without_limit`.
std::optional<Unlimited> without_part_limits(const Bank& bank, std::span<const PartLimit> parts);

/// The same without these parts: what is limited, or kept, is 0.
std::optional<Unlimited> without_parts(const Bank& bank, std::span<const PartLimit> parts);

/// Whether a force is at the device's limit `most` (N) along x or y, so that its law may ask for more.
bool at_limit(glm::dvec2 force, double most);

}  // namespace wale
