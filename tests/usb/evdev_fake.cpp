#include "tests/usb/evdev_fake.hpp"

#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace wale::test {
namespace {

input_event event(std::uint16_t type, std::uint16_t code, std::int32_t value) {
  input_event event{};
  event.type = type;
  event.code = code;
  event.value = value;
  return event;
}

}  // namespace

EvdevFake::EvdevFake(const Features& features) : features_(features) {
  for (input_absinfo& axis : axes_)
    axis = {.value = 0, .minimum = -32767, .maximum = 32767, .fuzz = 255, .flat = 4095, .resolution = 0};
  start();
}

glm::dvec2 EvdevFake::force() {
  const std::lock_guard lock(mutex_);
  glm::dvec2 force(0);
  for (const auto& [id, effect] : effects_) {
    const std::int64_t length = std::int64_t{effect.said.replay.length} * 1000;
    if (!effect.plays || (length > 0 && now() - effect.started >= length)) continue;
    const double turn = effect.said.direction * 2 * 3.14159265358979323846 / 65536;
    force += effect.said.u.constant.level / 32767.0 * glm::dvec2(std::sin(turn), -std::cos(turn));
  }
  return force;
}

void EvdevFake::tell(const std::vector<input_event>& events) const {
  send(device_end(), events.data(), events.size() * sizeof(input_event), MSG_NOSIGNAL);
}

void EvdevFake::move_to(std::int32_t x, std::int32_t y) {
  const std::lock_guard lock(mutex_);
  axes_[0].value = x;
  axes_[1].value = y;
  tell({event(EV_ABS, ABS_X, x), event(EV_ABS, ABS_Y, y), event(EV_SYN, SYN_REPORT, 0)});
}

void EvdevFake::move_unheard(std::int32_t x, std::int32_t y) {
  const std::lock_guard lock(mutex_);
  axes_[0].value = x;
  axes_[1].value = y;
  tell({event(EV_SYN, SYN_DROPPED, 0), event(EV_ABS, ABS_X, -1), event(EV_SYN, SYN_REPORT, 0)});
}

void EvdevFake::move_while_grabbed(std::int32_t x, std::int32_t y) {
  const std::lock_guard lock(mutex_);
  axes_[0].value = x;
  axes_[1].value = y;
}

void EvdevFake::erase_through_the_same_file(int effect) {
  const std::lock_guard lock(mutex_);
  effects_.erase(effect);
}

std::map<int, EvdevFake::Effect> EvdevFake::effects() {
  const std::lock_guard lock(mutex_);
  return effects_;
}

std::vector<std::string> EvdevFake::log() {
  const std::lock_guard lock(mutex_);
  return log_;
}

std::int32_t EvdevFake::fuzz() {
  const std::lock_guard lock(mutex_);
  return axes_[0].fuzz;
}

int EvdevFake::answer_bits(unsigned type, std::uint8_t* bits, std::size_t size) const {
  std::memset(bits, 0, size);
  const auto set = [&](unsigned bit) {
    if (bit / 8 < size) bits[bit / 8] |= static_cast<std::uint8_t>(1u << bit % 8);
  };
  if (type == EV_FF) {
    if (features_.makes_constant_force) set(FF_CONSTANT);
    set(FF_GAIN);
    set(FF_AUTOCENTER);
  } else if (type == EV_ABS && features_.tells_position) {
    set(ABS_X);
    set(ABS_Y);
  }
  return static_cast<int>(size);
}

int EvdevFake::upload(ff_effect& effect) {
  if (effect.id == -1) {
    if (static_cast<int>(effects_.size()) >= features_.room) {
      errno = ENOSPC;
      return -1;
    }
    effect.id = static_cast<std::int16_t>(effects_.size());
  } else if (!effects_.contains(effect.id)) {
    errno = EINVAL;
    return -1;
  }
  effects_[effect.id].said = effect;
  log_.push_back("upload " + std::to_string(effect.id) + " level " + std::to_string(effect.u.constant.level) +
                 " toward " + std::to_string(effect.direction));
  return 0;
}

int EvdevFake::answer(unsigned long request, void* argument) {
  const unsigned number = _IOC_NR(request);
  constexpr unsigned bits_of = 0x20, position_of = 0x40, set_position_of = 0xc0;  // EVIOCGBIT, EVIOCGABS, EVIOCSABS
  if (_IOC_TYPE(request) != 'E') {
    errno = ENOTTY;
    return -1;
  }
  if (request == EVIOCGVERSION) return 0;
  if (request == EVIOCSFF) return upload(*static_cast<ff_effect*>(argument));
  if (request == EVIOCGEFFECTS) return *static_cast<int*>(argument) = features_.most_effects, 0;
  if (request == EVIOCRMFF) {
    const auto id = static_cast<int>(reinterpret_cast<std::intptr_t>(argument));
    log_.push_back("erase " + std::to_string(id));
    return effects_.erase(id) == 1 ? 0 : -1;
  }
  if (number == position_of + ABS_X || number == position_of + ABS_Y) {
    return *static_cast<input_absinfo*>(argument) = axes_[number - position_of], 0;
  }
  if (number == set_position_of + ABS_X || number == set_position_of + ABS_Y) {
    return axes_[number - set_position_of] = *static_cast<input_absinfo*>(argument), 0;
  }
  if (number >= bits_of && number < position_of) {
    return answer_bits(number - bits_of, static_cast<std::uint8_t*>(argument), _IOC_SIZE(request));
  }
  errno = ENOTTY;
  return -1;
}

void EvdevFake::frame() {
  input_event said{};
  while (recv(device_end(), &said, sizeof said, MSG_DONTWAIT) == sizeof said) {
    if (said.type != EV_FF) continue;
    if (said.code == FF_GAIN) {
      log_.push_back("gain " + std::to_string(said.value));
    } else if (said.code == FF_AUTOCENTER) {
      log_.push_back("autocenter " + std::to_string(said.value));
    } else {
      log_.push_back((said.value != 0 ? "play " : "stop ") + std::to_string(said.code));
      if (const auto found = effects_.find(said.code); found != effects_.end()) {
        found->second.plays = said.value != 0;
        found->second.started = now();
      }
    }
  }
}

}  // namespace wale::test
