#include "runtime/machine/shared_maps.hpp"

#include <mutex>
#include <unordered_map>

#include "schema/home_process.hpp"
#include "schema/patch_program_format.hpp"

namespace wale {
namespace {

/// All maps in use, by the hash of their content, and some expired ones.
struct Registry {
  std::mutex mutex;
  std::unordered_multimap<std::uint64_t, std::weak_ptr<const SharedMap>> maps;
  std::size_t next_sweep = 64;
};

Registry& registry() {
  // Never destroyed: programs in static variables may outlive other static variables.
  static auto* const all = new PerProcess<Registry>;
  return **all;
}

}  // namespace

std::shared_ptr<const SharedMap> shared_map(const HeightTable& table) {
  const std::uint64_t hash = patch_program_format::content_hash(table);
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto [begin, end] = all.maps.equal_range(hash);
  for (auto each = begin; each != end; ++each) {
    if (auto alive = each->second.lock(); alive && alive->table == table) return alive;
  }
  if (all.maps.size() >= all.next_sweep) {
    std::erase_if(all.maps, [](const auto& each) { return each.second.expired(); });
    all.next_sweep = 2 * all.maps.size() + 64;
  }
  auto made = std::make_shared<const SharedMap>(table);
  all.maps.emplace(hash, made);
  return made;
}

}  // namespace wale
