#include "compiler/read/cut_part.hpp"

#include <glm/geometric.hpp>

#include "compiler/read/relief_figures.hpp"
#include "compiler/read/spring_end.hpp"
#include "compiler/read/tolerances.hpp"

namespace wale {

StillField field_of(const Unlimited& law) {
  return [&law](std::span<const glm::dvec2> places) {
    std::vector<glm::dvec2> forces = forces_at(law.bank, places);
    for (glm::dvec2& force : forces) force *= law.scale;
    return forces;
  };
}

std::optional<CutPart> cut_part(const Bank& bank, const PartLimit& part, const std::vector<glm::dvec2>& places,
                                const std::vector<glm::dvec2>& asked) {
  constexpr double least_cut_part = 0.025;  // of the places: the 99th percentile of a texture cuts a hundredth ...
  constexpr double least_even_part = 1e-3;  // ... and the end of a wall or a spring is cut evenly
  constexpr double alike = 0.02;            // of the part where it is cut
  const auto law = without_part_limits(bank, {&part, 1});
  if (!law) return std::nullopt;
  const std::vector<glm::dvec2> whole = field_of(*law)(places);
  std::vector<std::size_t> cut;
  std::vector<glm::dvec2> there, off;
  double more = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (glm::length(whole[i] - asked[i]) <= 0.5 * least_force) continue;
    cut.push_back(i), there.push_back(places[i]), off.push_back(whole[i] - asked[i]);
    more += glm::dot(whole[i], whole[i]) - glm::dot(asked[i], asked[i]);
  }
  const double share = static_cast<double>(cut.size()) / static_cast<double>(places.size());
  if (share <= least_even_part || (share <= least_cut_part && !changes_evenly(there, off))) return std::nullopt;
  if (!(more > 0)) return std::nullopt;
  if (!part.keeping.empty()) {
    const double newton = end_of_a_spring(there, off);
    return newton > 0 ? std::optional(CutPart{part, newton}) : std::nullopt;
  }
  const auto rest = without_parts(bank, {&part, 1});
  if (!rest) return std::nullopt;
  const std::vector<glm::dvec2> others = field_of(*rest)(there);
  std::vector<double> sizes;
  for (std::size_t i = 0; i < cut.size(); ++i) sizes.push_back(glm::length(asked[cut[i]] - others[i]));
  const double newton = percentile(sizes, 0.5);
  const bool is_force = percentile(sizes, 0.9) - percentile(sizes, 0.1) <= alike * newton;
  return is_force && newton >= least_force ? std::optional(CutPart{part, newton}) : std::nullopt;
}

}  // namespace wale
