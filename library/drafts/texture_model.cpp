// Models of textures of the Penn Haptic Texture Toolkit (Culbertson, Lopez Delgado and Kuchenbecker 2014), as its own
// loader reads them. The models synthesise the acceleration of a tool from noise by a filter for each speed and force.
#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <complex>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>

#include "library/drafts/draft.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

constexpr double rate = 10'000;         // Hz at which the models run: the toolkit says so, and its files do not
constexpr double usual_mass = 0.02;     // kg
constexpr int bins = 4096;              // of the spectrum, from 0 to half the rate
constexpr double lowest = 10, highest = 1000;  // Hz that a hand feels as texture
constexpr std::size_t most_waves = 3, most_poles = 200, most_models = 10'000;

/// One filter: for a speed and a force.
struct SpectralModel {
  std::vector<double> lines;  ///< line spectral frequencies of its poles, rad, rising
  std::optional<double> variance, speed, force;  ///< (m/s^2)^2, mm/s, N
  bool has_zeros = false;
};

struct TextureModel {
  std::optional<double> friction;
  std::vector<SpectralModel> models;
};

/// What expat tells, element by element.
struct ModelReader {
  XML_Parser parser = nullptr;
  std::vector<std::string> path;  ///< of open elements
  std::string text;
  TextureModel read;
  std::string trouble;
  std::size_t line = 0;

  void stop(std::string why) {
    if (!trouble.empty()) return;
    trouble = std::move(why), line = XML_GetCurrentLineNumber(parser);
    XML_StopParser(parser, XML_FALSE);
  }
  std::optional<double> number() {
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    const std::size_t end = text.find_last_not_of(" \t\r\n");
    double value = 0;
    if (begin == text.npos) return stop("expected a number"), std::nullopt;
    const char* last = text.data() + end + 1;
    const auto [at, wrong] = std::from_chars(text.data() + begin, last, value);
    if (wrong != std::errc() || at != last || !std::isfinite(value))
      return stop(fmt::format("expected a number, found \"{}\"", visible_text(text.substr(begin, std::min<std::size_t>(40, end + 1 - begin))))),
             std::nullopt;
    return value;
  }
  bool within(std::string_view name) const { return std::ranges::find(path, name) != path.end(); }

  void begin(const char* name) {
    if (path.size() > 32) return stop("elements lie too deep in one another");
    path.emplace_back(name), text.clear();
    if (path.back() != "model") return;
    if (read.models.size() >= most_models) return stop("there are too many models");
    read.models.emplace_back();
  }
  void end() {
    const std::string name = path.back();
    path.pop_back();
    SpectralModel* model = within("model") && !read.models.empty() ? &read.models.back() : nullptr;
    const bool of_list = name == "value";
    const std::string& what = of_list && !path.empty() ? path.back() : name;
    if (what == "mu" && !model) {
      if (const auto value = number()) read.friction = *value;
    } else if (model && (what == "ARlsf" || what == "MAlsf") && (of_list || text.find_first_not_of(" \t\r\n") != text.npos)) {
      const auto value = number();
      if (!value) return;
      if (what == "MAlsf") return void(model->has_zeros = true);
      if (model->lines.size() >= most_poles) return stop("a filter has too many poles");
      model->lines.push_back(*value);
    } else if (model && (what == "var" || what == "speedMod" || what == "forceMod")) {
      (what == "var" ? model->variance : what == "speedMod" ? model->speed : model->force) = number();
    }
    text.clear();
  }
};

/// The coefficients of a filter from its line spectral frequencies, the first of which is 1.
std::vector<double> coefficients_of(const std::vector<double>& lines) {
  const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> c(a.size() + b.size() - 1, 0);
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
    return c;
  };
  std::vector<double> sum = {1}, difference = {1};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    auto& into = i % 2 == 0 ? sum : difference;
    into = product(into, {1, -2 * std::cos(lines[i]), 1});
  }
  if (lines.size() % 2 == 1) {
    difference = product(difference, {1, 0, -1});
  } else {
    sum = product(sum, {1, 1}), difference = product(difference, {1, -1});
  }
  std::vector<double> all;
  for (std::size_t i = 0; i + 1 < sum.size(); ++i)
    all.push_back((sum[i] + (i < difference.size() ? difference[i] : 0)) / 2);
  return all;
}

struct Wave {
  double frequency = 0, acceleration = 0;  ///< Hz; its amplitude, m/s^2
};

/// The strongest waves of the acceleration, each with the power between the valleys beside it.
std::vector<Wave> waves_of(const SpectralModel& model) {
  const std::vector<double> poles = coefficients_of(model.lines);
  std::vector<double> power(bins);
  for (int i = 0; i < bins; ++i) {
    const double angle = std::numbers::pi * (i + 0.5) / bins;
    std::complex<double> sum = 0;
    for (std::size_t k = 0; k < poles.size(); ++k) sum += poles[k] * std::polar(1.0, -angle * static_cast<double>(k));
    power[static_cast<std::size_t>(i)] = *model.variance / std::norm(sum) / bins;  // of both signs of the frequency
  }
  const auto frequency = [](std::size_t bin) { return (static_cast<double>(bin) + 0.5) / bins * rate / 2; };
  std::vector<Wave> waves;
  for (std::size_t i = 1; i + 1 < power.size(); ++i) {
    if (!(power[i] > power[i - 1] && power[i] >= power[i + 1])) continue;
    if (frequency(i) < lowest || frequency(i) > highest) continue;
    std::size_t left = i, right = i;
    while (left > 0 && power[left - 1] < power[left]) --left;
    while (right + 1 < power.size() && power[right + 1] < power[right]) ++right;
    double all = 0;
    for (std::size_t k = left; k <= right; ++k) all += power[k];
    waves.push_back({frequency(i), std::sqrt(2 * all)});
  }
  std::ranges::stable_sort(waves, std::greater<>(), &Wave::acceleration);
  if (waves.size() > most_waves) waves.resize(most_waves);
  return waves;
}

Error malformed(const std::string& path, std::size_t line, std::string sentence) {
  return error_in_row(path, line, std::move(sentence), "name a file Models_….xml of the toolkit as it was downloaded");
}

Result<TextureModel> read_model(const std::string& path, const std::string& text) {
  ModelReader reader;
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr), XML_ParserFree);
  if (!parser)
    return Error{.code = Code::short_of_resources, .sentence = "the system has no memory", .place = {.name = path}};
  reader.parser = parser.get();
  XML_SetUserData(parser.get(), &reader);
  XML_SetElementHandler(
      parser.get(), [](void* to, const char* name, const char**) { static_cast<ModelReader*>(to)->begin(name); },
      [](void* to, const char*) { static_cast<ModelReader*>(to)->end(); });
  XML_SetCharacterDataHandler(parser.get(), [](void* to, const char* part, int size) {
    auto& into = static_cast<ModelReader*>(to)->text;
    if (into.size() < 1000) into.append(part, static_cast<std::size_t>(size));
  });
  // A model declares no entities; those of a hostile file may grow without end.
  XML_SetEntityDeclHandler(parser.get(), [](void* to, const char*, int, const char*, int, const char*, const char*, const char*,
                                            const char*) { static_cast<ModelReader*>(to)->stop("a model declares no entities"); });
  const XML_Status status = XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), XML_TRUE);
  if (!reader.trouble.empty()) return malformed(path, reader.line, reader.trouble);
  if (status != XML_STATUS_OK)
    return malformed(path, XML_GetCurrentLineNumber(parser.get()), XML_ErrorString(XML_GetErrorCode(parser.get())));
  const std::size_t last = XML_GetCurrentLineNumber(parser.get());
  if (!reader.read.friction || *reader.read.friction < 0 || *reader.read.friction > 10)
    return malformed(path, last, "expected a coefficient of friction `mu` of 0 to 10");
  if (reader.read.models.empty()) return malformed(path, last, "there is no `model`");
  for (const SpectralModel& each : reader.read.models) {
    const bool rises = std::ranges::is_sorted(each.lines, std::less_equal<>()) && !each.lines.empty() &&
                       each.lines.front() > 0 && each.lines.back() < std::numbers::pi;
    if (!rises) return malformed(path, last, "the frequencies in `ARlsf` do not rise from 0 to pi");
    if (!each.variance || !(*each.variance >= 0)) return malformed(path, last, "a `model` has no variance `var`");
    if (!each.speed || !each.force || *each.speed < 0 || *each.force < 0)
      return malformed(path, last, "a `model` has no `speedMod` and `forceMod`");
  }
  return std::move(reader.read);
}

/// The model nearest to the middle of speeds and forces, of those that move.
const SpectralModel* middle_of(const std::vector<SpectralModel>& models) {
  double fastest = 0, hardest = 0;
  for (const SpectralModel& each : models)
    fastest = std::max(fastest, *each.speed), hardest = std::max(hardest, *each.force);
  const SpectralModel* best = nullptr;
  double least = 0;
  for (const SpectralModel& each : models) {
    if (*each.speed <= 0) continue;
    const double away = std::hypot(*each.speed / fastest - 0.5, hardest > 0 ? *each.force / hardest - 0.5 : 0);
    if (!best || away < least) best = &each, least = away;
  }
  return best;
}

}  // namespace

Result<Draft> texture_model_draft(const std::string& path, const std::string& text, const std::string& name,
                                  const DraftOptions& options) {
  constexpr std::size_t largest = std::size_t{64} << 20;
  if (text.size() > largest) return malformed(path, 1, "the file has more than 64 MB");
  const auto read = read_model(path, text);
  if (!read) return read.error();
  const SpectralModel* model = middle_of(read->models);
  if (!model) return malformed(path, 1, "no `model` is for a tool that moves");
  const std::string file = std::filesystem::path(path).filename().string();
  const double mass = options.mass.value_or(usual_mass), drag = *read->friction * *model->force;
  Draft draft{.name = name, .text = {}};
  if (!options.mass) draft.assumed.push_back(fmt::format("the mass of the tool, {:.6g} kg (--mass)", mass));
  draft.assumed.push_back("that its speeds are in mm/s, and that it runs at 10 kHz");
  if (model->has_zeros) draft.assumed.push_back("that its poles alone shape the spectrum: its zeros are left out");
  std::string params = fmt::format(
      "    param friction = {0:.6g} N in 0 N .. {1:.6g} N \"{2:.6g} times {3:.6g} N, with which the tool is pressed\"\n", drag,
      std::max(2 * drag, 0.1), *read->friction, *model->force);
  std::string force = "hold(viscous(4 N s/m), friction)";
  const std::vector<Wave> waves = waves_of(*model);
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const double newton = mass * waves[i].acceleration, period = *model->speed / waves[i].frequency;
    if (newton < 1e-4) continue;
    params += fmt::format(
        "    param wave_{0} = {1:.6g} N in 0 N .. {2:.6g} N \"{3:.4g} m/s^2 on {4:.6g} kg\"\n"
        "    height ridge_{0} = grating(x, period: {5:.6g} mm)  // {6:.4g} Hz at {7:.6g} mm/s\n",
        i + 1, newton, 2 * newton, waves[i].acceleration, mass, period, waves[i].frequency, *model->speed);
    force += fmt::format(" + lateral(ridge_{0}, amplitude: wave_{0})", i + 1);
  }
  draft.text = fmt::format(
      "/// The model `{}` of the Penn Haptic Texture Toolkit: friction, and the strongest waves of the acceleration of a tool.\n"
      "material {} {{\n{}  physical {{\n{}    force = {}\n  }}\n}}\n",
      visible_text(file), name,
      draft_names(name, "Penn Haptic Texture Toolkit, " + file + ": for research alone, not to be passed on",
                  options.licence.empty() ? "LicenseRef-HaTT-research-only" : options.licence),
      params, force);
  return draft;
}

}  // namespace wale
