#include "compiler/layout/ground.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "compiler/areas/edge_distances.hpp"

namespace wale {
namespace {

constexpr double finest_step = 0.5e-3;  // m
constexpr double most_steps = 1000;     // in a row

}  // namespace

Ground::Ground(const std::vector<LaidPatch>& laid, double radius)
    : laid_(laid),
      radius_(radius),
      step_(std::max(finest_step, 2 * radius / most_steps)),
      half_(static_cast<int>(std::ceil(radius / step_))),
      side_(2 * half_ + 1) {
  felt_.assign(static_cast<std::size_t>(side_ * side_), nobody);
  covered_.assign(laid.size(), 0), seen_.assign(laid.size(), 0);
  for (std::size_t i = 0; i < laid.size(); ++i) lay(static_cast<int>(i), radius);
  for (const int each : felt_)
    if (each != nobody) ++seen_[static_cast<std::size_t>(each)];
}

void Ground::lay(int number, double radius) {
  const LaidPatch& patch = laid_[static_cast<std::size_t>(number)];
  const glm::dvec2 middle(patch.patch->at[0], patch.patch->at[1]);
  const glm::dvec2 half(0.5 * patch.size.width, 0.5 * patch.size.height);
  const auto index = [&](double metres, bool up) {  // a little further out than needed
    const double of_step = half_ + (up ? std::floor(metres / step_) - 1 : std::ceil(metres / step_) + 1);
    return static_cast<int>(std::clamp(of_step, 0.0, side_ - 1.0));
  };
  for (int row = index(middle.y - half.y, true); row <= index(middle.y + half.y, false); ++row)
    for (int column = index(middle.x - half.x, true); column <= index(middle.x + half.x, false); ++column) {
      const glm::dvec2 place(x_of(column), y_of(row));
      if (std::hypot(place.x, place.y) > radius || !is_on(number, place)) continue;
      felt_[static_cast<std::size_t>(row * side_ + column)] = number;
      ++covered_[static_cast<std::size_t>(number)];
    }
}

bool Ground::is_on(int number, glm::dvec2 place) const {
  const LaidPatch& patch = laid_[static_cast<std::size_t>(number)];
  const glm::dvec2 from = place - glm::dvec2(patch.patch->at[0], patch.patch->at[1]);
  return std::abs(from.x) <= 0.5 * patch.size.width && std::abs(from.y) <= 0.5 * patch.size.height &&
         patch.shape.contains(glm::vec2(from));
}

glm::dvec2 Ground::edge_of(int patch, glm::dvec2 within, glm::dvec2 beyond) const {
  while (std::hypot(beyond.x - within.x, beyond.y - within.y) > 1e-6) {
    const glm::dvec2 middle = 0.5 * (within + beyond);
    (is_on(patch, middle) ? within : beyond) = middle;
  }
  return within;
}

template <class Visit>
void Ground::each_way(const Visit& visit) const {
  for (const bool upwards : {false, true})
    for (int line = 0; line < side_; ++line) {
      int last = nobody, last_at = 0;
      for (int i = 0; i < side_; ++i) {
        const int here = upwards ? at(line, i) : at(i, line);
        if (here == nobody) continue;
        const auto place = [&](int at) {
          return upwards ? glm::dvec2(x_of(line), y_of(at)) : glm::dvec2(x_of(at), y_of(line));
        };
        if (last != nobody && last != here) visit(last, here, i - last_at - 1, place(last_at), place(i));
        last = here, last_at = i;
      }
    }
}

std::map<std::pair<int, int>, std::vector<Ground::Crossing>> Ground::neighbours() const {
  std::map<std::pair<int, int>, std::vector<Crossing>> all;
  each_way([&](int here, int there, int between, glm::dvec2 last, glm::dvec2 first) {
    if (between * step_ > rim(here) + rim(there)) return;
    all[std::minmax(here, there)].push_back(here < there ? Crossing{last, first} : Crossing{first, last});
  });
  return all;
}

bool Ground::is_slit(std::size_t patch) const {
  const auto& at = laid_[patch].patch->at;
  return covered_[patch] == 0 && std::hypot(at[0], at[1]) < radius_;
}

double Ground::gap_between(int one, int other, glm::dvec2 of_one, glm::dvec2 of_other) const {
  if (!is_on(one, of_one) || !is_on(other, of_other)) return HUGE_VAL;
  const glm::dvec2 gap = edge_of(other, of_other, of_one) - edge_of(one, of_one, of_other);
  return std::max(0.0, gap.x + gap.y);
}

double Ground::gap_beside(const Gap& gap) const {
  constexpr double golden = 0.618033988749895, told = 1e-6;  // m
  const glm::dvec2 along = gap.of_other - gap.of_one;
  const glm::dvec2 aside = along.x > along.y ? glm::dvec2(0, 1) : glm::dvec2(1, 0);
  const auto width = [&](double shift) {
    return gap_between(gap.one, gap.other, gap.of_one + shift * aside, gap.of_other + shift * aside);
  };
  double least = gap.width;
  for (const double sign : {-1.0, 1.0}) {
    double near = 0, far = step_;
    while (far - near > told) {
      const double a = far - golden * (far - near), b = near + golden * (far - near);
      const double at_a = width(sign * a), at_b = width(sign * b);
      least = std::min({least, at_a, at_b});
      (at_a <= at_b ? far : near) = at_a <= at_b ? b : a;
    }
  }
  return least;
}

std::map<std::pair<int, int>, double> Ground::gaps() const {
  std::map<std::pair<int, int>, Gap> all;
  std::set<std::pair<int, int>> touching;
  each_way([&](int here, int there, int between, glm::dvec2 last, glm::dvec2 first) {
    const std::pair<int, int> both = std::minmax(here, there);
    if (between == 0) touching.insert(both);
    const auto [known, is_new] = all.emplace(both, Gap{});
    if ((between - 1) * step_ >= known->second.width) return;
    const double width = gap_between(here, there, last, first);
    if (width < known->second.width) known->second = {here, there, last, first, width};
  });
  std::map<std::pair<int, int>, double> widths;
  for (const auto& [both, gap] : all) {
    if (touching.contains(both)) continue;
    const auto is_straight = [&](int patch) {
      return std::holds_alternative<RectangleOutline>(laid_[static_cast<std::size_t>(patch)].patch->outline);
    };
    const double width = is_straight(gap.one) && is_straight(gap.other) ? gap.width : gap_beside(gap);
    if (width >= 1e-5) widths.emplace(both, width);
  }
  return widths;
}

std::vector<double> Ground::widths() const {
  const auto side = static_cast<std::size_t>(side_);
  const std::vector<double> to_edge = squared_edge_distances<int>(felt_, side, side);
  std::vector<double> widths(laid_.size(), 0);
  for (std::size_t i = 0; i < felt_.size(); ++i)
    if (felt_[i] != nobody) {
      double& width = widths[static_cast<std::size_t>(felt_[i])];
      width = std::max(width, (2 * std::sqrt(to_edge[i]) - 1) * step_);
    }
  return widths;
}

}  // namespace wale
