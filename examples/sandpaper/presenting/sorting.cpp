#include "presenting/sorting.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

namespace sandpaper {
namespace {

constexpr double pitch = 1.25;      // sides of a key from one place to the next
constexpr double gap = 1.08;        // the same within a pile
constexpr double growth = 1.1;      // of a table that is too small
constexpr std::size_t room = 2;     // places for each key, so that piles find room
constexpr std::size_t in_a_row = 3; // keys of a pile
constexpr double label_room = 0.5;  // sides of a key, above a pile

bool is_name(const std::string& text) {
  return !text.empty() && !std::isdigit(static_cast<unsigned char>(text.front())) &&
         std::ranges::all_of(text, [](unsigned char letter) { return std::isalnum(letter) || letter == '_'; });
}

/// As std::shuffle, but alike with every library.
template <class List>
void shuffle_list(List& list, std::mt19937& random) {
  for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[random() % i]);
}

/// Places of a table outside the touching area.
std::vector<glm::dvec2> free_places(glm::dvec2 table, double side, glm::dvec2 area_at, glm::dvec2 area) {
  std::vector<glm::dvec2> places;
  const double step = pitch * side;
  const int columns = static_cast<int>(table.x / step), rows = static_cast<int>(table.y / step);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const glm::dvec2 at{(column - (columns - 1) / 2.0) * step, (row - (rows - 1) / 2.0) * step};
      const glm::dvec2 from = at - area_at;
      if (std::abs(from.x) > (area.x + step) / 2 || std::abs(from.y) > (area.y + step) / 2) places.push_back(at);
    }
  return places;
}

}  // namespace

bool Sorting::start(const wale::MiniKeys& declared, const Contents& contents, std::uint32_t seed) {
  stop();
  std::vector<SortingKey> keys;
  for (const PlacedRef& each : contents.placed)
    if (each->is_laid_out() && is_name(each->patch.name)) keys.push_back({.id = each->id, .name = each->patch.name});
  if (keys.empty()) return false;
  declared_ = declared;
  std::mt19937 random(seed);
  table_ = 2.0 * glm::dvec2(std::abs(area_at().x) + area_size().x / 2, std::abs(area_at().y) + area_size().y / 2) +
           4 * pitch * side();
  if (table_.x < 1.4 * table_.y) table_.x = 1.4 * table_.y;
  std::vector<glm::dvec2> places;
  while ((places = free_places(table_, side(), area_at(), area_size())).size() < room * keys.size()) table_ *= growth;
  shuffle_list(places, random);
  std::set<std::uint32_t> numbers;
  const auto many =
      static_cast<std::uint32_t>(std::max<std::size_t>(900, 10 * keys.size()));  // three digits for 90 keys and more
  wale::SessionOrder order{.what = "keys", .of = declared.name, .seed = seed};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    std::uint32_t number = 0;
    do number = 100 + random() % many;
    while (!numbers.insert(number).second);
    keys[i].label = declared.numbered_at_random ? QString::number(number) : QString::fromStdString(keys[i].name);
    keys[i].at = places[i];
  }
  if (declared.numbered_at_random)  // the order in which they are reached by keys must tell nothing either
    std::ranges::sort(keys, {}, [](const SortingKey& each) { return each.label.toInt(); });
  for (const SortingKey& each : keys) order.items.push_back({each.name, each.label.toStdString(), each.at});
  if (!session_.log(order)) return false;
  keys_ = std::move(keys);
  lay_out();
  emit changed();
  return true;
}

void Sorting::stop() {
  keys_.clear(), says_.clear(), steps_.clear();
  chosen_.reset();
  emit changed();
}

void Sorting::lay_out() {
  session_.lay_out("keys", declared_.name, [keys = keys_] {
    std::vector<wale::SessionPlace> places;
    for (const SortingKey& each : keys) places.push_back({.name = each.name, .at = each.at});
    return places;
  });
}

std::vector<int> Sorting::piles() const {
  std::set<int> numbers;
  for (const SortingKey& each : keys_)
    if (each.pile != 0) numbers.insert(each.pile);
  return {numbers.begin(), numbers.end()};
}

int Sorting::new_pile() const {
  const auto all = piles();
  int number = 1;
  while (std::ranges::find(all, number) != all.end()) ++number;
  return number;
}

QString Sorting::says(int pile) const {
  const auto found = says_.find(pile);
  return found == says_.end() ? QString() : found->second;
}

std::optional<std::size_t> Sorting::key_at(glm::dvec2 metres) const {
  for (std::size_t i = keys_.size(); i-- > 0;)
    if (std::abs(metres.x - keys_[i].at.x) <= side() / 2 && std::abs(metres.y - keys_[i].at.y) <= side() / 2) return i;
  return std::nullopt;
}

void Sorting::choose(std::size_t key) {
  if (key >= keys_.size() || chosen_ == key) return;
  if (!session_.log(wale::SessionShown{"key", keys_[key].name, keys_[key].label.toStdString(),
                                       static_cast<std::uint32_t>(key + 1)}))
    return;
  chosen_ = key;
  emit chosen_changed();
  emit changed();
}

void Sorting::move(std::size_t key, glm::dvec2 to) {
  if (key >= keys_.size()) return;
  const glm::dvec2 most = 0.5 * (table_ - side());
  keys_[key].at = {std::clamp(to.x, -most.x, most.x), std::clamp(to.y, -most.y, most.y)};
  lay_out();
  emit changed();
}

wale::SessionAnswer Sorting::in_pile(std::size_t key, int pile) const {
  return {"pile", keys_[key].name, std::to_string(pile)};
}

bool Sorting::answer(std::vector<wale::SessionAnswer> answers, int begun) {
  // A new pile has no label, also if one with its number had one before.
  if (begun != 0 && !says(begun).isEmpty()) answers.push_back({"label", std::to_string(begun), ""});
  Step step{keys_, says_, {}};
  for (const wale::SessionAnswer& each : answers) {
    const auto line = session_.log(each);
    if (!line) {
      // What was logged of it already does not count.
      if (!step.answers.empty()) session_.log(wale::SessionTakenBack{step.answers});
      return false;
    }
    if (*line != 0) step.answers.push_back(*line);
  }
  steps_.push_back(std::move(step));
  if (begun != 0) says_.erase(begun);
  return true;
}

void Sorting::tidy(int pile) {
  std::vector<SortingKey*> of_it;
  for (SortingKey& each : keys_)
    if (each.pile == pile) of_it.push_back(&each);
  if (of_it.empty()) return;
  // Around the place of the first key, or as near to it as the pile lies on nothing else.
  const glm::dvec2 first = of_it.front()->at;
  const std::size_t columns = std::min(of_it.size(), in_a_row), rows = (of_it.size() + in_a_row - 1) / in_a_row;
  const glm::dvec2 size = gap * side() * glm::dvec2(static_cast<double>(columns), static_cast<double>(rows));
  const glm::dvec2 margin{0.1 * side(), 0.1 * side()}, label{0, label_room * side()};
  const glm::dvec2 low = -0.5 * table_, high = 0.5 * table_ - size - label;
  const auto is_free = [&](glm::dvec2 corner) {
    const glm::dvec2 from = corner - margin, to = corner + size + label + margin;
    const auto lies_on = [&](glm::dvec2 at, glm::dvec2 whole) {
      const glm::dvec2 least = at - 0.5 * whole, most = at + 0.5 * whole;
      return from.x < most.x && to.x > least.x && from.y < most.y && to.y > least.y;
    };
    return !lies_on(area_at(), area_size()) && std::ranges::none_of(keys_, [&](const SortingKey& each) {
      return each.pile != pile && lies_on(each.at, glm::dvec2(side()));
    });
  };
  const auto within = [&](glm::dvec2 corner) {
    return glm::dvec2(std::clamp(corner.x, low.x, std::max(low.x, high.x)),
                      std::clamp(corner.y, low.y, std::max(low.y, high.y)));
  };
  const glm::dvec2 wanted = within(first - 0.5 * gap * side());
  glm::dvec2 corner = wanted;
  if (!is_free(wanted)) {
    double nearest = std::numeric_limits<double>::infinity();
    for (double x = low.x; x <= high.x; x += side() / 4)
      for (double y = low.y; y <= high.y; y += side() / 4)
        if (const double way = std::hypot(x - wanted.x, y - wanted.y); way < nearest && is_free({x, y}))
          nearest = way, corner = {x, y};
  }
  for (std::size_t i = 0; i < of_it.size(); ++i)
    of_it[i]->at =
        corner +
        gap * side() * glm::dvec2(static_cast<double>(i % in_a_row) + 0.5, static_cast<double>(i / in_a_row) + 0.5);
}

void Sorting::put(std::size_t key, int pile) {
  if (key >= keys_.size() || pile < 0 || keys_[key].pile == pile) return;
  const int before = keys_[key].pile;
  const auto same = std::ranges::find_if(keys_, [&](const SortingKey& each) { return pile != 0 && each.pile == pile; });
  if (!answer({in_pile(key, pile)}, same == keys_.end() ? pile : 0)) return;
  keys_[key].pile = pile;
  if (same != keys_.end()) {
    const glm::dvec2 where = same->at;
    if (key < static_cast<std::size_t>(same - keys_.begin())) keys_[key].at = where;
    tidy(pile);
  }
  if (before != 0) tidy(before);
  lay_out();
  emit changed();
}

void Sorting::put_on(std::size_t key, std::size_t other) {
  if (key >= keys_.size() || other >= keys_.size() || key == other) return;
  if (keys_[other].pile != 0) return put(key, keys_[other].pile);
  const int pile = new_pile(), before = keys_[key].pile;
  if (!answer({in_pile(other, pile), in_pile(key, pile)}, pile)) return;
  keys_[key].at = keys_[other].at;
  keys_[key].pile = keys_[other].pile = pile;
  tidy(pile);
  if (before != 0) tidy(before);
  lay_out();
  emit changed();
}

void Sorting::join(int pile, int into) {
  if (pile == into || pile <= 0 || into <= 0) return;
  std::vector<wale::SessionAnswer> answers;
  for (std::size_t i = 0; i < keys_.size(); ++i)
    if (keys_[i].pile == pile) answers.push_back(in_pile(i, into));
  const auto target = std::ranges::find(keys_, into, &SortingKey::pile);
  if (answers.empty() || target == keys_.end() || !answer(answers)) return;
  const glm::dvec2 where = target->at;
  for (SortingKey& each : keys_)
    if (each.pile == pile) each.pile = into, each.at = where;
  std::ranges::find(keys_, into, &SortingKey::pile)->at = where;
  tidy(into);
  lay_out();
  emit changed();
}

void Sorting::label(int pile, const QString& says) {
  const auto all = piles();
  if (std::ranges::find(all, pile) == all.end() || this->says(pile) == says) return;
  if (!answer({{"label", std::to_string(pile), says.toStdString()}})) return;
  says_[pile] = says;
  emit changed();
}

void Sorting::take_back() {
  if (steps_.empty()) return;
  Step& last = steps_.back();
  if (!last.answers.empty() && !session_.log(wale::SessionTakenBack{last.answers})) return;
  keys_ = std::move(last.keys), says_ = std::move(last.says);
  steps_.pop_back();
  lay_out();
  emit changed();
}

std::vector<wale::SortedGroups::Group> Sorting::groups() const {
  std::vector<wale::SortedGroups::Group> groups;
  for (const int pile : piles()) {
    wale::SortedGroups::Group group{{}, says(pile).toStdString()};
    for (const SortingKey& each : keys_)
      if (each.pile == pile) group.patches.push_back(each.name);
    std::ranges::sort(group.patches);
    groups.push_back(std::move(group));
  }
  return groups;
}

std::string groups_text(const wale::SortedGroups& groups) {
  std::string text = "groups " + groups.name + " {\n  of    " + groups.workspace + "\n";
  for (const auto& group : groups.groups) {
    text += "  group ";
    for (std::size_t i = 0; i < group.patches.size(); ++i) text += (i ? ", " : "") + group.patches[i];
    if (!group.says.empty()) {
      text += ", \"";
      for (const char letter : group.says)
        text += letter == '"' || letter == '\\' ? std::string("\\") + letter : std::string(1, letter);
      text += "\"";
    }
    text += "\n";
  }
  return text + "}";
}

}  // namespace sandpaper
