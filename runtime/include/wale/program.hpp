#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "wale/patch_program.hpp"

namespace wale {

/// The hand as a patch program sees it, in m, m/s and m/s^2. All values are allowed here; a program sees only finite
/// ones: position and workspace within plus and minus the workspace's diameter, velocities within the device's speed
/// limit, accelerations within a change by that speed in one tick, time from 0 on, distances to an edge within the
/// workspace's diameter, their slopes within 1, and 0 for not-a-number.
struct Hand {
  glm::vec2 position{0.0f};          ///< from the patch's centre
  glm::vec2 velocity{0.0f};          ///< filtered
  glm::vec2 acceleration{0.0f};      ///< filtered
  glm::vec2 raw_velocity{0.0f};      ///< plain differences of positions
  glm::vec2 raw_acceleration{0.0f};  ///< plain differences of raw velocities
  glm::vec2 workspace{0.0f};         ///< position from the workspace's centre
  double time = 0;                   ///< s since the stage began to run
  bool button = false;               ///< the button is pressed
  glm::vec2 edge_slope{0.0f};        ///< how `edge` changes along x and y
  float edge = 0;                    ///< distance to the edge of the patch's own shape; 0 if it is a rectangle
};

/// A command: newtons along x and y. For a program that vibrates a pad (`PatchProgram::vibrates`) the same two numbers
/// are the amplitude in m/s^2 and the frequency in Hz.
using Force = glm::vec2;

/// Full width and height of a placed patch and the rim over which it fades, in m.
struct PatchSize {
  float width = 0, height = 0, rim = 0;

  friend bool operator==(const PatchSize&, const PatchSize&) = default;
};

struct DecodedProgram;

/// A verified patch program, ready to run. Immutable; copies share it; any number of threads may use it at once.
class Program {
 public:
  /// Reads, verifies and decodes a `.wpp` file. Its texts become visible (no control characters), since anybody may
  /// write them. What is written of it loads again. Errors: `damaged_file`, `newer_file`, `refused_program`.
  static Result<Program> load(std::span<const std::byte> bytes);
  /// The same of a description. A `refused_program` has the instructions that led to it (`Error::led_to`).
  static Result<Program> load(PatchProgram program);

  const PatchProgram& description() const;
  PatchSize default_size() const;
  /// The parameters' default values in SI units, in the order of `description().parameters`.
  std::vector<float> default_parameters() const;
  /// The index of the parameter of that name, if there is one.
  std::optional<std::size_t> parameter(std::string_view name) const;

  const DecodedProgram& decoded() const { return *decoded_; }

 private:
  explicit Program(std::shared_ptr<const DecodedProgram> decoded) : decoded_(std::move(decoded)) {}
  std::shared_ptr<const DecodedProgram> decoded_;
};

/// All registers of one program at given parameter values: what a tick reads, and its temporaries.
///
/// A control thread makes it and hands it over to the real-time thread; one thread at a time may use it.
class Bank {
 public:
  /// Runs setup and its peaks. `parameters` are in SI units and clamped to their ranges; not-a-number becomes the
  /// default. A side that is not positive becomes the default, one longer than the workspace's diameter becomes that
  /// diameter. Allocates; takes as long as the peaks need.
  Bank(const Program& program, std::span<const float> parameters, PatchSize size);
  /// With the default parameters and size.
  explicit Bank(const Program& program);

  const Program& program() const { return program_; }
  PatchSize size() const { return size_; }
  std::span<float> registers() { return registers_; }
  std::span<const float> registers() const { return registers_; }

 private:
  Program program_;
  PatchSize size_;
  std::vector<float> registers_;
};

/// The program's force on a hand that has just entered, in N (a pad's amplitude in m/s^2 and frequency in Hz). States
/// and grids have their initial values, and nothing is remembered (see `Memory`). The patch's edge is not checked: the
/// caller does so. Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
Force tick(Bank& bank, const Hand& hand) noexcept;

/// The same for many hands, in blocks of lanes and, for enough work, on all cores; bit-identical to `tick`. `forces` is
/// as long as `hands`. wale/batch.hpp has instances with memory.
void tick_all(const Bank& bank, std::span<const Hand> hands, std::span<Force> forces);

/// The height of the surface (the picture section) at many positions, in m or as a plain number, with the states of a
/// hand that has entered at rest at the patch's centre. `surface_all` of wale/picture.hpp also takes a memory and gives
/// colours.
void relief_all(const Bank& bank, std::span<const glm::vec2> positions, std::span<float> heights);

/// How a carrier of a given size feels, by the map that the program carries.
struct Prediction {
  float magnitude = 0;  ///< in the map's free-modulus units
  float level = 0;      ///< 1 is the percept's reference stimulus
};

/// The prediction of percept number `index` of the program for a carrier of size `amplitude`, in its record's unit.
Prediction predict(const Bank& bank, std::size_t index, float amplitude);

/// The size of percept number `index`'s carrier that the program aims at with this bank's parameters, in its record's
/// unit.
float amplitude(const Bank& bank, std::size_t index);

}  // namespace wale
