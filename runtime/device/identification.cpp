#include "runtime/device/identification.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace wale {
namespace {

// A gentle push: no harder than needed, and slow enough that a person who holds the handle can let go.
constexpr double share_of_peak = 0.2;   // of the device's force, at most
constexpr double rise_seconds = 2;      // s, from no force to the largest allowed
constexpr double hold_seconds = 0.5;    // s at the largest force, after which the handle counts as not moving
constexpr double ease_seconds = 0.1;    // s, back to no force
constexpr double rest_seconds = 1.5;    // s, longest wait for the handle to come to rest
constexpr double still_seconds = 0.2;   // s without a move of two counts, after which the handle is at rest
constexpr double share_to_move = 0.02;  // of the workspace's diameter: a move
constexpr double share_to_show = 0.1;   // of the workspace's diameter: a move by hand, more than a slip
constexpr double shown_seconds = 0.3;   // s, for which the person must hold the handle there
constexpr double person_seconds = 15;   // s, a person's time to do what was asked for
constexpr double least_counts = 8;      // more than an encoder's noise
constexpr double plainly = 2;           // least ratio of the moves along one axis and the other

/// The axis along which the handle clearly moved, and its direction.
std::optional<SignedAxis> plain_axis(glm::dvec2 moved) {
  const double x = std::abs(moved.x), y = std::abs(moved.y);
  if (std::max(x, y) < plainly * std::min(x, y)) return std::nullopt;
  const int axis = x > y ? 0 : 1;
  return SignedAxis{axis, moved[axis] < 0 ? -1 : 1};
}

}  // namespace

Identification::Identification(const DeviceProfile& profile, const IdentifyOptions& options)
    : asks_(options.asks),
      most_(std::min(options.most_newton, share_of_peak * profile.force_newton)),
      tick_seconds_(1 / profile.rate),
      position_step_(profile.position_step()),
      enough_(std::max(share_to_move * profile.workspace_diameter, least_counts * profile.position_step())),
      far_(share_to_show * profile.workspace_diameter) {}

void Identification::enter(Phase phase) {
  phase_ = phase;
  ticks_ = still_ticks_ = shown_ticks_ = 0;
}

std::string_view Identification::request() const {
  switch (phase_) {
    case Phase::rest:
    case Phase::push:
    case Phase::hold:
    case Phase::ease: return "Keep your hand off the handle, or lay it on loosely: the device pushes it gently.";
    case Phase::ask_right: return "Now move the handle to the right yourself, and hold it there.";
    case Phase::back: return "Move it back to where it was.";
    case Phase::ask_away: return "Now move the handle away from you, and hold it there.";
    case Phase::done: break;
  }
  return "";
}

bool Identification::is_still(glm::dvec2 position) {
  if (ticks_ == 0 || glm::distance(position, still_at_) > 2 * position_step_) {
    still_at_ = position;
    still_ticks_ = 0;
  }
  return static_cast<double>(still_ticks_++) * tick_seconds_ >= still_seconds;
}

Force Identification::tick(glm::ivec2 counts) {
  const glm::dvec2 position = glm::dvec2(counts) * position_step_;
  const double rise = most_ / rise_seconds * tick_seconds_;
  switch (phase_) {
    case Phase::rest:
      if (is_still(position) || seconds() >= rest_seconds) {
        start_ = position;
        enter(Phase::push);
      }
      break;
    case Phase::push:
    case Phase::hold: {
      const glm::dvec2 moved = position - start_;
      Push& push = pushes_[static_cast<std::size_t>(push_)];
      const bool has_moved = glm::length(moved) >= enough_;
      const bool gives_up = phase_ == Phase::hold && seconds() >= hold_seconds;
      if (has_moved || gives_up) {
        push = {moved, has_moved ? force_ : 0};
        eased_from_ = force_;
        enter(Phase::ease);
        break;
      }
      force_ = std::min(most_, force_ + rise);
      if (phase_ == Phase::push && force_ >= most_) enter(Phase::hold);
      break;
    }
    case Phase::ease:
      force_ = std::max(0.0, force_ - eased_from_ / ease_seconds * tick_seconds_);
      if (force_ > 0) break;
      ++push_;
      if (push_ < 4) {
        enter(Phase::rest);
      } else {
        start_ = position;
        enter(asks_ ? Phase::ask_right : Phase::done);
      }
      return Force(0);
    case Phase::ask_right:
    case Phase::ask_away:
    case Phase::back: watch_person(position); break;
    case Phase::done: break;
  }
  ++ticks_;
  if (phase_ != Phase::push && phase_ != Phase::hold && phase_ != Phase::ease) return Force(0);
  Force force(0);
  force[static_cast<int>(motor())] = static_cast<float>(sense() * force_);
  return force;
}

/// A movement by hand counts once the handle has stayed there for a moment.
void Identification::watch_person(glm::dvec2 position) {
  const glm::dvec2 moved = position - start_;
  const bool is_back = phase_ == Phase::back;
  const bool is_there = is_back ? glm::length(moved) < far_ / 2 : glm::length(moved) >= far_;
  shown_ticks_ = is_there ? shown_ticks_ + 1 : 0;
  const bool is_shown = static_cast<double>(shown_ticks_) * tick_seconds_ >= shown_seconds;
  if (!is_shown && seconds() < person_seconds) return;
  if (is_back) {
    start_ = position;
    return enter(Phase::ask_away);
  }
  const bool is_first = phase_ == Phase::ask_right;
  if (is_shown) shown_[is_first ? 0 : 1] = plain_axis(moved);
  enter(is_first ? Phase::back : Phase::done);
}

Identified Identification::result() const {
  Identified found;
  found.shown = shown_;
  for (std::size_t motor = 0; motor < 2; ++motor) {
    MotorAnswer& answer = found.motors[motor];
    for (std::size_t way = 0; way < 2; ++way) {
      const Push& push = pushes_[2 * motor + way];
      if (!(push.newton > 0)) continue;
      auto moves = plain_axis(push.moved);
      if (moves && way == 1) moves->sign = -moves->sign;
      if (!moves) {
        answer.problem = "the handle moved along both axes alike";
      } else if (answer.moves && *answer.moves != *moves) {
        answer.problem = "the handle moved differently each way; perhaps a hand held it";
      } else {
        answer.moves = moves;
      }
      answer.newton = answer.newton > 0 ? std::min(answer.newton, push.newton) : push.newton;
    }
    if (!(answer.newton > 0))
      answer.problem = "nothing moved: its friction is greater than the force, or the handle is blocked";
    if (!answer.problem.empty()) answer.moves.reset();
  }
  const auto& [first, second] = found.motors;
  if (!first.moves || !second.moves) {
    found.problem = !first.moves ? "its x motor: " + first.problem : "its y motor: " + second.problem;
    return found;
  }
  if (first.moves->axis == second.moves->axis) {
    found.problem = "both motors moved the handle along the same axis";
    return found;
  }
  // The device's own axes, unless the person has shown that they lie differently. One of the two determines the other.
  std::array<SignedAxis, 2> axes{{{0}, {1}}};
  if (shown_[0] && shown_[1] && shown_[0]->axis == shown_[1]->axis) {
    found.problem = "the person moved the handle along the same axis to the right and away";
    return found;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (!shown_[i]) continue;
    axes[i] = *shown_[i];
    axes[1 - i].axis = 1 - axes[i].axis;
  }
  if (shown_[1]) axes[1] = *shown_[1];
  std::array<SignedAxis, 2> motors;
  for (std::size_t i = 0; i < 2; ++i) {
    const int motor = first.moves->axis == axes[i].axis ? 0 : 1;
    motors[i] = {motor, found.motors[static_cast<std::size_t>(motor)].moves->sign * axes[i].sign};
  }
  found.axes_settled = axes;
  found.motors_settled = motors;
  return found;
}

}  // namespace wale
