#include "compiler/check_legibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "compiler/compare/compare.hpp"
#include "compiler/diagnostics/advice.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

/// The workspace in small squares, each with the patch that the hand feels there.
class Ground {
 public:
  /// `radius`: how far the device reaches, m.
  Ground(const std::vector<LaidPatch>& laid, double radius)
      : laid_(laid), half_(static_cast<int>(std::ceil(radius / step))), side_(2 * half_ + 1) {
    felt_.assign(static_cast<std::size_t>(side_ * side_), nobody);
    covered_.assign(laid.size(), 0), seen_.assign(laid.size(), 0);
    for (std::size_t i = 0; i < laid.size(); ++i) lay(static_cast<int>(i), radius);
    for (const int each : felt_)
      if (each != nobody) ++seen_[static_cast<std::size_t>(each)];
  }

  /// Whether a patch that the device reaches lies wholly behind others.
  bool is_hidden(std::size_t patch) const { return covered_[patch] > 0 && seen_[patch] == 0; }

  /// Patches, a < b, with places from which the way to the other is no longer than the rims of both, and those that
  /// overlap.
  std::set<std::pair<int, int>> neighbours() const {
    std::set<std::pair<int, int>> all;
    for (int row = 0; row < side_; ++row)
      for (int column = 0; column < side_; ++column) add_neighbours_of(column, row, all);
    return all;
  }

 private:
  static constexpr double step = 0.5e-3;  // m
  static constexpr int nobody = -1;

  int at(int column, int row) const { return felt_[static_cast<std::size_t>(row * side_ + column)]; }

  void lay(int number, double radius) {
    const LaidPatch& patch = laid_[static_cast<std::size_t>(number)];
    const glm::dvec2 middle(patch.patch->at[0], patch.patch->at[1]);
    const glm::dvec2 half(0.5 * patch.size.width, 0.5 * patch.size.height);
    const auto index = [&](double metres, bool up) {
      const double of_step = metres / step;
      return std::clamp(half_ + static_cast<int>(up ? std::ceil(of_step) : std::floor(of_step)), 0, side_ - 1);
    };
    for (int row = index(middle.y - half.y, true); row <= index(middle.y + half.y, false); ++row)
      for (int column = index(middle.x - half.x, true); column <= index(middle.x + half.x, false); ++column) {
        const glm::dvec2 place((column - half_) * step, (row - half_) * step);
        const glm::dvec2 from = place - middle;
        if (std::hypot(place.x, place.y) > radius || std::abs(from.x) > half.x || std::abs(from.y) > half.y ||
            !patch.shape.contains(glm::vec2(from)))
          continue;
        felt_[static_cast<std::size_t>(row * side_ + column)] = number;
        ++covered_[static_cast<std::size_t>(number)];
      }
  }

  /// Looks to the right and upwards.
  void add_neighbours_of(int column, int row, std::set<std::pair<int, int>>& all) const {
    const int here = at(column, row);
    if (here == nobody) return;
    for (const auto& [right, up] : {std::pair(1, 0), std::pair(0, 1)}) {
      for (int away = 1;; ++away) {
        const int x = column + right * away, y = row + up * away;
        if (x >= side_ || y >= side_) break;
        const int there = at(x, y);
        if (there == here) break;
        if (there == nobody) {
          if ((away + 1) * step > widest_rims()) break;
          continue;
        }
        if ((away - 1) * step <= rim(here) + rim(there)) all.insert(std::minmax(here, there));
        break;
      }
    }
  }

  double rim(int patch) const { return laid_[static_cast<std::size_t>(patch)].size.rim; }
  double widest_rims() const {
    if (widest_rims_ == 0)
      for (const LaidPatch& each : laid_) widest_rims_ = std::max(widest_rims_, 2.0 * each.size.rim + 2 * step);
    return widest_rims_;
  }

  const std::vector<LaidPatch>& laid_;
  int half_, side_;  // squares
  std::vector<int> felt_;
  std::vector<long> covered_, seen_;  // squares of each patch
  mutable double widest_rims_ = 0;    // m
};

void warn_of_hidden(const LaidPatch& patch, Diagnostics& diagnostics) {
  diagnostics.report(
      Advice("move it, or write it behind the others, which then lie behind it")
          .about(Code::hidden_patch, patch.patch->material.span,
                 fmt::format("`{}` is never felt: it lies behind later patches", patch.patch->material.name)));
}

}  // namespace

void check_legibility(const std::vector<LaidPatch>& laid, const Declarations& declarations, const std::string& device,
                      Diagnostics& diagnostics) {
  const DeviceDeclaration* declared = declarations.devices.find(device);
  if (laid.size() < 2 || declared == nullptr || !declared->profile.has_position()) return;
  const Ground ground(laid, 0.5 * declared->profile.workspace_diameter);
  for (std::size_t i = 0; i < laid.size(); ++i)
    if (ground.is_hidden(i)) warn_of_hidden(laid[i], diagnostics);
  if (declared->profile.shaker) return;  // cues are forces
  const Comparer comparer(declarations, device);
  std::map<const Program*, Cues> read;
  const auto cues_of_patch = [&](const LaidPatch& patch) -> const Cues& {
    const auto known = read.find(patch.program.get());
    if (known != read.end()) return known->second;
    const Bank bank(*patch.program, patch.program->default_parameters(), patch.program->default_size());
    return read.emplace(patch.program.get(), cues_of(bank, declarations)).first->second;
  };
  for (const auto& [a, b] : ground.neighbours()) {
    const LaidPatch &one = laid[static_cast<std::size_t>(a)], &other = laid[static_cast<std::size_t>(b)];
    if (one.patch->made_of == other.patch->made_of) continue;  // one surface of several parts
    const Distance distance = comparer.distance(cues_of_patch(one), cues_of_patch(other));
    if (distance.verdict != Verdict::alike) continue;
    diagnostics.report(
        Advice(fmt::format("give one of them another level or material, or leave {:.2g} mm between them",
                           1e3 * (one.size.rim + other.size.rim) + 1))
            .about(
                Code::indistinct_neighbours, other.patch->material.span,
                readable("people would not tell `{}` from `{}` beside it: they differ by {:.2g} of a just noticeable "
                         "difference",
                         other.patch->material.name, one.patch->material.name, distance.noticeable)));
  }
}

}  // namespace wale
