#include "presenting/session.hpp"

#include <QDir>
#include <QFileInfo>
#include <QRandomGenerator>
#include <QRegularExpression>
#include <algorithm>
#include <utility>

namespace sandpaper {
namespace {

constexpr int longest_name = 60;
constexpr std::size_t patches_in_a_line = 5000;  // far from the longest line of a log
constexpr std::size_t places_in_a_line = 500;    // the same, with shapes of many corners
constexpr int before_places = 250;               // ms from a move to its line

/// The next `most` of a list from `from` on.
template <class Item>
std::vector<Item> part_of(const std::vector<Item>& all, std::size_t from, std::size_t most) {
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(std::min(from, all.size()));
  return {first, first + static_cast<std::ptrdiff_t>(std::min(most, all.size() - std::min(from, all.size())))};
}

}  // namespace

Session::Session(QObject* parent) : QObject(parent) {
  placing_.setSingleShot(true);
  placing_.setInterval(before_places);
  connect(&placing_, &QTimer::timeout, this, &Session::log_places);
}

wale::Result<> Session::begin(const QString& participant, std::uint32_t seed, const QString& file,
                              const QString& device) {
  if (participant.trimmed().isEmpty())
    return wale::Error{.code = wale::Code::malformed_value,
                       .sentence = "a session needs an identifier of the participant",
                       .mend = "type one, as S48"};
  if (file.isEmpty())
    return wale::Error{.code = wale::Code::unwritable_file,
                       .sentence = "the log lies beside the file, which has no name yet",
                       .mend = "save it first"};
  QString name = participant.trimmed().left(longest_name);
  name.replace(QRegularExpression("[^A-Za-z0-9_-]"), "_");
  const QFileInfo presented(file);
  const wale::SessionBegin begin{.participant = participant.trimmed().toStdString(),
                                 .seed = seed,
                                 .device = device.toStdString(),
                                 .file = presented.fileName().toStdString(),
                                 .versions = {{"wale", WALE_VERSION}, {"qt", qVersion()}}};
  for (int number = 1;; ++number) {
    const QString path =
        presented.dir().filePath(QString("%1-%2-%3.session").arg(presented.completeBaseName(), name).arg(number));
    if (QFileInfo::exists(path)) continue;
    auto log = wale::SessionLog::create(path.toStdString(), begin);
    if (!log) return log.error();
    end("another session began");
    log_ = *std::move(log);
    break;
  }
  participant_ = participant.trimmed();
  trouble_.clear();
  seed_ = seed;
  random_.seed(seed);
  programs_.clear(), places_.clear(), changed_places_.clear();
  emit changed();
  return {};
}

void Session::end(const char* why) {
  if (!log_) return;
  log(wale::SessionEnd{why});
  log_.reset();
  placing_.stop();
  trouble_.clear();
  emit changed();
}

std::optional<std::uint64_t> Session::log(const wale::SessionEvent& event) {
  if (!log_) return 0;
  return log_places() ? append(event) : std::nullopt;
}

void Session::lay_out(const std::string& what, const std::string& of,
                      std::function<std::vector<wale::SessionPlace>()> places) {
  if (!log_) return;
  changed_places_[{what, of}] = std::move(places);
  if (!placing_.isActive()) placing_.start();
}

bool Session::log_places() {
  placing_.stop();
  while (log_ && !changed_places_.empty()) {
    const auto first = changed_places_.begin();
    if (!log_places_of(first->first, first->second())) return false;  // the next event tries again
    changed_places_.erase(first);
  }
  return true;
}

bool Session::log_places_of(const Layout& layout, const std::vector<wale::SessionPlace>& places) {
  auto& known = places_[layout];
  std::vector<wale::SessionPlace> moved;
  std::map<std::string, wale::SessionPlace> now;
  for (const wale::SessionPlace& each : places) {
    if (const auto before = known.find(each.name); before == known.end() || !(before->second == each))
      moved.push_back(each);
    now.insert_or_assign(each.name, each);
  }
  std::vector<std::string> gone;
  for (const auto& [name, place] : known)
    if (!now.contains(name)) gone.push_back(name);
  for (std::size_t from = 0; from < std::max(moved.size(), gone.size()); from += places_in_a_line)
    if (!append(wale::SessionPlaced{layout.first, layout.second, part_of(moved, from, places_in_a_line),
                                    part_of(gone, from, places_in_a_line)}))
      return false;
  known = std::move(now);
  return true;
}

std::optional<std::uint64_t> Session::append(const wale::SessionEvent& event) {
  const auto line = log_->append(event);
  const QString before =
      std::exchange(trouble_, line ? QString() : QString::fromStdString(wale::in_words(line.error())));
  if (before != trouble_) emit changed();
  if (line) return *line;
  emit said(tr("Nothing is presented that cannot be logged: %1").arg(trouble_));
  emit failed();
  return std::nullopt;
}

bool Session::log_programs(const std::vector<PatchToLog>& patches) {
  if (!log_) return true;
  // Copies of one program have one decoded form; only one of them is hashed.
  std::map<std::pair<std::string, const void*>, std::size_t> known;
  std::vector<std::vector<const PatchToLog*>> alike;
  for (const PatchToLog& each : patches) {
    const auto [found, is_new] = known.try_emplace({each.material, &each.program->decoded()}, alike.size());
    if (is_new) alike.emplace_back();
    alike[found->second].push_back(&each);
  }
  for (const auto& made_of_it : alike) {
    const std::string& material = made_of_it.front()->material;
    const std::uint64_t hash = wale::program_hash(*made_of_it.front()->program);
    std::vector<std::string> names;
    for (const PatchToLog* each : made_of_it)
      if (const auto before = programs_.find(each->patch);
          before == programs_.end() || before->second.material != material || before->second.hash != hash)
        names.push_back(each->patch);
    for (std::size_t from = 0; from < names.size(); from += patches_in_a_line) {
      const std::size_t to = std::min(names.size(), from + patches_in_a_line);
      std::string joined;
      for (std::size_t i = from; i < to; ++i) joined += (i > from ? ", " : "") + names[i];
      if (!log(wale::SessionProgram{joined, material, hash})) return false;
      for (std::size_t i = from; i < to; ++i) programs_[names[i]] = {material, hash};
    }
  }
  return true;
}

std::uint32_t Session::next_seed() {
  return log_ ? static_cast<std::uint32_t>(random_()) : QRandomGenerator::global()->generate();
}

}  // namespace sandpaper
