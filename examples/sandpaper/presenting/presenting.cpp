#include "presenting/presenting.hpp"
#include "document/counted.hpp"

#include <QApplication>
#include <algorithm>
#include <cctype>
#include <random>
#include <utility>

namespace sandpaper {
namespace {

constexpr std::size_t numbers_in_a_line = 5000;  // far from the longest line of a log
constexpr std::size_t longest_shape = 1000;      // bytes; of a longer one the file tells the rest

/// At most so many bytes of a text, without half a letter at its end.
std::string beginning_of(const std::string& text, std::size_t most) {
  std::size_t length = std::min(most, text.size());
  while (length < text.size() && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) --length;
  return text.substr(0, length);
}

/// The patches as the log tells where they lie.
std::vector<wale::SessionPlace> places_of(const Contents& contents) {
  std::vector<wale::SessionPlace> places;
  for (const PlacedRef& each : contents.placed) {
    if (!each->is_laid_out()) continue;
    const wale::LaidOutPatch& patch = each->patch;
    places.push_back({.name = patch.name,
                      .at = patch.at,
                      .size = patch.size,
                      .shape = beginning_of(patch.shape, longest_shape),
                      .rim = patch.rim,
                      .layer = static_cast<std::uint32_t>(places.size() + 1)});
  }
  return places;
}

}  // namespace

Presenting::Presenting(const wale::Library& library, Document& document, Numbers& numbers, Feeling& feeling,
                       QObject* parent)
    : QObject(parent),
      library_(library),
      document_(document),
      numbers_(numbers),
      feeling_(feeling),
      sorting_(session_) {
  connect(&session_, &Session::said, this, &Presenting::said);
  // Nobody feels what cannot be logged.
  connect(&session_, &Session::failed, this, [this] { feeling_.set_on(false); });
  connect(&sorting_, &Sorting::chosen_changed, this, &Presenting::felt_changed);
  connect(&feeling_, &Feeling::programs_changed, this, [this] {
    log_programs();
    start_if_ready();
  });
  connect(&feeling_, &Feeling::on_changed, this,
          [this] { session_.log(wale::SessionNote{feeling_.is_on() ? "force on" : "force off"}); });
  connect(&feeling_, &Feeling::device_changed, this, [this] {
    session_.log(
        wale::SessionNote{"device " + feeling_.profile().name + " (" + feeling_.spelling().toStdString() + ")"});
  });
  connect(&document_, &Document::unloading, this, [this] {
    end("another file was opened");
    movie_.clear(), order_.clear();
    frame_ = -1;
    begins_anew_ = false;
  });
  connect(&document_, &Document::contents_changed, this, &Presenting::follow_contents);
}

void Presenting::follow_contents() {
  if (sorting_.runs() && !std::ranges::all_of(sorting_.keys(), [this](const SortingKey& each) {
        const Placed* still = document_.contents().find(each.id);
        return still && still->patch.name == each.name;
      })) {
    cancel_sorting("the workspace was changed");
    emit said(tr("The sort was broken off: its patches were changed"));
  }
  if (!session_.runs()) return;
  // Another workspace came otherwise than by a step: by the menu, by an undo, or in the text.
  if (document_.contents().name != shown_) {
    shown_ = document_.contents().name;
    session_.log(wale::SessionShown{"frame", shown_, "", 0});
  }
  log_numbers();
  lay_out();
  log_programs();
}

void Presenting::lay_out() {
  if (!session_.runs()) return;
  session_.lay_out("patches", shown_, [contents = document_.contents()] { return places_of(contents); });
}

Contents Presenting::felt() const {
  Contents contents = document_.contents();
  if (!sorting_.runs()) return contents;
  const SortingKey* chosen = sorting_.chosen();
  for (PlacedRef& each : contents.placed) {
    Placed other = *each;
    other.away = !chosen || chosen->id != each->id;
    if (!other.away) {
      other.patch.at = sorting_.area_at();
      other.patch.size = sorting_.area_size();
      other.patch.shape.clear(), other.patch.outline = {};
    }
    each = std::make_shared<const Placed>(std::move(other));
  }
  return contents;
}

void Presenting::begin_session(const QString& participant, std::uint32_t seed) {
  if (sorting_.runs()) return emit said(tr("Finish the sort first, or break it off: a session begins before it"));
  if (document_.is_stale())
    return emit said(tr("The text has errors: mend them first, so that all is felt that is logged"));
  const QString device = QString::fromStdString(feeling_.profile().name);
  if (const auto begun = session_.begin(participant, seed, document_.file(), device); !begun)
    return emit said(tr("The session did not begin: %1").arg(QString::fromStdString(wale::in_words(begun.error()))));
  order_.clear();
  frame_ = -1;
  begins_anew_ = false;
  numbered_.clear();
  shown_ = document_.contents().name;
  numbers_.renew(session_.next_seed());
  if (!session_.log(wale::SessionShown{"frame", shown_, "", 0}) || !log_numbers()) return;
  lay_out();
  if (feeling_.is_on()) session_.log(wale::SessionNote{"force on"});
  log_programs();
  if (session_.trouble().isEmpty())
    emit said(tr("The session of %1 is logged in %2").arg(session_.participant(), session_.path()));
}

bool Presenting::log_numbers() {
  if (!session_.runs()) return true;
  std::set<std::string>& known = numbered_[shown_];
  wale::SessionOrder order{.what = "numbers", .of = shown_, .seed = numbers_.seed()};
  const auto log_order = [&] {
    if (order.items.empty()) return true;
    if (!session_.log(order)) return false;
    for (const wale::SessionItem& each : std::exchange(order.items, {})) known.insert(each.name);
    return true;
  };
  for (const PlacedRef& each : document_.contents().placed) {
    if (!each->is_laid_out() || known.contains(each->patch.name)) continue;
    order.items.push_back({each->patch.name, numbers_.of(*each).toStdString(), each->patch.at});
    if (order.items.size() == numbers_in_a_line && !log_order()) return false;
  }
  return log_order();
}

void Presenting::log_programs() {
  if (!session_.runs()) return;
  std::vector<PatchToLog> patches;
  for (const PlacedRef& each : document_.contents().placed)
    if (const wale::Program* program = feeling_.program(each->id))
      patches.push_back({each->patch.name, each->patch.made_of, program});
  session_.log_programs(patches);
}

std::optional<wale::Presentation> Presenting::presentation() const {
  auto found = library_.presentation(document_.text(),
                                     document_.file().isEmpty() ? "untitled.wale" : document_.file().toStdString());
  return found ? std::optional(*std::move(found)) : std::nullopt;
}

QStringList Presenting::movies() const {
  QStringList names;
  if (const auto all = presentation())
    for (const wale::Movie& each : all->movies) names << QString::fromStdString(each.name);
  return names;
}

QStringList Presenting::keys() const {
  QStringList names;
  if (const auto all = presentation())
    for (const wale::MiniKeys& each : all->keys) names << QString::fromStdString(each.name);
  return names;
}

void Presenting::choose_movie(const QString& name) {
  movie_ = name;
  order_.clear();
  frame_ = -1;
  begins_anew_ = true;
  emit said(tr("The movie is %1: F8 shows its first frame").arg(name));
}

QStringList Presenting::frames() {
  QStringList declared = document_.workspaces();
  if (const auto all = presentation(); all && !all->movies.empty()) {
    const wale::Movie* movie = &all->movies.front();
    for (const wale::Movie& each : all->movies)
      if (each.name == movie_.toStdString()) movie = &each;
    movie_ = QString::fromStdString(movie->name);
    declared.clear();
    for (const std::string& each : movie->frames) declared << QString::fromStdString(each);
  } else if (all) {
    movie_.clear();
  }
  QStringList a = order_, b = declared;
  a.sort(), b.sort();
  if (a != b) order_.clear();  // the movie was written anew
  return order_.isEmpty() ? declared : order_;
}

void Presenting::step(int by) {
  if (sorting_.runs()) return emit said(tr("Finish the sort first, or break it off"));
  const QStringList all = frames();
  if (all.size() < 2) return emit said(tr("This file has one workspace: there is nothing to step to"));
  const QString now = QString::fromStdString(document_.contents().name);
  // A frame can come several times, so its number counts and not its name.
  qsizetype at = -1;
  if (!begins_anew_) at = frame_ >= 0 && frame_ < all.size() && all[frame_] == now ? frame_ : all.indexOf(now);
  const qsizetype next = at < 0 ? (by > 0 ? 0 : all.size() - 1) : (at + by + all.size()) % all.size();
  if (document_.is_stale() || !document_.workspaces().contains(all[next]))
    return emit said(tr("%1 cannot be shown: mend the text first").arg(all[next]));
  if (!session_.log(wale::SessionShown{"frame", all[next].toStdString(), "", static_cast<std::uint32_t>(next + 1)}))
    return;
  shown_ = all[next].toStdString();
  if (all[next] != now && !document_.show_workspace(all[next]))
    return emit said(tr("%1 cannot be shown").arg(all[next]));
  frame_ = next;
  begins_anew_ = false;
  QApplication::beep();
  emit said(tr("%1, %2 of %3").arg(all[next]).arg(next + 1).arg(all.size()));
}

void Presenting::shuffle_frames() {
  if (sorting_.runs()) return emit said(tr("Finish the sort first, or break it off"));
  order_.clear();
  QStringList all = frames();
  if (all.size() < 2) return emit said(tr("This file has one workspace: there is no order to shuffle"));
  const std::uint32_t seed = session_.next_seed();
  std::mt19937 random(seed);
  for (qsizetype i = all.size(); i > 1; --i) all.swapItemsAt(i - 1, random() % static_cast<std::uint32_t>(i));
  wale::SessionOrder order{.what = "frames", .of = movie_.toStdString(), .seed = seed};
  for (const QString& each : all) order.items.push_back({each.toStdString(), "", {}});
  if (!session_.log(order)) return;
  order_ = all;
  frame_ = -1;
  begins_anew_ = true;
  emit said(tr("%1 frames have a new order, from seed %2: F8 shows the first").arg(all.size()).arg(seed));
}

void Presenting::shuffle_places(const SizeOf& size_of) {
  if (sorting_.runs()) return emit said(tr("Finish the sort first, or break it off"));
  if (document_.is_stale()) return document_.change(tr("Shuffle"), document_.contents());  // says why not
  const std::uint32_t seed = session_.next_seed();
  Shuffled shuffled =
      shuffle(document_.contents(), document_.chosen(), seed, feeling_.profile().workspace_diameter, size_of);
  if (shuffled.moved == 0) return emit said(tr("Two unlocked patches are needed to shuffle"));
  wale::SessionOrder order{.what = "places", .of = document_.contents().name, .seed = seed};
  for (const PlacedRef& each : shuffled.contents.placed)
    if (each->is_laid_out()) order.items.push_back({each->patch.name, "", each->patch.at});
  if (!session_.log(order)) return;
  document_.change(tr("Shuffle"), std::move(shuffled.contents));
  QString words = tr("New places for %1, from seed %2").arg(counted(shuffled.moved, "patch", "patches")).arg(seed);
  if (shuffled.overlap.value_or(0) > 0) words += tr("; there is not room for all side by side");
  emit said(words);
}

void Presenting::start_sorting(const QString& name) {
  if (sorting_.runs()) return emit said(tr("Finish the sort first, or break it off"));
  if (document_.is_stale())
    return emit said(tr("The text has errors: mend them first, then there is something to sort"));
  const auto all = presentation();
  const auto found = !all              ? decltype(all->keys.begin()){}
                     : name.isEmpty() ? all->keys.begin()
                                      : std::ranges::find(all->keys, name.toStdString(), &wale::MiniKeys::name);
  if (!all || found == all->keys.end())
    return emit said(name.isEmpty()
                         ? tr("This file has no keys: keys sorting { of %1; area 80 mm, 80 mm; labels random }")
                               .arg(QString::fromStdString(document_.contents().name))
                         : tr("This file has no keys %1").arg(name));
  waiting_ = *found;
  if (hides_names_) waiting_->numbered_at_random = true;
  if (waiting_->workspace != document_.contents().name) {
    if (!session_.log(wale::SessionShown{"frame", waiting_->workspace, "", 0})) return waiting_.reset();
    shown_ = waiting_->workspace;
    if (!document_.show_workspace(QString::fromStdString(waiting_->workspace))) {
      waiting_.reset();
      return emit said(tr("The workspace of these keys cannot be shown"));
    }
  }
  start_if_ready();
  if (waiting_) emit said(tr("The keys are shown when their materials are compiled"));
}

void Presenting::start_if_ready() {
  if (!waiting_) return;
  if (waiting_->workspace != document_.contents().name) return waiting_.reset();  // somebody went elsewhere meanwhile
  for (const PlacedRef& each : document_.contents().placed) {
    if (!each->is_laid_out() || feeling_.program(each->id)) continue;
    if (feeling_.material(each->id)) {
      waiting_.reset();
      return emit said(
          tr("%1 has an error in its material: mend it first").arg(QString::fromStdString(each->patch.name)));
    }
    return;
  }
  const wale::MiniKeys declared = *std::exchange(waiting_, std::nullopt);
  log_programs();
  if (!sorting_.start(declared, document_.contents(), session_.next_seed())) {
    if (session_.trouble().isEmpty())
      emit said(tr("%1 has no patch that can be a key").arg(QString::fromStdString(declared.workspace)));
    return;
  }
  emit felt_changed();
  const QString keys = counted(static_cast<qsizetype>(sorting_.keys().size()), "key", "keys");
  emit said(session_.runs() ? tr("%1 to sort").arg(keys)
                            : tr("%1 to sort. There is no session: nothing is logged").arg(keys));
}

void Presenting::finish_sorting() {
  if (!sorting_.runs()) return;
  wale::SortedGroups groups{.workspace = sorting_.declared().workspace, .groups = sorting_.groups()};
  if (groups.groups.empty()) return emit said(tr("No pile was made: drag a key onto another one, or press +"));
  const auto all = presentation();
  if (!all || document_.is_stale())
    return emit said(tr("The text has errors: mend them first, then the groups can be saved"));
  std::string base = "sorted";
  if (session_.runs()) base += "_" + session_.participant().toStdString();
  groups.name = free_name(base, *all);
  wale::SessionGroups logged{.name = groups.name, .workspace = groups.workspace};
  for (const auto& each : groups.groups) logged.groups.push_back({each.patches, each.says});
  if (!session_.log(logged)) return;
  const std::size_t alone = sorting_.keys().size() - [&] {
    std::size_t sorted = 0;
    for (const auto& each : groups.groups) sorted += each.patches.size();
    return sorted;
  }();
  sorting_.stop();
  Contents next = document_.contents();
  while (next.tail.ends_with('\n')) next.tail.pop_back();
  next.tail += "\n\n" + groups_text(groups) + "\n";
  document_.change(tr("Save groups %1").arg(QString::fromStdString(groups.name)), std::move(next));
  emit felt_changed();
  QString words = tr("Sorted into %1, %2")
                      .arg(counted(static_cast<qsizetype>(groups.groups.size()), "group", "groups"),
                           QString::fromStdString(groups.name));
  if (alone > 0) words += tr("; %1 lay alone").arg(counted(static_cast<qsizetype>(alone), "key", "keys"));
  emit said(words);
}

std::string Presenting::free_name(const std::string& base, const wale::Presentation& taken) const {
  std::string name;
  for (const unsigned char each : base) name += std::isalnum(each) && each < 128 ? static_cast<char>(each) : '_';
  const std::string plain = name, text = document_.text();
  const auto is_taken = [&] {
    const auto has_it = [&](const auto& each) { return each.name == name; };
    return std::ranges::any_of(taken.groups, has_it) || std::ranges::any_of(taken.keys, has_it) ||
           std::ranges::any_of(taken.movies, has_it) ||
           std::ranges::find(taken.workspaces, name) != taken.workspaces.end() ||
           text.find(" " + name + " ") != std::string::npos;
  };
  for (int i = 2; is_taken(); ++i) name = plain + "_" + std::to_string(i);
  return name;
}

void Presenting::cancel_sorting(const char* why) {
  waiting_.reset();
  if (!sorting_.runs()) return;
  session_.log(wale::SessionNote{std::string("sort broken off: ") + why});
  sorting_.stop();
  emit felt_changed();
}

void Presenting::recentre() {
  if (!feeling_.recentre()) return;
  const glm::dvec2 at = 1e3 * feeling_.centre();
  const QString words = tr("the centre is %1, %2 mm from the device's own").arg(at.x, 0, 'f', 1).arg(at.y, 0, 'f', 1);
  if (session_.log(wale::SessionNote{words.toStdString()})) emit said(tr("All force is taken away; %1").arg(words));
}

void Presenting::centre_back() {
  if (!feeling_.centre_back()) return emit said(tr("The centre is the device's own"));
  if (session_.log(wale::SessionNote{"the centre is the device's own"}))
    emit said(tr("All force is taken away; the centre is the device's own"));
}

void Presenting::end(const char* why) {
  cancel_sorting(why);
  session_.end(why);
}

}  // namespace sandpaper
