// wale-keeper: lets a joystick go when the program that pushes it dies, hangs or is stopped. Wale starts one for each
// device that it opens (runtime/keeper/keeper.hpp), and it ends with it. It knows no protocol and decides nothing but
// when: its owner has prepared the packets.

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "runtime/keeper/keeper_board.hpp"
#include "runtime/keeper/process/watch.hpp"

namespace {

using namespace wale;

/// Above the loop's (runtime/stage/scheduling.hpp: 80), so that a loop that never rests does not keep it waiting, and
/// below the kernel's own watchdogs (99).
constexpr int priority = 90;

/// Closes all descriptors but these few: standard input and output may be pipes whose readers wait for their end.
void keep_only(const int* kept, int count) {
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int standard = 0; standard < 3; ++standard) dup2(nothing, standard);
  for (unsigned first = 3;;) {
    unsigned next = ~0u;  // the lowest of ours from `first` on
    for (int i = 0; i < count; ++i) {
      const auto each = static_cast<unsigned>(kept[i]);
      if (each >= first) next = std::min(next, each);
    }
    if (next > first) close_range(first, next == ~0u ? next : next - 1, 0);
    if (next == ~0u) return;
    first = next + 1;
  }
}

/// No more rights than the open descriptors give, and no delay by the pager or by others' work, where that is
/// permitted.
void settle() {
  setsid();
  if (chdir("/") != 0) return;
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  const rlimit none{0, 0};
  for (const auto limit : {RLIMIT_CORE, RLIMIT_FSIZE, RLIMIT_NPROC}) setrlimit(limit, &none);
  sched_param wanted{};
  wanted.sched_priority = priority;
  sched_setscheduler(0, SCHED_FIFO, &wanted);
  mlockall(MCL_CURRENT | MCL_FUTURE);
}

}  // namespace

/// wale-keeper BOARD OWNER WAKE [DEVICE]: the numbers of descriptors that it inherits.
int main(int count, char** words) {
  constexpr int least = 3, most = 4;
  int handed[most] = {-1, -1, -1, -1};
  const int given = count - 1;
  for (int i = 0; i < std::min(given, most); ++i) {
    char* end = nullptr;
    handed[i] = static_cast<int>(std::strtol(words[1 + i], &end, 10));
    if (*end != 0 || handed[i] < 3) handed[i] = -1;
  }
  if (given < least || given > most || handed[0] < 0 || handed[1] < 0 || handed[2] < 0) {
    std::fprintf(stderr,
                 "wale-keeper: Wale starts this program for each joystick that it opens, and nobody else needs "
                 "to\n");
    return 2;
  }
  void* mapped = mmap(nullptr, sizeof(KeeperBoard), PROT_READ | PROT_WRITE, MAP_SHARED, handed[0], 0);
  if (mapped == MAP_FAILED) return 1;
  auto& board = *static_cast<KeeperBoard*>(mapped);
  if (board.version != KeeperBoard::current_version) return 1;
  keep_only(handed, given);
  static const LetGoPlan plan = board.plan;  // whatever the owner does to its memory later
  keeper::DeviceNode node(plan, handed[3]);
  if (!node.is_open()) return 1;
  settle();
  keeper::watch(board, node, handed[1], handed[2]);
  return 0;
}
