#include "runtime/device/hid_pid/pid_transport.hpp"

#include <sys/ioctl.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <bit>

namespace wale {
namespace {

constexpr int seen_bits = 28;

}  // namespace

std::string_view in_words(PidTransportKind kind) noexcept {
  return pid_transport_names[static_cast<std::size_t>(kind)];
}

std::optional<PidTransportKind> read_transport_kind(std::string_view text) noexcept {
  for (std::size_t i = 0; i < pid_transport_names.size(); ++i) {
    if (pid_transport_names[i] == text) return static_cast<PidTransportKind>(i);
  }
  return std::nullopt;
}

int system_ioctl(int descriptor, unsigned long request, void* argument) {
  return ::ioctl(descriptor, request, argument);
}

PidTransport::PidTransport() { sem_init(&commanded_, 0, 0); }

PidTransport::~PidTransport() {
  end_keeper();
  sem_destroy(&commanded_);
}

void PidTransport::set_keeper(std::unique_ptr<Keeper> keeper) noexcept {
  keeper_.store(keeper.release(), std::memory_order_release);
}

void PidTransport::command(glm::vec2 force) noexcept {
  if (Keeper* const keeper = this->keeper()) keeper->beat();  // first: a force that is sent is then watched over
  const std::uint64_t x = std::bit_cast<std::uint32_t>(force.x), y = std::bit_cast<std::uint32_t>(force.y);
  wanted_.store(x << 32 | y, std::memory_order_release);
  sem_post(&commanded_);
}

std::optional<glm::vec2> PidTransport::wait_for_command(std::int64_t most_microseconds) noexcept {
  timespec until{};
  clock_gettime(CLOCK_MONOTONIC, &until);
  constexpr long second = 1'000'000'000;  // ns
  const std::int64_t nanoseconds = until.tv_nsec + most_microseconds * 1000;
  until.tv_sec += nanoseconds / second;
  until.tv_nsec = nanoseconds % second;
  if (sem_clockwait(&commanded_, CLOCK_MONOTONIC, &until) != 0) return std::nullopt;
  while (sem_trywait(&commanded_) == 0) {  // several commands: only the newest counts
  }
  if (is_ending()) return std::nullopt;
  const std::uint64_t wanted = wanted_.load(std::memory_order_acquire);
  return glm::vec2(std::bit_cast<float>(static_cast<std::uint32_t>(wanted >> 32)),
                   std::bit_cast<float>(static_cast<std::uint32_t>(wanted)));
}

void PidTransport::stop_waiting() noexcept {
  ends_.store(true, std::memory_order_release);
  sem_post(&commanded_);
}

PidTransport::Seen PidTransport::seen() const noexcept {
  const std::uint64_t packed = seen_.load(std::memory_order_acquire);
  const auto number = [](std::uint64_t bits) {
    const std::int64_t sign = std::int64_t{1} << (seen_bits - 1);
    return static_cast<std::int32_t>((static_cast<std::int64_t>(bits & ((1u << seen_bits) - 1)) ^ sign) - sign);
  };
  return {number(packed >> seen_bits), number(packed), (packed >> (2 * seen_bits) & 1) != 0};
}

void PidTransport::show(std::int64_t x, std::int64_t y, bool button) noexcept {
  const auto bits = [](std::int64_t value) {
    const std::int64_t most = (std::int64_t{1} << (seen_bits - 1)) - 1;
    return static_cast<std::uint64_t>(std::clamp(value, -most, most)) & ((1u << seen_bits) - 1);
  };
  seen_.store(std::uint64_t{button} << (2 * seen_bits) | bits(x) << seen_bits | bits(y), std::memory_order_release);
}

}  // namespace wale
