#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/truth/chance.hpp"
#include "tests/truth/truth.hpp"
#include "tests/truth/waveform.hpp"

namespace wale::truth {

/// A hand: m, m/s, m/s^2, s.
struct Sample {
  glm::dvec2 position{0}, velocity{0}, acceleration{0};
  double time = 0;
};
using ForceLaw = std::function<glm::dvec2(const Sample&)>;

/// A text of Wale, what is known of it, and its force where that follows from the hand alone.
struct Case {
  std::string name;    ///< "square/17"
  std::string source;  ///< a whole file
  Truth truth;
  ForceLaw force;              ///< empty if the program remembers or is not given by a formula here
  double force_tolerance = 0;  ///< N
  glm::dvec2 half{0};          ///< m: of the patch without its rim
};

/// One wave of a relief: a waveform along a direction.
struct Wave {
  Waveform form;
  double period = 0;       ///< m
  double orientation = 0;  ///< rad
  double phase = 0;        ///< periods
  double amplitude = 1;    ///< N, or the height's weight

  glm::dvec2 direction() const { return {std::cos(orientation), std::sin(orientation)}; }
  double turns(glm::dvec2 position) const { return glm::dot(direction(), position) / period + phase; }
};

std::optional<std::size_t> band_of(double period);

/// Puts programs together from parts whose feel is known.
class Composition {
 public:
  /// On the device's patch, or on one of this size in m.
  Composition() = default;
  explicit Composition(glm::dvec2 patch);

  Truth truth;

  /// Half of the patch without its rim, m.
  glm::dvec2 half() const { return half_; }
  /// m: the longest period of a wave that is no sine.
  double longest_period() const { return 2 * std::min(half_.x, half_.y) / 3; }

  /// A statement that pushes nothing.
  void statement(const std::string& text) { statements_ += "    " + text + "\n"; }
  /// A layer that is no relief, and its law; without a law the program's force is not checked.
  void push(const std::string& expression, ForceLaw law = {});
  /// A wave as a force along its direction, or along another (rad).
  void push_wave(const Wave& wave, std::optional<double> along = {});
  /// Waves as one height under `lateral`, of this amplitude in N.
  void push_height(const std::vector<Wave>& waves, double amplitude);
  /// A height in one direction by other means, `slope` its derivative by turns.
  void push_height(const std::string& height, const Wave& wave, const std::function<double(double)>& slope,
                   double amplitude);

  /// The program's force may differ from the closed form by this, in N: so much is lost in 32-bit floats.
  void allow(double force) { tolerance_ = std::max(tolerance_, force); }

  /// The amplitude, periods and shares of the relief follow from its laws.
  Case finished() const;
  /// The 99th percentile of the size of a force over the patch without its rim, N.
  double percentile_99(const ForceLaw& law) const;

 private:
  struct Relief {
    ForceLaw law;
    WaveTruth wave;
    WaveTruth sum;  ///< the wave of which it is a part, or itself
  };

  std::string turns_of(const Wave& wave);
  double mean_square(const ForceLaw& law) const;
  void judge_relief(Truth& truth) const;
  void judge_carriers(Truth& truth, const std::vector<double>& squares, double amplitude) const;

  std::string statements_;
  glm::dvec2 half_{0.075, 0.075};
  std::vector<Relief> relief_;     ///< each wave alone
  std::vector<ForceLaw> reliefs_;  ///< together all of the relief
  std::vector<ForceLaw> others_;
  bool checked_ = true;
  double tolerance_ = 1e-5;
  int names_ = 0;
};

/// A number with few digits, so that the text and the closed form have the same one.
double rounded(double value, int digits = 4);
/// "2.5 mm", of m.
std::string millimetres(double metres);
/// A number as Wale reads it.
std::string number(double value);
/// An angle that is often one of the axes, rad.
double any_orientation(Chance& chance);
/// "vector(0.8, 0.6)", of an angle.
std::string unit_vector(double angle);
/// The device's patch, or sometimes one of another size.
Composition any_patch(Chance& chance);

}  // namespace wale::truth
