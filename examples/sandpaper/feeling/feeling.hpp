#pragma once

#include <QObject>
#include <QString>
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <thread>
#include <wale/language_service.hpp>
#include <wale/stage.hpp>

#include "document/placed.hpp"
#include "feeling/hand_over.hpp"
#include "feeling/heard_forces.hpp"
#include "feeling/mouse_hand.hpp"
#include "feeling/programs.hpp"
#include "feeling/recentred.hpp"

namespace sandpaper {

/// The size and the rim with which a patch is felt.
wale::PatchSize felt_size(const wale::LaidOutPatch& patch, const wale::Program& program);

/// What is felt: the patches of the workspace on a stage, on a device. In the window's thread, except that the loop
/// serves its ticks on one of its own. Force is off until it is asked for, and off again after each change of device.
class Feeling : public QObject {
  Q_OBJECT

 public:
  Feeling(const wale::Library& library, Programs& programs, QObject* parent = nullptr);
  ~Feeling() override;

  /// Opens a device in the background, as `--device` spells it, or "mouse" for the mouse over the canvas.
  void open(const QString& spelling);
  const QString& spelling() const { return spelling_; }
  const wale::DeviceProfile& profile() const { return profile_; }
  bool is_mouse() const { return mouse_ != nullptr; }
  /// The devices that can be chosen now, with what a person calls them.
  std::vector<std::pair<QString, QString>> choices() const;

  /// N at the handle, the most that is ever pushed; never more than the device gives.
  void set_max_force(double newton);
  double max_force() const { return max_force_; }

  /// Records the next time that force is on into a file, which must not exist yet; `recorded` follows when force is
  /// off.
  void record(const QString& file);
  bool is_recording() const { return !record_.isEmpty(); }

  /// Begins to push, or takes all force away at once.
  void set_on(bool on);
  bool is_on() const { return on_; }

  /// Puts on the stage what the workspace holds. Patches whose programs are not known yet follow when they are.
  void follow(const Contents& contents);
  /// Moves a slider at once, before the document knows.
  void set(std::uint64_t id, const std::string& parameter, float value);
  void move_mouse(glm::vec2 to, bool pressed);

  /// Makes the place where the handle is now the workspace's centre, or gives back the device's own one. Takes all
  /// force away first, since each patch comes to lie elsewhere under the hand. Says why where it cannot: the mouse is
  /// where it is seen. Returns whether it could.
  bool recentre();
  bool centre_back();
  /// m, where the centre is from the device's own one.
  glm::dvec2 centre() const;

  wale::Now now() const;
  /// The forces of the ticks, for an ear.
  HeardForces& heard() { return heard_; }
  /// The patch that the hand is on.
  std::optional<std::uint64_t> touched(const wale::Now& now) const;
  /// The program of a patch as it is felt; nothing before it is known.
  const wale::Program* program(std::uint64_t id) const;
  /// Why a patch has no program, or its warnings; null before that is known.
  MaterialProgramRef material(std::uint64_t id) const;
  /// The present state of a patch, for pictures.
  std::optional<wale::Snapshot> snapshot(std::uint64_t id) const;
  /// The value of a parameter: what a slider gave it, or its default.
  float value(const Placed& placed, const wale::Parameter& parameter) const;

 signals:
  void on_changed();
  void device_changed();
  void programs_changed();
  /// A run begins: no program remembers anything.
  void forgot();
  /// A recording is in its file; `problem` says why it may not be.
  void recorded(const QString& file, const QString& problem);
  /// Something that a person should know, in a sentence.
  void said(const QString& words);

 private:
  struct Felt {
    PlacedRef placed;
    std::size_t layer = 0;
    MaterialProgramRef material;
    std::optional<wale::Program> program;  // the last that was good
    std::optional<wale::Patch> patch;
  };
  void take(QString spelling, wale::Result<std::unique_ptr<wale::Device>> device, std::uint64_t attempt);
  void renew_stage();
  void end_recording(const QString& problem);
  void place(Felt& felt);
  void update(Felt& felt, const PlacedRef& placed, std::size_t layer);
  void follow_programs();
  wale::PatchOptions options(const Felt& felt) const;

  const wale::Library& library_;
  Programs& programs_;
  QString spelling_;
  wale::DeviceProfile profile_;
  std::unique_ptr<Recentred> device_;
  HeardForces heard_;
  std::unique_ptr<HeardDevice> heard_device_;  // the same device, on the stage
  MouseHand* mouse_ = nullptr;
  double max_force_ = 0;
  bool on_ = false;
  QString record_;  // where the run is recorded to; mostly empty
  std::unique_ptr<wale::Stage> stage_;  // after the device, which must outlive it
  Contents contents_;
  std::map<std::uint64_t, Felt> felt_;
  std::map<std::uint64_t, std::uint64_t> by_patch_;  // ids of the document by those of the stage
  std::uint64_t attempt_ = 0;
  HandOver window_;
  std::thread opening_;
};

}  // namespace sandpaper
