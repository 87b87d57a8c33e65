#include "document/numbers.hpp"

#include <QRandomGenerator>

namespace sandpaper {
namespace {

constexpr std::uint32_t least = 100, three_digits = 900;

}  // namespace

Numbers::Numbers(const Document& document, QObject* parent) : QObject(parent), document_(document) {
  connect(&document_, &Document::contents_changed, this, &Numbers::follow);
  connect(&document_, &Document::loaded, this, [this] { renew(QRandomGenerator::global()->generate()); });
  renew(QRandomGenerator::global()->generate());
}

void Numbers::renew(std::uint32_t seed) {
  seed_ = seed;
  random_.seed(seed);
  known_.clear(), taken_.clear();
  follow();
  emit renewed();
}

void Numbers::follow() {
  for (const PlacedRef& each : document_.contents().placed) {
    if (!each->is_laid_out()) continue;
    const auto [entry, is_new] = known_.try_emplace({document_.contents().name, each->patch.name});
    if (!is_new) continue;
    // Room for ten times as many, so that a free one is soon found.
    const auto many =
        std::max<std::uint32_t>(three_digits, taken_.size() < three_digits - 90 ? 0 : 10 * (taken_.size() + 1));
    std::uint32_t number = 0;
    do number = least + random_() % many;
    while (!taken_.insert(number).second);
    entry->second = number;
  }
}

QString Numbers::of(const Placed& placed) const {
  const auto found = known_.find({document_.contents().name, placed.patch.name});
  return found == known_.end() ? QStringLiteral("–") : QString::number(found->second);
}

}  // namespace sandpaper
