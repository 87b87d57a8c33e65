#include "calibration/session/session_line.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* number_key = "line";
constexpr const char* time_key = "time";
constexpr const char* seconds_key = "seconds";
constexpr const char* event_key = "event";
constexpr double metre_in_mm = 1000;

/// The names of the events, in the order of the variant.
constexpr std::array<const char*, std::variant_size_v<SessionEvent> - 1> names = {
    "begin", "program", "order", "placed", "shown", "answer", "taken back", "groups", "resumed", "note", "end"};

bool is_known(std::string_view name) {
  for (const std::string_view each : names)
    if (each == name) return true;
  return false;
}

/// A field that is missing or something else. It is thrown within this file only.
struct Malformed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string hexadecimal(std::uint64_t number) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text(16, '0');
  for (std::size_t i = text.size(); i-- > 0; number /= 16) text[i] = digits[number % 16];
  return text;
}

double finite(double value) {
  if (!std::isfinite(value)) throw Malformed("a number is not finite");
  return value;
}

/// Without the digits behind the nanometre, which come from binary fractions: 2 and not 2.0000000000000018.
double in_mm(double metres) { return finite(std::round(metres * metre_in_mm * 1e6) / 1e6); }
Json in_mm(glm::dvec2 metres) { return {in_mm(metres.x), in_mm(metres.y)}; }

// ---- writing

struct Write {
  Json& to;

  void operator()(const SessionBegin& begin) const {
    to["format"] = session_log_version;
    to["participant"] = begin.participant;
    to["seed"] = begin.seed;
    to["device"] = begin.device;
    to["file"] = begin.file;
    to["versions"] = Json::object();
    for (const auto& [name, version] : begin.versions) to["versions"][name] = version;
    if (!begin.experiment.empty()) to["experiment"] = begin.experiment;
    if (!begin.grade.empty()) to["grade"] = begin.grade;
  }
  void operator()(const SessionProgram& program) const {
    to["patch"] = program.patch;
    to["material"] = program.material;
    to["hash"] = hexadecimal(program.hash);
  }
  void operator()(const SessionOrder& order) const {
    to["what"] = order.what;
    to["of"] = order.of;
    to["seed"] = order.seed;
    Json items = Json::array();
    for (const SessionItem& each : order.items) {
      Json item = {{"name", each.name}};
      if (!each.label.empty()) item["label"] = each.label;
      if (each.at) item["at_mm"] = in_mm(*each.at);
      items.push_back(std::move(item));
    }
    to["items"] = std::move(items);
  }
  void operator()(const SessionPlaced& placed) const {
    to["what"] = placed.what;
    to["of"] = placed.of;
    Json items = Json::array();
    for (const SessionPlace& each : placed.items) {
      Json item = {{"name", each.name}, {"at_mm", in_mm(each.at)}};
      if (each.size) item["size_mm"] = in_mm(*each.size);
      if (!each.shape.empty()) item["shape"] = each.shape;
      if (each.rim) item["rim_mm"] = in_mm(*each.rim);
      if (each.layer != 0) item["layer"] = each.layer;
      items.push_back(std::move(item));
    }
    to["items"] = std::move(items);
    if (!placed.gone.empty()) to["gone"] = placed.gone;
  }
  void operator()(const SessionShown& shown) const {
    to["what"] = shown.what;
    to["name"] = shown.name;
    if (!shown.label.empty()) to["label"] = shown.label;
    if (shown.number != 0) to["number"] = shown.number;
    if (shown.interval != 0) to["interval"] = shown.interval;
    if (!shown.recording.empty()) to["recording"] = shown.recording;
  }
  void operator()(const SessionAnswer& answer) const {
    to["question"] = answer.question;
    to["about"] = answer.about;
    to["answer"] = answer.answer;
  }
  void operator()(const SessionTakenBack& taken) const { to["answers"] = taken.answers; }
  void operator()(const SessionGroups& groups) const {
    to["name"] = groups.name;
    to["of"] = groups.workspace;
    Json all = Json::array();
    for (const SessionGroups::Group& each : groups.groups) {
      Json group = {{"patches", each.patches}};
      if (!each.says.empty()) group["says"] = each.says;
      all.push_back(std::move(group));
    }
    to["groups"] = std::move(all);
  }
  void operator()(const SessionResumed& resumed) const {
    to["gap"] = finite(resumed.gap);
    to["how"] = resumed.how;
  }
  void operator()(const SessionNote& note) const { to["text"] = note.text; }
  void operator()(const SessionEnd& end) const { to["why"] = end.why; }
  void operator()(const SessionOther& other) const {
    if (is_known(other.event) || other.event.empty()) throw Malformed("an event of one's own needs a name of its own");
    const Json fields = Json::parse(other.fields, nullptr, false);
    if (!fields.is_object()) throw Malformed("the fields of an event are no JSON object");
    for (const auto& [key, value] : fields.items()) {
      if (key == number_key || key == time_key || key == seconds_key || key == event_key)
        throw Malformed("each line has a field `" + key + "` already");
      to[key] = value;
    }
  }
};

// ---- reading

const Json& field(const Json& from, const char* key) {
  const auto found = from.find(key);
  if (found == from.end()) throw Malformed(std::string("there is no field `") + key + "`");
  return *found;
}

std::string text(const Json& value, const char* key) {
  if (!value.is_string()) throw Malformed(std::string("`") + key + "` is no text");
  return value.get<std::string>();
}

std::string text_of(const Json& from, const char* key) { return text(field(from, key), key); }

std::string text_if_any(const Json& from, const char* key) {
  const auto found = from.find(key);
  return found == from.end() ? std::string() : text(*found, key);
}

template <class Whole>
Whole whole(const Json& value, const char* key) {
  if (!value.is_number_unsigned() || !std::in_range<Whole>(value.get<std::uint64_t>()))
    throw Malformed(std::string("`") + key + "` is no whole number in its range");
  return static_cast<Whole>(value.get<std::uint64_t>());
}

double number(const Json& value, const char* key) {
  if (!value.is_number()) throw Malformed(std::string("`") + key + "` is no number");
  return finite(value.get<double>());
}

const Json& list_of(const Json& from, const char* key) {
  const Json& list = field(from, key);
  if (!list.is_array()) throw Malformed(std::string("`") + key + "` is no list");
  return list;
}

glm::dvec2 in_metres(const Json& value, const char* key) {
  if (!value.is_array() || value.size() != 2) throw Malformed(std::string("`") + key + "` has not two numbers");
  return glm::dvec2(number(value[0], key), number(value[1], key)) / metre_in_mm;
}

const Json& object(const Json& value, const char* key) {
  if (!value.is_object()) throw Malformed(std::string("`") + key + "` has something that is no object");
  return value;
}

void read(const Json& from, SessionBegin& begin) {
  begin.participant = text_of(from, "participant");
  begin.seed = whole<std::uint32_t>(field(from, "seed"), "seed");
  begin.device = text_of(from, "device");
  begin.file = text_of(from, "file");
  for (const auto& [name, version] : object(field(from, "versions"), "versions").items())
    begin.versions[name] = text(version, "versions");
  begin.experiment = text_if_any(from, "experiment");
  begin.grade = text_if_any(from, "grade");
}

void read(const Json& from, SessionProgram& program) {
  program.patch = text_of(from, "patch");
  program.material = text_of(from, "material");
  const std::string hash = text_of(from, "hash");
  const auto [end, error] = std::from_chars(hash.data(), hash.data() + hash.size(), program.hash, 16);
  if (error != std::errc() || end != hash.data() + hash.size() || hash != hexadecimal(program.hash))
    throw Malformed("`hash` has not 16 hexadecimal digits");
}

void read(const Json& from, SessionOrder& order) {
  order.what = text_of(from, "what");
  order.of = text_of(from, "of");
  order.seed = whole<std::uint32_t>(field(from, "seed"), "seed");
  for (const Json& each : list_of(from, "items")) {
    object(each, "items");
    SessionItem item{text_of(each, "name"), text_if_any(each, "label"), {}};
    if (const auto at = each.find("at_mm"); at != each.end()) item.at = in_metres(*at, "at_mm");
    order.items.push_back(std::move(item));
  }
}

void read(const Json& from, SessionPlaced& placed) {
  placed.what = text_of(from, "what");
  placed.of = text_of(from, "of");
  for (const Json& each : list_of(from, "items")) {
    object(each, "items");
    SessionPlace item{.name = text_of(each, "name"), .at = in_metres(field(each, "at_mm"), "at_mm")};
    if (const auto size = each.find("size_mm"); size != each.end()) item.size = in_metres(*size, "size_mm");
    item.shape = text_if_any(each, "shape");
    if (const auto rim = each.find("rim_mm"); rim != each.end()) item.rim = number(*rim, "rim_mm") / metre_in_mm;
    if (const auto layer = each.find("layer"); layer != each.end()) item.layer = whole<std::uint32_t>(*layer, "layer");
    placed.items.push_back(std::move(item));
  }
  if (from.contains("gone"))
    for (const Json& each : list_of(from, "gone")) placed.gone.push_back(text(each, "gone"));
}

void read(const Json& from, SessionShown& shown) {
  shown.what = text_of(from, "what");
  shown.name = text_of(from, "name");
  shown.label = text_if_any(from, "label");
  if (const auto place = from.find("number"); place != from.end())
    shown.number = whole<std::uint32_t>(*place, "number");
  if (const auto interval = from.find("interval"); interval != from.end())
    shown.interval = whole<std::uint32_t>(*interval, "interval");
  shown.recording = text_if_any(from, "recording");
}

void read(const Json& from, SessionAnswer& answer) {
  answer = {text_of(from, "question"), text_of(from, "about"), text_of(from, "answer")};
}

void read(const Json& from, SessionTakenBack& taken) {
  for (const Json& each : list_of(from, "answers")) taken.answers.push_back(whole<std::uint64_t>(each, "answers"));
}

void read(const Json& from, SessionGroups& groups) {
  groups.name = text_of(from, "name");
  groups.workspace = text_of(from, "of");
  for (const Json& each : list_of(from, "groups")) {
    SessionGroups::Group group{{}, text_if_any(object(each, "groups"), "says")};
    for (const Json& patch : list_of(each, "patches")) group.patches.push_back(text(patch, "patches"));
    groups.groups.push_back(std::move(group));
  }
}

void read(const Json& from, SessionResumed& resumed) {
  resumed.gap = number(field(from, "gap"), "gap");
  resumed.how = text_of(from, "how");
}
void read(const Json& from, SessionNote& note) { note.text = text_of(from, "text"); }
void read(const Json& from, SessionEnd& end) { end.why = text_of(from, "why"); }

void read(const Json& from, SessionOther& other) {
  other.event = text_of(from, event_key);
  Json fields = Json::object();
  for (const auto& [key, value] : from.items())
    if (key != number_key && key != time_key && key != seconds_key && key != event_key) fields[key] = value;
  other.fields = fields.dump();
}

template <std::size_t at = 0>
SessionEvent event_named(const std::string& name, const Json& from) {
  std::variant_alternative_t<at, SessionEvent> event;
  if constexpr (at < names.size())
    if (name != names[at]) return event_named<at + 1>(name, from);
  read(from, event);
  return event;
}

}  // namespace

Result<std::string> session_line(const SessionEntry& entry) try {
  const std::size_t kind = entry.event.index();
  const auto* other = std::get_if<SessionOther>(&entry.event);
  Json line = {{number_key, entry.number}, {time_key, entry.time}, {seconds_key, finite(entry.seconds)}};
  line[event_key] = other ? other->event : names[kind];
  std::visit(Write{line}, entry.event);
  std::string text = line.dump();
  if (text.size() > longest_session_line) throw Malformed("the line is longer than 1 MiB");
  return text;
} catch (const Malformed& why) {
  return Error{.code = Code::malformed_value, .sentence = std::string("this cannot be logged: ") + why.what()};
} catch (const nlohmann::json::exception&) {  // text that is no UTF-8
  return Error{.code = Code::malformed_value, .sentence = "this cannot be logged: a text is not UTF-8"};
}

Result<SessionEntry> read_session_line(std::string_view line) try {
  if (line.size() > longest_session_line) throw Malformed("the line is longer than 1 MiB");
  const Json from = Json::parse(line, nullptr, false);
  if (!from.is_object()) throw Malformed("this is no JSON object");
  const std::string name = text_of(from, event_key);
  if (name.empty()) throw Malformed("`event` is empty");
  if (name == names.front())
    if (const auto format = from.find("format");
        format != from.end() && format->is_number_unsigned() && *format != session_log_version)
      return Error{.code = Code::newer_file,
                   .sentence = "this log has format " + format->dump() + ", and this Wale reads format " +
                               std::to_string(session_log_version),
                   .mend = "read it with a newer Wale"};
  if (name == names.front()) (void)whole<int>(field(from, "format"), "format");
  return SessionEntry{.number = whole<std::uint64_t>(field(from, number_key), number_key),
                      .time = text_of(from, time_key),
                      .seconds = number(field(from, seconds_key), seconds_key),
                      .event = event_named(name, from)};
} catch (const Malformed& why) {
  return Error{.code = Code::damaged_file, .sentence = why.what()};
} catch (const nlohmann::json::exception& why) {
  return Error{.code = Code::damaged_file, .sentence = why.what()};
}

}  // namespace wale
