#include "runtime/device/hid_pid/evdev_transport.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "runtime/device/usb/system_error.hpp"

namespace wale {
namespace {

constexpr std::int64_t full_level = 32767;  // linux/input.h: ff_constant_effect
// Directions in 65536ths of a turn. The driver passes them on with the meaning of the PID class: a force of level m is
// m sin along x and -m cos along y, which points to the user.
constexpr std::uint16_t toward_x = 0x4000, toward_y = 0x8000;
constexpr std::int64_t turn_steps = 65536;
constexpr std::uint16_t endless = 0;         // ff_replay: no length
constexpr std::int64_t most_length = 32767;  // ms

template <std::size_t Bits>
using BitSet = std::array<std::uint8_t, Bits / 8 + 1>;
template <std::size_t Bytes>
bool has(const std::array<std::uint8_t, Bytes>& bits, unsigned bit) {
  return (bits[bit / 8] >> bit % 8 & 1) != 0;
}

std::int64_t microseconds(double seconds) { return static_cast<std::int64_t>(seconds * 1e6); }

void sleep_microseconds(std::int64_t duration) {
  const timespec time{duration / 1'000'000, duration % 1'000'000 * 1000};
  clock_nanosleep(CLOCK_MONOTONIC, 0, &time, nullptr);
}

}  // namespace

EvdevNode::EvdevNode(OwnedDescriptor descriptor, IoctlCall ioctl) : descriptor_(std::move(descriptor)), ioctl_(ioctl) {}

Result<EvdevNode> EvdevNode::open(const std::string& path, IoctlCall ioctl) {
  EvdevNode node(OwnedDescriptor(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK)), ioctl);
  if (!node.descriptor_) return why_not_opened(errno, path);
  if (Result<> learned = node.learn(path); !learned) return std::move(learned).error();
  return node;
}

Result<EvdevNode> EvdevNode::of(int descriptor, IoctlCall ioctl) {
  EvdevNode node(OwnedDescriptor::copy_of(descriptor), ioctl);
  const std::string name = "descriptor " + std::to_string(descriptor);
  if (!node.descriptor_) return why_not_opened(errno, name);
  if (Result<> learned = node.learn(name); !learned) return std::move(learned).error();
  return node;
}

Result<> EvdevNode::learn(const std::string& name) {
  BitSet<FF_MAX> forces{};
  if (call(EVIOCGBIT(EV_FF, forces.size()), forces.data()) < 0) return why_not_opened(errno, name);
  if (!has(forces, FF_CONSTANT)) {
    return Error{Code::unlike_device,
                 "the kernel's driver makes no constant force of it",
                 "Linux 6.12.24 and later know more sticks",
                 {.name = name}};
  }
  has_gain_ = has(forces, FF_GAIN);
  has_autocenter_ = has(forces, FF_AUTOCENTER);
  if (call(EVIOCGEFFECTS, &most_effects_) < 0) return why_not_opened(errno, name);
  BitSet<ABS_MAX> positions{};
  if (call(EVIOCGBIT(EV_ABS, positions.size()), positions.data()) < 0) return why_not_opened(errno, name);
  if (!has(positions, ABS_X) || !has(positions, ABS_Y)) {
    return Error{Code::unlike_device, "it sends no position", {}, {.name = name}};
  }
  return {};
}

Result<std::unique_ptr<PidTransport>> EvdevTransport::open(EvdevNode node, const Limits& limits,
                                                           const PidTransportOptions& options) {
  std::unique_ptr<EvdevTransport> transport(new EvdevTransport(std::move(node), limits, options));
  if (Result<> ready = transport->set_up(); !ready) return std::move(ready).error();
  if (Result<> kept = transport->get_keeper(options.keeper); !kept) return std::move(kept).error();
  transport->start_threads(options.priority);
  return transport;
}

EvdevTransport::EvdevTransport(EvdevNode node, const Limits& limits, const PidTransportOptions& options)
    : node_(std::move(node)),
      now_(options.now),
      pace_(2000 * std::int64_t{std::max(1, limits.report_interval)}),
      refresh_period_(options.session.effect_duration > 0 ? microseconds(options.session.effect_duration / 3) : 0),
      silence_(microseconds(options.session.command_silence)),
      limits_(options.session.limits),
      ends_reading_(eventfd(0, EFD_CLOEXEC)) {
  ranges_.full_force = std::clamp<std::int64_t>(limits.force_steps, 1, full_level);
  const std::int64_t length = std::llround(options.session.effect_duration * 1000);  // ms
  for (ff_effect& effect : effects_) {
    effect.type = FF_CONSTANT;
    effect.id = -1;
    effect.replay.length = length > 0 ? static_cast<std::uint16_t>(std::min(length, most_length)) : endless;
  }
  effects_[0].direction = toward_x;
  effects_[1].direction = toward_y;
}

Result<> EvdevTransport::set_up() {
  if (Result<> known = set_up_positions(); !known) return known;
  // The driver's own centring spring would add its force to every material.
  if (node_.has_autocenter()) tell(FF_AUTOCENTER, 0);

  // Nothing tells which of the queued updates the device has, and a full queue drops the newest. Each effect keeps
  // within its own limit whatever comes of the other; only one effect keeps a whole vector within the user's.
  const bool is_vector_limited = limits_.most_newton < glm::length(limits_.peak);
  if (node_.most_effects() < 2 || is_vector_limited) arrangement_ = hid::Arrangement::combined;
  for (std::size_t i = 0; i < effects(); ++i) {
    Result<> uploaded = upload(i);
    if (!uploaded && i == 0) return uploaded;
    if (!uploaded) arrangement_ = hid::Arrangement::combined;
  }
  gate_ = arrangement_ == hid::Arrangement::combined
              ? hid::ForceGate::of_one(limits_, ranges_.full_force, 360.0 / turn_steps, turn_steps - 1)
              : hid::ForceGate::of_two(limits_, ranges_.full_force, {{{1, 0}, {0, 1}}});
  if (node_.has_gain()) tell(FF_GAIN, 0xffff);
  const std::int64_t now = now_();
  for (std::size_t i = 0; i < effects(); ++i) {
    if (!tell(static_cast<std::uint16_t>(effects_[i].id), 1)) return why_not_opened(errno, "its event node");
    refresh_at_[i] = now + refresh_period_;
  }
  commanded_ = now;
  return {};
}

/// By default the driver declares a fuzz of 1/256 of a joystick's range, and the input layer drops smaller changes.
/// That is too coarse for a hand, so this sets the fuzz to 0.
Result<> EvdevTransport::set_up_positions() {
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const auto axis = static_cast<unsigned>(i == 0 ? ABS_X : ABS_Y);
    if (node_.call(EVIOCGABS(axis), &positions_[i]) < 0) return why_not_opened(errno, "its event node");
    if (positions_[i].minimum >= positions_[i].maximum) return Error{Code::unlike_device, "it sends no position"};
    input_absinfo finest = positions_[i];
    finest.fuzz = 0;
    node_.call(EVIOCSABS(axis), &finest);  // if this fails, positions are only coarser
  }
  ranges_.x_minimum = positions_[0].minimum;
  ranges_.x_maximum = positions_[0].maximum;
  ranges_.y_minimum = positions_[1].minimum;
  ranges_.y_maximum = positions_[1].maximum;
  learn_state();
  show(place_[0], place_[1], button_);
  return {};
}

Result<> EvdevTransport::upload(std::size_t effect) {
  if (!may_go(effects_[effect].u.constant.level != 0)) return Error{Code::lost_device, "its keeper has it"};
  if (node_.call(EVIOCSFF, &effects_[effect]) >= 0) return {};
  if (errno == ENOSPC) {
    return Error{Code::unusable_device, "it has no room for an effect: another program may hold them",
                 "close the programs that use it"};
  }
  const bool was_ours = effects_[effect].id >= 0;
  if (was_ours && (errno == EINVAL || errno == EACCES)) {
    effects_[effect].id = -1;
    return Error{Code::lost_device, "another program has erased its effects"};
  }
  return why_not_opened(errno, "its event node");
}

/// Uploads an effect that the kernel has already; false: it is lost.
bool EvdevTransport::update(std::size_t effect) {
  const Result<> taken = upload(effect);
  if (!taken) {
    const bool is_telling = taken.error().code == Code::lost_device || taken.error().code == Code::absent_device;
    lose(is_telling ? taken.error().sentence : "the kernel's driver takes no force any more");
  }
  return taken.has_value();
}

/// Plays an effect, or sets a property such as the gain.
bool EvdevTransport::tell(std::uint16_t code, std::int32_t value) {
  input_event event{};
  event.type = EV_FF;
  event.code = code;
  event.value = value;
  return write(node_.descriptor(), &event, sizeof event) == static_cast<ssize_t>(sizeof event);
}

/// While the effects play without force.
Result<> EvdevTransport::get_keeper(const std::optional<KeeperOptions>& options) {
  if (!options) return {};
  LetGoPlan plan;
  plan.node = LetGoPlan::Node::evdev;
  for (const auto way : {LetGoStep::Way::stop, LetGoStep::Way::erase}) {
    for (std::size_t i = 0; i < effects(); ++i) plan.add({.way = way, .effect = effects_[i].id});
  }
  auto keeper = Keeper::start(plan, node_.descriptor(), *options);
  if (!keeper) return std::move(keeper).error();
  set_keeper(*std::move(keeper));
  return {};
}

/// Takes the force from all effects; they end by themselves.
void EvdevTransport::let_go() {
  for (std::size_t i = 0; i < effects(); ++i) {
    if (effects_[i].id < 0) continue;
    effects_[i].u.constant.level = 0;
    node_.call(EVIOCSFF, &effects_[i]);
  }
}

/// The last look before the kernel's driver is told something. False: nothing may go, or the node is lost.
bool EvdevTransport::may_go(bool pushes) {
  if (!keeper()) return true;
  if (pushes) keeper()->note_push();
  const Keeper::Verdict verdict = keeper()->look();
  const bool is_late = verdict == Keeper::Verdict::late;
  if (verdict == Keeper::Verdict::good || (is_late && !pushes)) return true;
  if (is_late || was_lost()) return false;
  if (verdict != Keeper::Verdict::latched) let_go();
  lose(std::string(keeper()->why(verdict)));
  return false;
}

void EvdevTransport::start_threads(int priority) {
  reader_ = std::thread([this] { read_positions(); });
  writer_ = std::thread([this] { write_forces(); });
  if (priority <= 0) return;
  sched_param parameters{};
  parameters.sched_priority = priority;
  pthread_setschedparam(writer_.native_handle(), SCHED_FIFO, &parameters);
}

EvdevTransport::~EvdevTransport() {
  stop_waiting();
  if (writer_.joinable()) writer_.join();
  const std::uint64_t one = 1;
  if (write(ends_reading_.get(), &one, sizeof one) > 0 && reader_.joinable()) reader_.join();
  const bool is_taken = keeper() && keeper()->look() == Keeper::Verdict::latched;
  for (std::size_t i = 0; i < effects_.size() && !is_taken; ++i) {
    if (effects_[i].id < 0) continue;
    effects_[i].u.constant.level = 0;
    node_.call(EVIOCSFF, &effects_[i]);
    tell(static_cast<std::uint16_t>(effects_[i].id), 0);
    // The kernel takes the effect's number by value.
    node_.call(EVIOCRMFF, reinterpret_cast<void*>(static_cast<std::intptr_t>(effects_[i].id)));
  }
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    if (positions_[i].maximum > positions_[i].minimum) {
      node_.call(EVIOCSABS(static_cast<unsigned>(i == 0 ? ABS_X : ABS_Y)), &positions_[i]);
    }
  }
}

/// The writer's thread.
void EvdevTransport::write_forces() {
  constexpr std::int64_t patience = 20'000;  // microseconds; the longest wait between checks for refreshes and silence
  while (true) {
    // While an update is pending, it takes a newer command but does not wait for one.
    const auto wanted = wait_for_command(pending_ ? 0 : patience);
    if (is_ending()) return;
    const std::int64_t now = now_();
    if (wanted) {
      if (pending_) {
        const std::lock_guard lock(mutex_);
        ++counts_.overwritten;
      }
      const auto finite = [](float value) { return std::isnan(value) ? 0 : std::clamp<double>(value, -1, 1); };
      wanted_ = {finite(wanted->x), finite(wanted->y)};
      commanded_ = now;
      silent_ = false;
      pending_ = true;
    } else if (now - commanded_ > silence_ && !silent_) {
      silent_ = true;
      wanted_ = glm::dvec2(0);
      pending_ = true;
      const std::lock_guard lock(mutex_);
      ++counts_.silences;
    }
    if (was_lost() || !may_go(false)) return;
    if (write_next(now)) {
      sleep_microseconds(pace_);
    } else if (keeper() && !pending_ && is_level()) {
      keeper()->note_slack();
    }
  }
}

/// Sends the next update; false: there is none.
bool EvdevTransport::write_next(std::int64_t now) {
  if (refresh(now)) return true;
  if (!pending_) return false;
  const bool is_combined = arrangement_ == hid::Arrangement::combined;
  const auto change = is_combined ? gate_.next_at_once(wanted_) : gate_.next(wanted_);
  if (is_combined || !change) pending_ = false;
  return change && push(*change);
}

/// The only one that says how hard an effect pushes. False: it cannot be said any more.
bool EvdevTransport::push(const hid::ForceGate::Change& change) {
  ff_effect& effect = effects_[change.effect];
  effect.u.constant.level = static_cast<std::int16_t>(change.magnitude.counts() * full_level / ranges_.full_force);
  if (change.turns)
    effect.direction = static_cast<std::uint16_t>(std::llround(change.direction / 360 * turn_steps) % turn_steps);
  if (!update(change.effect)) return false;
  gate_.arrived(change.effect);  // its own limit alone counts, see `set_up`
  const std::lock_guard lock(mutex_);
  ++counts_.forces_sent[change.effect];
  if (change.turns) ++counts_.directions_sent;
  return true;
}

/// Whether the kernel's driver has been told that no effect pushes.
bool EvdevTransport::is_level() const noexcept {
  return effects_[0].u.constant.level == 0 && effects_[1].u.constant.level == 0;
}

/// Plays an effect again before its time is over. The kernel takes this for an effect that was erased too, so the
/// effect is updated before, which sends nothing to the device.
bool EvdevTransport::refresh(std::int64_t now) {
  if (refresh_period_ <= 0 || silent_) return false;
  for (std::size_t i = 0; i < effects(); ++i) {
    if (now < refresh_at_[i]) continue;
    refresh_at_[i] = now + refresh_period_;
    if (!update(i)) return false;
    if (!tell(static_cast<std::uint16_t>(effects_[i].id), 1)) {
      lose("the kernel's driver takes no force any more");
      return false;
    }
    const std::lock_guard lock(mutex_);
    ++counts_.refreshes;
    return true;
  }
  return false;
}

void EvdevTransport::lose(std::string reason) {
  const std::lock_guard lock(mutex_);
  if (reason_.empty()) reason_ = std::move(reason);
  show_lost();
}

/// The reader's thread. While another program has grabbed the node (EVIOCGRAB), the kernel gives all events to that
/// program, but tells the state to everybody who asks. A changed state without an event shows such a grab, and then
/// the state is asked for as often as the device reports, until events come again.
void EvdevTransport::read_positions() {
  constexpr int usual_patience = 20, patience_while_grabbed = 1;  // ms
  std::array<input_event, 64> events{};
  bool is_grabbed = false;
  while (true) {
    pollfd waits[2] = {{node_.descriptor(), POLLIN, 0}, {ends_reading_.get(), POLLIN, 0}};
    const int ready = poll(waits, 2, is_grabbed ? patience_while_grabbed : usual_patience);
    if (ready < 0 && errno != EINTR) return lose("its position cannot be read");
    if (ready == 0 && learn_state()) {
      is_grabbed = true;
      show(place_[0], place_[1], button_);
      const std::lock_guard lock(mutex_);
      ++counts_.inputs;
    }
    if (ready <= 0) continue;
    if (waits[1].revents != 0) return;
    if (waits[0].revents == 0) continue;
    is_grabbed = false;
    const ssize_t got = read(node_.descriptor(), events.data(), sizeof events);
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) return lose("it was unplugged");
    for (std::size_t i = 0; got > 0 && i < static_cast<std::size_t>(got) / sizeof(input_event); ++i) take(events[i]);
  }
}

void EvdevTransport::take(const input_event& event) {
  if (event.type == EV_SYN && event.code == SYN_DROPPED) {
    is_dropping_ = true;  // until the next report: the present one is incomplete
    return;
  }
  if (event.type == EV_SYN && event.code == SYN_REPORT) {
    if (is_dropping_) learn_state();
    is_dropping_ = false;
    show(place_[0], place_[1], button_);
    const std::lock_guard lock(mutex_);
    ++counts_.inputs;
    return;
  }
  if (is_dropping_) return;
  for (std::size_t i = 0; i < place_.size(); ++i)
    if (event.type == EV_ABS && event.code == (i == 0 ? ABS_X : ABS_Y))
      place_[i] = std::clamp(event.value, positions_[i].minimum, positions_[i].maximum);
  if (event.type == EV_KEY && event.code == BTN_JOYSTICK) button_ = event.value != 0;
}

/// Asks for the present state, because the kernel reports it only when it changes. Returns whether it is a new one.
bool EvdevTransport::learn_state() {
  auto place = place_;
  bool button = button_;
  for (std::size_t i = 0; i < place.size(); ++i) {
    input_absinfo now{};
    if (node_.call(EVIOCGABS(static_cast<unsigned>(i == 0 ? ABS_X : ABS_Y)), &now) < 0) return false;
    place[i] = std::clamp(now.value, positions_[i].minimum, positions_[i].maximum);
  }
  BitSet<KEY_MAX> keys{};
  if (node_.call(EVIOCGKEY(keys.size()), keys.data()) >= 0) button = has(keys, BTN_JOYSTICK);
  const bool is_new = place != place_ || button != button_;
  place_ = place, button_ = button;
  return is_new;
}

std::string EvdevTransport::reason() const {
  const std::lock_guard lock(mutex_);
  return reason_;
}

hid::PidSessionCounts EvdevTransport::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace wale
