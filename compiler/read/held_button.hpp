#pragma once

#include <optional>

#include "compiler/read/motion.hpp"
#include "compiler/read/slow_change.hpp"
#include "compiler/read/swing.hpp"
#include "wale/program.hpp"

namespace wale {

/// What resists and swings while the button is held from the entry on.
struct HeldButton {
  OpposingForce opposing;
  Mass inertia;   ///< kg
  Swing sway;         ///< slower than 10 Hz
  Swing vibration;
  SlowChange slow;
};

/// A program as if its button were always held, at the same parameters. Nothing if its tick does not read the button,
/// or one instruction more would cost too much.
std::optional<Bank> with_button_held(const Bank& bank);

/// Reads a program while its button is held; nothing if its tick does not read the button. What is felt in `wall` does
/// not count, if there is one.
std::optional<HeldButton> held_button(const Bank& bank, const WallFace* wall = nullptr);

}  // namespace wale
