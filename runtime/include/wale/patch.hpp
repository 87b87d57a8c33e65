#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "wale/memory.hpp"
#include "wale/program.hpp"
#include "wale/shape.hpp"

namespace wale {

struct StageState;

/// What `Patch::id` gives for a number on the stage and a generation of it.
constexpr std::uint64_t patch_id(std::uint32_t number, std::uint32_t generation) noexcept {
  return (std::uint64_t{generation} + 1) << 32 | number;
}

/// Where a patch goes, and how large it is.
struct PatchOptions {
  glm::vec2 at{0.0f};                  ///< m from the workspace's centre, of the patch's centre; finite
  std::optional<PatchSize> size = {};  ///< m; if none is given, that of the shape with the program's rim, or for a
                                       ///< rectangle the program's own. Width and height are positive, the rim is not
                                       ///< negative, all are finite; without an upper bound (`Patch::resize`)
  float layer = 0;                     ///< where patches overlap, the hand feels the one with the greatest; finite
  Shape shape = {};                    ///< the part of its rectangle that it covers, stretched to its size
};

/// A layer for a patch.
struct BringOptions {
  float layer = 0;  ///< finite
};

/// How a patch lies and what it is, at one moment: a value of its own, which nothing changes afterwards.
struct Placement {
  Program program;
  std::vector<float> values;  ///< of its parameters, SI, in the order of `program.description().parameters`
  glm::vec2 at{0.0f};         ///< m from the workspace's centre, of the patch's centre
  PatchSize size;             ///< m
  float layer = 0;
  bool enabled = true;
  Shape shape;  ///< as `add` was given it; the patch has it stretched: `shape.stretched({size.width, size.height})`

  /// The value of a parameter, SI. Error: `unknown_name`.
  Result<float> value(std::string_view parameter) const;
};

/// A patch's bank and a copy of its memory at one tick, for `show` and `surface_all` of wale/picture.hpp. Grids of more
/// than 32768 cells in all are copied over several ticks.
///
/// `show` takes a hand whose `position` counts from the patch's centre and whose `workspace` counts from the
/// workspace's, as `Now::position` does: `hand_on(now, snapshot.placement)` of wale/run.hpp is that hand.
struct Snapshot {
  Bank bank;
  Memory memory;
  Placement placement;  ///< of the patch with this bank
};

/// A patch on a stage. A light handle: copies name the same patch, and it may outlive the patch and the stage.
///
/// All calls are safe from any thread, also during a run; none is for a real-time thread (they lock and allocate). They
/// return before the change is felt. A place, a layer, enabling and removing are felt from the first tick after at most
/// two periods on, unless the patch waits for an edit; a parameter, a size and a program as soon as their bank is
/// prepared, the patch under the hand first; then the force slews. Until then the patch keeps its old bank. A change
/// whose bank is not begun is replaced by a newer one. Without a run, changes count from the next run on. In virtual
/// time all are felt at the next tick.
///
/// Errors of all calls: `wrong_moment` if the patch was removed, its stage is gone, or the handle never named a patch;
/// `malformed_value` for an argument that is not finite or not in its range. After an error nothing has changed.
class Patch {
 public:
  /// Names no patch.
  Patch() = default;

  /// Sets a parameter, in SI units, in the range that the program declares. A value outside it is refused, since who
  /// asks for it would feel something else: clamp it where that is meant, as a slider does. (A `Bank`
  /// and a batch clamp, since among thousands of values by chance one beyond the range must not end an experiment.)
  /// Errors also: `unknown_name`.
  Result<> set(std::string_view parameter, double value);
  /// Moves the patch's centre, m from the workspace's centre. A hand that is still on it does not enter anew; the
  /// energy that moving gives to the hand counts as the program's own.
  Result<> move(glm::vec2 to);
  /// Full width and height, and rim, in m. A shape is stretched with it. No length is too great, here and in `add`: one
  /// beyond the workspace's diameter (of a pad without a position 10 m) counts as that diameter, and a rim of half the
  /// smaller side or more as a quarter of it. `Placement::size` is what was asked for, `Bank::size` what counts.
  Result<> resize(PatchSize size);
  /// Another program. The patch keeps its place and layer; where it had its program's own size, it gets the new
  /// program's. A parameter that is not at its default keeps its value if the new program has one of the same name and
  /// unit (clamped to the new range). A state keeps its value if the new program has one of the same name and unit and
  /// the hand stays on the patch. Grids keep their cells if all have the same names, units, sizes and bounds; after 64
  /// replacements without a touch they begin anew. Errors also: `other_device`, `other_figures`.
  Result<> replace(const Program& program);
  /// A patch that is not enabled is not felt, and keeps its memory.
  Result<> enable(bool enabled = true);
  /// Puts it in front of all patches of a layer.
  Result<> bring(const BringOptions& to);
  /// Removes the patch. All handles to it then name nothing.
  Result<> remove();

  /// Whether it names a patch that is on its stage.
  bool exists() const;

  /// The patch as it is wanted: as all calls and commits that have returned have made it, whether the hand feels that
  /// yet or not. Values are the nearest floats to those that were set. Only waits for another call of the stage.
  Result<Placement> placement() const;
  /// The patch as it was published last: what the loop of the present run has, or that of the last one had. While a
  /// bank is prepared it is older than `placement`. One that is not enabled is published too. Errors also:
  /// `wrong_moment` if no run has had it yet.
  Result<Placement> published() const;
  /// The wanted value of a parameter, as in `placement`. Errors also: `unknown_name`.
  Result<float> value(std::string_view parameter) const;
  /// The wanted values of all parameters, as in `placement`.
  Result<std::vector<float>> values() const;

  /// A bank with the patch's present parameters, as they are wanted, for `predict` and `levels_back`. Runs setup and
  /// peaks if no patch has the same.
  Result<Bank> bank() const;
  /// A copy of the present memory. Never makes a tick wait: the thread that serves the ticks copies when it is asked,
  /// so this call takes a period or two during a run. Of a patch that no run has had it is a new memory. Errors also:
  /// `wrong_moment` if the run serves no tick for 0.2 s.
  Result<Snapshot> snapshot() const;

  friend bool operator==(const Patch& one, const Patch& other) {
    return one.number_ == other.number_ && one.generation_ == other.generation_ &&
           !one.stage_.owner_before(other.stage_) && !other.stage_.owner_before(one.stage_);
  }
  /// Its number on the stage, as in recordings. A later patch may get the number of a removed one.
  std::uint32_t number() const { return number_; }
  /// Never 0, and never that of another patch of the same stage.
  std::uint64_t id() const { return patch_id(number_, generation_); }

 private:
  friend class StageEdit;
  friend class Stage;
  friend struct StageState;
  Patch(std::weak_ptr<StageState> stage, std::uint32_t number, std::uint32_t generation)
      : stage_(std::move(stage)), number_(number), generation_(generation) {}

  std::weak_ptr<StageState> stage_;
  std::uint32_t number_ = 0, generation_ = 0;
};

}  // namespace wale
