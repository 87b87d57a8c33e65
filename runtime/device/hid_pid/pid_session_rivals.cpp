// How a session notices that another program has reset the device or stopped its effects.

#include <algorithm>

#include "runtime/device/hid_pid/pid_session.hpp"

namespace wale::hid {

/// Asks for Block Load, which names the effect that was created last, by any program.
std::optional<Transfer> PidSession::look_transfer(std::int64_t now) noexcept {
  if (!options_.is_shared || layout_->state || options_.rival_check_period <= 0) return std::nullopt;
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

/// A bit counts as lost only if it was set before, because much firmware never sets these bits.
void PidSession::take_state(const DeviceState& state, std::int64_t now) noexcept {
  if (!options_.is_shared || state_ != State::running) return;
  if (state.actuators_enabled) {
    if (!*state.actuators_enabled && actuators_seen_) return dispossess();
    actuators_seen_ = *state.actuators_enabled;
  }
  if (!state.effect_plays || !state.block_index) return;
  for (std::size_t i = 0; i < created_; ++i) {
    if (blocks_[i] != *state.block_index) continue;
    if (*state.effect_plays) {
      plays_seen_[i] = true;
      continue;
    }
    if (!plays_seen_[i] || silent_) continue;
    // A report of an end before our last start may still be under way.
    constexpr std::int64_t grace = 20'000;  // microseconds
    if (now - started_[i] < grace) continue;
    const bool has_run_out = duration_ != endless && now - started_[i] > microseconds(0.9 * duration_);
    if (!has_run_out) return dispossess();
    refresh_at_[i] = now;
  }
}

/// The session no longer knows the device's state, and its blocks may now belong to another program. So it sends
/// nothing more; its own effects that still play end with their duration.
void PidSession::dispossess() noexcept {
  lost_ = true;
  reason_ = "another program has reset it or stopped its effects";
  why_ = Code::lost_device;
  step_ = Step::none;
  state_ = State::over;
}

}  // namespace wale::hid
