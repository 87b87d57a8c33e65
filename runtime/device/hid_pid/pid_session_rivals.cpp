// How a session notices that another program has reset the device or stopped its effects.

#include <algorithm>

#include "runtime/device/hid_pid/pid_session.hpp"

namespace wale::hid {

/// Asks for Block Load, which names the effect that was created last, by any program.
std::optional<Transfer> PidSession::look_transfer(std::int64_t now) noexcept {
  if (!options_.is_shared || options_.rival_check_period <= 0) return std::nullopt;
  if (look_under_way_ || now < look_at_) return std::nullopt;
  look_under_way_ = true;
  look_at_ = now + microseconds(options_.rival_check_period);
  ++counts_.looks;
  return get_report(feature_report, layout_->block_load, Transfer::Purpose::look);
}

/// If the device has created an effect in one of our blocks, that block was freed before, which only a reset does: a
/// device gives out no block that is in use. A block that is not ours belongs to another program and is left alone.
void PidSession::take_look(std::span<const std::uint8_t> answer) noexcept {
  const auto load = decode_block_load(*layout_, answer);
  if (!load || load->status != BlockLoadAnswer::Status::loaded) return;
  if (load->block_index != last_load_ && is_ours(load->block_index)) return dispossess();
  last_load_ = load->block_index;
}

bool PidSession::is_ours(std::uint8_t block) const noexcept {
  return std::find(blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(created_), block) !=
         blocks_.begin() + static_cast<std::ptrdiff_t>(created_);
}

/// The last of the old states is the device's state when the session began to listen.
void PidSession::take_old_state(const DeviceState& state) noexcept {
  if (state.actuators_enabled) actuators_seen_ = *state.actuators_enabled;
  if (!state.effect_plays || !state.block_index || !is_ours(*state.block_index)) return;
  plays_seen_[*state.block_index == blocks_[0] ? 0 : 1] = *state.effect_plays;
}

/// A bit counts as lost only if it was set before, because much firmware never sets these bits.
void PidSession::take_state(const DeviceState& state, std::int64_t now) noexcept {
  if (!options_.is_shared) return;
  const bool is_about_ours = state.effect_plays && state.block_index && is_ours(*state.block_index);
  // A report of what came before our last order may still be on its way.
  constexpr std::int64_t grace = 20'000;  // microseconds
  if (step_ == Step::leave_wait || step_ == Step::leave_look) {
    // We start nothing any more: another program plays an effect that was given our block.
    const std::int64_t since = now - look_at_ + microseconds(options_.rival_patience);
    if (is_about_ours && *state.effect_plays && since >= grace) dispossess();
    return;
  }
  if (state_ != State::running) return;
  if (state.actuators_enabled) {
    if (!*state.actuators_enabled && actuators_seen_) return dispossess();
    actuators_seen_ = *state.actuators_enabled;
  }
  if (!is_about_ours) return;
  const std::size_t i = *state.block_index == blocks_[0] ? 0 : 1;
  if (*state.effect_plays) {
    plays_seen_[i] = true;
    return;
  }
  if (!plays_seen_[i] || silent_) return;
  if (now - started_[i] < grace) return;
  const bool has_run_out = duration_ != endless && now - started_[i] > microseconds(0.9 * duration_);
  if (!has_run_out) return dispossess_for_now(now);
  refresh_at_[i] = now;
}

/// Our effects were stopped. After a reset they are gone, and another program may get their blocks; otherwise they
/// still take up room in the device. The session sends nothing for a while, then asks.
void PidSession::dispossess_for_now(std::int64_t now) noexcept {
  dispossess();
  if (!layout_->block_free) return;  // nothing could be given back
  state_ = State::leaving;
  step_ = Step::leave_wait;
  look_at_ = now + microseconds(options_.rival_patience);
}

/// Whether the effect that was created last is the same as before our effects were stopped. Then no program has created
/// one since, so that our blocks are ours, or nobody's. A program that has reset the device, has created as many
/// effects as there were, and has started none of them yet, is not told apart.
bool PidSession::still_owns(std::span<const std::uint8_t> answer) const noexcept {
  const auto load = decode_block_load(*layout_, answer);
  return load && load->status == BlockLoadAnswer::Status::loaded && load->block_index == last_load_;
}

}  // namespace wale::hid
