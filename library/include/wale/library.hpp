#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wale/declared_device.hpp"
#include "wale/program.hpp"
#include "wale/result.hpp"
#include "wale/simulated.hpp"

namespace wale {

/// A simulated person: a hand, and the motions by which it explores by default.
struct SimulatedPerson {
  HandModel hand;
  Lateral lateral;
  Circular circular;
  std::string source;  ///< the source of the figures
};

struct LibraryOptions {
  /// Whether a stranger's picture may be decoded where the system offers no sandbox for its decoder. Otherwise a
  /// material that needs it is an error there (W0807).
  bool unsandboxed_pictures = false;
};

/// Materials and levels by name, compiled for a device.
///
/// All materials and calibrations are in the binary: no files are needed at run time.
class Library {
 public:
  explicit Library(const LibraryOptions& options = {});
  ~Library();

  /// A surface with a level of a percept: a named level ("coarse") or a number from 0 to 1 ("0.6"). Errors name the
  /// argument: W0201 for an unknown percept or level, W0406 for a level outside 0 .. 1, W0601 for an unknown device;
  /// and the errors of a percept that the device cannot render.
  Result<Program> level(const std::string& percept, const std::string& level,
                        const std::string& device = "sandpaper") const;

  /// A material by name ("corduroy"), or from a Wale file or patch program; `name` chooses one of the file's materials,
  /// by default the first one. Names are found by the rule of the command line (`wale find` lists them). Errors: a file
  /// or name that cannot be found (W0501, W0201, W0217), a program that does not load (W0606), or the first error in
  /// the file, with its line.
  Result<Program> material(const std::string& file_or_name, const std::string& name = {},
                           const std::string& device = "sandpaper") const;

  std::vector<DeclaredDevice> devices() const;
  /// Error: W0201 for an unknown name.
  Result<SimulatedPerson> person(const std::string& name = "normal") const;

  /// The Sandpaper joystick, simulated, in the hand of a simulated person who rubs to and fro.
  std::unique_ptr<SimulatedJoystick> simulated_joystick() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wale
