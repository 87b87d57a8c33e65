#include "tests/truth/composition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace wale::truth {
namespace {

using std::numbers::pi;

constexpr double rim = 0.005;                     // m: of a patch on `sandpaper`
constexpr double bands[] = {0.7e-3, 10e-3, 0.1};  // m: roughness lies between the first two, bumpiness beyond
constexpr double near_edge = 0.05;                // of a band: whether a wave counts is not judged
constexpr double least_share = 0.1;               // of the mean square: a weaker wave may be read or not
constexpr double dominant = 1.5;                  // times the mean square of the next wave: which is stronger is plain
constexpr std::size_t places = 20000;

/// Places spread evenly over a rectangle, in no lattice that a wave could fall into step with: the additive recurrence
/// by the plastic number (Roberts 2018).
glm::dvec2 place(std::size_t i, glm::dvec2 half) {
  const auto n = static_cast<double>(i);
  const glm::dvec2 unit{std::fmod(0.5 + n * 0.7548776662466927, 1), std::fmod(0.5 + n * 0.5698402909980532, 1)};
  return (2.0 * unit - 1.0) * half;
}

/// What a class says of its programs comes before what follows from their laws.
void settle(Expected& expected, Expected found) {
  if (expected.kind == Expected::Kind::none) expected = found;
}

}  // namespace

std::optional<std::size_t> band_of(double period) {
  for (const double edge : bands)
    if (std::abs(period - edge) < near_edge * edge) return std::nullopt;
  return static_cast<std::size_t>(std::ranges::count_if(bands, [&](double edge) { return period > edge; }));
}

double rounded(double value, int digits) {
  if (value == 0) return 0;
  const double factor = std::pow(10, digits - 1 - std::floor(std::log10(std::abs(value))));
  return std::round(value * factor) / factor;
}

std::string number(double value) {
  if (std::abs(value) < 1e-12) return "0";
  return fmt::format("{:.9g}", value).find('e') == std::string::npos ? fmt::format("{:.9g}", value)
                                                                     : fmt::format("{:.12f}", value);
}

std::string millimetres(double metres) { return number(1e3 * metres) + " mm"; }

double any_orientation(Chance& chance) {
  if (chance.happens(0.4)) return chance.one_of({0.0, pi / 2});
  return rounded(chance.between(0, pi), 3);
}

/// The waves of which a waveform is the sum, or itself.
std::vector<Waveform::Part> parts_of(const Waveform& form) {
  return form.parts.empty() ? std::vector<Waveform::Part>{{1, form.force, form.slope}} : form.parts;
}

std::string unit_vector(double angle) {
  return fmt::format("vector({}, {})", number(std::cos(angle)), number(std::sin(angle)));
}

Composition any_patch(Chance& chance) {
  if (chance.happens(0.75)) return Composition();
  const double side = rounded(chance.between(0.08, 0.2), 2);
  return Composition({side, chance.happens(0.5) ? side : rounded(chance.between(0.08, 0.2), 2)});
}

Composition::Composition(glm::dvec2 patch) : half_(patch / 2.0 - rim) {
  statement(fmt::format("patch {}, {}", millimetres(patch.x), millimetres(patch.y)));
}

std::string Composition::turns_of(const Wave& wave) {
  const std::string name = fmt::format("t{}", ++names_);
  statement(fmt::format("let {} = ({} * x + {} * y) / {} + {}", name, number(std::cos(wave.orientation)),
                        number(std::sin(wave.orientation)), millimetres(wave.period), number(wave.phase)));
  return name;
}

void Composition::push(const std::string& expression, ForceLaw law) {
  statement(fmt::format("force layer{} = {}", ++names_, expression));
  if (law)
    others_.push_back(std::move(law));
  else
    checked_ = false;
}

void Composition::push_wave(const Wave& wave, std::optional<double> along) {
  const double angle = along.value_or(wave.orientation);
  const std::string t = turns_of(wave);
  statement(fmt::format("force layer{} = {} N * {} * {}", ++names_, number(wave.amplitude), wave.form.force_text(t),
                        unit_vector(angle)));
  const glm::dvec2 direction{std::cos(angle), std::sin(angle)};
  const ForceLaw law = [wave, direction](const Sample& hand) {
    return wave.amplitude * wave.form.force(wave.turns(hand.position)) * direction;
  };
  for (const Waveform::Part& part : parts_of(wave.form))
    relief_.push_back({[wave, direction, part](const Sample& hand) {
                         return wave.amplitude * part.force(wave.turns(hand.position)) * direction;
                       },
                       {wave.period / part.number, wave.orientation},
                       {wave.period, wave.orientation}});
  reliefs_.push_back(law);
  allow(wave.amplitude * 20 * half_.x / wave.period * 0x1p-24);  // 20: the third harmonic, in rad for each turn
}

void Composition::push_height(const std::vector<Wave>& waves, double amplitude) {
  std::string height;
  for (const Wave& wave : waves)
    height += (height.empty() ? "" : " + ") + number(wave.amplitude) + " * " + wave.form.height_text(turns_of(wave));
  const auto gradient_by = [](const Wave& wave, const std::function<double(double)>& slope, const Sample& hand) {
    return wave.amplitude * slope(wave.turns(hand.position)) / wave.period * wave.direction();
  };
  const auto gradient = [gradient_by](const Wave& wave, const Sample& hand) {
    return gradient_by(wave, wave.form.slope, hand);
  };
  const ForceLaw whole = [waves, gradient](const Sample& hand) {
    glm::dvec2 sum{0};
    for (const Wave& wave : waves) sum += gradient(wave, hand);
    return sum;
  };
  const double scale = amplitude / percentile_99(whole);
  statement(fmt::format("height h{0} = {1}\n    force layer{0} = lateral(h{0}, amplitude: {2} N)", ++names_, height,
                        number(amplitude)));
  for (const Wave& wave : waves)
    for (const Waveform::Part& part : parts_of(wave.form))
      relief_.push_back({[wave, gradient_by, part, scale](const Sample& hand) {
                           return -scale * gradient_by(wave, part.slope, hand);
                         },
                         {wave.period / part.number, wave.orientation},
                         {wave.period, wave.orientation}});
  reliefs_.push_back([whole, scale, amplitude](const Sample& hand) {
    const glm::dvec2 force = -scale * whole(hand);
    return glm::length(force) > amplitude ? amplitude * glm::normalize(force) : force;
  });
  // The machine finds the percentile from fewer places.
  allow(0.01 * amplitude);
}

void Composition::push_height(const std::string& height, const Wave& wave, const std::function<double(double)>& slope,
                              double amplitude) {
  Wave described = wave;
  described.form.slope = slope;
  described.form.height_text = [&](const std::string&) { return height; };
  push_height({described}, amplitude);
}

double Composition::percentile_99(const ForceLaw& law) const {
  std::vector<double> sizes;
  for (std::size_t i = 0; i < places; ++i) sizes.push_back(glm::length(law({.position = place(i, half_)})));
  const auto rank = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * places);
  std::ranges::nth_element(sizes, rank);
  return *rank;
}

double Composition::mean_square(const ForceLaw& law) const {
  double sum = 0;
  for (std::size_t i = 0; i < places / 4; ++i) {
    const glm::dvec2 force = law({.position = place(i, half_)});
    sum += glm::dot(force, force);
  }
  return sum / (places / 4.0);
}

void Composition::judge_carriers(Truth& truth, const std::vector<double>& squares, double amplitude) const {
  const double all = std::accumulate(squares.begin(), squares.end(), 0.0);
  double rough = 0, bumpy = 0;
  bool clear = true;
  for (std::size_t i = 0; i < relief_.size(); ++i) {
    // A sum of waves is felt by its parts, whose common multiple may lie in another band.
    const auto band = band_of(relief_[i].wave.period);
    clear = clear && band;
    if (band == 1u) rough += squares[i];
    if (band == 2u) bumpy += squares[i];
  }
  const auto size = [&](double share) {
    if (!clear) return open;
    return share > 0 ? valued(amplitude * std::sqrt(share / all)) : Expected{};
  };
  settle(truth[Cue::roughness], size(rough));
  settle(truth[Cue::bumpiness], size(bumpy));
}

void Composition::judge_relief(Truth& truth) const {
  const double amplitude = percentile_99([&](const Sample& hand) {
    glm::dvec2 sum{0};
    for (const ForceLaw& law : reliefs_) sum += law(hand);
    return sum;
  });
  settle(truth[Cue::amplitude], valued(amplitude));
  std::vector<double> squares;
  for (const Relief& relief : relief_) squares.push_back(mean_square(relief.law));
  const std::size_t strongest = static_cast<std::size_t>(std::ranges::max_element(squares) - squares.begin());
  bool plain = true, parallel = true;
  const auto of_strongest = [&](const Relief& each) {
    return each.sum.period == relief_[strongest].sum.period &&
           each.sum.orientation == relief_[strongest].sum.orientation;
  };
  double of_the_strongest = 0;
  for (std::size_t i = 0; i < relief_.size(); ++i) of_the_strongest += of_strongest(relief_[i]) ? squares[i] : 0;
  for (std::size_t i = 0; i < relief_.size(); ++i) {
    plain = plain && (of_strongest(relief_[i]) || of_the_strongest > dominant * squares[i]);
    parallel = parallel && relief_[i].wave.orientation == relief_[0].wave.orientation;
    if (truth.waves) truth.waves->push_back(relief_[i].wave);
  }
  if (std::ranges::min(squares) < least_share * std::accumulate(squares.begin(), squares.end(), 0.0))
    truth.waves.reset();
  judge_carriers(truth, squares, amplitude);
  settle(truth[Cue::period], plain ? valued(relief_[strongest].sum.period) : open);
  settle(truth[Cue::orientation], parallel ? valued(relief_[0].wave.orientation) : open);
}

Case Composition::finished() const {
  Case made{"", "wale 1\nmaterial m {\n  physical {\n" + statements_ + "  }\n}\n", truth, {}, tolerance_, half_};
  if (!relief_.empty()) judge_relief(made.truth);
  if (checked_)
    made.force = [reliefs = reliefs_, others = others_](const Sample& hand) {
      glm::dvec2 sum{0};
      for (const ForceLaw& law : reliefs) sum += law(hand);
      for (const ForceLaw& law : others) sum += law(hand);
      return sum;
    };
  return made;
}

}  // namespace wale::truth
