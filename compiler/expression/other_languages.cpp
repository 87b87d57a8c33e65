#include "compiler/expression/other_languages.hpp"

#include <algorithm>
#include <string>

namespace wale {

namespace {

struct Instead {
  std::string_view theirs, ours;
};

/// In small letters, without a module before them.
constexpr Instead functions[] = {
    {"pow", "powers are written `a^2`"},
    {"power", "powers are written `a^2`"},
    {"sqr", "powers are written `a^2`"},
    {"square", "powers are written `a^2`"},
    {"mod", "the remainder is `modulo(value, divisor)`"},
    {"fmod", "the remainder is `modulo(value, divisor)`"},
    {"lerp", "write `mix(a, b, way)`"},
    {"blend", "write `mix(a, b, way)`"},
    {"interpolate", "write `mix(a, b, way)`"},
    {"fabs", "write `abs(value)`"},
    {"absolute", "write `abs(value)`"},
    {"trunc", "write `floor(value)`"},
    {"int", "write `floor(value)`"},
    {"clip", "write `clamp(value, low, high)`"},
    {"saturate", "write `clamp(value, 0, 1)`"},
    {"constrain", "write `clamp(value, low, high)`"},
    {"limit", "write `hold(value, ceiling)`, or `limit 2 N` behind a force"},
    {"ln", "write `log(value)`"},
    {"arcsin", "write `asin(value)`"},
    {"arccos", "write `acos(value)`"},
    {"arctan", "write `atan(value)`"},
    {"arctan2", "write `atan2(y, x)`"},
    {"hypot", "write `length(vector(a, b))`"},
    {"norm", "write `length(vector)`"},
    {"magnitude", "write `length(vector)`"},
    {"normalize", "write `normalise(vector)`"},
    {"distance", "write `length(a - b)`"},
    {"vec2", "write `vector(a, b)`"},
    {"vec", "write `vector(a, b)`"},
    {"step", "write `if … then … else …`, or `smoothstep(t)` for a smooth one"},
    {"radians", "a number in degrees has its unit: `45 deg`"},
    {"degrees", "a number in degrees has its unit: `45 deg`"},
    {"random", "noise is `noise(t)` along a line, `noise2(u, v)` on a plane"},
    {"rand", "noise is `noise(t)` along a line, `noise2(u, v)` on a plane"},
    {"simplex", "noise is `noise2(u, v)` or `gradient_noise(u, v)` on a plane"},
    {"perlin", "Perlin's noise is `gradient_noise(u, v)`"},
    {"perlin2", "Perlin's noise is `gradient_noise(u, v)`"},
    {"gradient", "write `grad(height)`"},
    {"derivative", "write `grad(height)`"},
    {"texture", "the texture of a height pushes by `lateral(height, amplitude: 1 N)`"},
    {"damper", "a damper is `viscous(2 N s/m)`"},
    {"damping", "a damper is `viscous(2 N s/m)`"},
    {"drag", "drag is `viscous(2 N s/m)`, or `sticky(0.5 N)` at every speed"},
    {"viscosity", "it is `viscous(2 N s/m)`"},
    {"friction", "friction is `sticky(0.5 N)`"},
    {"wall", "a wall is `firm(500 N/m, face: 20 mm)`"},
    {"stiffness", "a spring is `spring(100 N/m)`, a wall `firm(500 N/m, face: 20 mm)`"},
    {"mass", "a mass is `heavy(50 g)`"},
    {"inertia", "a mass is `heavy(50 g)`"},
    {"weight", "a mass is `heavy(50 g)`"},
    {"vibration", "it is `vibrate(0.5 N, rate: 120 Hz)`"},
    {"buzz", "it is `vibrate(0.5 N, rate: 120 Hz)`"},
    {"ridges", "ridges are `grating(x, period: 2 mm)`"},
    {"stripes", "stripes are `grating(x, period: 2 mm)`"},
    {"print", "nothing is printed; `wale sample FILE --at \"5 mm, 0 mm\"` shows a force"},
    {"url", "files are named by a text in quotes"},
    {"calc", "write the expression itself"},
    {"var", "write the name alone"},
    {"vec3", "a hand has two directions: write `vector(a, b)`"},
    {"float", "numbers have no types: write the value alone"},
    {"map", "a value between two others is `mix(a, b, way)`"},
    {"range", "a range follows a parameter: `in 1 mm .. 5 mm`"},
    {"sum", "forces are added with `+`, or each has a statement `force name = …`"},
    {"percent", "write `50 %`"},
    {"deg", "a number in degrees has its unit: `45 deg`"},
    {"rad", "angles without a unit are in radians"},
    {"force", "a force of two parts is `vector(1 N, 0 N)`; one with a name is a statement, `force name = …`"},
    {"height", "a height is a statement: `height name = …`"},
    {"rgb", "write `show colour(0.8, 0.5, 0.2)`"},
};

constexpr Instead values[] = {
    {"m_pi", "write `pi`"},
    {"tau", "write `2 pi`"},
    {"two_pi", "write `2 pi`"},
    {"position", "the hand is at `hand`, which has the parts `x` and `y`"},
    {"pos", "the hand is at `hand`, which has the parts `x` and `y`"},
    {"cursor", "the hand is at `hand`, which has the parts `x` and `y`"},
    {"mouse", "the hand is at `hand`, which has the parts `x` and `y`"},
    {"z", "a surface has `x` and `y`; a `height` is above them"},
    {"vx", "write `velocity.x`"},
    {"vy", "write `velocity.y`"},
    {"speed", "write `length(velocity)`"},
    {"vel", "write `velocity`"},
    {"accel", "write `acceleration`"},
    {"t", "the time is `time`"},
    {"now", "the time is `time`"},
    {"null", "write a number, or leave the statement out"},
    {"none", "write a number, or leave the statement out"},
    {"infinity", "write a number"},
    {"inf", "write a number"},
    {"nan", "write a number"},
    {"pressed", "write `button`"},
    {"red", "write `show colour(red, green, blue)`, each from 0 to 1"},
};

/// Without `Math.`, `np.` and the like, in small letters.
std::string small_letters_of(std::string_view name) {
  std::string word(name.substr(name.rfind('.') == std::string_view::npos ? 0 : name.rfind('.') + 1));
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return word;
}

template <std::size_t count>
std::optional<std::string_view> found_in(const Instead (&words)[count], const std::string& word) {
  const auto* found = std::ranges::find(words, word, &Instead::theirs);
  return found == std::end(words) ? std::nullopt : std::optional(found->ours);
}

}  // namespace

std::optional<std::string_view> instead_of_function(std::string_view name) {
  return found_in(functions, small_letters_of(name));
}

std::optional<std::string_view> instead_of_value(std::string_view name) {
  // Alone these are no words of other languages, but slips of a key.
  if (name == "X") return "write `x`, in a small letter";
  if (name == "Y") return "write `y`, in a small letter";
  const std::size_t dot = name.find('.');
  const std::string_view part = dot == std::string_view::npos ? "" : name.substr(dot + 1);
  if (part == "x" || part == "y" || part == "X" || part == "Y") {
    const std::string whole = small_letters_of(name.substr(0, dot));
    for (const std::string_view hand : {"position", "pos", "cursor", "mouse", "stylus", "finger", "p"})
      if (whole == hand) return "the hand is at `x` and `y`, which are the parts of `hand`: write `x`, `hand.x` …";
    for (const std::string_view motion : {"vel", "speed", "v"})
      if (whole == motion) return "write `velocity.x` or `velocity.y`";
    if (whole == "accel" || whole == "acc" || whole == "a") return "write `acceleration.x` or `acceleration.y`";
  }
  return found_in(values, small_letters_of(name));
}

}  // namespace wale
