#pragma once

#include "compiler/drawing/canvas.hpp"

/// The colours and letters of a preview. Neighbouring colours differ in lightness too, so that a grey print is
/// readable.
namespace wale::style {

inline constexpr Colour paper = {0.992f, 0.988f, 0.976f};
inline constexpr Colour ink = {0.13f, 0.125f, 0.12f};
inline constexpr Colour quiet = {0.45f, 0.43f, 0.41f};    // secondary text
inline constexpr Colour rule = {0.83f, 0.81f, 0.775f};    // lines that divide the page
inline constexpr Colour height = {0.49f, 0.335f, 0.17f};  // the surface
inline constexpr Colour force = {0.10f, 0.29f, 0.46f};    // the force at rest
inline constexpr Colour moving = {0.80f, 0.42f, 0.17f};   // the force on a moving hand
inline constexpr Colour field_weak = {0.975f, 0.970f, 0.955f};
inline constexpr Colour field_strong = {0.70f, 0.785f, 0.845f};

inline constexpr Type title = {Face::serif, 50, ink};
inline constexpr Type names = {Face::sans, 20, quiet};
inline constexpr Type heading = {Face::sans, 18, ink};
inline constexpr Type label = {Face::sans, 15.5, quiet};
inline constexpr Type word = {Face::sans, 17, quiet};
inline constexpr Type value = {Face::serif, 33, ink};

}  // namespace wale::style
