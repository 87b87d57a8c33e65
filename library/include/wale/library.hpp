#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "schema/declared_device.hpp"
#include "wale/program.hpp"
#include "wale/simulated.hpp"

namespace wale {

/// What could not be had, in words for the person who asked: diagnostics, rendered.
struct Unavailable {
  std::string reason;
};

/// A simulated person: a hand and how it explores unless told otherwise.
struct SimulatedPerson {
  HandModel hand;
  Lateral lateral;
  Circular circular;
  std::string source;  ///< where the figures come from
};

/// Materials and levels by name, compiled for a device.
///
/// Everything it knows is part of the library itself: no folder of calibrations is needed at run time.
class Library {
 public:
  Library();
  ~Library();

  /// A surface of that much of a percept: a named level ("coarse") or a number from 0 to 1 ("0.6").
  std::variant<Program, Unavailable> level(const std::string& percept, const std::string& level,
                                           const std::string& device = "sandpaper") const;

  /// A material of a Wale file; without a name the file's only or first one.
  std::variant<Program, Unavailable> material(const std::string& file, const std::string& name = {},
                                              const std::string& device = "sandpaper") const;

  std::vector<DeclaredDevice> devices() const;
  std::variant<SimulatedPerson, Unavailable> person(const std::string& name = "normal") const;

  /// The Sandpaper joystick, simulated, in the hand of a simulated person who rubs to and fro.
  std::unique_ptr<SimulatedJoystick> simulated_joystick() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wale
