// A libFuzzer target for the bytes of a Falcon. Any bytes, split in any way, are answers or are skipped, and each
// answer occurs in the input. A session with such bytes never pushes before it is homed, and always ends.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "runtime/device/falcon/falcon_plane.hpp"
#include "runtime/device/falcon/falcon_session.hpp"

namespace {

using namespace wale;
using namespace wale::falcon;

void demand(bool holds) {
  if (!holds) std::abort();
}

void read_answers(std::span<const std::uint8_t> bytes) {
  AnswerReader reader;
  const ForceLimits limits{.peak = glm::dvec2(8), .most_newton = 3};
  FalconPlane plane(limits);
  const TorqueGate gate(limits, 3);
  long answers = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto answer = reader.take(bytes[i]);
    if (!answer) continue;
    ++answers;
    demand(i + 1 >= packet_bytes && bytes[i] == '>' && bytes[i + 1 - packet_bytes] == '<');
    demand(answer->buttons < 16 && answer->homed < 8);
    if (!plane.see(answer->encoders, static_cast<std::int64_t>(i) * 1000)) continue;
    const auto push = plane.push({3, -2}, static_cast<std::int64_t>(i) * 1000);
    for (const std::int16_t torque : push.torques) demand(std::abs(torque) <= most_torque);
    const Torques allowed = gate.within({4096, -4096, 123}, answer->encoders);
    demand(gate.within(allowed, answer->encoders) == allowed);
    demand(std::isfinite(push.force.x) && std::isfinite(push.force.y) && std::isfinite(push.hold));
  }
  demand(reader.skipped() + answers * static_cast<long>(packet_bytes) <= static_cast<long>(bytes.size()));
}

/// The first byte of each piece selects how a transfer ends and the length of the incoming data.
void run_session(std::span<const std::uint8_t> bytes) {
  FalconSessionOptions options;
  options.firmware.assign(70, 0x5a);
  options.gate = TorqueGate({.gain = glm::dvec2(1e-6)}, 1);  // so weak that nothing reaches its peak
  FalconSession session(options);
  std::vector<Transfer> under_way;
  std::int64_t now = 0;
  const auto look = [&] {
    while (const auto transfer = session.next(now)) {
      under_way.push_back(*transfer);
      demand(under_way.size() <= 2);
      if (transfer->kind != Transfer::Kind::write || transfer->size != packet_bytes || transfer->bytes[0] != '<')
        continue;
      const bool may_push = session.state() == FalconSession::State::running;
      if (!may_push) demand(std::memcmp(transfer->bytes.data() + 1, "AAAAAAAAAAAA", 12) == 0);
    }
  };
  while (!bytes.empty() && session.state() != FalconSession::State::over) {
    look();
    if (under_way.empty()) break;
    const std::uint8_t how = bytes[0];
    bytes = bytes.subspan(1);
    const auto length = std::min<std::size_t>({static_cast<std::size_t>(how & 63), bytes.size()});
    const std::size_t which = how >> 6 & 1 ? under_way.size() - 1 : 0;
    const Transfer transfer = under_way[which];
    under_way.erase(under_way.begin() + static_cast<std::ptrdiff_t>(which));
    now += 1 + (how & 15) * 1000;
    const bool is_read = transfer.kind == Transfer::Kind::read;
    const bool goes_wrong = how == 0xff;
    session.finish(transfer, goes_wrong ? Outcome::failed : Outcome::done,
                   is_read ? bytes.first(length) : std::span<const std::uint8_t>{}, now);
    if (is_read) bytes = bytes.subspan(length);
    session.command({100, 200, 300}, now);
  }
  session.stop();
  for (int i = 0; i < 100 && session.state() != FalconSession::State::over; ++i) {
    look();
    if (under_way.empty()) continue;
    const Transfer transfer = under_way.front();
    under_way.erase(under_way.begin());
    now += 50'000;
    session.finish(transfer, Outcome::timed_out, {}, now);
  }
  demand(session.state() == FalconSession::State::over);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  read_answers(bytes);
  run_session(bytes);
  return 0;
}
